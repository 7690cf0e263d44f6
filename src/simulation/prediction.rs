//! Predictions of the time at which two disks collide, and of the time at which a disk leaves its cell.

#[cfg(target_arch = "x86_64")]
mod avx512;
#[cfg(target_arch = "x86_64")]
mod exits;

use glam::DVec2;

use super::cells::Cells;
use super::state::{Bodies, Earliest, Exit};
use crate::boundary::Region;
use crate::instructions::{Instructions, compiled_for_each};

/// Number of pairs that are predicted side by side.
///
/// Each step of the arithmetic is written for all lanes at once. The compiler turns it into vector
/// instructions, and no branch depends on whether a pair approaches: such a branch is a coin toss.
pub(super) const LANES: usize = 4;

/// The relative positions and velocities of some pairs.
#[derive(Debug, Clone, Copy, Default)]
struct Pairs {
    x: [f64; LANES],
    y: [f64; LANES],
    velocity_x: [f64; LANES],
    velocity_y: [f64; LANES],
    contact_squared: [f64; LANES],
}

impl Pairs {
    /// Returns the time until each pair touches; infinite for never.
    ///
    /// With the separation r, the relative velocity v and the contact distance σ, the pair touches at the
    /// smaller root of v² t² + 2 (r·v) t + (r² - σ²) = 0. The textbook root (-r·v - √d)/v² subtracts two
    /// numbers that are nearly equal when the disks nearly touch, and divides by zero when they move alike.
    /// Multiplied above and below by √d - r·v, the root is (r² - σ²)/(√d - r·v). Both terms of the
    /// denominator are positive while the pair approaches, so nothing cancels, and the gap in the numerator
    /// is as exact as the positions are.
    ///
    /// The method is stable event detection (Bannerman et al. 2014). A pair that touches or overlaps by
    /// rounding collides at once while it approaches, and never while it recedes. If an overlap of 1e-16 were
    /// a reason to wait for the other root, the disks would pass through each other. If it were a collision
    /// in any case, a pair that has just collided would collide forever.
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

    /// Takes collisions that are earlier. Of equal times, the smaller partner wins.
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

/// Tells whether two disks close, in exactly the arithmetic of [`earliest_collision`]. Other arithmetic would
/// round differently, and a pair that seems to part here could be predicted to collide.
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
    /// The candidates may include the disk itself, which never meets itself. So the room behind the
    /// candidates is filled with the disk.
    #[inline(never)]
    earliest_collision(
        bodies: &Bodies, periods: DVec2, disk: usize, candidates: &mut [u32], count: usize, now: f64, known: Earliest
    ) -> Earliest = search::<0>, search::<1>, avx512::search
}

compiled_for_each! {
    /// Finds the next collisions of two disks, each with one of the first candidates in its list.
    #[inline(never)]
    find_partners(
        again: Instructions, bodies: &mut Bodies, periods: DVec2, disks: [usize; 2],
        found: &mut [Vec<u32>; 2], counts: [usize; 2], now: f64
    ) -> () = search_in_turn, search_in_turn, avx512::search_both
}

