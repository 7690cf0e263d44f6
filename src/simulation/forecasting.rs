//! Forecasts of the next event of each disk: the search for its partner, the end of its flight, and the
//! message to the scheduler.

use std::hint::select_unpredictable;

use super::Simulation;
use super::engine::Engine;
use super::prediction::{LANES, earliest_collision, find_partners, leave_cell, leave_cells};
use super::state::{Earliest, Exit, Forecast};
use crate::Flight;
use crate::boundary::{Boundary, FirstTouch, Touch};
use crate::collision::{CollisionRule, Material};
use crate::scheduler::EventScheduler;

/// Number of epochs ahead to which the search for a wall extends. The limit makes every search end.
pub(super) const HORIZON: f64 = 2.0;

impl<R: CollisionRule, B: Boundary, S: EventScheduler> Simulation<R, B, S> {
    /// Finds the next event of a disk among all its neighbors, and passes its time to the scheduler.
    pub(super) fn predict(&mut self, disk: usize) {
        self.find_next(disk);
        self.schedule(disk);
    }

    /// Finds the next event of a disk among all its neighbors.
    ///
    /// The function is not inlined, since the whole search is inlined into it.
    #[inline(never)]
    pub(super) fn find_next(&mut self, disk: usize) {
        self.engine.find_partner(disk);
        self.end_flight(disk);
    }

    /// Finds another partner for a disk whose partner has collided since the prediction. The end of the
    /// disk's own flight in its cell stays the same.
    #[inline(always)]
    pub(super) fn predict_partner(&mut self, disk: usize) {
        self.engine.find_partner(disk);
        self.schedule(disk);
    }

    /// Finds the next events of two disks, whose neighbors have been listed.
    #[inline(always)]
    pub(super) fn find_next_of_both(&mut self, disks: [usize; 2], counts: [usize; 2]) {
        let engine: &mut Engine = &mut self.engine;
        let Engine { instructions, bodies, cells, clock, scratch, .. } = engine;
        let (instructions, periods, now) = (*instructions, cells.grid.periods, clock.now);
        find_partners(instructions, instructions, bodies, periods, disks, &mut scratch.found, counts, now);
        let at_wall = leave_cells(instructions, bodies, cells, disks[0], disks[1], now);
        for (disk, at_wall) in disks.into_iter().zip(at_wall) {
            if at_wall {
                self.end_at_wall(disk);
            }
        }
    }

    /// Passes the time of a disk's next event to the scheduler.
    #[inline(always)]
    pub(super) fn schedule(&mut self, disk: usize) {
        self.parts.scheduler.set(disk, self.engine.forecast(disk).due());
    }

    /// Finds when and where a disk's flight in its cell ends.
    #[inline(always)]
    pub(super) fn end_flight(&mut self, disk: usize) {
        self.engine.instructions.run(
            #[inline(always)]
            move || {
                if leave_cell(&mut self.engine.bodies, &self.engine.cells, disk, self.engine.clock.now) {
                    self.end_at_wall(disk);
                }
            },
        );
    }

    /// Ends the flight at a wall, if the disk touches one before it leaves its cell.
    fn end_at_wall(&mut self, disk: usize) {
        let now = self.engine.clock.now;
        let horizon = now + HORIZON * self.engine.clock.epoch_length;
        let flight = self.engine.flight(disk);
        let until = self.engine.forecast(disk).exit_due.min(horizon);
        let (time, exit) = match self.parts.boundary.first_touch(&flight, until) {
            FirstTouch::At(Touch { time, wall }) => {
                self.engine.forecast_mut(disk).wall = wall as u16;
                // A prediction cannot return an error. An impossible touch is due immediately, and is
                // reported when its turn comes.
                let is_possible = time >= now && time <= until && wall < self.engine.wall_count;
                if is_possible { (time, Exit::Wall) } else { (now, Exit::Impossible) }
            }
            FirstTouch::NotBefore(open) if open >= until => {
                if self.engine.forecast(disk).exit_due <= horizon {
                    return;
                }
                (horizon, Exit::Horizon)
            }
            FirstTouch::NotBefore(open) if open > now => (open, Exit::Horizon),
            // The search makes no progress, so the run would not either.
            FirstTouch::NotBefore(_) => (now, Exit::Impossible),
        };
        let forecast = self.engine.forecast_mut(disk);
        (forecast.exit_due, forecast.exit) = (time, exit);
    }
}

impl Engine {
    /// Finds the next collision of a disk among all its neighbors.
    #[inline(always)]
    fn find_partner(&mut self, disk: usize) {
        let count = self.neighbors(disk, 0);
        let earliest = self.earliest_collision(disk, count, Earliest::NONE);
        self.bodies.expect(disk, earliest);
    }

