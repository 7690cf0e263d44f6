//! Many processes on one folder: nothing is done twice or mixed, and the bytes are those of one process.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Child;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use granular_edmd_study::vibrated_box::VibratedBox;
use granular_edmd_study::{Axis, Control, Plan, Progress, Protocol, RampStatus, Study, StudyError};

use crate::logs;
use crate::support::{AnyError, RAMP, SEED, Scratch, assert_same, contents, done, small_box, start};

/// Six ramps of one value.
pub(crate) fn plan(seed: u64) -> Plan<VibratedBox> {
    Plan::new(small_box(), Protocol::new(25, 6, 10).unwrap(), seed)
        .and_then(|plan| plan.with_axis(Axis::new("friction", [0.0, 0.1, 0.2]).unwrap()))
        .and_then(|plan| plan.with_repeats(2))
        .unwrap()
}

/// The work of a process of these tests: the whole study, or one ramp.
#[test]
#[ignore = "started by the tests of many processes"]
fn child() {
    let Ok(folder) = std::env::var(crate::support::CHILD_FOLDER) else { return };
    let number = |name: &str| std::env::var(name).ok().map(|text| text.parse::<u64>().unwrap());
    let study = match Study::open_or_create(folder, &plan(number(SEED).unwrap())) {
        Err(StudyError::Different { .. }) => std::process::exit(3),
        study => study.unwrap(),
    };
    let control = Control::default().with_save_interval(Duration::ZERO);
    match number(RAMP) {
        Some(ramp) => study.run_ramp(ramp as usize, &control).unwrap(),
        None => study.run(&control).unwrap(),
    };
}

fn begin(folder: &Path, seed: u64, ramp: Option<usize>) -> Child {
    let mut command = start("processes::child", folder);
    command.env(SEED, seed.to_string());
    if let Some(ramp) = ramp {
        command.env(RAMP, ramp.to_string());
    }
    command.spawn().unwrap()
}

/// Numbers that look random and are the same on every run.
fn numbers(seed: u64) -> impl FnMut(u64) -> u64 {
    let mut state = seed;
    move |below| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) % below
    }
}

#[test]
fn processes_that_start_together_on_a_fresh_folder_share_the_work() {
    let (expected, _) = done(&plan(1), "together-not");
    for trial in 0..15 {
        let scratch = Scratch::new(&format!("together-{trial}"));
        let ramps = [None, None, Some(trial % 6), Some(5)];
        let children = ramps.map(|ramp| begin(&scratch.0, 1, ramp));
        for mut child in children {
            assert!(child.wait().unwrap().success());
        }
        assert_same(&scratch.0, &expected.0);
        let finished = logs::finished(&scratch.0);
        assert_eq!(finished.len(), 6);
        assert!(finished.values().all(|times| times.len() == 1), "nothing is done twice: {finished:?}");
    }
}

#[test]
fn of_two_plans_at_the_same_moment_one_wins_and_the_other_is_told() {
    two_plans(0..10);
}

#[test]
#[ignore = "a minute: the same two hundred times"]
fn of_two_plans_at_the_same_moment_one_wins_two_hundred_times() {
    two_plans(10..210);
}

fn two_plans(trials: std::ops::Range<u64>) {
    let expected =
        [1, 2].map(|seed| (seed, done(&plan(seed), &format!("rivals-not-{seed}-{}", trials.start))));
    for trial in trials {
        let scratch = Scratch::new(&format!("rivals-{trial}"));
        let children = [1, 2, 1, 2].map(|seed| (seed, begin(&scratch.0, seed, None)));
        let ends = children.map(|(seed, mut child)| (seed, child.wait().unwrap().code()));
        let winner = ends.iter().find(|(_, code)| *code == Some(0)).unwrap().0;
        for (seed, code) in ends {
            assert_eq!(code, Some(if seed == winner { 0 } else { 3 }), "{seed} {winner}");
        }
        let (_, (folder, _)) = expected.iter().find(|(seed, _)| *seed == winner).unwrap();
        assert_same(&scratch.0, &folder.0);
    }
}

/// Four processes run at once on a fresh folder, and some of them are killed. Then one finishes the rest.
fn killed(round: u64) -> BTreeMap<PathBuf, Vec<u8>> {
    let scratch = Scratch::new(&format!("many-killed-{round}"));
    let mut below = numbers(round);
    for _ in 0..2 {
        let mut children: Vec<Child> = (0..4)
            .map(|_| {
                let ramp = below(8);
                begin(&scratch.0, 1, (ramp < 6).then_some(ramp as usize))
            })
            .collect();
        for child in &mut children {
            std::thread::sleep(Duration::from_millis(below(60)));
            if below(3) > 0 {
                let _ = child.kill();
            }
        }
        for (index, mut child) in children.into_iter().enumerate() {
            let status = child.wait().unwrap();
            assert!(
                status.success() || status.code().is_none(),
                "process {index} of round {round}: {status}"
            );
        }
    }
    assert!(begin(&scratch.0, 1, None).wait().unwrap().success());
    contents(&scratch.0)
}

