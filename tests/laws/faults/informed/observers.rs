//! Observers that break their contract where a check may not look.

use std::cell::Cell;

use granular_edmd::Disk;
use granular_edmd::collision::Regime;
use granular_edmd::observable::{Collision, Observer, ObserverError, SampleTimes, Snapshot, Verdict};

use crate::faults::{List, Planted};

struct Changed {
    times: SampleTimes,
    next: f64,
    samples: u64,
    runs: u64,
    collisions: u64,
    arrivals: u64,
    asked: Cell<u64>,
    start: fn(&mut Self, f64),
    sample: fn(&mut Self, f64),
    collision: fn(&mut Self, f64),
    insert: fn(&mut Self, f64),
    remove: fn(&mut Self, f64),
    ask: fn(&Self) -> f64,
}

impl Observer for Changed {
    fn on_start(&mut self, start: &Snapshot<'_>) -> Result<(), ObserverError> {
        self.runs += 1;
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

    fn on_insert(&mut self, _: &Disk, time: f64) {
        self.arrivals += 1;
        (self.insert)(self, time);
    }

    fn on_remove(&mut self, _: &Disk, time: f64) {
        (self.remove)(self, time);
    }

    fn verdict(&mut self) -> Verdict {
        ().verdict()
    }
}

fn changed() -> Changed {
    let times = SampleTimes::every(0.7).expect("an interval");
    let (next, asked) = (times.upcoming(), Cell::new(0));
    let nothing: fn(&mut Changed, f64) = |_, _| ();
    let (samples, runs, collisions, arrivals) = (0, 0, 0, 0);
    let ask = |clock: &Changed| clock.next;
    Changed {
        times,
        next,
        samples,
        runs,
        collisions,
        arrivals,
        asked,
        start: nothing,
        sample: nothing,
        collision: nothing,
        insert: nothing,
        remove: nothing,
        ask,
    }
}

pub(crate) fn catalogue() -> Vec<Planted<Box<dyn Observer>>> {
    let mut all = List::default();
    let mut add = |family, name: &str, observer: Changed| {
        all.family = family;
        all.plant(name, Box::new(observer) as Box<dyn Observer>);
    };
    let start: fn(&mut Changed, f64) = |clock, time| {
        if clock.runs == 5 {
            clock.next = time - 1e-6;
        }
    };
    add("late run", "the fifth run starts a little early", Changed { start, ..changed() });
    let sample: fn(&mut Changed, f64) = |clock, time| {
        if time > 5000.0 {
            clock.next = time;
        }
    };
    add("late time", "after 5000, samples are asked for again", Changed { sample, ..changed() });
    let collision: fn(&mut Changed, f64) = |clock, _| {
        if clock.collisions == 400 {
            clock.next += 0.1;
        }
    };
    add("late collision", "the 400th collision puts the sample off", Changed { collision, ..changed() });
    let moves: fn(&mut Changed, f64) = |clock, time| clock.next = time + 1.0;
    add("disks", "a disk that comes in puts the sample off", Changed { insert: moves, ..changed() });
    add("disks", "a disk that is removed puts the sample off", Changed { remove: moves, ..changed() });
    let both = Changed { insert: moves, remove: moves, ..changed() };
    add("disks", "each change of the number of disks puts the sample off", both);
    let insert: fn(&mut Changed, f64) = |clock, _| {
        if clock.arrivals == 30 {
            clock.next += 1e-6;
        }
    };
    add("disks", "the 30th disk that comes in puts the sample off by 1e-6", Changed { insert, ..changed() });
    let remove: fn(&mut Changed, f64) = |clock, _| clock.next = f64::INFINITY;
    add("disks", "a disk that is removed ends the samples", Changed { remove, ..changed() });
    let ask: fn(&Changed) -> f64 = |clock| if clock.asked.get() == 777 { f64::NAN } else { clock.next };
    add("seldom", "question 777 has no number", Changed { ask, ..changed() });
    let start: fn(&mut Changed, f64) = |clock, time| {
        if clock.runs == 2 {
            clock.next = time + 0.7;
        }
    };
    add("second run", "the second run counts from its start", Changed { start, ..changed() });
    let start: fn(&mut Changed, f64) = |clock, _| clock.next += 0.7;
    add("left out", "each run leaves out a sample", Changed { start, ..changed() });
    let sample: fn(&mut Changed, f64) = |clock, time| {
        if clock.samples == 5000 {
            clock.next = time;
        }
    };
    add("beyond the script", "sample 5000 is asked for again", Changed { sample, ..changed() });
    let regimes = [Regime::Sticking, Regime::Sliding, Regime::ContactDuration, Regime::ElasticBelow];
    for regime in regimes.into_iter().chain([Regime::LeastRebound, Regime::Unspecified]) {
        all.family = "regimes";
        let observer = OnlyAt { clock: changed(), regime };
        all.plant(format!("a collision of the regime {regime:?} puts the sample off"), Box::new(observer));
    }
    all.faults
}

/// A clock that collisions of one regime put off.
struct OnlyAt {
    clock: Changed,
    regime: Regime,
}

impl Observer for OnlyAt {
    fn on_start(&mut self, start: &Snapshot<'_>) -> Result<(), ObserverError> {
        self.clock.on_start(start)?;
        Ok(())
    }

    fn on_collision(&mut self, collision: &Collision) {
        if collision.impulse.regime() == self.regime {
            self.clock.next += 1.0;
        }
    }

    fn next_sample(&self) -> f64 {
        self.clock.next_sample()
    }

    fn on_sample(&mut self, snapshot: &Snapshot<'_>) {
        self.clock.on_sample(snapshot);
    }
}