#[inline(always)]
fn search_in_turn(
    instructions: Instructions,
    bodies: &mut Bodies,
    periods: DVec2,
    disks: [usize; 2],
    found: &mut [Vec<u32>; 2],
    counts: [usize; 2],
    now: f64,
) {
    for ((disk, found), count) in disks.into_iter().zip(found).zip(counts) {
        let earliest = earliest_collision(instructions, bodies, periods, disk, found, count, now, Earliest::NONE);
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

compiled_for_each! {
    /// Finds when and where two disks leave their cells. Returns whether they can touch a wall there.
    #[inline(never)]
    leave_cells(bodies: &mut Bodies, cells: &Cells, first: usize, second: usize, now: f64) -> [bool; 2]
        = exits_in_turn, exits::exits_of_both, exits::exits_of_both
}

#[inline(always)]
fn exits_in_turn(bodies: &mut Bodies, cells: &Cells, first: usize, second: usize, now: f64) -> [bool; 2] {
    [leave_cell(bodies, cells, first, now), leave_cell(bodies, cells, second, now)]
}

/// Finds when and where a disk leaves its cell. Returns whether it can touch a wall there.
#[inline(always)]
pub(super) fn leave_cell(bodies: &mut Bodies, cells: &Cells, disk: usize, now: f64) -> bool {
    let (region, at_wall) = cells.region(disk);
    let (due, exit) = cell_exit(bodies, disk, &region, now);
    bodies.exit(disk, due, exit);
    at_wall
}

/// Returns the offset at which a disk leaves its cell, and the edge.
#[inline(always)]
fn cell_exit(bodies: &Bodies, disk: usize, region: &Region, now: f64) -> (f64, Exit) {
    let (position, velocity) = (bodies.position(disk, now), bodies.velocity(disk, now));
    let rightward = velocity.x > 0.0;
    let distance = if rightward { region.max.x - position.x } else { position.x - region.min.x };
    let sideways = distance / velocity.x.abs();
    let (above, below) = (region.max.y - position.y, position.y - region.min.y);
    let (vertical, up) = exit_under_pull(above, below, velocity.y, bodies.gravity.downward());
    let (sideways, rightward) = if bodies.gravity.rightward() == 0.0 {
        (sideways, rightward)
    } else {
        let (left, right) = (position.x - region.min.x, region.max.x - position.x);
        exit_sideways(left, right, velocity.x, bodies.gravity.rightward())
    };
    // For a disk at rest that reaches no edge, the result is 0/0 or inf/inf, which means never.
    let sideways = if sideways.is_nan() { f64::INFINITY } else { sideways };
    let level = vertical < sideways;
    let wait = if level { vertical } else { sideways }.max(0.0);
    let exit = Exit::EDGES[usize::from(level)][usize::from((level & up) | (!level & rightward))];
    (now + wait, exit)
}

/// Returns the time until a disk leaves its column, and whether it leaves to the right, for gravity to the
/// right. It is not inlined, since gravity is vertical in most runs.
#[inline(never)]
fn exit_sideways(left: f64, right: f64, velocity: f64, gravity: f64) -> (f64, bool) {
    let (wait, leftward) = exit_under_pull(left, right, -velocity, gravity);
    (wait, !leftward)
}

/// Returns the time until a disk leaves its row, and whether it leaves through the edge above, for gravity
/// that pulls down, or up if it is negative.
#[inline(always)]
fn exit_under_pull(above: f64, below: f64, velocity: f64, gravity: f64) -> (f64, bool) {
    if gravity >= 0.0 {
        return vertical_exit(above, below, velocity, gravity);
    }
    let (wait, down) = vertical_exit(below, above, -velocity, -gravity);
    (wait, !down)
}

/// Returns the time until a disk leaves its row, and whether it leaves through the edge above, for gravity
/// that pulls down.
///
/// There are three ways: up to the edge above, up and down again through the edge below, or straight down.
/// The code selects numbers and does not branch: the way that a disk takes is a coin toss, and a
/// misprediction would cost more than all three roots. Each root has the form in which nothing cancels: a
/// distance over a sum of speeds if the disk goes straight to the edge, and a sum of speeds over gravity if
/// it turns back.
#[inline(always)]
fn vertical_exit(above: f64, below: f64, velocity: f64, gravity: f64) -> (f64, bool) {
    let (above, below) = (above.max(0.0), below.max(0.0));
    let square = velocity * velocity;
    let reserve = square - 2.0 * gravity * above;
    let reserve = if velocity > 0.0 { reserve } else { -1.0 };
    let radicand = if reserve > 0.0 { reserve } else { square + 2.0 * gravity * below };
    let sum = radicand.sqrt() + velocity.abs();
    let distance = 2.0 * if reserve > 0.0 { above } else { below };
    let turning = if velocity > 0.0 { sum } else { distance };
    let numerator = if reserve > 0.0 { distance } else { turning };
    let turning = if velocity > 0.0 { gravity } else { sum };
    let denominator = if reserve > 0.0 { sum } else { turning };
    let wait = numerator / denominator;
    (if wait.is_nan() { f64::INFINITY } else { wait }, reserve > 0.0)
}
