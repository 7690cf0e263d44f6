//! Growth: a study that takes over what earlier ones have done gets the bytes of one that did it all.

use std::fs;
use std::path::PathBuf;

use granular_edmd_study::vibrated_box::{Sides, VibratedBox};
use granular_edmd_study::{Axis, Control, Course, Experiment, Plan, PlanError, Protocol, Ramp, Study, Width};

use crate::logs;
use crate::mixture::{Mixture, mixture};
use crate::support::{AnyError, Scratch, assert_same, small_box};
use support::report::report;

/// Returns the number of values that the logs say were taken over.
fn taken<E: Experiment>(study: &Study<E>) -> usize {
    logs::finished(study.folder()).values().flatten().filter(|seconds| seconds.is_nan()).count()
}

/// Does these plans, then a larger one after them, and checks that it is as if it had done everything.
/// Returns the number of values that it took over.
fn grown<E: Experiment>(name: &str, before: &[Plan<E>], larger: &Plan<E>) -> Result<usize, AnyError> {
    let scratch = Scratch::new(name);
    let run = |plan: &Plan<E>, folder: &str, earlier: &[PathBuf]| -> Result<Study<E>, AnyError> {
        let study = Study::create(scratch.0.join(folder), plan)?;
        assert!(study.run(&Control::default().with_earlier_studies(earlier))?.is_complete());
        Ok(study)
    };
    fs::create_dir_all(&scratch.0)?;
    let names: Vec<String> = (0..before.len()).map(|index| format!("before-{index}")).collect();
    for (plan, name) in before.iter().zip(&names) {
        run(plan, name, &[])?;
    }
    let folders: Vec<PathBuf> = names.iter().map(|name| scratch.0.join(name)).collect();
    let study = run(larger, "grown", &folders)?;
    assert_same(study.folder(), run(larger, "fresh", &[])?.folder());
    Ok(taken(&study))
}

/// A sweep of two axes with this friction and this inelasticity, and so many repeats.
fn sweep(friction: &[f64], inelasticity: &[f64], repeats: usize) -> Result<Plan<VibratedBox>, PlanError> {
    Plan::new(small_box(), Protocol::new(5, 4, 2)?, 7)?
        .with_axis(Axis::new("friction", friction.iter().copied())?)?
        .with_axis(Axis::new("inelasticity", inelasticity.iter().copied())?)?
        .with_repeats(repeats)
}

#[test]
fn values_anywhere_on_the_axes_and_repeats_are_added() -> Result<(), AnyError> {
    let before = sweep(&[0.1, 0.3], &[0.0, 0.02], 1)?;
    let larger = sweep(&[0.0, 0.3, 0.2, 0.1], &[0.02, 0.0, 0.01], 2)?;
    assert_eq!(grown("growth-sweep", &[before], &larger)?, 4);
    Ok(())
}

#[test]
fn the_parts_of_a_sweep_have_seeds_of_their_own_and_become_one() -> Result<(), AnyError> {
    let parts = [sweep(&[0.1, 0.2], &[0.0], 2)?, sweep(&[0.1, 0.2], &[0.02], 2)?];
    let seeds = |plan: &Plan<VibratedBox>| (0..4).map(|ramp| plan.ramp_seed(ramp)).collect::<Vec<_>>();
    let [one, other] = parts.each_ref().map(seeds);
    assert!(one.iter().all(|seed| !other.contains(seed)));
    assert_eq!(grown("growth-parts", &parts, &sweep(&[0.1, 0.2], &[0.0, 0.02], 2)?)?, 8);
    Ok(())
}

