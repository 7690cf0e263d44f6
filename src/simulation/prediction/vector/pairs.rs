//! The search for partners, four pairs at a time, with selections by the bits of a mask (AVX-512).
//!
//! A mask has a bit for each lane; a comparison under a mask compares only the lanes whose bit is set.

use std::arch::x86_64::{
    __m256d, __m256i, _CMP_EQ_OQ as EQUAL, _CMP_GT_OQ as GREATER, _CMP_LE_OQ as LESS_OR_EQUAL,
    _CMP_LT_OQ as LESS, _mm256_add_pd as add, _mm256_cmp_pd_mask as compare,
    _mm256_cmplt_epu64_mask as is_smaller, _mm256_cvtsd_f64, _mm256_cvtsi256_si32, _mm256_div_pd as divide,
    _mm256_mask_cmp_pd_mask as compare_under, _mm256_mask_mov_epi64, _mm256_mask_mov_pd,
    _mm256_maskz_mov_pd as where_true, _mm256_max_pd as max, _mm256_min_epu64, _mm256_min_pd as min,
    _mm256_mul_pd as multiply, _mm256_permute_pd, _mm256_permute2f128_pd, _mm256_permute4x64_epi64,
    _mm256_set_epi64x, _mm256_set_m128d, _mm256_set1_epi64x, _mm256_set1_pd as all, _mm256_setzero_pd,
    _mm256_shuffle_epi32, _mm256_sqrt_pd as square_root, _mm256_sub_pd as subtract, _mm256_unpackhi_pd,
    _mm256_unpacklo_pd,
};

use glam::DVec2;

use crate::instructions::{Instructions, load};
use crate::simulation::prediction::{self as plain, LANES};
use crate::simulation::state::{Bodies, Earliest, Trajectory};

/// A search in progress: the motion of its disk, the same in all lanes, and the earliest collision found in
/// each lane.
struct Search {
    x: __m256d,
    y: __m256d,
    velocity_x: __m256d,
    velocity_y: __m256d,
    due: __m256d,
    partner: __m256i,
}

/// The numbers that all pairs share.
#[derive(Clone, Copy)]
struct Common {
    now: __m256d,
    contact_squared: __m256d,
    period_x: __m256d,
    period_y: __m256d,
}

impl Common {
    #[target_feature(enable = "avx512vl")]
    #[inline]
    fn new(now: f64, diameter: f64, periods: DVec2) -> Self {
        let (period_x, period_y) = (all(periods.x), all(periods.y));
        Self { now: all(now), contact_squared: all(diameter * diameter), period_x, period_y }
    }
}

impl Search {
    #[target_feature(enable = "avx512vl")]
    #[inline]
    fn new(disk: &Trajectory, known: Earliest) -> Self {
        Self {
            x: all(disk.position.x),
            y: all(disk.position.y),
            velocity_x: all(disk.velocity.x),
            velocity_y: all(disk.velocity.y),
            due: all(known.due),
            partner: _mm256_set1_epi64x(i64::from(known.partner)),
        }
    }

    /// Predicts the collisions with four more disks, and keeps the earlier collision in each lane. At equal
    /// times, the smaller partner wins.
    #[target_feature(enable = "avx512vl")]
    #[inline]
    fn improve<const IS_PERIODIC: bool>(&mut self, bodies: &Bodies, lanes: &[u32; LANES], common: &Common) {
        let Common { now, contact_squared, period_x, period_y } = *common;
        let [a, b, c, d] = lanes.each_ref().map(load::alone);
        let row = |other: u32| &bodies.particles[other as usize].trajectory;
        let [x, y, velocity_x, velocity_y] = columns(row(a), row(b), row(c), row(d));
        let velocity_x = subtract(velocity_x, self.velocity_x);
        let velocity_y = subtract(velocity_y, self.velocity_y);
        let mut x = add(subtract(x, self.x), multiply(velocity_x, now));
        let mut y = add(subtract(y, self.y), multiply(velocity_y, now));
        if IS_PERIODIC {
            (x, y) = (nearest_image(x, period_x), nearest_image(y, period_y));
        }
        let due = add(now, wait(x, y, velocity_x, velocity_y, contact_squared));
        let partner = _mm256_set_epi64x(i64::from(d), i64::from(c), i64::from(b), i64::from(a));
        let better = compare::<LESS>(due, self.due)
            | compare_under::<EQUAL>(is_smaller(partner, self.partner), due, self.due);
        self.due = _mm256_mask_mov_pd(self.due, better, due);
        self.partner = _mm256_mask_mov_epi64(self.partner, better, partner);
    }

    /// Returns the earliest collision of all lanes.
    #[target_feature(enable = "avx512vl")]
    #[inline]
    fn earliest(&self) -> Earliest {
        let due = min(self.due, _mm256_permute2f128_pd::<0b01>(self.due, self.due));
        let due = min(due, _mm256_permute_pd::<0b01_01>(due));
        let is_first = compare::<EQUAL>(self.due, due);
        let nobody = _mm256_set1_epi64x(i64::from(u32::MAX));
        let partner = _mm256_mask_mov_epi64(nobody, is_first, self.partner);
        let partner = _mm256_min_epu64(partner, _mm256_permute4x64_epi64::<0b01_00_11_10>(partner));
        let partner = _mm256_min_epu64(partner, _mm256_shuffle_epi32::<0b01_00_11_10>(partner));
        Earliest { due: _mm256_cvtsd_f64(due), partner: _mm256_cvtsi256_si32(partner).cast_unsigned() }
    }
}

