//! Walls in the event loop: where a flight ends at one, and what a collision with one does.

use glam::DVec2;

use super::Simulation;
use super::errors::{BoundaryFault, Outcome, RunError};
use super::event_loop::MOST_NUDGES;
use super::events::Event;
use super::resolution::{failed, is_unit_and_finite, resolve_wall};
use super::state::{Exit, Forecast};
use crate::Flight;
use crate::boundary::{Boundary, Response};
use crate::collision::CollisionRule;
use crate::observable::{Collision, Observer};
use crate::scheduler::EventScheduler;

/// Epochs that a wall is searched for ahead: no search is endless.
const HORIZON: f64 = 2.0;

impl<R: CollisionRule, B: Boundary, S: EventScheduler> Simulation<R, B, S> {
    /// A disk collides with a wall.
    pub(super) fn collide_with_wall<O: Observer + ?Sized>(
        &mut self,
        disk: usize,
        wall: usize,
        observer: &mut O,
    ) -> Outcome<Event> {
        let now = self.clock.now;
        let position = self.bodies.position(disk, now);
        let surface = self.boundary.surface(wall, position, now);
        if !is_unit_and_finite(&surface) {
            let (normal, velocity) = (surface.normal, surface.velocity);
            return Err(self.boundary_fault(disk, BoundaryFault::Surface { wall, normal, velocity }).into());
        }
        let parts = (self.bodies.velocity(disk, now) - surface.velocity).dot(surface.normal) > 0.0;
        let (collision, kick) =
            resolve_wall(&self.bodies, &self.rule, &mut self.generator, &surface, &self.clock, disk, wall);
        if !kick.is_possible() {
            let error = match surface.response {
                Response::Rule(own) => failed(own, &collision),
                _ => failed(&self.rule, &collision),
            };
            return Err(error.into());
        }
        if let Some((_, depth)) = self.boundary.overlap(position, self.bodies.material(disk).radius, now) {
            self.counters.max_wall_overlap = self.counters.max_wall_overlap.max(depth);
        }
        if !self.is_tame(&kick) {
            self.begin_epoch_for(&[kick]);
        }
        self.counters.wall_collisions += 1;
        self.count_regime(&collision);
        self.kick(disk, &kick);
        observer.on_collision(&collision);
        self.find_next(disk);
        if parts {
            self.leave_wall(disk, wall, &collision);
        }
        self.schedule(disk);
        Ok(Event::WallCollision { disk, wall })
    }

    /// Makes a disk leave a wall that it parts from, but which the boundary takes it to approach, by a rounding of its speed: they
    /// compute it in different ways. A disk that rests on a wall does not part from it.
    #[cold]
    #[inline(never)]
    fn leave_wall(&mut self, disk: usize, wall: usize, collision: &Collision) {
        for doubling in 0..MOST_NUDGES {
            let Forecast { exit, exit_due, wall: next, .. } = *self.forecast(disk);
            if exit != Exit::Wall || exit_due > self.clock.now || usize::from(next) != wall {
                return;
            }
            // The speed relative to the wall has the rounding of what it is the difference of.
            let fallen = self.bodies.fall(self.clock.now).1.length();
            let scale = f64::EPSILON * (self.bodies.speed(disk) + fallen);
            self.bodies.push(disk, collision.normal * (f64::from(1_u32 << doubling) * scale), self.clock.now);
            self.find_next(disk);
        }
    }

    /// Ends the flight at a wall, if the disk touches one before it leaves its cell.
    pub(super) fn end_at_wall(&mut self, disk: usize) {
        let now = self.clock.now;
        let horizon = now + HORIZON * self.clock.epoch_length;
        let flight = self.flight(disk);
        let forecast = &mut self.bodies.particles[disk].forecast;
        let until = forecast.exit_due.min(horizon);
        if let Some(touch) = self.boundary.first_touch(&flight, until) {
            let is_possible = touch.time >= now && touch.time <= until && touch.wall < self.wall_count;
            (forecast.exit_due, forecast.exit) =
                if is_possible { (touch.time, Exit::Wall) } else { (now, Exit::Impossible) };
            forecast.wall = touch.wall as u16;
        } else if forecast.exit_due > horizon {
            (forecast.exit_due, forecast.exit) = (horizon, Exit::Horizon);
        }
    }

    #[inline]
    fn flight(&self, disk: usize) -> Flight {
        let now = self.clock.now;
        let acceleration = DVec2::new(0.0, -self.bodies.gravity);
        let (position, velocity) = (self.bodies.position(disk, now), self.bodies.velocity(disk, now));
        Flight::new(now, position, velocity, acceleration, self.bodies.material(disk).radius)
    }

    #[cold]
    fn boundary_fault(&self, disk: usize, fault: BoundaryFault) -> RunError {
        RunError::Boundary { disk, time: self.time(), fault }
    }

    /// Asks the boundary once more for a touch that cannot be, to tell which it was.
    #[cold]
    pub(super) fn impossible_touch(&self, disk: usize) -> RunError {
        let (now, forecast) = (self.clock.now, self.forecast(disk));
        let until = now + HORIZON * self.clock.epoch_length;
        let touch = self.boundary.first_touch(&self.flight(disk), until);
        let wall = touch.map_or(usize::from(forecast.wall), |touch| touch.wall);
        let early_by = now - touch.map_or(now, |touch| touch.time);
        self.boundary_fault(disk, BoundaryFault::Touch { wall, early_by, walls: self.wall_count })
    }
}
