//! Reads of numbers that the compiler neither splits nor merges.
//!
//! A processor that reads what it has just written must wait, unless a single write covers all that is read.
//! It therefore matters how many numbers a read takes; in hot code, these functions fix that number.

use std::arch::x86_64::{__m128d, __m256d, __m512d, _mm_loadu_pd, _mm256_loadu_pd, _mm512_loadu_pd};

/// Reads two numbers with one instruction.
#[allow(unsafe_code)]
#[target_feature(enable = "avx2")]
#[inline]
pub(crate) fn two(numbers: &[f64; 2]) -> __m128d {
    // SAFETY: there are two numbers.
    unsafe { _mm_loadu_pd(numbers.as_ptr()) }
}

/// Reads four numbers with one instruction.
#[allow(unsafe_code)]
#[target_feature(enable = "avx2")]
#[inline]
pub(crate) fn four(numbers: &[f64; 4]) -> __m256d {
    // SAFETY: there are four numbers.
    unsafe { _mm256_loadu_pd(numbers.as_ptr()) }
}

/// Reads eight numbers with one instruction.
#[allow(unsafe_code)]
#[target_feature(enable = "avx512f")]
#[inline]
pub(crate) fn eight(numbers: &[f64; 8]) -> __m512d {
    // SAFETY: there are eight numbers.
    unsafe { _mm512_loadu_pd(numbers.as_ptr()) }
}

/// Reads one number without any of its neighbors.
#[allow(unsafe_code)]
#[inline(always)]
pub(crate) fn alone(number: &u32) -> u32 {
    // SAFETY: the number is borrowed, so nothing changes it during the read.
    unsafe { std::ptr::from_ref(number).read_volatile() }
}
