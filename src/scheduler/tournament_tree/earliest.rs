//! The earliest of 32 times, by the vector instructions of each level.

/// Number of players of a match.
pub(super) const PLAYERS: usize = 32;

/// The times of the players of a match.
#[derive(Debug, Clone, Copy)]
#[repr(align(64))]
pub(super) struct Times(pub(super) [f64; PLAYERS]);

/// Stands for a seat if no player is left out.
pub(super) const NO_SEAT: usize = PLAYERS;

/// Returns the earliest time, and the first seat of this time, without the players in two seats: they count
/// as infinitely late.
pub(super) fn earliest_without(times: &Times, one: usize, other: usize) -> (f64, usize) {
    let mut times = times.0;
    for seat in [one, other].into_iter().filter(|&seat| seat != NO_SEAT) {
        times[seat] = f64::INFINITY;
    }
    let first = times.into_iter().fold(f64::INFINITY, f64::min);
    (first, times.iter().position(|&time| time == first).unwrap_or_default())
}

#[cfg(target_arch = "x86_64")]
pub(super) mod avx512 {
    use std::arch::x86_64::*;

    use super::Times;

    #[target_feature(enable = "avx512f,avx512dq,bmi1,bmi2,lzcnt,popcnt")]
    #[inline]
    pub(in super::super) fn earliest_without(times: &Times, one: usize, other: usize) -> (f64, usize) {
        let hidden = ((1_u64 << one) | (1_u64 << other)) as u32;
        let late = _mm512_set1_pd(f64::INFINITY);
        let t = &times.0;
        let eight = |k: usize| {
            let t = &t[8 * k..8 * k + 8];
            let all = _mm512_setr_pd(t[0], t[1], t[2], t[3], t[4], t[5], t[6], t[7]);
            _mm512_mask_mov_pd(all, (hidden >> (8 * k)) as u8, late)
        };
        let [a, b, c, d] = [eight(0), eight(1), eight(2), eight(3)];
        let first = _mm512_min_pd(_mm512_min_pd(a, b), _mm512_min_pd(c, d));
        let first = _mm512_min_pd(first, _mm512_shuffle_f64x2::<0b0100_1110>(first, first));
        let first = _mm512_min_pd(first, _mm512_shuffle_f64x2::<0b1011_0001>(first, first));
        let first = _mm512_min_pd(first, _mm512_permute_pd::<0b0101_0101>(first));
        let at = |t| u32::from(_mm512_cmp_pd_mask::<_CMP_EQ_OQ>(t, first));
        let seats = (at(a) | (at(b) << 8)) | ((at(c) << 16) | (at(d) << 24));
        (_mm512_cvtsd_f64(first), seats.trailing_zeros() as usize % super::PLAYERS)
    }
}
