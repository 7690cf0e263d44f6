//! Transitions, bracketed and bisected along a ramp.

use std::fs;

use granular_edmd_study::vibrated_box::VibratedBox;
use granular_edmd_study::{
    Axis, Control, Course, Leg, Plan, Progress, Protocol, Ramp, Record, Study, StudyError, Width,
};

use crate::logs;
use crate::mixture::{Mixture, mixture};
use crate::support::{AnyError, Scratch, assert_same, contents, run_with_interruptions, small_box};
use support::report::report;

const WIDTH: f64 = 0.002;

/// Up and down over a transition at 0.137, for two losses.
fn plan() -> Plan<Mixture> {
    let ramp = Ramp::new("weight", [0.1, 0.15, 0.2, 0.25], Course::UpAndDown)
        .unwrap()
        .with_refinement(Width::Absolute(WIDTH))
        .unwrap();
    Plan::new(mixture(), Protocol::new(2, 3, 1).unwrap(), 3)
        .and_then(|plan| plan.with_axis(Axis::new("loss", [0.0, 0.2]).unwrap()))
        .and_then(|plan| plan.with_ramp(ramp))
        .unwrap()
}

fn done(name: &str) -> (Scratch, Study<Mixture>) {
    let scratch = Scratch::new(name);
    let study = Study::create(&scratch.0, &plan()).unwrap();
    let summary = study.run(&Control::default()).unwrap();
    assert!(summary.is_complete());
    // Each ramp has seven values, and five halves for each of its two brackets of width 0.05.
    assert_eq!(summary.total, 2 * (7 + 2 * 5));
    (scratch, study)
}

#[test]
fn a_transition_is_bracketed_from_below_and_from_above() -> Result<(), AnyError> {
    let (scratch, study) = done("refined");
    for ramp in 0..2 {
        let brackets = study.transitions(ramp)?;
        assert_eq!(
            brackets.iter().map(|bracket| bracket.leg).collect::<Vec<_>>(),
            [Some(Leg::Up), Some(Leg::Down)]
        );
        for bracket in brackets {
            let (low, high) = (bracket.near.min(bracket.far), bracket.near.max(bracket.far));
            assert!(low <= 0.137 && 0.137 < high && high - low <= WIDTH, "{bracket:?}");
        }
        // The first half starts where the value on the near side has ended.
        let records: Vec<Record<Mixture>> = study.ramp_records(ramp).collect::<Result<_, _>>()?;
        let (near, half) = (&records[0], &records[7]);
        assert!(
            half.times()[0] > near.checkpoint().ok_or("no state")?.time()
                && half.times()[0] < records[1].checkpoint().ok_or("no state")?.time()
        );
        assert_eq!(half.ramped_value(), Some(0.125));
    }
    let table = fs::read_to_string(scratch.0.join("transitions.csv"))?;
    assert!(
        table.starts_with("ramp,leg,loss,weight_near,weight_far,from_state,to_state\n0,up,0.0,0.13"),
        "{table}"
    );
    assert_eq!(table.lines().count(), 5);
    Ok(())
}

#[test]
fn an_interrupted_refinement_goes_on_with_the_same_bytes() {
    let (expected, _) = done("refined-not-interrupted");
    let scratch = Scratch::new("refined-interrupted");
    let watch = |progress: &Progress| assert!(progress.done <= progress.total);
    // A known value counts as one step, so each run gets further than the previous one.
    assert!(run_with_interruptions(&scratch.0, &plan(), |run| 25 + 4 * run, watch) > 2);
    assert_same(&scratch.0, &expected.0);
}

#[test]
fn a_damaged_value_of_a_refinement_is_done_again() -> Result<(), AnyError> {
    let (scratch, study) = done("refined-damaged");
    let before = contents(&scratch.0);
    drop(study);
    let [log, other] = ["blocks/0001.log", "blocks/0000.log"].map(|name| scratch.0.join(name));
    for value in [1, 9] {
        logs::replace(&scratch.0, 1, value, b"cut");
        let study = Study::<Mixture>::open(&scratch.0)?;
        assert!(matches!(study.record(1, value as usize), Err(StudyError::Damaged { .. })));
        assert_eq!(study.run(&Control::default().with_verification())?.redone, std::slice::from_ref(&log));
        assert!(contents(&scratch.0) == before);
    }
    // The place in the record of another half shows that it is another one.
    logs::replace(&scratch.0, 0, 8, &logs::record(&scratch.0, 0, 7));
    let study = Study::<Mixture>::open(&scratch.0)?;
    assert_eq!(study.run(&Control::default().with_verification())?.redone, [other]);
    assert!(contents(&scratch.0) == before);
    Ok(())
}

#[test]
fn the_states_of_the_box_are_its_convective_regimes() -> Result<(), AnyError> {
    let scratch = Scratch::new("refined-box");
    let plan = Plan::new(small_box(), Protocol::new(5, 10, 2)?, 1)?;
    let study = Study::<VibratedBox>::create(&scratch.0, &plan)?;
    study.run(&Control::default())?;
    let record = study.record(0, 0)?.ok_or("no record")?;
    let state = <VibratedBox as granular_edmd_study::Experiment>::state(&record);
    assert!(state.is_some_and(|state| !state.is_empty()));
    assert_eq!(study.transitions(0)?, []);
    Ok(())
}

#[test]
fn a_width_that_cannot_be_is_refused() {
    let numbers = [0.0, -1.0, f64::NAN];
    for width in numbers.map(Width::Absolute).into_iter().chain(numbers.map(Width::Relative)) {
        let ramp = Ramp::new("weight", [0.1, 0.2], Course::Up).unwrap();
        let error = report(&ramp.with_refinement(width).unwrap_err());
        assert!(error.contains("width of a transition must be finite and positive"), "{error}");
    }
    let ramp = Ramp::new("weight", [0.0, 0.2], Course::Up).unwrap();
    let error = report(&ramp.with_refinement(Width::Relative(0.01)).unwrap_err());
    assert!(error.contains("value of a ramp with a relative width must be"), "{error}");
}
