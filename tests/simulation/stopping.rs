//! An observer stops a run: at a collision or a sample, with the bits that the run would have had.

use std::ops::ControlFlow;

use granular_edmd::Simulation;
use granular_edmd::boundary::Container;
use granular_edmd::collision::Frictional;
use granular_edmd::observable::{Collision, Observer, Snapshot, Verdict};
use granular_edmd::simulation::RunEnd;

use crate::setups::shaken_and_heated;
use support::schedulers::{SCHEDULERS, Scheduler};

type Run = Simulation<Frictional, Container, Scheduler>;

fn run(scheduler: Scheduler, start: f64) -> Run {
    shaken_and_heated().starting_at(start).scheduler(scheduler).build().unwrap()
}

/// An observer that stops after every `each[0]` collisions and every `each[1]` samples.
#[derive(Default)]
struct Stopper {
    collisions: Vec<f64>,
    samples: Vec<f64>,
    each: [usize; 2],
    stop: bool,
    next: f64,
}

impl Observer for Stopper {
    fn on_collision(&mut self, collision: &Collision) {
        self.collisions.push(collision.time);
        self.stop |= self.collisions.len().is_multiple_of(self.each[0]);
    }
    fn next_sample(&self) -> f64 {
        self.next
    }
    fn on_sample(&mut self, snapshot: &Snapshot<'_>) {
        self.samples.push(snapshot.time());
        self.next += 0.3;
        self.stop |= self.samples.len().is_multiple_of(self.each[1]);
    }
    fn verdict(&mut self) -> Verdict {
        Ok(if std::mem::take(&mut self.stop) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) })
    }
}

#[test]
fn a_run_that_is_stopped_goes_on_with_the_same_bits() {
    for start in [0.0, 1e7] {
        let end = start + 30.0;
        let mut plain = run(SCHEDULERS[0](), start);
        let mut whole = Stopper { each: [usize::MAX; 2], next: start, ..Stopper::default() };
        assert_eq!(plain.run_until(end, &mut whole).unwrap(), RunEnd::Time);
        for (scheduler, each) in
            SCHEDULERS.into_iter().flat_map(|s| [[1, 1000], [7, 3], [1000, 1]].map(|e| (s, e)))
        {
            let mut cut = run(scheduler(), start);
            let mut stopper = Stopper { each, next: start, ..Stopper::default() };
            let mut stops = 0;
            while cut.run_until(end, &mut stopper).unwrap() == RunEnd::Observer {
                stops += 1;
                let last = |times: &[f64]| times.last().copied().unwrap_or(f64::NEG_INFINITY);
                let present = last(&stopper.collisions).max(last(&stopper.samples));
                let rounding = 4.0 * f64::EPSILON * present;
                assert!((cut.time() - present).abs() <= rounding, "{} {present}", cut.time());
            }
            let asked = stopper.collisions.len() / each[0] + stopper.samples.len() / each[1];
            assert!(stops > 0 && stops <= asked, "{stops} {asked}");
            assert_eq!(cut.disks(), plain.disks(), "{start:e} {each:?}");
            assert_eq!(cut.counters(), plain.counters(), "{start:e} {each:?}");
            assert_eq!(stopper.collisions, whole.collisions, "{start:e} {each:?}");
            assert_eq!(stopper.samples, whole.samples, "{start:e} {each:?}");
        }
    }
}
