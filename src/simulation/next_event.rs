//! What a disk does next.

use std::hint::select_unpredictable;

use super::engine::Simulation;
use super::event::{Earliest, Exit};
use super::prediction::{LANES, cell_exit, earliest_collision};
use crate::Flight;
use crate::boundary::Boundary;
use crate::collision::CollisionRule;
use crate::scheduler::EventScheduler;

/// How far ahead a wall is searched for, in epochs: no search is endless.
const HORIZON: f64 = 2.0;

impl<R: CollisionRule, B: Boundary, S: EventScheduler> Simulation<R, B, S> {
    #[inline]
    pub(super) fn earliest_collision(&mut self, disk: usize, count: usize, known: Earliest) -> Earliest {
        let period = self.cells.grid().period();
        earliest_collision(&self.bodies, period, disk, &mut self.found, count, self.now, known)
    }

    /// Finds the next event of a disk among all its neighbours, and tells the scheduler.
    pub(super) fn predict(&mut self, disk: usize) {
        self.find_next(disk);
        self.schedule(disk);
    }

    /// Finds the next event of a disk among all its neighbours.
    ///
    /// One copy for all callers: the whole search is inlined into it.
    #[inline(never)]
    pub(super) fn find_next(&mut self, disk: usize) {
        self.find_partner(disk);
        self.end_flight(disk);
    }

    /// Finds another partner for a disk whose partner has collided meanwhile: its own flight in its cell ends as it did.
    #[inline(never)]
    pub(super) fn predict_partner(&mut self, disk: usize) {
        self.find_partner(disk);
        self.schedule(disk);
    }

    /// Finds the next collision of a disk among all its neighbours.
    #[inline(always)]
    fn find_partner(&mut self, disk: usize) {
        let count = self.find_neighbours(disk);
        let earliest = self.earliest_collision(disk, count, Earliest::NONE);
        let partner_collisions =
            self.bodies.particles.get(earliest.partner as usize).map_or(0, |partner| partner.slot.collisions);
        self.slot_mut(disk).meet(earliest, partner_collisions);
    }

    /// Tells the scheduler when the next event of a disk is due.
    #[inline]
    pub(super) fn schedule(&mut self, disk: usize) {
        self.scheduler.set(disk, self.slot(disk).due());
    }

    /// The next collision of a disk, where `known` was before, is this one.
    ///
    /// No branch on whether it is the same: that is known last of all, and much would be undone (dilute 4 % slower).
    #[inline]
    pub(super) fn meet_next(&mut self, disk: usize, earliest: Earliest, known: Earliest) {
        let nobody = earliest.partner as usize >= self.bodies.len();
        let partner = select_unpredictable(nobody, disk, earliest.partner as usize);
        let counted = self.slot(disk).partner_collisions;
        let collisions = select_unpredictable(earliest == known, counted, self.slot(partner).collisions);
        self.slot_mut(disk).meet(earliest, collisions);
    }

    /// Writes the disks around this one to the room for neighbours; returns how many.
    #[inline]
    pub(super) fn find_neighbours(&mut self, disk: usize) -> usize {
        self.make_room();
        self.cells.around(disk, &mut self.found)
    }

    /// Keeps the room for neighbours in step with the cells, which may have grown.
    #[inline]
    pub(super) fn make_room(&mut self) {
        let room = self.cells.room() + LANES;
        if self.found.len() < room {
            self.found.resize(room, 0);
        }
    }

    /// Finds when the flight of a disk in its cell ends, and how.
    #[inline]
    pub(super) fn end_flight(&mut self, disk: usize) {
        let (place, grid) = (self.cells.place(disk), self.cells.grid());
        let (exit_due, exit) = cell_exit(&self.bodies, disk, &grid.region(place), self.now);
        let at_wall = self.cells.is_at_wall(place);
        let slot = self.slot_mut(disk);
        (slot.exit_due, slot.exit) = (exit_due, exit);
        if at_wall {
            self.end_at_wall(disk);
        }
    }

    #[inline]
    fn flight(&self, disk: usize) -> Flight {
        let acceleration = glam::DVec2::new(0.0, -self.bodies.gravity);
        let (position, velocity) =
            (self.bodies.position(disk, self.now), self.bodies.velocity(disk, self.now));
        Flight::new(self.now, position, velocity, acceleration, self.bodies.material(disk).radius)
    }

    /// The flight ends at a wall, if it touches one before it leaves its cell.
    fn end_at_wall(&mut self, disk: usize) {
        let horizon = self.now + HORIZON * self.epoch_length;
        let flight = self.flight(disk);
        let slot = &mut self.bodies.particles[disk].slot;
        if let Some(touch) = self.boundary.first_touch(&flight, slot.exit_due.min(horizon)) {
            (slot.exit_due, slot.exit, slot.wall) = (touch.time, Exit::Wall, touch.wall as u16);
        } else if slot.exit_due > horizon {
            (slot.exit_due, slot.exit) = (horizon, Exit::Stay);
        }
    }
}