fn assert_same_bytes(round: u64, found: &BTreeMap<PathBuf, Vec<u8>>, expected: &BTreeMap<PathBuf, Vec<u8>>) {
    let places: BTreeSet<&PathBuf> = found.keys().chain(expected.keys()).collect();
    let differ: Vec<_> =
        places.into_iter().filter(|place| found.get(*place) != expected.get(*place)).collect();
    let text = |files: &BTreeMap<PathBuf, Vec<u8>>| {
        differ
            .first()
            .and_then(|place| files.get(*place))
            .map(|bytes| String::from_utf8_lossy(bytes).into_owned())
    };
    assert!(differ.is_empty(), "round {round}: {differ:?}: {:?}, not {:?}", text(found), text(expected));
}

#[test]
fn four_processes_killed_at_random_end_with_the_bytes_of_one() {
    let (folder, _) = done(&plan(1), "many-not-killed");
    let expected = contents(&folder.0);
    for round in 0..20 {
        assert_same_bytes(round, &killed(round), &expected);
    }
}

#[test]
#[ignore = "a minute: the same a hundred times"]
fn four_processes_killed_at_random_a_hundred_times_end_with_the_bytes_of_one() {
    let (folder, _) = done(&plan(1), "many-not-killed-often");
    let expected = contents(&folder.0);
    for round in 100..200 {
        assert_same_bytes(round, &killed(round), &expected);
    }
}

#[test]
fn ramps_one_by_one_make_the_study_and_the_last_one_writes_the_tables() -> Result<(), AnyError> {
    let (expected, _) = done(&plan(1), "one-by-one-not");
    let scratch = Scratch::new("one-by-one");
    for (index, ramp) in [3, 0, 5, 1, 4, 2].into_iter().enumerate() {
        let study = Study::open_or_create(&scratch.0, &plan(1))?;
        assert_eq!(study.all_status().unwrap()[ramp], RampStatus::Waiting);
        let summary = study.run_ramp(ramp, &Control::default())?;
        assert_eq!((summary.finished, summary.total), (1, 1));
        assert_eq!(study.all_status().unwrap()[ramp], RampStatus::Done);
        assert_eq!(scratch.0.join("values.csv").exists(), index == 5);
    }
    assert_same(&scratch.0, &expected.0);
    let error = Study::open_or_create(&scratch.0, &plan(1))?.run_ramp(6, &Control::default()).unwrap_err();
    assert_eq!(error.to_string(), "there is no ramp 6: the study has 6, counted from 0");
    Ok(())
}

/// One of many tasks leaves the tables alone if it has done nothing; a run of the whole study writes them
/// again.
#[test]
fn tables_that_tell_of_all_are_written_again_by_whole_runs_and_after_new_values() -> Result<(), AnyError> {
    let (scratch, study) = done(&plan(1), "tables-again");
    let path = scratch.0.join("values.csv");
    fs::remove_file(&path)?;
    assert!(study.run_ramp(2, &Control::default())?.is_complete());
    assert!(!path.exists());
    drop(study);
    logs::forget(&scratch.0, 2, 0);
    let study = Study::<VibratedBox>::open(&scratch.0)?;
    // A table without a row must not look complete.
    let error = study.write_tables().unwrap_err().to_string();
    assert!(error.contains("is damaged: a record of ramp 2 is missing"), "{error}");
    assert!(study.run_ramp(2, &Control::default().with_verification())?.is_complete());
    assert!(path.exists());
    fs::remove_file(&path)?;
    assert!(study.run(&Control::default())?.is_complete());
    assert!(path.exists());
    Ok(())
}

#[test]
fn a_ramp_that_somebody_does_is_left_to_them() -> Result<(), AnyError> {
    let scratch = Scratch::new("taken");
    let study = Study::create(&scratch.0, &plan(1))?;
    let seen = AtomicBool::new(false);
    let look = |progress: &Progress| {
        if seen.swap(true, Ordering::Relaxed) {
            return;
        }
        let other = Study::<VibratedBox>::open(&scratch.0).unwrap();
        let summary = other.run_ramp(progress.ramp, &Control::default().without_waiting()).unwrap();
        assert_eq!((summary.finished, summary.elsewhere), (0, vec![progress.ramp]));
        assert_eq!(other.all_status().unwrap()[progress.ramp], RampStatus::Running);
    };
    assert!(study.run(&Control::default().with_progress(&look))?.is_complete());
    assert!(seen.into_inner());
    Ok(())
}
