//! The earliest of 32 times: as plain code, and by the vector instructions of each level.

/// Number of players of a match.
pub(super) const PLAYERS: usize = 32;

/// The times of the players of a match. An empty seat has an infinite time.
#[derive(Debug, Clone, Copy)]
#[repr(align(64))]
pub(super) struct Times(pub(super) [f64; PLAYERS]);

/// The seat to name if no player is left out.
pub(super) const NO_SEAT: usize = PLAYERS;

/// Returns the earliest time, and the first seat with this time. The players in two seats are left out: they
/// count as infinitely late.
pub(super) fn earliest_without(times: &Times, one: usize, other: usize) -> (f64, usize) {
    let time = |seat: usize| if seat == one || seat == other { f64::INFINITY } else { times.0[seat] };
    let first = (0..PLAYERS).map(time).fold(f64::INFINITY, f64::min);
    (first, (0..PLAYERS).position(|seat| time(seat) == first).unwrap_or_default())
}

/// Four vectors, each with the times of eight players.
#[cfg(target_arch = "x86_64")]
pub(super) mod avx512 {
    use std::arch::x86_64::{
        _CMP_EQ_OQ, _mm512_cmp_pd_mask, _mm512_cvtsd_f64, _mm512_mask_mov_pd, _mm512_min_pd as min,
        _mm512_permute_pd, _mm512_set1_pd, _mm512_shuffle_f64x2,
    };

    use super::{PLAYERS, Times};
    use crate::instructions::load;

    #[target_feature(enable = "avx512f,bmi1")]
    #[inline]
    pub(in super::super) fn earliest_without(times: &Times, one: usize, other: usize) -> (f64, usize) {
        let (eights, _) = times.0.as_chunks();
        let (left_out, late) = ((1_u64 << one) | (1_u64 << other), _mm512_set1_pd(f64::INFINITY));
        let eight = |k: usize| _mm512_mask_mov_pd(load::eight(&eights[k]), (left_out >> (8 * k)) as u8, late);
        let [a, b, c, d] = [eight(0), eight(1), eight(2), eight(3)];
        // The earliest time of each column, then of columns that are four, two and one apart. In the end, all
        // columns hold the earliest time.
        let first = min(min(a, b), min(c, d));
        let first = min(first, _mm512_shuffle_f64x2::<0b01_00_11_10>(first, first));
        let first = min(first, _mm512_shuffle_f64x2::<0b10_11_00_01>(first, first));
        let first = min(first, _mm512_permute_pd::<0b01_01_01_01>(first));
        let seats = |times| u32::from(_mm512_cmp_pd_mask::<_CMP_EQ_OQ>(times, first));
        let seats = (seats(a) | (seats(b) << 8)) | ((seats(c) << 16) | (seats(d) << 24));
        (_mm512_cvtsd_f64(first), seats.trailing_zeros() as usize % PLAYERS)
    }
}

/// Eight vectors, each with the times of four players.
#[cfg(target_arch = "x86_64")]
pub(super) mod avx2 {
    use std::arch::x86_64::{
        _CMP_EQ_OQ, _mm256_cmp_pd, _mm256_cvtsd_f64, _mm256_max_pd as max, _mm256_min_pd as min,
        _mm256_movemask_pd, _mm256_permute_pd, _mm256_permute2f128_pd,
    };

    use super::{NO_SEAT, PLAYERS, Times};
    use crate::instructions::load;

    /// A table of negative infinities with one positive infinity. In any 32 consecutive entries, the positive
    /// infinity is in one seat or in none. AVX2 cannot select by the bits of a mask. Instead, taking the
    /// maximum of each time and its entry of this table makes one player infinitely late.
    static LATE: [f64; 3 * PLAYERS] = {
        let mut late = [f64::NEG_INFINITY; 3 * PLAYERS];
        late[PLAYERS] = f64::INFINITY;
        late
    };

    #[inline(always)]
    fn late_in(seat: usize) -> &'static [[f64; 4]] {
        // The remainder changes nothing, but proves to the compiler that the end is within the table.
        let start = (PLAYERS - seat) % (2 * PLAYERS);
        LATE[start..start + PLAYERS].as_chunks().0
    }

    #[target_feature(enable = "avx2,bmi1")]
    #[inline]
    pub(in super::super) fn earliest_without(times: &Times, one: usize, other: usize) -> (f64, usize) {
        let ((times, _), late, later) = (times.0.as_chunks(), late_in(one), late_in(other));
        let four = |k: usize| {
            let times = max(load::four(&times[k]), load::four(&late[k]));
            if other == NO_SEAT { times } else { max(times, load::four(&later[k])) }
        };
        let (a, b, c, d) = (four(0), four(1), four(2), four(3));
        let (e, f, g, h) = (four(4), four(5), four(6), four(7));
        let first = min(min(min(a, b), min(c, d)), min(min(e, f), min(g, h)));
        let first = min(first, _mm256_permute2f128_pd::<0b01>(first, first));
        let first = min(first, _mm256_permute_pd::<0b01_01>(first));
        let seats = |times| _mm256_movemask_pd(_mm256_cmp_pd::<_CMP_EQ_OQ>(times, first)).cast_unsigned();
        // If this were a sum of shifted masks, or a loop, the compiler would collect the masks through
        // memory.
        let low = ((seats(d) * 16 + seats(c)) * 16 + seats(b)) * 16 + seats(a);
        let high = ((seats(h) * 16 + seats(g)) * 16 + seats(f)) * 16 + seats(e);
        (_mm256_cvtsd_f64(first), (low | (high << 16)).trailing_zeros() as usize % PLAYERS)
    }
}

#[cfg(all(test, target_arch = "x86_64"))]
mod tests {
    use rand::{RngExt, SeedableRng};
    use rand_xoshiro::Xoshiro256PlusPlus;

    use super::{NO_SEAT, PLAYERS, Times, avx2, avx512, earliest_without};
    use crate::instructions::{Instructions, compiled_for_each};

    compiled_for_each! {
        #[inline(never)]
        earliest(times: &Times, one: usize, other: usize) -> (f64, usize)
            = earliest_without,
            |times, one, other| avx2::earliest_without(times, one, other),
            |times, one, other| avx512::earliest_without(times, one, other)
    }

    /// Returns a random time, or one of a few values, so that ties, both zeros and both infinities occur.
    fn time(generator: &mut Xoshiro256PlusPlus) -> f64 {
        const FEW: [f64; 7] = [f64::NEG_INFINITY, -1.0, -0.0, 0.0, 1.0, f64::MAX, f64::INFINITY];
        if generator.random() { FEW[generator.random_range(0..FEW.len())] } else { generator.random() }
    }

    #[test]
    fn all_levels_name_the_same_seat() {
        let mut generator = Xoshiro256PlusPlus::seed_from_u64(3);
        for round in 0..1_000_000 {
            // In some rounds, most times are infinite.
            let is_late =
                |generator: &mut Xoshiro256PlusPlus| round % 8 == 0 && generator.random_range(0..16) > 0;
            let times = Times(std::array::from_fn(|_| {
                if is_late(&mut generator) { f64::INFINITY } else { time(&mut generator) }
            }));
            let mut seat = || generator.random_range(0..=PLAYERS);
            let (one, other) = (seat(), if round % 2 == 0 { NO_SEAT } else { seat() });
            let answers = Instructions::all().into_iter().map(|level| earliest(level, &times, one, other));
            let answers: Vec<_> = answers.collect();
            assert!(
                answers.iter().all(|answer| *answer == answers[0]),
                "{times:?} {one} {other}: {answers:?}"
            );
        }
    }
}