    /// Lists the neighbors of a disk in the first or second list. Returns their number.
    #[inline(always)]
    pub(super) fn neighbors(&mut self, disk: usize, list: usize) -> usize {
        self.cells.around(disk, &mut self.scratch.found[list])
    }

    #[inline(always)]
    pub(super) fn earliest_collision(&mut self, disk: usize, count: usize, known: Earliest) -> Earliest {
        let (periods, now) = (self.cells.grid.periods, self.clock.now);
        let found = &mut self.scratch.found[0];
        earliest_collision(self.instructions, &self.bodies, periods, disk, found, count, now, known)
    }

    /// Sets `earliest` as the next collision of a disk whose next collision was `known` before.
    ///
    /// The code does not branch on whether the two are the same. The result is known last of all, and a
    /// misprediction would undo much work.
    #[inline]
    pub(super) fn expect_next(&mut self, disk: usize, earliest: Earliest, known: Earliest) {
        let nobody = earliest.partner as usize >= self.bodies.len();
        // Without a partner, the disk's own index is used, since a count is read in any case.
        let partner = select_unpredictable(nobody, disk, earliest.partner as usize);
        // A known collision keeps the count of its own prediction. With the partner's present count, a
        // prediction that the partner's last collision has outdated would count as valid.
        let counted = self.forecast(disk).partner_collisions;
        let collisions = select_unpredictable(earliest == known, counted, self.forecast(partner).collisions);
        self.forecast_mut(disk).set_collision(earliest, collisions);
    }

    /// Enlarges the buffer for neighbors to the size that the cells need.
    ///
    /// The need grows when a cell gets crowded, so this method is called wherever disks enter cells.
    #[inline]
    pub(super) fn make_room(&mut self) {
        let room = self.cells.room() + LANES;
        if self.scratch.found[0].len() < room {
            self.enlarge_room(room);
        }
    }

    #[cold]
    #[inline(never)]
    fn enlarge_room(&mut self, room: usize) {
        for found in &mut self.scratch.found {
            found.resize(room, 0);
        }
    }

    #[inline]
    pub(super) fn flight(&self, disk: usize) -> Flight {
        let now = self.clock.now;
        let (position, velocity) = (self.bodies.position(disk, now), self.bodies.velocity(disk, now));
        let Material { radius, kind, .. } = self.bodies.material(disk);
        Flight::new(now, position, velocity, self.bodies.gravity.acceleration(), radius).with_kind(kind)
    }

    #[inline]
    pub(super) fn forecast(&self, disk: usize) -> &Forecast {
        &self.bodies.particles[disk].forecast
    }

    #[inline]
    pub(super) fn forecast_mut(&mut self, disk: usize) -> &mut Forecast {
        &mut self.bodies.particles[disk].forecast
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec2;

    use crate::Simulation;
    use crate::boundary::{Container, Thermal, Wall};
    use crate::collision::Frictional;
    use crate::disk::Disk;
    use crate::error::ParameterError;
    use crate::instructions::Instructions;

    type Outcome<T = ()> = Result<T, Box<dyn std::error::Error>>;

    #[test]
    fn all_instructions_of_this_processor_give_the_same_bits() -> Outcome {
        for (is_periodic, growth) in [(false, 0.0), (true, 0.0), (true, 0.001)] {
            let states =
                Instructions::all().into_iter().map(|which| state_after_a_run(which, is_periodic, growth));
            let states = states.collect::<Outcome<Vec<_>>>()?;
            assert!(states.iter().all(|state| *state == states[0]));
        }
        Ok(())
    }

    /// Returns the disks after a run with these instructions; radii grow by `growth` from disk to disk.
    fn state_after_a_run(instructions: Instructions, is_periodic: bool, growth: f64) -> Outcome<Vec<Disk>> {
        let container = Container::open(20.0)?.with_temperature(Wall::Floor, Thermal::new(2.0)?)?;
        let container = if is_periodic { container.with_periodic_sides().unwrap() } else { container };
        let disk = |k: u32| {
            let place = DVec2::new(0.7 + 1.3 * f64::from(k % 15), 0.7 + 1.3 * f64::from(k / 15));
            let velocity = DVec2::new(libm::sin(f64::from(k)), libm::cos(f64::from(7 * k)));
            Disk::new(place, 0.3 + growth * f64::from(k))?.with_velocity(velocity)
        };
        let disks = (0..150).map(disk).collect::<Result<Vec<_>, ParameterError>>()?;
        let mut run = Simulation::builder(Frictional::from_inelasticity(0.02, 0.02, 0.3)?, container)
            .disks(disks)
            .gravity(0.1)
            .build()?;
        run.engine.instructions = instructions;
        run.run_until(100.0, &mut ())?;
        Ok(run.disks())
    }
}