/// Returns the x and y of the positions of four trajectories, then the x and y of their velocities.
///
/// Position and velocity are read separately, because the last collision wrote them separately.
#[target_feature(enable = "avx512vl")]
#[inline]
fn columns(a: &Trajectory, b: &Trajectory, c: &Trajectory, d: &Trajectory) -> [__m256d; 4] {
    let rows =
        |low: &DVec2, high: &DVec2| _mm256_set_m128d(load::two(high.as_ref()), load::two(low.as_ref()));
    let (even, odd) = (rows(&a.position, &c.position), rows(&b.position, &d.position));
    let (x, y) = (_mm256_unpacklo_pd(even, odd), _mm256_unpackhi_pd(even, odd));
    let (even, odd) = (rows(&a.velocity, &c.velocity), rows(&b.velocity, &d.velocity));
    [x, y, _mm256_unpacklo_pd(even, odd), _mm256_unpackhi_pd(even, odd)]
}

/// See [`Pairs::wait`](plain::Pairs::wait).
#[target_feature(enable = "avx512vl")]
#[inline]
fn wait(
    x: __m256d,
    y: __m256d,
    velocity_x: __m256d,
    velocity_y: __m256d,
    contact_squared: __m256d,
) -> __m256d {
    let zero = _mm256_setzero_pd();
    let approach = add(multiply(x, velocity_x), multiply(y, velocity_y));
    let gap = subtract(add(multiply(x, x), multiply(y, y)), contact_squared);
    let square = add(multiply(velocity_x, velocity_x), multiply(velocity_y, velocity_y));
    let discriminant = subtract(multiply(approach, approach), multiply(square, gap));
    let root = square_root(max(discriminant, zero));
    let time = max(divide(gap, subtract(root, approach)), zero);
    let touches = compare::<LESS_OR_EQUAL>(zero, discriminant) | compare::<LESS_OR_EQUAL>(gap, zero);
    let meets = compare_under::<LESS>(touches, approach, zero);
    _mm256_mask_mov_pd(all(f64::INFINITY), meets, time)
}

/// See [`nearest_image`](plain::nearest_image).
#[target_feature(enable = "avx512vl")]
#[inline]
fn nearest_image(x: __m256d, period: __m256d) -> __m256d {
    let half = multiply(all(0.5), period);
    let back = where_true(compare::<GREATER>(x, half), period);
    let forth = where_true(compare::<LESS>(x, subtract(_mm256_setzero_pd(), half)), period);
    add(subtract(x, back), forth)
}

/// Returns the first `count` candidates in groups of four. The disk itself fills the last four.
#[inline(always)]
fn by_fours(candidates: &mut [u32], count: usize, disk: usize) -> &[[u32; LANES]] {
    candidates[count..count + LANES].copy_from_slice(&[disk as u32; LANES]);
    candidates[..count.next_multiple_of(LANES)].as_chunks().0
}

/// See [`search`](plain::search). Disks of different sizes are left to that function.
#[target_feature(enable = "avx512vl")]
#[inline]
pub(in crate::simulation::prediction) fn search(
    bodies: &Bodies,
    periods: DVec2,
    disk: usize,
    candidates: &mut [u32],
    count: usize,
    now: f64,
    known: Earliest,
) -> Earliest {
    let Some(diameter) = bodies.common_diameter() else {
        return plain::search::<2>(bodies, periods, disk, candidates, count, now, known);
    };
    let common = Common::new(now, diameter, periods);
    let mut search = Search::new(&bodies.particles[disk].trajectory, known);
    if periods == DVec2::ZERO {
        for lanes in by_fours(candidates, count, disk) {
            search.improve::<false>(bodies, lanes, &common);
        }
    } else {
        for lanes in by_fours(candidates, count, disk) {
            search.improve::<true>(bodies, lanes, &common);
        }
    }
    search.earliest()
}

/// See [`search_both`](plain::search_both). Disks of different sizes are left to that function.
#[target_feature(enable = "avx512vl")]
#[inline]
pub(in crate::simulation::prediction) fn search_both(
    instructions: Instructions,
    bodies: &mut Bodies,
    periods: DVec2,
    disks: [usize; 2],
    found: &mut [Vec<u32>; 2],
    counts: [usize; 2],
    now: f64,
) {
    let Some(diameter) = bodies.common_diameter() else {
        return plain::search_both(instructions, bodies, periods, disks, found, counts, now);
    };
    let common = Common::new(now, diameter, periods);
    let [first, second] = if periods == DVec2::ZERO {
        improve_both::<false>(bodies, disks, found, counts, &common)
    } else {
        improve_both::<true>(bodies, disks, found, counts, &common)
    };
    bodies.expect(disks[0], first);
    bodies.expect(disks[1], second);
}

#[target_feature(enable = "avx512vl")]
#[inline]
fn improve_both<const IS_PERIODIC: bool>(
    bodies: &Bodies,
    disks: [usize; 2],
    [one, two]: &mut [Vec<u32>; 2],
    counts: [usize; 2],
    common: &Common,
) -> [Earliest; 2] {
    let (one, two) = (by_fours(one, counts[0], disks[0]), by_fours(two, counts[1], disks[1]));
    let search = |disk: usize| Search::new(&bodies.particles[disk].trajectory, Earliest::NONE);
    let (mut first, mut second) = (search(disks[0]), search(disks[1]));
    for turn in 0..one.len().max(two.len()) {
        // The shorter list repeats its last four pairs, since a second prediction of a pair changes nothing.
        // Neither list is empty, since each has the disk itself.
        first.improve::<IS_PERIODIC>(bodies, &one[turn.min(one.len() - 1)], common);
        second.improve::<IS_PERIODIC>(bodies, &two[turn.min(two.len() - 1)], common);
    }
    [first.earliest(), second.earliest()]
}
