//! Observers that break their contract.

use std::cell::Cell;

use granular_edmd::observable::{Collision, Observer, ObserverError, SampleTimes, Snapshot, Verdict};

use crate::faults::{List, Planted, tenth};

/// An observer with a clock, some of whose steps are changed.
struct Altered {
    times: SampleTimes,
    /// The answer to the question for the next sample.
    next: f64,
    size: f64,
    samples: u64,
    collisions: u64,
    asked: Cell<u64>,
    start: fn(&mut Self, f64),
    sample: fn(&mut Self, f64),
    collision: fn(&mut Self, f64),
    end: fn(&mut Self, f64),
    verdict: fn(&mut Self),
    ask: fn(&Self) -> f64,
}

const INTERVAL: f64 = 0.5;

impl Default for Altered {
    fn default() -> Self {
        let times = SampleTimes::every(INTERVAL).expect("an interval");
        Self {
            times,
            next: times.upcoming(),
            size: 0.0,
            samples: 0,
            collisions: 0,
            asked: Cell::new(0),
            start: |_, _| (),
            sample: |_, _| (),
            collision: |_, _| (),
            end: |_, _| (),
            verdict: |_| (),
            ask: |clock| clock.next,
        }
    }
}

/// Each step is done rightly first, and then changed.
impl Observer for Altered {
    fn on_start(&mut self, start: &Snapshot<'_>) -> Result<(), ObserverError> {
        self.times.start_at(start.time());
        self.next = self.times.upcoming();
        (self.start)(self, start.time());
        Ok(())
    }

    fn on_collision(&mut self, collision: &Collision) {
        self.collisions += 1;
        (self.collision)(self, collision.time);
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

    fn on_end(&mut self, end: &Snapshot<'_>) {
        (self.end)(self, end.time());
    }

    fn verdict(&mut self) -> Verdict {
        (self.verdict)(self);
        ().verdict()
    }
}

/// The catalogue while it grows.
type Observers = List<Box<dyn Observer>>;

impl Observers {
    fn add(&mut self, name: impl Into<String>, observer: Altered) {
        self.plant(name, Box::new(observer));
    }

    fn add_start(&mut self, name: &str, start: fn(&mut Altered, f64)) {
        self.add(name, Altered { start, ..Altered::default() });
    }

    fn add_sample(&mut self, name: &str, sample: fn(&mut Altered, f64)) {
        self.add(name, Altered { sample, ..Altered::default() });
    }

    fn add_collision(&mut self, name: &str, collision: fn(&mut Altered, f64)) {
        self.add(name, Altered { collision, ..Altered::default() });
    }

