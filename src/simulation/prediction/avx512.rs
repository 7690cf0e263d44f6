//! The search for the partner of a disk by vector instructions.
//!
//! Each line does for four pairs what the line of the same name in `prediction.rs` does for one. [`Pairs`] says
//! why. The compiler would make nearly the same of the plain code, but it reads the numbers of four
//! candidates at once, from memory into which the cells have just been copied, one over the other. Such a
//! load waits until all of these copies have left the processor: 5 % of a run.
//!
//! [`Pairs`]: super::Pairs

use std::arch::x86_64::{
    __m256d, __m256i, _CMP_EQ_OQ, _CMP_GT_OQ, _CMP_LE_OQ, _CMP_LT_OQ, _mm256_add_pd as add,
    _mm256_cmp_pd_mask, _mm256_cmplt_epu64_mask, _mm256_cvtsd_f64,
    _mm256_cvtsi256_si32, _mm256_div_pd as divide, _mm256_mask_cmp_pd_mask, _mm256_mask_mov_epi64,
    _mm256_mask_mov_pd, _mm256_maskz_mov_pd, _mm256_max_pd as max, _mm256_min_epu64, _mm256_min_pd as min,
    _mm256_mul_pd as multiply, _mm256_permute_pd, _mm256_permute2f128_pd, _mm256_permute4x64_epi64,
    _mm256_set_epi64x, _mm256_set_m128d, _mm256_set1_epi64x, _mm256_set1_pd as all, _mm256_setzero_pd,
    _mm256_shuffle_epi32, _mm256_sqrt_pd, _mm256_sub_pd as subtract, _mm256_unpackhi_pd, _mm256_unpacklo_pd,
};

use glam::DVec2;

use super::LANES;
use crate::instructions::{Instructions, load};
use crate::simulation::state::{Bodies, Earliest, Trajectory};

/// The search of a disk: its motion in all lanes, and the earliest collision of each lane.
struct Search {
    x: __m256d,
    y: __m256d,
    velocity_x: __m256d,
    velocity_y: __m256d,
    due: __m256d,
    partner: __m256i,
}

/// What all pairs have in common.
struct Common {
    now: __m256d,
    contact_squared: __m256d,
    periods: [__m256d; 2],
}

impl Common {
    #[target_feature(enable = "avx512vl")]
    #[inline]
    fn new(now: f64, diameter: f64, periods: DVec2) -> Self {
        let periods = [all(periods.x), all(periods.y)];
        Self { now: all(now), contact_squared: all(diameter * diameter), periods }
    }
}

impl Search {
    #[target_feature(enable = "avx512vl")]
    #[inline]
    fn new(disk: &Trajectory, known: Earliest) -> Self {
        let [x, y, velocity_x, velocity_y] = disk.row();
        Self {
            x: all(x),
            y: all(y),
            velocity_x: all(velocity_x),
            velocity_y: all(velocity_y),
            due: all(known.due),
            partner: _mm256_set1_epi64x(i64::from(known.partner)),
        }
    }

    /// Takes the collisions with four more disks that are earlier.
    #[target_feature(enable = "avx512vl")]
    #[inline]
    fn meet<const IS_PERIODIC: bool>(&mut self, bodies: &Bodies, lanes: &[u32; LANES], common: &Common) {
        let Common { now, contact_squared, periods } = *common;
        let [a, b, c, d] = lanes.each_ref().map(load::one);
        let row = |other: u32| &bodies.particles[other as usize].trajectory;
        let [x, y, velocity_x, velocity_y] = columns(row(a), row(b), row(c), row(d));
        let (velocity_x, velocity_y) = (subtract(velocity_x, self.velocity_x), subtract(velocity_y, self.velocity_y));
        let x = add(subtract(x, self.x), multiply(velocity_x, now));
        let y = add(subtract(y, self.y), multiply(velocity_y, now));
        let (x, y) = if IS_PERIODIC { (nearest_image(x, periods[0]), nearest_image(y, periods[1])) } else { (x, y) };
        let zero = _mm256_setzero_pd();
        let approach = add(multiply(x, velocity_x), multiply(y, velocity_y));
        let gap = subtract(add(multiply(x, x), multiply(y, y)), contact_squared);
        let square = add(multiply(velocity_x, velocity_x), multiply(velocity_y, velocity_y));
        let discriminant = subtract(multiply(approach, approach), multiply(square, gap));
        let root = _mm256_sqrt_pd(max(discriminant, zero));
        let wait = max(divide(gap, subtract(root, approach)), zero);
        let real = _mm256_cmp_pd_mask::<_CMP_LE_OQ>(zero, discriminant) | _mm256_cmp_pd_mask::<_CMP_LE_OQ>(gap, zero);
        let meets = _mm256_mask_cmp_pd_mask::<_CMP_LT_OQ>(real, approach, zero);
        let due = _mm256_mask_mov_pd(all(f64::INFINITY), meets, add(now, wait));
        let partner = _mm256_set_epi64x(i64::from(d), i64::from(c), i64::from(b), i64::from(a));
        let is_smaller = _mm256_cmplt_epu64_mask(partner, self.partner);
        let better = _mm256_cmp_pd_mask::<_CMP_LT_OQ>(due, self.due)
            | _mm256_mask_cmp_pd_mask::<_CMP_EQ_OQ>(is_smaller, due, self.due);
        self.due = _mm256_mask_mov_pd(self.due, better, due);
        self.partner = _mm256_mask_mov_epi64(self.partner, better, partner);
    }

