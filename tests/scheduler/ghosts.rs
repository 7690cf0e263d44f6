//! The sentences in which the check of schedulers names a fault. The target `laws` plants the faults that it
//! must find.

use granular_edmd::boundary::Container;
use granular_edmd::collision::Elastic;
use granular_edmd::scheduler::laws::check;
use granular_edmd::scheduler::{BucketQueue, EventScheduler, LinearScan, NOTHING_DUE};
use granular_edmd::{Simulation, initial};

/// A scheduler with one fault.
#[derive(Default)]
struct Liar {
    honest: LinearScan,
    sets: usize,
    asked: bool,
    fault: Fault,
}

#[derive(Debug, Clone, Copy, PartialEq, Default)]
enum Fault {
    #[default]
    NotANumber,
    SomebodyWithoutDisks,
    ConfusedByLookingAhead,
    TakesWhatWasNamed,
}

impl Liar {
    fn with(fault: Fault) -> Self {
        Self { fault, ..Self::default() }
    }
}

impl EventScheduler for Liar {
    fn reset(&mut self, due: &[f64]) {
        self.honest.reset(due);
        self.asked = false;
    }

    fn set(&mut self, disk: usize, due: f64) {
        self.sets += 1;
        self.honest.set(disk, due);
        self.asked = false;
    }

    fn earliest(&self) -> (usize, f64) {
        let (disk, due) = self.honest.earliest();
        match self.fault {
            Fault::NotANumber if self.sets > 100 => (disk, f64::NAN),
            Fault::SomebodyWithoutDisks if (disk, due) == NOTHING_DUE => (0, f64::INFINITY),
            Fault::ConfusedByLookingAhead if self.asked => (disk, due + 1.0),
            _ => (disk, due),
        }
    }

    fn upcoming(&mut self, disks: &mut Vec<usize>) {
        self.asked = true;
        if self.fault == Fault::TakesWhatWasNamed {
            disks.clear();
        }
    }
}

#[test]
fn a_violation_names_the_step_and_both_answers() {
    let violation = check(|| Liar::with(Fault::NotANumber)).unwrap_err();
    let said = violation.to_string();
    assert!(said.contains("step 1") && said.contains(", after ") && said.ends_with(" at NaN"), "{said}");

    let said = check(|| Liar::with(Fault::SomebodyWithoutDisks)).unwrap_err().to_string();
    let answers = "before the first reset: the earliest is nothing, not disk 0 at inf";
    assert!(said.starts_with("scheduler, law \"earliest\": script") && said.ends_with(answers), "{said}");
}

#[test]
fn the_check_is_the_same_at_each_call() {
    let violation = || check(Liar::default);
    assert_eq!(violation(), violation());
}

#[test]
fn only_looking_ahead_is_blamed_for_what_it_does() {
    let removed = check(|| Liar::with(Fault::TakesWhatWasNamed)).unwrap_err();
    assert_eq!(removed.law(), "hint", "{removed}");
    let confused = check(|| Liar::with(Fault::ConfusedByLookingAhead)).unwrap_err().to_string();
    assert!(confused.contains("after a look at upcoming disks"), "{confused}");
}

/// A scheduler that names disks that do not exist, besides the right ones.
#[derive(Default)]
struct Ghosts(BucketQueue);

impl EventScheduler for Ghosts {
    fn reset(&mut self, due: &[f64]) {
        self.0.reset(due);
    }

    fn set(&mut self, disk: usize, due: f64) {
        self.0.set(disk, due);
    }

    fn earliest(&self) -> (usize, f64) {
        self.0.earliest()
    }

    fn upcoming(&mut self, disks: &mut Vec<usize>) {
        self.0.upcoming(disks);
        disks.extend([usize::MAX, 1 << 40, 1 << 32, u32::MAX as usize, 40_000]);
    }
}

/// The engine asks for upcoming disks from 30 000 on.
#[test]
fn upcoming_disks_that_do_not_exist_are_ignored_by_the_engine() {
    assert_eq!(check(Ghosts::default), Ok(()), "it is a hint, and no law is broken");
    let container = Container::closed(400.0, 400.0).unwrap();
    let disks = initial::lattice(&container, 40_000, 0.5).unwrap();
    let disks = initial::with_maxwellian_velocities(disks, 1.0, 1).unwrap();
    let builder = || Simulation::builder(Elastic, container.clone()).disks(disks.clone());
    let mut misled = builder().scheduler(Ghosts::default()).build().unwrap();
    let mut plain = builder().build().unwrap();
    misled.run_until(0.2, &mut ()).unwrap();
    plain.run_until(0.2, &mut ()).unwrap();
    assert!(plain.counters().disk_collisions > 1000, "{:?}", plain.counters());
    assert_eq!(misled.disks(), plain.disks());
}
