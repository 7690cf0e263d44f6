//! A small study, and the files in its folder.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::Duration;

use granular_edmd_study::vibrated_box::{Base, VibratedBox};
use granular_edmd_study::{Axis, Control, Course, Experiment, Plan, Progress, Protocol, Ramp, Study};

pub(crate) use crate::logs::contents;

pub(crate) type AnyError = Box<dyn std::error::Error>;

pub(crate) const BASE: Base = Base::BiParabolic { amplitude: 0.1, angular_frequency: 10.0 };

pub(crate) fn small_box() -> VibratedBox {
    VibratedBox::new(30, 10.0, BASE)
        .with_height(30.0)
        .with_gravity(0.015_625)
        .with_inelasticity(0.05)
        .with_contact_duration(1e-4)
}

/// Two ramps of five values.
pub(crate) fn small_plan() -> Plan<VibratedBox> {
    let ramp = Ramp::new("friction", vec![0.01, 0.1, 0.3], Course::UpAndDown).unwrap();
    Plan::new(small_box(), Protocol::new(25, 6, 10).unwrap(), 7)
        .and_then(|study| study.with_ramp(ramp))
        .and_then(|study| study.with_axis(Axis::new("inelasticity", vec![0.0, 0.02]).unwrap()))
        .unwrap()
}

/// A folder for one test, removed with it.
pub(crate) struct Scratch(pub(crate) PathBuf);

impl Scratch {
    pub(crate) fn new(name: &str) -> Self {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&folder);
        Self(folder)
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// Does the study of a plan without a break.
pub(crate) fn done(plan: &Plan<VibratedBox>, name: &str) -> (Scratch, Study<VibratedBox>) {
    let scratch = Scratch::new(name);
    let study = Study::create(&scratch.0, plan).unwrap();
    assert!(study.run(&Control::default()).unwrap().is_complete());
    (scratch, study)
}

pub(crate) fn assert_same(found: &Path, expected: &Path) {
    let (found, expected) = (contents(found), contents(expected));
    assert_eq!(found.keys().collect::<Vec<_>>(), expected.keys().collect::<Vec<_>>());
    for (name, bytes) in &expected {
        assert!(&found[name] == bytes, "{} differs", name.display());
    }
}

/// Runs a study again and again, each time interrupted after a number of steps that depends on the run, until
/// it is complete; returns the number of interruptions.
pub(crate) fn run_with_interruptions<E: Experiment>(
    folder: &Path,
    plan: &Plan<E>,
    steps: impl Fn(u64) -> u64 + Sync,
    watch: impl Fn(&Progress) + Sync,
) -> u64 {
    for run in 0.. {
        let (stop, done) = (AtomicBool::new(false), AtomicU64::new(0));
        let progress = |progress: &Progress| {
            watch(progress);
            stop.store(done.fetch_add(1, Ordering::Relaxed) > steps(run), Ordering::Relaxed);
        };
        let control = Control::default().with_interrupt(&stop).with_progress(&progress);
        let study = Study::open_or_create(folder, plan).unwrap();
        if study.run(&control.with_save_interval(Duration::ZERO)).unwrap().is_complete() {
            return run;
        }
    }
    unreachable!("a study ends");
}

/// Name of a file that a killed process was writing.
pub(crate) const TEMPORARY: &str = "granular-edmd-4711-0-0123456789abcdef.tmp";

pub(crate) const CHILD_FOLDER: &str = "GRANULAR_EDMD_TEST_STUDY";

/// Variables of the processes that tests start: the seed of the plan, and the ramp that is run, if it is one
/// alone.
pub(crate) const SEED: &str = "GRANULAR_EDMD_TEST_SEED";
pub(crate) const RAMP: &str = "GRANULAR_EDMD_TEST_RAMP";

/// Returns the command that does an ignored test on a folder.
pub(crate) fn start(test: &str, folder: &Path) -> Command {
    let mut command = Command::new(std::env::current_exe().unwrap());
    command.args(["--exact", test, "--ignored"]).env(CHILD_FOLDER, folder);
    command.stdout(Stdio::null()).stderr(Stdio::null());
    command
}
