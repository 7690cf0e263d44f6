//! Insertion and removal of single disks during a run.
//!
//! A removal or an insertion takes the same time however many disks there are. The last disk gets the index
//! of the removed disk, so no other index changes. Predictions of other disks that name one of the two
//! indices are then out of date: their collision count does not match the disk that has this index now. The
//! engine replaces them when they are due, as for any partner that has collided since.

use glam::DVec2;
use rand_xoshiro::Xoshiro256PlusPlus;

use super::builder::{check_speeds, too_small};
use super::engine::Engine;
use super::errors::{BuildError, Outcome, RunError};
use super::prediction::nearest_image;
use super::{Inlet, Simulation};
use crate::boundary::{Boundary, Probe, WallView};
use crate::collision::CollisionRule;
use crate::disk::MOST_DISKS;
use crate::observable::Observer;
use crate::quantity::accept;
use crate::scheduler::EventScheduler;
use crate::{Disk, ParameterError};

/// Number of positions that an inlet tries for a disk at each opening.
const TRIES: u32 = 32;

impl<R: CollisionRule, B: Boundary, S: EventScheduler> Simulation<R, B, S> {
    /// Adds an inlet, which lets disks in from now on.
    ///
    /// At equal times, the inlet opens after all events of disks and before a sample. Its clock and that of
    /// the sample may [differ by a rounding](crate::observable::SampleTimes#two-clocks). Several inlets open
    /// in the order in which they were added.
    ///
    /// # Errors
    /// If the inlet is not in the domain, or a model does not fit into the boundary, just fills a hollow of a
    /// wall, or moves at a speed below 1e-100. The simulation then stays unchanged.
    pub fn add_inlet(&mut self, mut inlet: Inlet) -> Result<(), BuildError> {
        check_inlets(&self.parts.boundary, std::slice::from_ref(&inlet))?;
        check_speeds(inlet.models().iter().map(Disk::velocity).chain(inlet.velocity_of_return()))?;
        let diameter = inlet.largest_diameter();
        if diameter > 0.0 && !self.make_cells_suit(diameter) {
            return Err(too_small(&self.parts.boundary.domain(), diameter));
        }
        inlet.times.start_at(self.time());
        self.engine.inlets.push(inlet);
        self.reset_scheduler();
        Ok(())
    }

    /// Returns the inlets, in the order in which they were added.
    pub fn inlets(&self) -> &[Inlet] {
        &self.engine.inlets
    }

    /// Removes all inlets, and returns them with the disks that wait.
    pub fn remove_inlets(&mut self) -> Vec<Inlet> {
        std::mem::take(&mut self.engine.inlets)
    }

    /// Opens all inlets that are due at this absolute time.
    pub(super) fn open_inlets<O: Observer + ?Sized>(&mut self, time: f64, observer: &mut O) -> Outcome<()> {
        for number in 0..self.engine.inlets.len() {
            if self.engine.inlets[number].times.upcoming() > time {
                continue;
            }
            let mut random = self.engine.inlets[number].open(time, number);
            while let Some(disk) = self.engine.inlets[number].waiting.front().copied()
                && let Some(placed) = self.place_for(number, &disk, &mut random)?
            {
                self.put_in(&placed)?;
                self.engine.inlets[number].waiting.pop_front();
                self.engine.counters.insertions += 1;
                self.engine.ledger.count(time, self.len() - 1);
                observer.on_insert(&self.engine.bodies.disk(self.len() - 1, self.engine.clock.now), time);
            }
        }
        Ok(())
    }

    /// Finds room for a disk at an inlet.
    fn place_for(
        &mut self,
        inlet: usize,
        disk: &Disk,
        random: &mut Xoshiro256PlusPlus,
    ) -> Outcome<Option<Disk>> {
        let numbered = self.engine.bodies.identities.check_room(&[disk.identified(0)]);
        numbered.map_err(|source| RunError::Inlet { time: self.time(), source })?;
        if self.len() >= MOST_DISKS || !self.make_cells_suit(2.0 * disk.radius()) {
            return Ok(None);
        }
        Ok((0..TRIES).find_map(|_| {
            let placed = self.engine.inlets[inlet].placed(disk, random)?;
            self.has_room(&placed).then_some(placed)
        }))
    }

    fn has_room(&mut self, disk: &Disk) -> bool {
        let (position, radius, now) = (disk.position(), disk.radius(), self.engine.clock.now);
        let found = &mut self.engine.scratch.found[0];
        let count = self.engine.cells.near(position, 2.0 * radius, found);
        let periods = self.engine.cells.grid.periods;
        let is_free = |other: usize| {
            let apart = self.engine.bodies.position(other, now) - position;
            let apart = DVec2::new(nearest_image(apart.x, periods.x), nearest_image(apart.y, periods.y));
            apart.length() >= radius + self.engine.bodies.radius(other)
        };
        found[..count].iter().all(|&other| is_free(other as usize))
            && self.parts.boundary.overlap(&Probe::of(disk, now)).is_none()
    }