    /// Returns the earliest collision of all lanes.
    #[target_feature(enable = "avx512vl")]
    #[inline]
    fn earliest(&self) -> Earliest {
        let due = min(self.due, _mm256_permute2f128_pd::<1>(self.due, self.due));
        let due = min(due, _mm256_permute_pd::<0b0101>(due));
        let first = _mm256_cmp_pd_mask::<_CMP_EQ_OQ>(self.due, due);
        // Of the lanes with this time, the smallest partner.
        let nobody = _mm256_set1_epi64x(i64::from(u32::MAX));
        let partner = _mm256_mask_mov_epi64(nobody, first, self.partner);
        let partner = _mm256_min_epu64(partner, _mm256_permute4x64_epi64::<0b0100_1110>(partner));
        let partner = _mm256_min_epu64(partner, _mm256_shuffle_epi32::<0b0100_1110>(partner));
        Earliest { due: _mm256_cvtsd_f64(due), partner: _mm256_cvtsi256_si32(partner).cast_unsigned() }
    }
}

/// Returns the x of four trajectories, their y, and both components of their velocities.
#[target_feature(enable = "avx512vl")]
#[inline]
fn columns(a: &Trajectory, b: &Trajectory, c: &Trajectory, d: &Trajectory) -> [__m256d; 4] {
    let pairs = |low: &DVec2, high: &DVec2| _mm256_set_m128d(load::two(high.as_ref()), load::two(low.as_ref()));
    let (even, odd) = (pairs(&a.position, &c.position), pairs(&b.position, &d.position));
    let (even_velocity, odd_velocity) = (pairs(&a.velocity, &c.velocity), pairs(&b.velocity, &d.velocity));
    [
        _mm256_unpacklo_pd(even, odd),
        _mm256_unpackhi_pd(even, odd),
        _mm256_unpacklo_pd(even_velocity, odd_velocity),
        _mm256_unpackhi_pd(even_velocity, odd_velocity),
    ]
}

#[target_feature(enable = "avx512vl")]
#[inline]
fn nearest_image(x: __m256d, period: __m256d) -> __m256d {
    let half = multiply(all(0.5), period);
    let back = _mm256_maskz_mov_pd(_mm256_cmp_pd_mask::<_CMP_GT_OQ>(x, half), period);
    let minus_half = subtract(_mm256_setzero_pd(), half);
    let forth = _mm256_maskz_mov_pd(_mm256_cmp_pd_mask::<_CMP_LT_OQ>(x, minus_half), period);
    add(subtract(x, back), forth)
}

/// Returns the first `count` candidates by fours. The disk itself, which never meets itself, fills the last four.
#[inline(always)]
fn padded(candidates: &mut [u32], count: usize, disk: usize) -> &[[u32; LANES]] {
    candidates[count..count + LANES].copy_from_slice(&[disk as u32; LANES]);
    candidates[..count.next_multiple_of(LANES)].as_chunks().0
}

/// Does the same as [`search`](super::search).
#[target_feature(enable = "avx512vl")]
#[inline]
pub(super) fn search(
    bodies: &Bodies,
    periods: DVec2,
    disk: usize,
    candidates: &mut [u32],
    count: usize,
    now: f64,
    known: Earliest,
) -> Earliest {
    let Some(diameter) = bodies.common_diameter() else {
        return super::search::<2>(bodies, periods, disk, candidates, count, now, known);
    };
    let candidates = padded(candidates, count, disk);
    let common = Common::new(now, diameter, periods);
    let mut search = Search::new(&bodies.particles[disk].trajectory, known);
    if periods == DVec2::ZERO {
        for lanes in candidates {
            search.meet::<false>(bodies, lanes, &common);
        }
    } else {
        for lanes in candidates {
            search.meet::<true>(bodies, lanes, &common);
        }
    }
    search.earliest()
}

/// Does the same as [`search_in_turn`](super::search_in_turn).
///
/// The searches are independent of each other, so the processor works on both at once.
#[target_feature(enable = "avx512vl")]
#[inline]
pub(super) fn search_both(
    instructions: Instructions,
    bodies: &mut Bodies,
    periods: DVec2,
    disks: [usize; 2],
    found: &mut [Vec<u32>; 2],
    counts: [usize; 2],
    now: f64,
) {
    let Some(diameter) = bodies.common_diameter() else {
        return super::search_in_turn(instructions, bodies, periods, disks, found, counts, now);
    };
    let common = Common::new(now, diameter, periods);
    let [first, second] = if periods == DVec2::ZERO {
        meet_both::<false>(bodies, disks, found, counts, &common)
    } else {
        meet_both::<true>(bodies, disks, found, counts, &common)
    };
    bodies.expect(disks[0], first);
    bodies.expect(disks[1], second);
}

#[target_feature(enable = "avx512vl")]
#[inline]
fn meet_both<const IS_PERIODIC: bool>(
    bodies: &Bodies,
    disks: [usize; 2],
    [one, two]: &mut [Vec<u32>; 2],
    counts: [usize; 2],
    common: &Common,
) -> [Earliest; 2] {
    let (one, two) = (padded(one, counts[0], disks[0]), padded(two, counts[1], disks[1]));
    let [mut first, mut second] = disks.map(|disk| Search::new(&bodies.particles[disk].trajectory, Earliest::NONE));
    for at in 0..one.len().max(two.len()) {
        // The shorter list waits at its end: no disk is met earlier by being met again.
        first.meet::<IS_PERIODIC>(bodies, &one[at.min(one.len() - 1)], common);
        second.meet::<IS_PERIODIC>(bodies, &two[at.min(two.len() - 1)], common);
    }
    [first.earliest(), second.earliest()]
}
