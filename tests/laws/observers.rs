//! Observers that break their contract.

use std::cell::Cell;

use granular_edmd::collision::Regime;
use granular_edmd::observable::{Collision, Observer, ObserverError, SampleTimes, Snapshot, laws};

use crate::{Fault, blind, honest, informed, judge};

const INTERVAL: f64 = 0.5;

/// An observer with a clock, some of whose steps are changed after they have been done rightly.
struct Altered {
    times: SampleTimes,
    /// The answer to the question for the next sample.
    next: f64,
    runs: u64,
    samples: u64,
    asked: Cell<u64>,
    start: fn(&mut Self, f64),
    sample: fn(&mut Self, f64),
    collision: fn(&mut Self, &Collision),
    ask: fn(&Self) -> f64,
}

impl Altered {
    fn honest() -> Self {
        let times = SampleTimes::every(INTERVAL).expect("an interval");
        Self {
            times,
            next: times.upcoming(),
            runs: 0,
            samples: 0,
            asked: Cell::new(0),
            start: |_, _| (),
            sample: |_, _| (),
            collision: |_, _| (),
            ask: |clock| clock.next,
        }
    }

    fn start(start: fn(&mut Self, f64)) -> Self {
        Self { start, ..Self::honest() }
    }

    fn sample(sample: fn(&mut Self, f64)) -> Self {
        Self { sample, ..Self::honest() }
    }

    fn collision(collision: fn(&mut Self, &Collision)) -> Self {
        Self { collision, ..Self::honest() }
    }
}

impl Observer for Altered {
    fn on_start(&mut self, start: &Snapshot<'_>) -> Result<(), ObserverError> {
        self.runs += 1;
        self.times.start_at(start.time());
        self.next = self.times.upcoming();
        (self.start)(self, start.time());
        Ok(())
    }

    fn on_collision(&mut self, collision: &Collision) {
        (self.collision)(self, collision);
    }

    fn next_sample(&self) -> f64 {
        self.asked.set(self.asked.get() + 1);
        (self.ask)(self)
    }

    fn on_sample(&mut self, snapshot: &Snapshot<'_>) {
        self.samples += 1;
        self.times.advance_past(snapshot.time());
        self.next = self.times.upcoming();
        (self.sample)(self, snapshot.time());
    }
}

fn faults() -> Vec<Fault<Altered>> {
    vec![
        blind("the first sample is at no number", Altered::start(|clock, _| clock.next = f64::NAN)),
        informed(
            "question 777 has no number",
            Altered {
                ask: |clock| if clock.asked.get() == 777 { f64::NAN } else { clock.next },
                ..Altered::honest()
            },
        ),
        blind("the sample is asked for again", Altered::sample(|clock, time| clock.next = time)),
        informed(
            "after 5000, samples are asked for again",
            Altered::sample(|clock, time| {
                clock.next = if time > 5000.0 { time } else { clock.next };
            }),
        ),
        blind(
            "the first sample is before the start by 1e-7",
            Altered::start(|clock, time| clock.next = time - 1e-7),
        ),
        blind(
            "a collision puts the sample off",
            Altered::collision(|clock, collision| clock.next = collision.time + INTERVAL),
        ),
        informed(
            "a collision of the regime least rebound puts the sample off",
            Altered::collision(|clock, collision| {
                clock.next += if collision.impulse.regime() == Regime::LeastRebound { 1.0 } else { 0.0 };
            }),
        ),
        blind(
            "each run counts its samples from its own start",
            Altered {
                start: |clock, time| clock.next = time + INTERVAL,
                sample: |clock, time| clock.next = time + INTERVAL,
                ..Altered::honest()
            },
        ),
        informed("each run leaves out a sample", Altered::start(|clock, _| clock.next += INTERVAL)),
        honest("clock", Altered::honest()),
    ]
}

#[test]
fn the_check_of_observers_finds_planted_faults() {
    judge("observer", faults(), |mut observer: Altered| laws::check(&mut observer));
}
