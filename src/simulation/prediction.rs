//! Predictions of the time at which two disks collide.
//!
//! `exits.rs` computes the time at which a disk leaves its cell, and `vector.rs` has the same arithmetic in
//! vector instructions.

mod exits;
#[cfg(target_arch = "x86_64")]
mod vector;

use glam::DVec2;

use super::state::{Bodies, Earliest};
use crate::instructions::{Instructions, compiled_for_each};
pub(super) use exits::{leave_cell, leave_cells};
#[cfg(target_arch = "x86_64")]
use vector::pairs;

/// Number of pairs that are predicted side by side.
///
/// Each step of the arithmetic is written for all lanes together. The compiler turns it into vector
/// instructions, and no branch depends on whether a pair approaches: such a branch would be a coin toss.
pub(super) const LANES: usize = 4;

/// The relative positions and velocities of several pairs.
#[derive(Debug, Clone, Copy, Default)]
struct Pairs {
    x: [f64; LANES],
    y: [f64; LANES],
    velocity_x: [f64; LANES],
    velocity_y: [f64; LANES],
    contact_squared: [f64; LANES],
}

impl Pairs {
    /// Returns the time until each pair touches, or infinity if it never does.
    ///
    /// With the separation r, the relative velocity v and the contact distance σ, the pair touches at the
    /// smaller root of v² t² + 2 (r·v) t + (r² - σ²) = 0. The textbook root (-r·v - √d)/v² subtracts two
    /// numbers that are nearly equal when the disks nearly touch, and divides by zero when they move alike.
    /// With numerator and denominator multiplied by √d - r·v, the root is (r² - σ²)/(√d - r·v). Both terms of
    /// the denominator are positive while the pair approaches, so nothing cancels, and the gap in the
    /// numerator is as exact as the positions are.
    ///
    /// The method is stable event detection (Bannerman et al. 2014). A pair that touches or overlaps by
    /// rounding collides immediately while it approaches, and never while it recedes. If an overlap of 1e-16
    /// were a reason to wait for the other root, the disks would pass through each other. If every such
    /// overlap were a collision, a pair that has just collided would collide forever.
    #[inline]
    fn wait(&self) -> [f64; LANES] {
        let mut wait = [0.0; LANES];
        for (lane, wait) in wait.iter_mut().enumerate() {
            let (x, y) = (self.x[lane], self.y[lane]);
            let (velocity_x, velocity_y) = (self.velocity_x[lane], self.velocity_y[lane]);
            let approach = x * velocity_x + y * velocity_y;
            let gap = x * x + y * y - self.contact_squared[lane];
            let square = velocity_x * velocity_x + velocity_y * velocity_y;
            let discriminant = approach * approach - square * gap;
            let root = discriminant.max(0.0).sqrt();
            let time = (gap / (root - approach)).max(0.0);
            let meets = (approach < 0.0) & ((discriminant >= 0.0) | (gap <= 0.0));
            *wait = if meets { time } else { f64::INFINITY };
        }
        wait
    }
}

/// The earliest collision found in each lane.
#[derive(Debug, Clone, Copy)]
struct Best {
    due: [f64; LANES],
    partner: [u64; LANES],
}

impl Best {
    #[inline]
    fn new(known: Earliest) -> Self {
        Self { due: [known.due; LANES], partner: [u64::from(known.partner); LANES] }
    }

    /// Replaces the known collision in each lane where a new one is earlier. At equal times, the smaller
    /// partner wins.
    #[inline]
    fn improve(&mut self, due: [f64; LANES], partners: &[u32]) {
        for lane in 0..LANES {
            let partner = u64::from(partners[lane]);
            let better = (due[lane] < self.due[lane])
                | ((due[lane] == self.due[lane]) & (partner < self.partner[lane]));
            self.due[lane] = if better { due[lane] } else { self.due[lane] };
            self.partner[lane] = if better { partner } else { self.partner[lane] };
        }
    }

    /// Returns the earliest collision of all lanes.
    #[inline]
    fn earliest(&self) -> Earliest {
        // Time and partner form one number, which orders by time first and then by partner. Times are not
        // negative, so their bits have the same order.
        let rank =
            |lane: usize| (u128::from(self.due[lane].to_bits()) << 32) | u128::from(self.partner[lane]);
        let first = (1..LANES).fold(rank(0), |first, lane| first.min(rank(lane)));
        Earliest { due: f64::from_bits((first >> 32) as u64), partner: first as u32 }
    }
}

/// Returns the shortest distance that equals `x` up to periods. The period is 0 where the domain is not
/// periodic.
#[inline]
pub(super) fn nearest_image(x: f64, period: f64) -> f64 {
    let half = 0.5 * period;
    let back = if x > half { period } else { 0.0 };
    let forth = if x < -half { period } else { 0.0 };
    x - back + forth
}

