//! A hint to the processor to fetch data from memory before they are needed.

/// Asks the processor to fetch the cache line of an element. Nothing happens if there is no such element.
///
/// In a system larger than the caches, each event touches dozens of lines that no cache holds. Waiting for
/// them one by one takes most of the time of a run. Lines that are requested some events ahead arrive in
/// time, side by side.
#[inline(always)]
#[allow(unsafe_code)]
pub(crate) fn prefetch<T>(slice: &[T], index: usize) {
    #[cfg(target_arch = "x86_64")]
    if let Some(element) = slice.get(index) {
        // SAFETY: a prefetch reads and writes nothing that the program can see, and the address belongs to a
        // live element. SSE is part of every x86-64 processor.
        unsafe {
            use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
            _mm_prefetch::<_MM_HINT_T0>(std::ptr::from_ref(element).cast());
        }
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = (slice, index);
}
