//! The exits of two disks from their cells, computed together (AVX2 and AVX-512).
//!
//! A mask is a number with all bits set in the lanes where it is true.

use std::arch::x86_64::{
    __m128d, _CMP_GT_OQ as GREATER, _CMP_LT_OQ as LESS, _CMP_ORD_Q as BOTH_ARE_NUMBERS, _mm_add_pd as add,
    _mm_and_pd as and, _mm_andnot_pd as and_not, _mm_blendv_pd, _mm_cmp_pd as compare, _mm_cvtsd_f64,
    _mm_div_pd as divide, _mm_max_pd as max, _mm_movemask_pd, _mm_mul_pd as multiply, _mm_set_pd,
    _mm_set1_pd as both, _mm_setzero_pd, _mm_sqrt_pd as square_root, _mm_sub_pd as subtract, _mm_unpackhi_pd,
};

use crate::simulation::cells::Cells;
use crate::simulation::state::{Bodies, Exit};

/// See `exits_of_both` in `prediction/exits.rs`. Gravity must pull straight down, or not at all.
#[target_feature(enable = "avx2")]
#[inline]
pub(in crate::simulation::prediction) fn exits_of_both(
    bodies: &mut Bodies,
    cells: &Cells,
    first: usize,
    second: usize,
    now: f64,
) -> [bool; 2] {
    let ((one, at_wall), (two, also_at_wall)) = (cells.region(first), cells.region(second));
    let (a, b) = (&bodies.particles[first].trajectory, &bodies.particles[second].trajectory);
    let ((fallen, gained), time, zero) = (bodies.fall(now), both(now), _mm_setzero_pd());
    let (velocity_x, velocity_y) = (pair(a.velocity.x, b.velocity.x), pair(a.velocity.y, b.velocity.y));
    let (x, y) = (pair(a.position.x, b.position.x), pair(a.position.y, b.position.y));
    let x = add(add(x, multiply(velocity_x, time)), both(fallen.x));
    let y = add(add(y, multiply(velocity_y, time)), both(fallen.y));
    let (velocity_x, velocity_y) = (add(velocity_x, both(gained.x)), add(velocity_y, both(gained.y)));

    let rightward = compare::<GREATER>(velocity_x, zero);
    let (right, left) = (pair(one.max.x, two.max.x), pair(one.min.x, two.min.x));
    let distance = select(rightward, subtract(right, x), subtract(x, left));
    let sideways = number(divide(distance, size(velocity_x)));
    let (top, bottom) = (pair(one.max.y, two.max.y), pair(one.min.y, two.min.y));
    let (above, below) = (subtract(top, y), subtract(y, bottom));
    let (vertical, up) = vertical_exit(above, below, velocity_y, bodies.gravity.downward());

    let level = compare::<LESS>(vertical, sideways);
    let due = add(time, max(select(level, vertical, sideways), zero));
    let (sense, level) = (_mm_movemask_pd(select(level, up, rightward)), _mm_movemask_pd(level));
    let exit = |lane: i32| Exit::EDGES[(level >> lane & 1) as usize][(sense >> lane & 1) as usize];
    bodies.exit(first, _mm_cvtsd_f64(due), exit(0));
    bodies.exit(second, _mm_cvtsd_f64(_mm_unpackhi_pd(due, due)), exit(1));
    [at_wall, also_at_wall]
}

/// See `vertical_exit` in `prediction/exits.rs`.
#[target_feature(enable = "avx2")]
#[inline]
fn vertical_exit(above: __m128d, below: __m128d, velocity: __m128d, gravity: f64) -> (__m128d, __m128d) {
    let zero = _mm_setzero_pd();
    let (above, below) = (max(above, zero), max(below, zero));
    let (square, twice) = (multiply(velocity, velocity), both(2.0 * gravity));
    let reserve = subtract(square, multiply(twice, above));
    let rising = compare::<GREATER>(velocity, zero);
    // For a disk that falls, the plain function has a negative reserve instead. Both functions select the
    // same numbers.
    let up = and(rising, compare::<GREATER>(reserve, zero));
    let radicand = select(up, reserve, add(square, multiply(twice, below)));
    let sum = add(square_root(radicand), size(velocity));
    let distance = multiply(both(2.0), select(up, above, below));
    let numerator = select(up, distance, select(rising, sum, distance));
    let denominator = select(up, sum, select(rising, both(gravity), sum));
    (number(divide(numerator, denominator)), up)
}

#[target_feature(enable = "avx2")]
#[inline]
fn pair(first: f64, second: f64) -> __m128d {
    _mm_set_pd(second, first)
}

#[target_feature(enable = "avx2")]
#[inline]
fn select(mask: __m128d, yes: __m128d, no: __m128d) -> __m128d {
    _mm_blendv_pd(no, yes, mask)
}

/// Returns the absolute values.
#[target_feature(enable = "avx2")]
#[inline]
fn size(numbers: __m128d) -> __m128d {
    and_not(both(-0.0), numbers)
}

/// Replaces NaN by infinity.
#[target_feature(enable = "avx2")]
#[inline]
fn number(waits: __m128d) -> __m128d {
    select(compare::<BOTH_ARE_NUMBERS>(waits, waits), waits, both(f64::INFINITY))
}
