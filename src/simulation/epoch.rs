//! Changes that affect all disks together: a new epoch, cells of another size, new predictions of all events.

use super::Simulation;
use super::cells::{CellSize, Cells, SPARE_DISKS};
use super::errors::Outcome;
use super::state::Tally;
use crate::boundary::Boundary;
use crate::collision::CollisionRule;
use crate::scheduler::{EventScheduler, LARGE_SYSTEM};

impl<R: CollisionRule, B: Boundary, S: EventScheduler> Simulation<R, B, S> {
    /// Predicts the next event of every disk from the present state alone.
    pub(super) fn predict_all(&mut self) {
        self.make_room();
        for disk in 0..self.bodies.len() {
            self.find_next(disk);
        }
        self.reset_scheduler();
    }

    /// Passes the times of all events to the scheduler.
    pub(super) fn reset_scheduler(&mut self) {
        let mut due = std::mem::take(&mut self.scratch.due);
        due.clear();
        due.extend(self.bodies.particles.iter().map(|particle| particle.forecast.due()));
        if !self.inlets.is_empty() {
            // Room for disks that are added later.
            due.resize(due.len() + due.len() / 4 + SPARE_DISKS, f64::INFINITY);
        }
        self.scratch.seats = due.len();
        self.scheduler.reset(&due);
        // The memory is kept, so that nothing is allocated again. In large systems, the memory is freed,
        // since its size matters more there.
        if due.len() < LARGE_SYSTEM {
            self.scratch.due = due;
        }
    }

    /// Moves the epoch by whole epochs to just before the offset `due`, and sets the present to `due`.
    #[cold]
    #[inline(never)]
    pub(super) fn move_epoch(&mut self, due: f64) -> Outcome<()> {
        self.clock.check_coarseness(due)?;
        self.check_all(due)?;
        let by = self.clock.whole_epochs(due);
        self.clock.now = due;
        self.shift_epoch(by);
        self.bodies.settle();
        self.clock.epoch_length = self.bodies.epoch_length();
        Ok(())
    }

    /// Moves the epoch forward by this time.
    pub(super) fn shift_epoch(&mut self, by: f64) {
        self.bodies.shift(by);
        self.clock.shift(by);
        self.boundary.set_time_origin(self.clock.origin);
        self.reset_scheduler();
    }

    /// Changes to larger or smaller cells, if another size suits the events since the epoch last moved.
    ///
    /// The choice depends on the state alone, so it is the same on every run. After a change, all events are
    /// predicted anew from the present.
    #[cold]
    pub(super) fn adapt_cells(&mut self) {
        let tally =
            Tally { cell_crossings: self.counters.cell_crossings, collisions: self.counters.disk_collisions };
        let last = std::mem::replace(&mut self.clock.tally, tally);
        let crossings = tally.cell_crossings - last.cell_crossings;
        let size = self.cells.grid().cell_size();
        let suitable = size.suitable(crossings, tally.collisions - last.collisions);
        if suitable == size {
            return;
        }
        if self.renew_cells(suitable, None) {
            self.counters.cell_resizes += 1;
        }
    }

    /// Makes new cells for the present disks and for a disk of the diameter `further`, and predicts all
    /// events anew. Returns false, and changes nothing, if the domain has no room for such cells.
    pub(super) fn renew_cells(&mut self, size: CellSize, further: Option<f64>) -> bool {
        let (bodies, now) = (&self.bodies, self.clock.now);
        let disks = (0..bodies.len()).map(|disk| (bodies.position(disk, now), bodies.radius(disk)));
        let Some(cells) = Cells::new(&self.boundary, size, disks, further) else { return false };
        self.cells = cells;
        self.predict_all();
        true
    }
}
