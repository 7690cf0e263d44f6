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
    use crate::instructions::load;

    #[target_feature(enable = "avx512f,avx512dq,bmi1,bmi2,lzcnt,popcnt")]
    #[inline]
    pub(in super::super) fn earliest_without(times: &Times, one: usize, other: usize) -> (f64, usize) {
        let hidden = ((1_u64 << one) | (1_u64 << other)) as u32;
        let late = _mm512_set1_pd(f64::INFINITY);
        let (eights, _) = times.0.as_chunks();
        let eight = |k: usize| _mm512_mask_mov_pd(load::eight(&eights[k]), (hidden >> (8 * k)) as u8, late);
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

#[cfg(target_arch = "x86_64")]
pub(super) mod avx2 {
    use std::arch::x86_64::*;

    use super::{PLAYERS, Times};
    use crate::instructions::load;

    /// Infinity before and behind which there is nothing late: a window of 32 numbers shows it in any seat.
    static LATE: [f64; 3 * PLAYERS] = {
        let mut late = [f64::NEG_INFINITY; 3 * PLAYERS];
        late[PLAYERS] = f64::INFINITY;
        late
    };

    #[inline(always)]
    fn window(seat: usize) -> &'static [[f64; 4]] {
        let start = (PLAYERS - seat) % (2 * PLAYERS);
        LATE[start..start + PLAYERS].as_chunks().0
    }

    #[target_feature(enable = "avx2,bmi1")]
    #[inline]
    pub(in super::super) fn earliest_without(times: &Times, one: usize, other: usize) -> (f64, usize) {
        let ((times, _), one, two) = (times.0.as_chunks(), window(one), window(other));
        let four = |k: usize| {
            let late = _mm256_max_pd(load::four(&times[k]), load::four(&one[k]));
            if other == super::NO_SEAT { late } else { _mm256_max_pd(late, load::four(&two[k])) }
        };
        let (a, b, c, d, e, f, g, h) = (four(0), four(1), four(2), four(3), four(4), four(5), four(6), four(7));
        let min = |a, b| _mm256_min_pd(a, b);
        let first = min(min(min(a, b), min(c, d)), min(min(e, f), min(g, h)));
        let first = min(first, _mm256_permute2f128_pd::<1>(first, first));
        let first = min(first, _mm256_permute_pd::<0b0101>(first));
        let at = |t| _mm256_movemask_pd(_mm256_cmp_pd::<_CMP_EQ_OQ>(t, first)).cast_unsigned();
        let low = ((at(d) * 16 + at(c)) * 16 + at(b)) * 16 + at(a);
        let high = ((at(h) * 16 + at(g)) * 16 + at(f)) * 16 + at(e);
        (_mm256_cvtsd_f64(first), (low | (high << 16)).trailing_zeros() as usize % PLAYERS)
    }
}
