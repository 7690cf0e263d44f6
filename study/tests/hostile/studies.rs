//! A small study.

use std::sync::atomic::{AtomicBool, Ordering};

use granular_edmd_study::vibrated_box::{Base, VibratedBox};
use granular_edmd_study::{
    Control, Course, Experiment, Plan, Progress, Protocol, Ramp, Study, StudyError, Summary,
};

use crate::mixture::{Mixture, mixture};
use crate::specimens::Scratch;

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
