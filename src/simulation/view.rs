//! Running, watching and changing a simulation: its public face.

use super::builder::{cells_for, check_inside, check_overlaps};
use super::engine::Simulation;
use super::errors::{BuildError, RunError};
use super::event::{Counters, Event};
use crate::Disk;
use crate::boundary::Boundary;
use crate::collision::CollisionRule;
use crate::observable::{Observable, Observer, Snapshot};
use crate::quantity::finite;
use crate::scheduler::EventScheduler;

impl<R: CollisionRule, B: Boundary, S: EventScheduler> Simulation<R, B, S> {
    /// Runs until the absolute time `end`, with `observer` watching; `&mut ()` for nobody.
    ///
    /// # Errors
    /// If the end is not finite or before the present, the run cannot progress, a rule answers with numbers that are not
    /// finite, or an observer's sampling time does not advance. The state is that of the moment.
    pub fn run_until<O: Observer + ?Sized>(&mut self, end: f64, observer: &mut O) -> Result<(), RunError> {
        if !(end.is_finite() && end >= self.time() - self.rounding()) {
            return Err(RunError::End { end, time: self.time() });
        }
        loop {
            let sample = observer.next_sample();
            let stop = end.min(sample.max(self.time()));
            self.run_events(stop, observer)?;
            if sample > stop {
                return Ok(());
            }
            observer.on_sample(&self.snapshot_as_of(stop));
            let next = observer.next_sample();
            if next <= sample {
                return Err(RunError::SampleTime { next, time: self.time() });
            }
        }
    }

    /// What the present may differ by from a time that was run to: it is kept as an offset from an epoch.
    fn rounding(&self) -> f64 {
        4.0 * f64::EPSILON * (self.origin.abs() + self.now.abs())
    }

    /// Does all events until the absolute time `stop`, and goes there.
    fn run_events<O: Observer + ?Sized>(&mut self, stop: f64, observer: &mut O) -> Result<(), RunError> {
        while let Some((disk, due)) = self.next_due(stop - self.origin) {
            self.advance(disk, due, observer)?;
        }
        self.now = self.now.max(stop - self.origin);
        Ok(())
    }

    /// Does the next event and says which it was; `None` if there never is one. Samples are not taken.
    ///
    /// # Errors
    /// As [`Self::run_until`].
    pub fn step<O: Observer + ?Sized>(&mut self, observer: &mut O) -> Result<Option<Event>, RunError> {
        match self.next_due(f64::MAX) {
            Some((disk, due)) => self.advance(disk, due, observer).map(Some),
            None => Ok(None),
        }
    }

    /// How many disks there are.
    pub fn len(&self) -> usize {
        self.bodies.len()
    }

    /// Whether there are no disks.
    pub fn is_empty(&self) -> bool {
        self.bodies.len() == 0
    }

    /// A disk as it is now.
    ///
    /// # Panics
    /// If there is no such disk.
    pub fn disk(&self, disk: usize) -> Disk {
        self.bodies.disk(disk, self.now)
    }

    /// All disks as they are now.
    pub fn disks(&self) -> Vec<Disk> {
        (0..self.len()).map(|disk| self.disk(disk)).collect()
    }

    /// The present state, for observables.
    pub fn snapshot(&mut self) -> Snapshot<'_> {
        self.snapshot_as_of(self.time())
    }

    /// The present state under the name by which it was asked for, which [`Self::time`] may miss by rounding.
    fn snapshot_as_of(&mut self, time: f64) -> Snapshot<'_> {
        let Self { bodies, copies, now, .. } = self;
        copies.clear();
        copies.extend((0..bodies.len()).map(|disk| bodies.disk(disk, *now)));
        Snapshot::new(time, &self.copies, self.boundary.domain(), self.bodies.gravity)
    }

    /// The value of an observable now.
    pub fn measure<Q: Observable + ?Sized>(&mut self, observable: &Q) -> Q::Value {
        observable.measure(&self.snapshot())
    }

    /// What happened since the simulation was built.
    pub const fn counters(&self) -> &Counters {
        &self.counters
    }

    /// The rule between the disks.
    pub const fn rule(&self) -> &R {
        &self.rule
    }

    /// The walls.
    pub const fn boundary(&self) -> &B {
        &self.boundary
    }

    /// Gravity, pointing down.
    pub const fn gravity(&self) -> f64 {
        self.bodies.gravity
    }

    /// From now on another rule holds. Predictions stay: a rule decides what a collision does, not when it comes.
    pub fn set_rule(&mut self, rule: R) {
        self.rule = rule;
    }

    /// From now on gravity has another value.
    ///
    /// # Errors
    /// If it is not finite; the simulation is as before.
    pub fn set_gravity(&mut self, gravity: f64) -> Result<(), BuildError> {
        finite("gravity", gravity)?;
        self.shift_epoch(self.now);
        self.bodies.gravity = gravity;
        self.epoch_length = self.bodies.epoch_length();
        self.predict_all();
        Ok(())
    }

    /// From now on there are other walls.
    ///
    /// # Errors
    /// If the disks do not fit into them; the simulation is as before.
    pub fn set_boundary(&mut self, mut boundary: B) -> Result<(), BuildError> {
        boundary.set_time_origin(self.time());
        let disks = self.disks();
        check_inside(&boundary, &disks)?;
        let cells = cells_for(&boundary, &disks)?;
        check_overlaps(&boundary, &disks, &cells)?;
        self.shift_epoch(self.now);
        self.boundary = boundary;
        self.boundary.set_time_origin(self.origin);
        self.cells = cells;
        self.predict_all();
        Ok(())
    }
}
