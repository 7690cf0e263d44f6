//! Damaged files are named and done again, and foreign files are named and left alone.

use std::fs;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

use granular_edmd_study::vibrated_box::VibratedBox;
use granular_edmd_study::{Control, Progress, Study, StudyError};

use crate::logs;
use crate::support::{AnyError, Scratch, TEMPORARY, assert_same, contents, done, small_plan};

#[test]
fn damage_is_noticed_named_and_repaired() -> Result<(), AnyError> {
    let (scratch, study) = done(&small_plan(), "damaged");
    let expected = contents(&scratch.0);
    drop(study);
    let (log, place) = logs::place(&scratch.0, 1, 2);
    let sound = fs::read(&log)?;
    let flipped = |at: usize| {
        let mut bytes = sound.clone();
        bytes[at] ^= 0x10;
        bytes
    };
    let another = logs::record(&scratch.0, 1, 3);
    logs::replace(&scratch.0, 1, 2, &another);
    let another = fs::read(&log)?;
    let mark = place.start;
    let changed = [mark, mark + 4, mark + 9, mark + 24, mark + 40, mark + 60, place.end - 1].map(flipped);
    for bytes in changed.into_iter().chain([another]) {
        fs::write(&log, bytes)?;
        let study = Study::<VibratedBox>::open(&scratch.0)?;
        let error = study.record(1, 2).unwrap_err();
        assert!(matches!(&error, StudyError::Damaged { path, .. } if *path == log), "{error}");
        assert!(study.write_tables().is_err());
        let summary = study.run(&Control::default().with_verification())?;
        assert!(summary.is_complete());
        assert_eq!(summary.redone, std::slice::from_ref(&log));
        assert!(contents(&scratch.0) == expected);
        assert!(Study::<VibratedBox>::open(&scratch.0)?.records().all(|record| record.is_ok()));
    }
    // A log that was cut has whole records or none.
    for length in [place.start, place.start + 10, place.end - 1] {
        fs::write(&log, &sound[..length])?;
        let study = Study::<VibratedBox>::open(&scratch.0)?;
        assert!(study.record(1, 2)?.is_none());
        assert!(study.run(&Control::default())?.is_complete());
        assert!(contents(&scratch.0) == expected);
    }
    Ok(())
}

#[test]
fn a_damaged_half_done_value_is_started_again() -> Result<(), AnyError> {
    let (expected, _) = done(&small_plan(), "half-done-not");
    let scratch = Scratch::new("half-done");
    let stop = AtomicBool::new(false);
    let progress = |_: &Progress| stop.store(true, Ordering::Relaxed);
    let study = Study::create(&scratch.0, &small_plan())?;
    let summary = study.run(&Control::default().with_interrupt(&stop).with_progress(&progress))?;
    assert!(!summary.is_complete());
    // The ramp that reported its progress first has begun.
    let partials = [0, 1].map(|ramp| scratch.0.join(format!("unfinished/{ramp:04}-0000")));
    let partial = partials.into_iter().find(|path| path.exists()).ok_or("nothing was begun")?;
    let bytes = fs::read(&partial)?;
    fs::write(&partial, &bytes[..bytes.len() / 2])?;
    fs::write(partial.with_file_name(TEMPORARY), "of a killed process")?;
    let summary = study.run(&Control::default())?;
    assert_eq!(summary.redone, [partial]);
    assert_same(&scratch.0, &expected.0);
    Ok(())
}

#[test]
fn a_changed_plan_takes_no_old_records() -> Result<(), AnyError> {
    let (scratch, _) = done(&small_plan(), "changed");
    let before = contents(&scratch.0);
    let path = scratch.0.join("plan.toml");
    fs::write(&path, fs::read_to_string(&path)?.replace("seed = 7", "seed = 8"))?;
    let error = Study::<VibratedBox>::open(&scratch.0).unwrap_err();
    assert!(error.to_string().contains("provenance.json is of another plan"), "{error}");
    fs::write(&path, &before[Path::new("plan.toml")])?;
    assert!(contents(&scratch.0) == before, "nothing was lost");
    Ok(())
}

#[test]
fn a_torn_provenance_is_refused_wherever_it_is_torn() -> Result<(), AnyError> {
    let (scratch, _) = done(&small_plan(), "torn");
    let path = scratch.0.join("provenance.json");
    let text = fs::read_to_string(&path)?;
    for length in 0..text.trim_end().len() {
        if !text.is_char_boundary(length) {
            continue;
        }
        fs::write(&path, &text[..length])?;
        let opened = Study::<VibratedBox>::open(&scratch.0);
        assert!(opened.is_err(), "{}", &text[..length]);
        let opened = Study::open_or_create(&scratch.0, &small_plan());
        assert!(opened.is_err(), "{}", &text[..length]);
    }
    fs::write(&path, &text)?;
    Study::<VibratedBox>::open(&scratch.0)?;
    Ok(())
}