    fn add_ask(&mut self, name: &str, ask: fn(&Altered) -> f64) {
        self.add(name, Altered { ask, ..Altered::default() });
    }
}

/// Returns the observer on which faults are planted.
pub(crate) fn honest() -> Vec<Planted<Box<dyn Observer>>> {
    let mut observers = Observers::default();
    observers.add("clock", Altered::default());
    observers.faults
}

pub(crate) fn catalogue() -> Vec<Planted<Box<dyn Observer>>> {
    List::grown(&[numbers, later, starts, moves, cuts])
}

/// "`next_sample` is never NaN."
fn numbers(observers: &mut Observers) {
    observers.family = "not a number";
    observers.add_start("the first sample is at no number", |clock, _| clock.next = f64::NAN);
    observers.add_start("a run that starts at 0 has no number", |clock, time| {
        clock.next *= 0.0 / time + 1.0;
    });
    observers.add_sample("the third sample is followed by no number", |clock, _| {
        if clock.samples == 3 {
            clock.next = f64::NAN;
        }
    });
    observers.add_sample("the hundredth sample is followed by no number", |clock, _| {
        if clock.samples == 100 {
            clock.next = f64::NAN;
        }
    });
    observers.add_collision("after the first collision, no number is given", |clock, _| {
        clock.next = f64::NAN;
    });
    observers.add_ask("a time at or after 1000 is not a number", |clock| {
        if clock.next >= 1000.0 { f64::NAN } else { clock.next }
    });
    let next = f64::NAN;
    observers.add("before the start, no number is given", Altered { next, ..Altered::default() });
}

/// "After a sample, `next_sample` names a later time."
fn later(observers: &mut Observers) {
    observers.family = "not later";
    observers.add_sample("the sample is asked for again", |clock, time| clock.next = time);
    observers.add_sample("the fourth sample is asked for again", |clock, time| {
        if clock.samples == 4 {
            clock.next = time;
        }
    });
    observers.add_sample("the next sample is later only by what rounding takes", |clock, time| {
        clock.next = time + 1e-16;
    });
    observers.add_sample("the next sample is that of the multiple below", |clock, time| {
        clock.next = (time / INTERVAL).floor() * INTERVAL;
    });
    observers.add_sample(
        "the last of ten samples is followed by a time without end before it",
        |clock, _| {
            if clock.samples == 10 {
                clock.next = f64::NEG_INFINITY;
            }
        },
    );
    for n in [0, 3, 9] {
        let sample: fn(&mut Altered, f64) = |clock, time| clock.next = time - clock.size;
        let name = format!("the next sample is earlier than the sample by 1e-{n}");
        observers.add(name, Altered { sample, size: tenth(n), ..Altered::default() });
    }
}

/// "After `on_start`, `next_sample` names no time before the start."
fn starts(observers: &mut Observers) {
    observers.family = "before start";
    for n in [0, 3, 7] {
        let start: fn(&mut Altered, f64) = |clock, time| clock.next = time - clock.size;
        let name = format!("the first sample is before the start by 1e-{n}");
        observers.add(name, Altered { start, size: tenth(n), ..Altered::default() });
    }
    observers.add_start("every run starts at time 0", |clock, _| clock.next = INTERVAL);
    observers.add_start("a run that starts after 100 starts at time 0", |clock, time| {
        if time > 100.0 {
            clock.next = INTERVAL;
        }
    });
    observers.add_start("a run at negative times starts at the beat before", |clock, time| {
        if time < 0.0 {
            clock.next = (time / INTERVAL).trunc() * INTERVAL - INTERVAL;
        }
    });
}

/// "The value of `next_sample` changes only in `on_start` and `on_sample`."
fn moves(observers: &mut Observers) {
    observers.family = "moved";
    observers.add_collision("a collision asks for a sample", |clock, time| clock.next = time);
    observers.add_collision("a collision puts the sample off", |clock, time| clock.next = time + INTERVAL);
    observers.add_collision("the tenth collision puts the sample off by 1e-6", |clock, _| {
        if clock.collisions == 10 {
            clock.next += 1e-6;
        }
    });
    observers.add_collision("the hundredth collision ends the samples", |clock, _| {
        if clock.collisions == 100 {
            clock.next = f64::INFINITY;
        }
    });
    let verdict: fn(&mut Altered) = |clock| clock.next += 1e-3;
    observers.add("each verdict puts the sample off", Altered { verdict, ..Altered::default() });
    let end: fn(&mut Altered, f64) = |clock, _| clock.next += INTERVAL;
    observers.add("the end puts the sample off", Altered { end, ..Altered::default() });
    observers.add_ask("each question puts the sample off by 1e-9", |clock| {
        clock.next + 1e-9 * clock.asked.get() as f64
    });
    observers.add_ask("the hundredth question has another answer", |clock| {
        clock.next + if clock.asked.get() == 100 { 0.1 } else { 0.0 }
    });
}

/// Samples that depend on how a run is cut into pieces. No sentence of the trait forbids this; the clock of
/// the library promises it.
fn cuts(observers: &mut Observers) {
    observers.family = "cut";
    observers.add(
        "each run counts its samples from its own start",
        Altered {
            start: |clock, time| clock.next = time + INTERVAL,
            sample: |clock, time| clock.next = time + INTERVAL,
            ..Altered::default()
        },
    );
    observers.add_start("each run takes a sample at its start", |clock, time| clock.next = time);
    observers.add(
        "each run has only one sample",
        Altered { sample: |clock, _| clock.next = f64::INFINITY, ..Altered::default() },
    );
}
