//! Changes that affect all disks together: a new epoch, cells of another size, new predictions of all events.

use super::Simulation;
use super::cells::{CellSize, Cells, SPARE_DISKS};
use super::errors::Outcome;
use crate::boundary::Boundary;
use crate::collision::CollisionRule;
use crate::scheduler::{EventScheduler, LARGE_SYSTEM};

impl<R: CollisionRule, B: Boundary, S: EventScheduler> Simulation<R, B, S> {
    /// Predicts the next event of every disk from the present state alone.
    pub(super) fn predict_all(&mut self) {
        #[cfg(debug_assertions)]
        self.lend(super::lending::predict_all_erased);
        #[cfg(not(debug_assertions))]
        self.predict_all_here();
    }

    #[inline]
    pub(super) fn predict_all_here(&mut self) {
        self.engine.make_room();
        for disk in 0..self.engine.bodies.len() {
            self.find_next(disk);
        }
        self.reset_scheduler();
    }

    /// Passes the times of all events to the scheduler.
    pub(super) fn reset_scheduler(&mut self) {
        let mut due = std::mem::take(&mut self.engine.scratch.due);
        due.clear();
        due.extend(self.engine.bodies.particles.iter().map(|particle| particle.forecast.due()));
        if !self.engine.inlets.is_empty() {
            // Room for disks that are added later.
            due.resize(due.len() + due.len() / 4 + SPARE_DISKS, f64::INFINITY);
        }
        self.engine.scratch.seats = due.len();
        self.parts.scheduler.reset(&due);
        // The memory is kept, so that nothing is allocated again. In large systems, the memory is freed,
        // since its size matters more there.
        if due.len() < LARGE_SYSTEM {
            self.engine.scratch.due = due;
        }
    }

    /// Moves the epoch by whole epochs to just before the offset `due`, and sets the present to `due`.
    #[cold]
    #[inline(never)]
    pub(super) fn move_epoch(&mut self, due: f64) -> Outcome<()> {
        self.engine.clock.check_coarseness(due)?;
        self.check_all(due)?;
        let by = self.engine.clock.whole_epochs(due);
        self.engine.clock.now = due;
        self.shift_epoch(by);
        self.engine.bodies.settle();
        self.engine.clock.epoch_length = self.engine.bodies.epoch_length();
        Ok(())
    }

    /// Moves the epoch forward by this time.
    pub(super) fn shift_epoch(&mut self, by: f64) {
        self.engine.bodies.shift(by);
        self.engine.clock.shift(by);
        self.parts.boundary.set_time_origin(self.engine.clock.origin);
        self.reset_scheduler();
    }

    /// Changes to larger or smaller cells, if another size suits the events since the epoch last moved.
    ///
    /// The choice depends on the state alone, so it is the same on every run. After a change, all events are
    /// predicted anew from the present.
    #[cold]
    pub(super) fn adapt_cells(&mut self) {
        let tally = [self.engine.counters.cell_crossings, self.engine.counters.disk_collisions];
        let last = std::mem::replace(&mut self.engine.clock.tally, tally);
        let size = self.engine.cells.grid.layout.cell_size;
        let suitable = size.suitable(tally[0] - last[0], tally[1] - last[1]);
        if suitable == size {
            return;
        }
        if self.renew_cells(suitable, None) {
            self.engine.counters.cell_resizes += 1;
        }
    }

    /// Makes new cells for the present disks and for a disk of the diameter `further`, and predicts all
    /// events anew. Returns false, and changes nothing, if the domain has no room for such cells.
    pub(super) fn renew_cells(&mut self, size: CellSize, further: Option<f64>) -> bool {
        let (bodies, now) = (&self.engine.bodies, self.engine.clock.now);
        let disks = (0..bodies.len()).map(|disk| (bodies.position(disk, now), bodies.radius(disk)));
        let Some(cells) = Cells::new(&self.parts.boundary, size, disks, further) else { return false };
        self.engine.cells = cells;
        self.predict_all();
        true
    }
}
