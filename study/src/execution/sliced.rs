//! Runs in slices, of which an observer notices nothing.

use std::time::Duration;

use granular_edmd::boundary::Boundary;
use granular_edmd::collision::CollisionRule;
use granular_edmd::observable::{Collision, Observer, Snapshot, Verdict};
use granular_edmd::simulation::{Limits, RunEnd, RunError, Simulation};

/// Runs until an absolute time, or for this wall-clock time at most.
///
/// `is_under_way` tells whether an earlier slice has begun the run. The observer sees one start and one end,
/// however many slices there are.
pub(super) fn run<R: CollisionRule, B: Boundary, O: Observer>(
    simulation: &mut Simulation<R, B>,
    end: f64,
    slice: Duration,
    observer: &mut O,
    is_under_way: &mut bool,
) -> Result<RunEnd, RunError> {
    let mut sliced = Sliced { observer, is_under_way: *is_under_way };
    let ended = simulation.run(&Limits::until(end).with_wall_clock(slice), &mut sliced);
    *is_under_way = matches!(ended, Ok(RunEnd::WallClock));
    if !*is_under_way {
        observer.on_end(&simulation.snapshot());
    }
    // A verdict to stop comes too late now. A failure must still be reported, as after any run.
    let failed = observer.verdict().err().filter(|_| !*is_under_way && ended.is_ok());
    match failed {
        Some(source) => Err(RunError::Observer { time: simulation.time(), source }),
        None => ended,
    }
}

/// A wrapper that shows its observer the start of the first slice only, and no end.
struct Sliced<'a, O> {
    observer: &'a mut O,
    is_under_way: bool,
}

impl<O: Observer> Observer for Sliced<'_, O> {
    fn on_start(&mut self, start: &Snapshot<'_>) {
        if !self.is_under_way {
            self.observer.on_start(start);
        }
    }

    #[inline]
    fn on_collision(&mut self, collision: &Collision) {
        self.observer.on_collision(collision);
    }

    #[inline]
    fn next_sample(&self) -> f64 {
        self.observer.next_sample()
    }

    fn on_sample(&mut self, snapshot: &Snapshot<'_>) {
        self.observer.on_sample(snapshot);
    }

    #[inline]
    fn verdict(&mut self) -> Verdict {
        self.observer.verdict()
    }
}
