//! What is done for all disks at once: when the epoch moves, and when all events are predicted anew.

use super::cells::Cells;
use super::engine::Simulation;
use super::event::Counters;
use crate::boundary::Boundary;
use crate::collision::CollisionRule;
use crate::scheduler::{EventScheduler, LARGE_SYSTEM};

impl<R: CollisionRule, B: Boundary, S: EventScheduler> Simulation<R, B, S> {
    /// Predicts every disk's next event from the present state alone.
    pub(super) fn predict_all(&mut self) {
        for disk in 0..self.bodies.len() {
            self.find_next(disk);
        }
        self.reset_scheduler();
    }

    /// Tells the scheduler the times of all events.
    fn reset_scheduler(&mut self) {
        let mut due = std::mem::take(&mut self.due);
        due.clear();
        due.extend(self.bodies.particles.iter().map(|particle| particle.slot.due()));
        self.scheduler.reset(&due);
        // Kept, so that nothing is allocated again; in large systems memory counts for more.
        if due.len() < LARGE_SYSTEM {
            self.due = due;
        }
    }

    /// Moves the epoch to a little before the offset `due`, and returns the new offset of the same time.
    #[cold]
    #[inline(never)]
    pub(super) fn move_epoch(&mut self, due: f64) -> f64 {
        let by = (due / self.epoch_length).floor() * self.epoch_length;
        self.shift_epoch(by);
        self.epoch_length = self.bodies.epoch_length();
        due - by
    }

    /// Changes to larger or smaller cells, if those suit what happened since the last epoch; returns whether it did.
    ///
    /// All events are predicted anew from the present, also the one that was due.
    #[cold]
    pub(super) fn adapt_cells(&mut self) -> bool {
        let Counters { cell_crossings, collisions, .. } = self.counters;
        let (last_crossings, last_collisions) =
            std::mem::replace(&mut self.tally, (cell_crossings, collisions));
        let mesh = self.cells.grid().mesh();
        let suitable = mesh.suitable(cell_crossings - last_crossings, collisions - last_collisions);
        if suitable == mesh {
            return false;
        }
        let positions = (0..self.bodies.len()).map(|disk| self.bodies.position(disk, self.now));
        let diameter = 2.0 * self.bodies.largest_radius();
        if let Some(cells) = Cells::new(&self.boundary, diameter, suitable, positions) {
            self.cells = cells;
            self.predict_all();
            return true;
        }
        false
    }

    pub(super) fn shift_epoch(&mut self, by: f64) {
        self.bodies.shift(by);
        self.origin += by;
        self.now -= by;
        self.guard.shift(by);
        self.boundary.set_time_origin(self.origin);
        self.reset_scheduler();
    }
}
