//! The same bytes on any number of threads, and after any interruption.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::Duration;

use granular_edmd::boundary::Container;
use granular_edmd::collision::Elastic;
use granular_edmd::observable::{Collision, Observer, ObserverError, Snapshot};
use granular_edmd::{Disk, Fingerprint, initial};
use granular_edmd_study::{Column, Control, Experiment, ExperimentError, Plan, Progress, Protocol, Study};
use serde::{Deserialize, Serialize};

use crate::support::{CHILD_FOLDER, Scratch, assert_same, done, run_with_interruptions, small_plan, start};

#[test]
fn threads_do_not_matter() -> Result<(), crate::support::AnyError> {
    let (expected, _) = done(&small_plan(), "threads-any");
    for threads in [1, 2] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
        let (found, _) = pool.install(|| done(&small_plan(), &format!("threads-{threads}")));
        assert_same(&found.0, &expected.0);
    }
    Ok(())
}

#[test]
fn an_interrupted_study_goes_on() {
    let (expected, _) = done(&small_plan(), "interrupted-not");
    let scratch = Scratch::new("interrupted");
    let last = AtomicU64::new(0);
    let watch = |progress: &Progress| last.store(progress.done, Ordering::Relaxed);
    assert!(run_with_interruptions(&scratch.0, &small_plan(), |_| 16, watch) > 1);
    assert_eq!(last.into_inner(), 10 * 9, "three steps to settle, six samples");
    assert_same(&scratch.0, &expected.0);
}

/// The work of a process that is killed; it does nothing unless another test starts it.
#[test]
#[ignore = "started by the tests of killed processes"]
fn child() {
    let Ok(folder) = std::env::var(CHILD_FOLDER) else { return };
    let study = Study::open_or_create(folder, &small_plan()).unwrap();
    study.run(&Control::default().with_save_interval(Duration::ZERO)).unwrap();
}

/// The process is killed at moments that drift through the run, until the study is complete.
#[test]
fn a_killed_study_ends_with_the_same_bytes() {
    let (expected, _) = done(&small_plan(), "killed-not");
    let scratch = Scratch::new("killed");
    let mut kills = 0;
    loop {
        let mut child = start("interruption::child", &scratch.0).spawn().unwrap();
        std::thread::sleep(Duration::from_millis(20 + 7 * kills));
        match child.try_wait().unwrap() {
            Some(status) => {
                assert!(status.success());
                break;
            }
            None => child.kill().unwrap(),
        }
        child.wait().unwrap();
        kills += 1;
    }
    assert!(kills > 0);
    assert_same(&scratch.0, &expected.0);
}

/// A gas whose sampling interval takes a good while.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Slow {
    cycle: f64,
}

/// Counts what it hears of.
#[derive(Debug, Default, Serialize, Deserialize)]
struct Heard {
    starts: u64,
    collisions: u64,
    ends: u64,
}

impl Observer for Heard {
    fn on_start(&mut self, _: &Snapshot<'_>) -> Result<(), ObserverError> {
        self.starts += 1;
        Ok(())
    }

    fn on_collision(&mut self, _: &Collision) {
        self.collisions += 1;
    }

    fn on_end(&mut self, _: &Snapshot<'_>) {
        self.ends += 1;
    }
}

impl Experiment for Slow {
    type Rule = Elastic;
    type Boundary = Container;
    type Observer = Heard;
    type Sample = [u64; 3];

    fn revision() -> Fingerprint {
        Fingerprint::of("Slow")
    }

    fn rule(&self) -> Result<Elastic, ExperimentError> {
        Ok(Elastic)
    }

    fn boundary(&self) -> Result<Container, ExperimentError> {
        Ok(Container::closed(12.0, 12.0)?)
    }

    fn disks(&self, seed: u64) -> Result<Vec<Disk>, ExperimentError> {
        let disks = initial::lattice(&self.boundary()?, 60, 0.5)?;
        Ok(initial::with_maxwellian_velocities(disks, 1.0, seed)?)
    }

    fn cycle(&self) -> f64 {
        self.cycle
    }

    fn observer(&self) -> Result<Heard, ExperimentError> {
        Ok(Heard::default())
    }

    fn sample(&self, _: &Snapshot<'_>, heard: &mut Heard) -> [u64; 3] {
        [heard.starts, heard.collisions, heard.ends]
    }

    fn columns() -> Vec<Column<Self>> {
        vec![Column::sampled("collisions", "1", |heard: &[u64; 3]| heard[1])]
    }
}

/// A stop cuts sampling intervals in pieces, of which neither the bytes nor the observer tell.
#[test]
fn a_stop_within_a_sampling_interval_changes_nothing() {
    let plan = Plan::new(Slow { cycle: 2000.0 }, Protocol::new(1, 2, 1).unwrap(), 1).unwrap();
    let (whole, cut) = (Scratch::new("slices-not"), Scratch::new("slices"));
    let study = Study::create(&whole.0, &plan).unwrap();
    assert!(study.run(&Control::default()).unwrap().is_complete());
    let record = study.record(0, 0).unwrap().unwrap();
    let heard: Vec<_> = record.samples().iter().map(|[starts, _, ends]| (*starts, *ends)).collect();
    assert_eq!(heard, [(1, 1), (3, 3)], "a run to each sample, and one to the end of its step");
    let mut stops = 0;
    loop {
        let stop = AtomicBool::new(false);
        let study = Study::open_or_create(&cut.0, &plan).unwrap();
        let summary = std::thread::scope(|scope| {
            scope.spawn(|| {
                std::thread::sleep(Duration::from_millis(10));
                stop.store(true, Ordering::Relaxed);
            });
            study.run(&Control::default().with_interrupt(&stop).with_save_interval(Duration::ZERO)).unwrap()
        });
        if summary.is_complete() {
            break;
        }
        stops += 1;
    }
    assert!(stops > 3, "{stops} stops: some lie within one of three steps");
    assert_same(&cut.0, &whole.0);
}
