//! The log of a run, which can also end the run in the middle.

use std::ops::ControlFlow;

use granular_edmd::observable::{Collision, Observer, Snapshot, Verdict};

/// Number of collisions that are kept, which is more than one step has.
pub(crate) const KEPT: usize = 4;

/// Counts the collisions, up to a budget, keeps the first ones, and takes one sample.
pub(crate) struct Log {
    pub(crate) count: usize,
    budget: usize,
    pub(crate) collisions: Vec<Collision>,
    sample: f64,
    pub(crate) taken: Vec<f64>,
}

impl Log {
    pub(crate) fn new(sample: f64, budget: usize) -> Self {
        Self { count: 0, budget, collisions: Vec::new(), sample, taken: Vec::new() }
    }
}

impl Observer for Log {
    fn on_collision(&mut self, collision: &Collision) {
        self.count += 1;
        if self.collisions.len() < KEPT {
            self.collisions.push(*collision);
        }
    }
    fn verdict(&mut self) -> Verdict {
        Ok(if self.count > self.budget { ControlFlow::Break(()) } else { ControlFlow::Continue(()) })
    }
    fn next_sample(&self) -> f64 {
        if self.taken.is_empty() { self.sample } else { f64::INFINITY }
    }
    fn on_sample(&mut self, snapshot: &Snapshot<'_>) {
        self.taken.push(snapshot.time());
    }
}