/// Returns whether two disks approach each other, in exactly the arithmetic of [`earliest_collision`]. Other
/// arithmetic would round differently, and a pair that seems to part here could be predicted to collide.
#[inline]
pub(super) fn are_closing(bodies: &Bodies, periods: DVec2, disk: usize, partner: usize, now: f64) -> bool {
    let (mine, other) = (bodies.particles[disk].trajectory.row(), bodies.particles[partner].trajectory.row());
    let [x, y, velocity_x, velocity_y]: [f64; 4] = std::array::from_fn(|k| other[k] - mine[k]);
    let (x, y) = (x + velocity_x * now, y + velocity_y * now);
    let (x, y) = (nearest_image(x, periods.x), nearest_image(y, periods.y));
    x * velocity_x + y * velocity_y < 0.0
}

compiled_for_each! {
    /// Returns the earliest collision of `disk` with one of the first `count` of `candidates`, or `known`
    /// if that is earlier.
    ///
    /// The candidates may include the disk itself, which never meets itself: the room behind the candidates
    /// is filled with it.
    #[inline(never)]
    pub(super) earliest_collision(
        bodies: &Bodies, periods: DVec2, disk: usize, candidates: &mut [u32], count: usize, now: f64, known: Earliest
    ) -> Earliest = search::<0>, search::<1>, pairs::search
}

compiled_for_each! {
    /// Finds the next collisions of two disks: of each with one of the first `counts` in its list.
    #[inline(never)]
    pub(super) find_partners(
        instructions: Instructions, bodies: &mut Bodies, periods: DVec2, disks: [usize; 2],
        found: &mut [Vec<u32>; 2], counts: [usize; 2], now: f64
    ) -> () = search_both, search_both, pairs::search_both
}

#[inline(always)]
fn search_both(
    instructions: Instructions,
    bodies: &mut Bodies,
    periods: DVec2,
    disks: [usize; 2],
    found: &mut [Vec<u32>; 2],
    counts: [usize; 2],
    now: f64,
) {
    for ((disk, found), count) in disks.into_iter().zip(found).zip(counts) {
        let none = Earliest::NONE;
        let earliest = earliest_collision(instructions, bodies, periods, disk, found, count, now, none);
        bodies.expect(disk, earliest);
    }
}

#[inline(always)]
fn search<const COPY: u8>(
    bodies: &Bodies,
    periods: DVec2,
    disk: usize,
    candidates: &mut [u32],
    count: usize,
    now: f64,
    known: Earliest,
) -> Earliest {
    candidates[count..count + LANES].copy_from_slice(&[disk as u32; LANES]);
    let candidates = &candidates[..count.next_multiple_of(LANES)];
    let image = |x: f64, y: f64| (nearest_image(x, periods.x), nearest_image(y, periods.y));
    // The choice is made outside the loop over pairs, so each of the four loops tests neither sizes nor
    // periods.
    match (bodies.common_diameter(), periods == DVec2::ZERO) {
        (Some(diameter), true) => scan(bodies, disk, candidates, now, known, |_| diameter, |x, y| (x, y)),
        (Some(diameter), false) => scan(bodies, disk, candidates, now, known, |_| diameter, image),
        (None, is_walled) => {
            let radius = bodies.radius(disk);
            let contact = |other: usize| radius + bodies.radius(other);
            if is_walled {
                return scan(bodies, disk, candidates, now, known, contact, |x, y| (x, y));
            }
            scan(bodies, disk, candidates, now, known, contact, image)
        }
    }
}

#[inline(always)]
fn scan(
    bodies: &Bodies,
    disk: usize,
    candidates: &[u32],
    now: f64,
    known: Earliest,
    contact: impl Fn(usize) -> f64,
    image: impl Fn(f64, f64) -> (f64, f64),
) -> Earliest {
    let mine = bodies.particles[disk].trajectory.row();
    let mut best = Best::new(known);
    for lanes in candidates.chunks_exact(LANES) {
        let rows: [[f64; 4]; LANES] = std::array::from_fn(|lane| {
            let other = bodies.particles[lanes[lane] as usize].trajectory.row();
            std::array::from_fn(|k| other[k] - mine[k])
        });
        let mut pairs = Pairs::default();
        for (lane, [x, y, velocity_x, velocity_y]) in rows.into_iter().enumerate() {
            pairs.x[lane] = x;
            pairs.y[lane] = y;
            pairs.velocity_x[lane] = velocity_x;
            pairs.velocity_y[lane] = velocity_y;
        }
        for (lane, &candidate) in lanes.iter().enumerate() {
            let x = pairs.x[lane] + pairs.velocity_x[lane] * now;
            let y = pairs.y[lane] + pairs.velocity_y[lane] * now;
            (pairs.x[lane], pairs.y[lane]) = image(x, y);
            let contact = contact(candidate as usize);
            pairs.contact_squared[lane] = contact * contact;
        }
        best.improve(pairs.wait().map(|wait| now + wait), lanes);
    }
    best.earliest()
}