    /// Removes a disk. The last one gets its index.
    pub(super) fn take_out(&mut self, disk: usize) {
        let last = self.len() - 1;
        self.engine.cells.take_out(disk);
        self.engine.bodies.swap_remove(disk);
        // The lookahead holds indices, of which the last one no longer exists.
        self.engine.lookahead.forget();
        self.engine.make_room();
        // The scheduler cannot remove a disk. To the scheduler, a disk that is never due is as good as
        // removed.
        self.parts.scheduler.set(last, f64::INFINITY);
        if disk != last {
            self.schedule(disk);
        }
        self.keep_cells_suitable();
    }

    /// Inserts a disk at a free position, into cells that suit it.
    fn put_in(&mut self, disk: &Disk) -> Outcome<()> {
        // The position of a disk at a distant epoch would lack digits, as would the position of a fast disk.
        if self.engine.clock.now > self.engine.clock.epoch_length {
            self.move_epoch(self.engine.clock.now)?;
        }
        let velocity = disk.velocity() - self.engine.bodies.fall(self.engine.clock.now).1;
        // The length of an epoch is measured in the typical diameter, which no disk has defined yet.
        if self.is_empty() {
            self.engine.bodies.typical_diameter = 2.0 * disk.radius();
        }
        if self.is_empty() || !self.engine.bodies.keeps_pace(velocity, self.engine.clock.epoch_length) {
            self.begin_epoch_at(std::iter::once(velocity))?;
        }
        let new = self.len();
        self.engine.bodies.push_disk(disk, self.engine.clock.now);
        self.engine.cells.put_in(disk.position(), 2.0 * disk.radius());
        self.engine.make_room();
        self.find_next(new);
        if new < self.engine.scratch.seats {
            self.schedule(new);
        } else {
            self.reset_scheduler();
        }
        self.keep_cells_suitable();
        Ok(())
    }

    /// Makes new cells if the present ones do not suit disks of this diameter. Returns whether the domain has
    /// room for such disks.
    fn make_cells_suit(&mut self, diameter: f64) -> bool {
        self.engine.cells.suit(diameter)
            || self.renew_cells(self.engine.cells.grid.layout.cell_size, Some(diameter))
    }

    /// Makes new cells if there are far more or far fewer disks than the present cells suit.
    fn keep_cells_suitable(&mut self) {
        if self.engine.cells.are_outgrown() {
            self.renew_cells(self.engine.cells.grid.layout.cell_size, None);
        }
    }
}

impl Engine {
    /// Returns the absolute time at which the next inlet opens, or infinity without inlets.
    pub(super) fn next_opening(&self) -> Outcome<f64> {
        let mut next = f64::INFINITY;
        for opening in self.inlets.iter().map(|inlet| inlet.times.upcoming()) {
            if opening.is_nan() {
                let late =
                    ParameterError::new("time of the next opening", "a number that is not too late", opening);
                return Err(RunError::Inlet { time: self.time(), source: late }.into());
            }
            next = next.min(opening);
        }
        Ok(next)
    }

    /// Passes a disk, which a sink has removed, to the inlet that puts such disks back.
    pub(super) fn take_back(&mut self, gone: &Disk) {
        let inlets = self.inlets.iter_mut().filter(|inlet| inlet.velocity_of_return().is_some());
        if let Some(inlet) = inlets.min_by_key(|inlet| inlet.waiting()) {
            inlet.take_back(gone);
        }
    }
}

/// Checks that inlets are in the domain of a boundary, and that the boundary has room for their models.
pub(super) fn check_inlets(boundary: &dyn Boundary, inlets: &[Inlet]) -> Result<(), BuildError> {
    let domain = boundary.domain();
    for inlet in inlets {
        for place in inlet.places() {
            let is_inside = (domain.left..=domain.right).contains(&place.x);
            accept(is_inside, "place of an inlet", "within the sides of the domain", place.x)?;
            let is_inside = (domain.bottom..=domain.top).contains(&place.y);
            accept(is_inside, "place of an inlet", "within the ends of the domain", place.y)?;
        }
        for (disk, model) in inlet.models().iter().enumerate() {
            if let Some(wall) = boundary.tight_fit(model.radius()) {
                let wall = WallView::of(boundary, wall, 0.0).to_string();
                return Err(BuildError::TightFit { disk, radius: model.radius(), wall });
            }
        }
        let (diameter, periods) = (inlet.largest_diameter(), domain.periods());
        // Cells need four diameters where the domain is periodic.
        let room = |length: f64, period: f64| if period > 0.0 { 0.25 * period } else { length };
        if diameter > room(domain.width(), periods.x).min(room(domain.height(), periods.y)) {
            return Err(too_small(&domain, diameter));
        }
    }
    Ok(())
}