/// Ramps of one plan, done in folders of their own: on the disks of nodes, for example, where the file system
/// that all nodes share has no locks.
#[test]
fn ramps_in_many_folders_become_one_study() -> Result<(), AnyError> {
    let (scratch, plan) = (Scratch::new("growth-folders"), sweep(&[0.1, 0.2], &[0.0], 2)?);
    let folders = [0, 1, 2, 3].map(|ramp| scratch.0.join(format!("part-{ramp}")));
    for (ramp, folder) in folders.iter().enumerate() {
        assert!(Study::create(folder, &plan)?.run_ramp(ramp, &Control::default())?.is_complete());
    }
    let study = Study::create(scratch.0.join("joined"), &plan)?;
    assert!(study.run(&Control::default().with_earlier_studies(&folders))?.is_complete());
    let fresh = Study::create(scratch.0.join("fresh"), &plan)?;
    fresh.run(&Control::default())?;
    assert_same(study.folder(), fresh.folder());
    assert_eq!(taken(&study), 4);
    Ok(())
}

/// The order of the axes and the name by which a plan calls a parameter do not count.
#[test]
fn seeds_are_those_of_the_parameters() -> Result<(), AnyError> {
    let plan = sweep(&[0.1, 0.2], &[0.0, 0.02], 1)?;
    let turned = Plan::new(small_box(), Protocol::new(5, 4, 2)?, 7)?
        .with_axis(Axis::new("inelasticity", [0.0, 0.02])?)?
        .with_axis(Axis::new("friction", [0.1, 0.2])?)?;
    let seeds = |plan: &Plan<VibratedBox>, ramps: [usize; 4]| ramps.map(|ramp| plan.ramp_seed(ramp));
    assert_eq!(seeds(&plan, [0, 1, 2, 3]), seeds(&turned, [0, 2, 1, 3]));
    let base = |name: &str| -> Result<u64, AnyError> {
        let plan = Plan::new(small_box(), Protocol::new(5, 4, 2)?, 7)?;
        Ok(plan.with_axis(Axis::new(name, [0.1])?)?.ramp_seed(0))
    };
    assert_eq!(base("amplitude")?, base("base.bi_parabolic.amplitude")?);
    let sides =
        |sides| Plan::new(small_box(), Protocol::new(5, 4, 2)?, 7)?.with_axis(Axis::new("sides", sides)?);
    let (both, one) = (sides(vec!["hard", "periodic"])?, sides(vec!["periodic"])?);
    assert_eq!((both.ramp_seed(1), one.experiment(0, 0)?.sides), (one.ramp_seed(0), Sides::Periodic));
    Ok(())
}

#[test]
fn values_that_kept_their_state_go_on_to_more_samples() -> Result<(), AnyError> {
    let plan = |samples| -> Result<_, PlanError> {
        let plan = Plan::new(small_box(), Protocol::new(5, samples, 2)?.with_phase(0.5)?, 7)?;
        plan.with_axis(Axis::new("friction", [0.0, 0.1])?)
    };
    let scratch = Scratch::new("growth-samples");
    let before = Study::create(scratch.0.join("before"), &plan(3)?.with_end_states())?;
    before.run(&Control::default())?;
    let first = Study::create(scratch.0.join("fresh"), &plan(5)?)?;
    first.run(&Control::default())?;
    let study = Study::create(scratch.0.join("grown"), &plan(5)?)?;
    let from = [before.folder().to_owned()];
    let least = std::sync::atomic::AtomicU64::new(u64::MAX);
    let look = |progress: &granular_edmd_study::Progress| {
        least.fetch_min(progress.done, std::sync::atomic::Ordering::Relaxed);
    };
    study.run(&Control::default().with_earlier_studies(&from).with_progress(&look))?;
    assert!(least.into_inner() >= 3 + 3, "it does not settle and sample again");
    assert_same(study.folder(), first.folder());
    // Without states, all is done again.
    assert_eq!(grown("growth-no-states", &[plan(3)?], &plan(5)?)?, 0);
    // Fewer samples are other values.
    assert_eq!(grown("growth-fewer", &[plan(5)?.with_end_states()], &plan(3)?)?, 0);
    Ok(())
}

