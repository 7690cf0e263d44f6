//! The exits of two disks from their cells at once, by vector instructions.

use std::arch::x86_64::{
    _CMP_GT_OQ, _CMP_LT_OQ, _CMP_ORD_Q, _mm_add_pd, _mm_and_pd, _mm_andnot_pd, _mm_blendv_pd, _mm_cmp_pd,
    _mm_cvtsd_f64, _mm_div_pd, _mm_max_pd, _mm_movemask_pd, _mm_mul_pd, _mm_set_pd, _mm_set1_pd, _mm_setzero_pd,
    _mm_sqrt_pd, _mm_sub_pd, _mm_unpackhi_pd,
};

use crate::simulation::cells::Cells;
use crate::simulation::state::{Bodies, Exit};

/// Does the same as [`exits_in_turn`](super::exits_in_turn).
///
/// One root and one quotient serve both disks.
#[target_feature(enable = "avx2")]
#[inline]
pub(super) fn exits_of_both(bodies: &mut Bodies, cells: &Cells, first: usize, second: usize, now: f64) -> [bool; 2] {
    let gravity = bodies.gravity.downward();
    if bodies.gravity.rightward() != 0.0 || gravity < 0.0 {
        return super::exits_in_turn(bodies, cells, first, second, now);
    }
    let disks = [first, second];
    let ((one, at_wall), (two, also_at_wall)) = (cells.region(first), cells.region(second));
    let both = |x: f64| _mm_set1_pd(x);
    let select = |mask, yes, no| _mm_blendv_pd(no, yes, mask);
    let (zero, infinity, time) = (_mm_setzero_pd(), both(f64::INFINITY), both(now));
    let (first, second) = (&bodies.particles[first].trajectory, &bodies.particles[second].trajectory);
    let (fallen, gained) = bodies.fall(now);
    let of_both = |one: f64, two: f64| _mm_set_pd(two, one);
    let velocity_x = of_both(first.velocity.x, second.velocity.x);
    let velocity_y = of_both(first.velocity.y, second.velocity.y);
    let x = of_both(first.position.x, second.position.x);
    let y = of_both(first.position.y, second.position.y);
    let x = _mm_add_pd(_mm_add_pd(x, _mm_mul_pd(velocity_x, time)), both(fallen.x));
    let y = _mm_add_pd(_mm_add_pd(y, _mm_mul_pd(velocity_y, time)), both(fallen.y));
    let velocity_x = _mm_add_pd(velocity_x, both(gained.x));
    let velocity_y = _mm_add_pd(velocity_y, both(gained.y));

    let speed = |velocity| _mm_andnot_pd(both(-0.0), velocity);
    let rightward = _mm_cmp_pd::<_CMP_GT_OQ>(velocity_x, zero);
    let (to_left, to_right) = (_mm_sub_pd(x, of_both(one.min.x, two.min.x)), _mm_sub_pd(of_both(one.max.x, two.max.x), x));
    let sideways = _mm_div_pd(select(rightward, to_right, to_left), speed(velocity_x));

    let above = _mm_max_pd(_mm_sub_pd(of_both(one.max.y, two.max.y), y), zero);
    let below = _mm_max_pd(_mm_sub_pd(y, of_both(one.min.y, two.min.y)), zero);
    let square = _mm_mul_pd(velocity_y, velocity_y);
    let rising = _mm_cmp_pd::<_CMP_GT_OQ>(velocity_y, zero);
    let twice = both(2.0 * gravity);
    let reserve = _mm_sub_pd(square, _mm_mul_pd(twice, above));
    let up = _mm_and_pd(rising, _mm_cmp_pd::<_CMP_GT_OQ>(reserve, zero));
    let radicand = select(up, reserve, _mm_add_pd(square, _mm_mul_pd(twice, below)));
    let sum = _mm_add_pd(_mm_sqrt_pd(radicand), speed(velocity_y));
    let distance = _mm_mul_pd(both(2.0), select(up, above, below));
    let numerator = select(up, distance, select(rising, sum, distance));
    let denominator = select(up, sum, select(rising, both(gravity), sum));
    let vertical = _mm_div_pd(numerator, denominator);

    let number = |wait| select(_mm_cmp_pd::<_CMP_ORD_Q>(wait, wait), wait, infinity);
    let (vertical, sideways) = (number(vertical), number(sideways));
    let level = _mm_cmp_pd::<_CMP_LT_OQ>(vertical, sideways);
    let due = _mm_add_pd(time, _mm_max_pd(select(level, vertical, sideways), zero));
    let sense = _mm_movemask_pd(select(level, up, rightward));
    let level = _mm_movemask_pd(level);
    let exit = |k: i32| Exit::EDGES[(level >> k & 1) as usize][(sense >> k & 1) as usize];
    bodies.exit(disks[0], _mm_cvtsd_f64(due), exit(0));
    bodies.exit(disks[1], _mm_cvtsd_f64(_mm_unpackhi_pd(due, due)), exit(1));
    [at_wall, also_at_wall]
}
