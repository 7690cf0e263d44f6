//! Separates partners that rounding has left approaching each other after a collision.

use glam::DVec2;

use super::Simulation;
use super::engine::Engine;
use super::prediction::are_closing;
use super::state::{Exit, Forecast};
use crate::boundary::Boundary;
use crate::collision::CollisionRule;
use crate::observable::Collision;
use crate::scheduler::EventScheduler;

/// Largest number of pushes, each twice as strong as the last, with which two partners are made to part. If
/// these fail, the partners stay unchanged.
const MOST_NUDGES: u32 = 24;

/// Closing speed after a collision, relative to the speeds of the disks, above which it is not a rounding
/// error: the rule leaves the disks approaching on purpose.
const WANTED: f64 = 1e-9;

impl<R: CollisionRule, B: Boundary, S: EventScheduler> Simulation<R, B, S> {
    /// Makes a disk leave a wall if the engine and the boundary disagree about its motion.
    ///
    /// Because its speed is rounded, a disk can part from the wall in the engine's arithmetic and approach it
    /// in the boundary's. A disk that rests on a wall does not part from it, and stays unchanged. The pushes
    /// are added to the collision, so that its impulse and energy are the impulse and energy that the disk
    /// receives.
    #[cold]
    #[inline(never)]
    pub(super) fn leave_wall(&mut self, disk: usize, wall: usize, collision: &mut Collision) {
        let now = self.engine.clock.now;
        for doubling in 0..MOST_NUDGES {
            let Forecast { exit, exit_due, wall: next, .. } = *self.engine.forecast(disk);
            if exit != Exit::Wall || exit_due > now || usize::from(next) != wall {
                return;
            }
            // The speed relative to the wall is a difference of speeds, so it has the rounding error of these
            // speeds.
            let fallen = self.engine.bodies.fall(now).1.length();
            let scale = f64::EPSILON * (self.engine.bodies.speed(disk) + fallen);
            let before = self.engine.bodies.velocity(disk, now);
            self.engine.bodies.push(disk, collision.normal * (f64::from(1_u32 << doubling) * scale), now);
            let after = self.engine.bodies.velocity(disk, now);
            collision.add_push(before, after, self.engine.bodies.material(disk).inverse_mass);
            self.find_next(disk);
        }
    }
}

impl Engine {
    /// Makes two disks part if their relative speed after a collision is zero, or if rounding lets them
    /// approach.
    ///
    /// Velocities are rounded relative to themselves, not to their difference. A rule that takes all of the
    /// closing speed leaves about 1e-17 of it, of either sign. Disks that touch and still approach collide
    /// immediately, again and again. Therefore, the speed at which the disks part is raised in steps of its
    /// rounding error, until the prediction sees them part.
    #[cold]
    #[inline(never)]
    pub(super) fn part(&mut self, disk: usize, partner: usize, normal: DVec2, left: f64) {
        let masses = [disk, partner].map(|disk| self.bodies.material(disk).inverse_mass);
        let (periods, now) = (self.cells.grid().periods(), self.clock.now);
        let speed = self.bodies.speed(disk) + self.bodies.speed(partner);
        if left > WANTED * speed {
            return;
        }
        for doubling in 0..MOST_NUDGES {
            if !are_closing(&self.bodies, periods, disk, partner, now) {
                return;
            }
            let push = normal * (f64::from(1_u32 << doubling) * f64::EPSILON * speed);
            // The push is shared as an impulse would be, so that momentum is conserved.
            let total = masses[0] + masses[1];
            self.bodies.push(disk, push * (masses[0] / total), now);
            self.bodies.push(partner, -push * (masses[1] / total), now);
        }
    }
}
