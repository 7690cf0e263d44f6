//! Everything that happens in a run, from which each measure is computed anew.

use granular_edmd::observable::{Collision, Observer, ObserverError, SampleTimes, Snapshot};
use granular_edmd::{Disk, ParameterError};

/// Interval between two states that are kept: short enough to follow disks across periodic sides.
pub(super) const FINE: f64 = 0.125;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Occasion {
    Start,
    Sample,
    End,
}

#[derive(Debug, Clone)]
pub(super) struct State {
    pub(super) occasion: Occasion,
    pub(super) time: f64,
    pub(super) disks: Vec<Disk>,
    /// Number of collisions so far.
    pub(super) collisions: usize,
    /// Height of the lid, in a closed box; 0 elsewhere.
    pub(super) lid: f64,
}

impl State {
    /// Returns whether the measures take a sample of this state, once in each unit of time.
    pub(super) fn is_sampled(&self) -> bool {
        self.occasion == Occasion::Sample && self.time.fract() == 0.0
    }

    pub(super) fn mean(&self, quantity: impl Fn(&Disk) -> f64) -> f64 {
        self.disks.iter().map(quantity).sum::<f64>() / self.disks.len() as f64
    }
}

/// An observer that keeps all.
#[derive(Debug)]
pub(super) struct Log {
    times: SampleTimes,
    pub(super) states: Vec<State>,
    pub(super) collisions: Vec<Collision>,
}

impl Log {
    pub(super) fn new() -> Result<Self, ParameterError> {
        Ok(Self { times: SampleTimes::every(FINE)?, states: Vec::new(), collisions: Vec::new() })
    }

    pub(super) fn samples(&self) -> impl Iterator<Item = &State> {
        self.states.iter().filter(|state| state.is_sampled())
    }

    /// Returns the intervals between two samples that the run watched as a whole, from its start or from a
    /// sample on, each with its last state and its collisions.
    pub(super) fn intervals(&self) -> impl Iterator<Item = (&State, &[Collision])> {
        let mut from = 0;
        self.samples().map(move |state| {
            let range = std::mem::replace(&mut from, state.collisions)..state.collisions;
            (state, &self.collisions[range])
        })
    }

    fn keep(&mut self, occasion: Occasion, snapshot: &Snapshot<'_>) {
        let (disks, collisions) = (snapshot.disks().to_vec(), self.collisions.len());
        let lid = snapshot.wall_point(3).map_or(0.0, |place| place.y);
        self.states.push(State { occasion, time: snapshot.time(), disks, collisions, lid });
    }
}

impl Observer for Log {
    fn on_start(&mut self, start: &Snapshot<'_>) -> Result<(), ObserverError> {
        self.times.start_at(start.time());
        self.keep(Occasion::Start, start);
        Ok(())
    }
    fn on_collision(&mut self, collision: &Collision) {
        self.collisions.push(*collision);
    }
    fn next_sample(&self) -> f64 {
        self.times.upcoming()
    }
    fn on_sample(&mut self, snapshot: &Snapshot<'_>) {
        self.keep(Occasion::Sample, snapshot);
        self.times.advance_past(snapshot.time());
    }
    fn on_end(&mut self, end: &Snapshot<'_>) {
        self.keep(Occasion::End, end);
    }
}
