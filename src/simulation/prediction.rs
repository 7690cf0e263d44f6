//! When a disk meets another, and when it leaves its cell.

use glam::DVec2;

use super::bodies::{Bodies, Trajectory};
use super::event::Exit;
use crate::boundary::Region;

/// The earliest collision found so far.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Earliest {
    pub(super) due: f64,
    pub(super) partner: u32,
}

impl Earliest {
    pub(super) const NONE: Self = Self { due: f64::INFINITY, partner: u32::MAX };

    /// The earlier of the two; of equal times the smaller partner.
    #[inline]
    fn or(self, due: f64, partner: u32) -> Self {
        let better = (due < self.due) | ((due == self.due) & (partner < self.partner));
        Self {
            due: if better { due } else { self.due },
            partner: if better { partner } else { self.partner },
        }
    }
}

/// When two disks touch that are `distance` apart in position and move with this relative velocity, seen from `now`.
///
/// Stable event detection (Bannerman et al. 2014): touching or overlapping by rounding counts at once while they
/// approach, never while they recede. The root is written so that nothing cancels, and without a branch.
#[inline]
fn touch(separation: DVec2, velocity: DVec2, contact_squared: f64, now: f64) -> f64 {
    let approach = separation.dot(velocity);
    let gap = separation.length_squared() - contact_squared;
    let discriminant = approach * approach - velocity.length_squared() * gap;
    let wait = gap / (discriminant.max(0.0).sqrt() - approach);
    let meets = (approach < 0.0) & ((discriminant >= 0.0) | (gap <= 0.0));
    if meets { now + wait.max(0.0) } else { f64::INFINITY }
}

/// The shortest way around periodic sides; `period` is 0 if there are none.
#[inline]
pub(super) fn nearest_image(mut separation: DVec2, period: f64) -> DVec2 {
    let half = 0.5 * period;
    if separation.x > half {
        separation.x -= period;
    } else if separation.x < -half {
        separation.x += period;
    }
    separation
}

/// The earliest collision of `disk` with one of `candidates`, itself excepted, or `known` if that is earlier.
#[inline]
pub(super) fn earliest_collision(
    bodies: &Bodies,
    period: f64,
    disk: usize,
    candidates: &[u32],
    now: f64,
    known: Earliest,
) -> Earliest {
    if period == 0.0 {
        search(bodies, disk, candidates, now, known, |separation| separation)
    } else {
        search(bodies, disk, candidates, now, known, |separation| nearest_image(separation, period))
    }
}

#[inline]
fn search(
    bodies: &Bodies,
    disk: usize,
    candidates: &[u32],
    now: f64,
    known: Earliest,
    image: impl Fn(DVec2) -> DVec2,
) -> Earliest {
    let mine = &bodies.trajectories[disk];
    if let Some(diameter) = bodies.common_diameter() {
        let contact_squared = diameter * diameter;
        scan(bodies, mine, candidates, now, known, image, |_| contact_squared)
    } else {
        let radius = bodies.material(disk).radius;
        scan(bodies, mine, candidates, now, known, image, |other| {
            let contact = radius + bodies.material(other).radius;
            contact * contact
        })
    }
}

#[inline]
fn scan(
    bodies: &Bodies,
    mine: &Trajectory,
    candidates: &[u32],
    now: f64,
    known: Earliest,
    image: impl Fn(DVec2) -> DVec2,
    contact_squared: impl Fn(usize) -> f64,
) -> Earliest {
    let here = mine.at(now);
    let mut earliest = known;
    for &candidate in candidates {
        let other = &bodies.trajectories[candidate as usize];
        let separation = image(other.at(now) - here);
        let due = touch(separation, other.velocity - mine.velocity, contact_squared(candidate as usize), now);
        earliest = earliest.or(due, candidate);
    }
    earliest
}

/// When and through which edge a disk leaves its cell, gravity pulling down.
#[inline]
pub(super) fn cell_exit(
    region: &Region,
    position: DVec2,
    velocity: DVec2,
    gravity: f64,
    now: f64,
) -> (f64, Exit) {
    let rightward = velocity.x > 0.0;
    let distance = if rightward { region.max.x - position.x } else { position.x - region.min.x };
    let (sideways, side) = (distance / velocity.x.abs(), if rightward { Exit::Right } else { Exit::Left });
    let (above, below) = (region.max.y - position.y, position.y - region.min.y);
    let (vertical, level) = if gravity >= 0.0 {
        vertical_exit(above, below, velocity.y, gravity, Exit::Up, Exit::Down)
    } else {
        vertical_exit(below, above, -velocity.y, -gravity, Exit::Down, Exit::Up)
    };
    let (wait, exit) =
        if vertical < sideways || sideways.is_nan() { (vertical, level) } else { (sideways, side) };
    // NaN stands for never: at rest in a cell without an edge there.
    let wait = if wait.is_nan() { f64::INFINITY } else { wait.max(0.0) };
    (now + wait, exit)
}

/// The same in one dimension, for a disk at these distances from the edges and gravity pulling it back from `far`.
#[inline]
fn vertical_exit(above: f64, below: f64, velocity: f64, gravity: f64, far: Exit, near: Exit) -> (f64, Exit) {
    let (above, below) = (above.max(0.0), below.max(0.0));
    let square = velocity * velocity;
    let reserve = square - 2.0 * gravity * above;
    let rises = (velocity > 0.0) & (reserve > 0.0);
    let root = if rises { reserve } else { square + 2.0 * gravity * below }.sqrt();
    let wait = if rises {
        2.0 * above / (velocity + root)
    } else if velocity > 0.0 {
        (velocity + root) / gravity
    } else {
        2.0 * below / (root - velocity)
    };
    (wait, if rises { far } else { near })
}
