//! A small run and a small study, and the files that they write.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

use granular_edmd::boundary::{Container, Wall};
use granular_edmd::collision::{ContactDuration, Frictional};
use granular_edmd::scheduler::LinearScan;
use granular_edmd::simulation::{Checkpoint, CheckpointError};
use granular_edmd::study::vibrated_box::{Base, VibratedBox};
use granular_edmd::study::{
    Control, Course, Experiment, Plan, Progress, Protocol, Ramp, Study, StudyError, Summary,
};
use granular_edmd::wall::BiParabolic;
use granular_edmd::{Simulation, initial};

use crate::mixture::{Mixture, mixture};

pub(crate) type Rule = ContactDuration<Frictional>;
type SmallRun = Simulation<Rule, Container, LinearScan>;

/// Magic, version and checksum come before the contents of every sealed file.
pub(crate) const VERSION_AT: usize = 8;
pub(crate) const CHECKSUM_AT: usize = 12;
pub(crate) const CONTENTS_AT: usize = 44;

pub(crate) fn rule() -> Rule {
    ContactDuration::new(Frictional::from_inelasticity(0.05, 0.05, 0.2).unwrap(), 1e-3).unwrap()
}

pub(crate) fn container() -> Container {
    let base = BiParabolic::new(0.1, 3.0).unwrap();
    Container::closed(5.0, 4.0).unwrap().with_motion(Wall::Floor, base).unwrap()
}

/// A run of four disks, some way in.
pub(crate) fn checkpoint() -> Checkpoint {
    let disks = initial::lattice(&container(), 4, 0.5).unwrap();
    let disks = initial::with_maxwellian_velocities(disks, 1.0, 3).unwrap();
    let builder = Simulation::builder(rule(), container()).disks(disks).gravity(0.1);
    let mut run = builder.build().unwrap();
    run.run_until(3.0, &mut ()).unwrap();
    run.checkpoint()
}

pub(crate) fn resume(checkpoint: &Checkpoint) -> Result<SmallRun, CheckpointError> {
    Simulation::resume(checkpoint, rule(), container()).scheduler(LinearScan::default()).build()
}

/// Contents behind the seal of `like`.
pub(crate) fn sealed(like: &[u8], contents: &[u8]) -> Vec<u8> {
    [&like[..CHECKSUM_AT], blake3::hash(contents).as_bytes(), contents].concat()
}

/// A study of two values.
pub(crate) fn plan() -> Plan<VibratedBox> {
    let base = Base::BiParabolic { amplitude: 0.1, angular_frequency: 10.0 };
    let experiment = VibratedBox::new(3, 4.0, base).with_height(3.0).with_contact_duration(1e-3);
    let ramp = Ramp::new("friction", [0.1, 0.2], Course::Up).unwrap();
    Plan::new(experiment, Protocol::new(2, 3, 1).unwrap(), 5)
        .unwrap()
        .with_ramp(ramp)
        .unwrap()
        .with_end_states()
}

/// The same for a user's experiment.
pub(crate) fn own_plan() -> Plan<Mixture> {
    let ramp = Ramp::new("weight", [0.1, 0.2], Course::Up).unwrap();
    Plan::new(mixture(), Protocol::new(2, 3, 1).unwrap(), 5)
        .unwrap()
        .with_ramp(ramp)
        .unwrap()
        .with_end_states()
}

/// A folder for one test, removed with it.
pub(crate) struct Scratch(pub(crate) PathBuf);

impl Scratch {
    pub(crate) fn new(name: &str) -> Self {
        let name = format!("hostile-{name}-{}", std::process::id());
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(&folder).unwrap();
        Self(folder)
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// A study, stopped after this many steps.
pub(crate) fn stopped_study<E: Experiment>(name: &str, plan: &Plan<E>, steps: u64) -> (Scratch, Study<E>) {
    let scratch = Scratch::new(name);
    let study = Study::create(&scratch.0, plan).unwrap();
    run_steps(&study, steps).unwrap();
    (scratch, study)
}

/// Runs a study until it has done this many steps in all.
pub(crate) fn run_steps<E: Experiment>(study: &Study<E>, steps: u64) -> Result<Summary, StudyError> {
    let stop = AtomicBool::new(false);
    let progress = |progress: &Progress| stop.store(progress.done >= steps, Ordering::Relaxed);
    study.run(&Control::default().with_progress(&progress).with_interrupt(&stop))
}

/// A study, done.
pub(crate) fn done_study<E: Experiment>(name: &str, plan: &Plan<E>) -> (Scratch, Study<E>) {
    let scratch = Scratch::new(name);
    let study = Study::create(&scratch.0, plan).unwrap();
    assert!(study.run(&Control::default()).unwrap().is_complete());
    (scratch, study)
}