#[test]
fn a_ramp_grows_at_its_end() -> Result<(), AnyError> {
    let plan = |values: &[f64], course| -> Result<_, PlanError> {
        let ramp = Ramp::new("friction", values.iter().copied(), course)?;
        Plan::new(small_box(), Protocol::new(5, 2, 2)?, 7)?.with_ramp(ramp)
    };
    let before = plan(&[0.01, 0.1, 0.2], Course::Up)?;
    // The last value kept no state, from which another could start.
    let larger = plan(&[0.01, 0.1, 0.2, 0.3], Course::UpAndDown)?;
    assert_eq!(grown("growth-ramp", std::slice::from_ref(&before), &larger)?, 2);
    assert_eq!(grown("growth-ramp-states", &[before.clone().with_end_states()], &larger)?, 3);
    // A value in the middle changes all that follow it.
    let refined = plan(&[0.01, 0.05, 0.1, 0.2], Course::Up)?;
    assert_eq!(grown("growth-ramp-middle", &[before], &refined)?, 1);
    Ok(())
}

#[test]
fn a_refinement_grows_finer() -> Result<(), AnyError> {
    let plan = |width| -> Result<Plan<Mixture>, AnyError> {
        let ramp = Ramp::new("weight", [0.1, 0.15, 0.2], Course::UpAndDown)?;
        let ramp = ramp.with_refinement(Width::Absolute(width))?;
        Ok(Plan::new(mixture(), Protocol::new(2, 3, 1)?, 3)?.with_ramp(ramp)?)
    };
    let taken = grown("growth-refined", &[plan(0.02)?], &plan(0.002)?)?;
    assert!(taken >= 5 + 2, "{taken}");
    Ok(())
}

#[test]
fn what_must_not_differ_is_named() -> Result<(), AnyError> {
    let scratch = Scratch::new("growth-refused");
    let before = Study::create(scratch.0.join("before"), &sweep(&[0.1], &[0.0], 1)?)?;
    before.run(&Control::default())?;
    let from = [before.folder().to_owned()];
    let swept = |parameter, seed, settle, gravity| -> Result<_, PlanError> {
        let plan = Plan::new(small_box().with_gravity(gravity), Protocol::new(settle, 4, 2)?, seed)?;
        plan.with_axis(Axis::new("friction", [0.1])?)?.with_axis(Axis::new(parameter, [0.0])?)
    };
    for (index, (plan, reason)) in [
        (swept("inelasticity", 8, 5, 0.015_625)?, "seed is 7 there and 8 here"),
        (swept("inelasticity", 7, 6, 0.015_625)?, "protocol.settle is 5 there and 6 here"),
        (swept("inelasticity", 7, 5, 0.5)?, "experiment.gravity is 0.015625 there and 0.5 here"),
        (
            swept("wall_friction", 7, 5, 0.015_625)?,
            "swept parameters is friction, inelasticity there and friction, wall_friction here",
        ),
    ]
    .into_iter()
    .enumerate()
    {
        let study = Study::create(scratch.0.join(index.to_string()), &plan)?;
        let error = report(&study.run(&Control::default().with_earlier_studies(&from)).unwrap_err());
        assert!(error.contains(reason), "{error}");
        assert!(!study.folder().join("blocks").exists(), "{error}");
    }
    Ok(())
}

/// Values that the clock ended depend on the machine, so a larger study computes them again.
#[test]
fn values_that_a_limit_ended_are_not_taken_over() -> Result<(), AnyError> {
    let scratch = Scratch::new("growth-limited");
    fs::create_dir_all(&scratch.0)?;
    let plan = sweep(&[0.1, 0.2], &[0.0], 1)?;
    let limited = Study::create(scratch.0.join("limited"), &plan)?;
    let summary = limited.run(&Control::default().with_most_seconds(1e-9)?)?;
    assert_eq!(summary.failed, 2);
    let larger = sweep(&[0.1, 0.2, 0.3], &[0.0], 1)?;
    let [grown, fresh] = ["grown", "fresh"].map(|name| Study::create(scratch.0.join(name), &larger));
    let (grown, fresh) = (grown?, fresh?);
    grown.run(&Control::default().with_earlier_studies(&[limited.folder().to_owned()]))?;
    fresh.run(&Control::default())?;
    assert_same(grown.folder(), fresh.folder());
    Ok(())
}
