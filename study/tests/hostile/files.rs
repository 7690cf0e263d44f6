//! Files of any contents: an error or a value, never a panic, and never a file read as what it is not.

use std::fs;

use granular_edmd_study::vibrated_box::VibratedBox;
use granular_edmd_study::{Plan, Study, StudyError};
use proptest::prelude::*;

use crate::edits::{edit, edited};
use crate::logs;
use crate::mixture::Mixture;
use crate::specimens::Scratch;
use crate::studies::{done_study, own_plan, plan};
use support::cases::config;

/// Files with one bit flipped, each `stride`-th one, and all beginnings.
fn damaged(bytes: &[u8], stride: usize) -> impl Iterator<Item = Vec<u8>> {
    let flipped = (0..8 * bytes.len()).step_by(stride).map(|bit| {
        let mut bytes = bytes.to_vec();
        bytes[bit / 8] ^= 1 << (bit % 8);
        bytes
    });
    flipped.chain((0..bytes.len()).map(|length| bytes[..length].to_vec()))
}

fn damaged_records(name: &str, stride: usize) {
    let (scratch, study) = done_study(name, &plan());
    let sound = study.record(0, 0).unwrap().unwrap();
    drop(study);
    let (path, place) = logs::place(&scratch.0, 0, 0);
    let all = fs::read(&path).unwrap();
    for (case, bytes) in damaged(&all[place.clone()], stride).enumerate() {
        let is_cut = bytes.len() < place.len();
        let rest = if is_cut { &[] } else { &all[place.end..] };
        fs::write(&path, [&all[..place.start], &bytes, rest].concat()).unwrap();
        match Study::<VibratedBox>::open(&scratch.0).unwrap().record(0, 0) {
            Ok(found) => assert!(is_cut && found.is_none(), "{case}"),
            Err(error) => {
                let is_named = matches!(&error, StudyError::Damaged { path: named, .. } if *named == path);
                assert!(is_named && !is_cut, "{case}: {error}");
            }
        }
    }
    fs::write(&path, all).unwrap();
    assert!(Study::open(&scratch.0).unwrap().record(0, 0).unwrap() == Some(sound));
}

/// The test flips a bit of nearly each byte, in turn.
#[test]
fn flipped_bits_and_cuts_of_a_record_are_noticed() {
    damaged_records("flips", 9);
}

#[test]
#[ignore = "some seconds: all bits"]
fn each_flipped_bit_and_each_cut_of_a_record_is_noticed() {
    damaged_records("all-flips", 1);
}

#[test]
fn plans_that_cannot_be_read_are_errors() {
    let scratch = Scratch::new("unreadable");
    fs::write(scratch.0.join("plan.toml"), [0xff, 0xfe, 0]).unwrap();
    fs::write(scratch.0.join("lock"), "").unwrap();
    let error = Study::<VibratedBox>::open(&scratch.0).unwrap_err().to_string();
    assert!(error.contains("plan.toml"), "{error}");
}

proptest! {
    #![proptest_config(config(1000))]

    #[test]
    fn any_plan_is_read_or_refused(edits in prop::collection::vec(edit(), 1..6)) {
        let text = edited(&plan().to_toml().unwrap(), &edits);
        if let Ok(plan) = Plan::<VibratedBox>::from_toml(&text) {
            prop_assert_eq!(Plan::from_toml(&plan.to_toml().unwrap()).unwrap(), plan);
        }
        let text = edited(&own_plan().to_toml().unwrap(), &edits);
        if let Ok(plan) = Plan::<Mixture>::from_toml(&text) {
            prop_assert_eq!(Plan::from_toml(&plan.to_toml().unwrap()).unwrap(), plan);
        }
    }
}
