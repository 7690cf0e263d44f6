//! Files whose checksum is right and whose contents are not: refused, or a state that runs on.
//!
//! What a forged state may cost is limited by the system: this test runs itself in a process with little memory and time.

use std::collections::BTreeMap;
use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicUsize, Ordering};

use granular_edmd::simulation::Checkpoint;
use granular_edmd::study::vibrated_box::{Convection, Sample, VibratedBox};
use granular_edmd::study::{Control, Study};

use crate::limits::{Limits, in_child};
use crate::specimens::{CONTENTS_AT, checkpoint, done_study, resume, run_steps, sealed, stopped_study};

/// What is written over the contents at each place: floats, and lengths and indices in their encoding.
fn patterns() -> Vec<Vec<u8>> {
    let floats = [
        f64::NAN,
        f64::INFINITY,
        f64::NEG_INFINITY,
        -1.0,
        -0.0,
        0.5,
        1e300,
        f64::MAX,
        f64::MIN_POSITIVE,
        5e-324,
        1e-30,
        1e60,
    ];
    let floats = floats.iter().map(|float| float.to_le_bytes().to_vec());
    let varints = [u64::MAX, 1 << 32, u64::from(u32::MAX), 1000].map(varint);
    let bytes = [0, 1, 2, 3, 4, 5, 0x7f, 0x80, 0xff].map(|byte| vec![byte]);
    floats.chain(varints).chain(bytes).collect()
}

fn varint(mut value: u64) -> Vec<u8> {
    let mut bytes = Vec::new();
    while value >= 0x80 {
        bytes.push(value as u8 | 0x80);
        value >>= 7;
    }
    bytes.push(value as u8);
    bytes
}

/// The file with each pattern at each `stride`-th place of its contents, under a right checksum.
fn forged(file: &[u8], stride: usize) -> impl Iterator<Item = (usize, Vec<u8>)> {
    let contents = &file[CONTENTS_AT..];
    let places = (0..contents.len()).flat_map(|place| patterns().into_iter().map(move |with| (place, with)));
    let files = places.flat_map(|(place, with)| {
        // In the place of as many bytes, and of one, as a longer length would be.
        [place + with.len(), place + 1].map(|end| {
            let rest = &contents[end.min(contents.len())..];
            (place, sealed(file, &[&contents[..place], &with, rest].concat()))
        })
    });
    files.step_by(stride)
}

static CASE: AtomicUsize = AtomicUsize::new(0);

/// Ends the process with a word if one case takes too long.
fn watch() {
    std::thread::spawn(|| {
        loop {
            let case = CASE.load(Ordering::Relaxed);
            std::thread::sleep(std::time::Duration::from_secs(20));
            if CASE.load(Ordering::Relaxed) == case {
                eprintln!("case {case} hangs");
                std::process::abort();
            }
        }
    });
}

/// Does all cases, and names each panic once.
fn none_panics(cases: impl Iterator<Item = (usize, Vec<u8>)>, check: impl Fn(&[u8])) {
    watch();
    let mut panics = BTreeMap::new();
    for (place, bytes) in cases {
        CASE.fetch_add(1, Ordering::Relaxed);
        if let Err(panic) = catch_unwind(AssertUnwindSafe(|| check(&bytes))) {
            let said = panic.downcast_ref::<String>().cloned();
            let said = said.or_else(|| panic.downcast_ref::<&str>().map(|&said| said.to_owned()));
            panics.entry(said.unwrap_or_default()).or_insert(place);
        }
    }
    assert!(panics.is_empty(), "panics, with the first place of each: {panics:#?}");
}

/// Of how many forged files one is tried.
const STRIDE: &str = "GRANULAR_EDMD_HOSTILE_STRIDE";

const LITTLE: Limits = Limits { memory_kib: 1 << 20, seconds: 600, file_kib: None };

#[test]
fn bytes_behind_a_checkpoint_are_refused() {
    let file = checkpoint().to_bytes().unwrap();
    let longer = sealed(&file, &[&file[CONTENTS_AT..], &[0]].concat());
    let error = Checkpoint::from_bytes(&longer).unwrap_err();
    assert!(error.to_string().contains("something follows it"), "{error}");
}

#[test]
#[ignore = "started by the test of forged checkpoints"]
fn forged_checkpoints() {
    let file = checkpoint().to_bytes().unwrap();
    none_panics(forged(&file, 1), |bytes| {
        let Ok(checkpoint) = Checkpoint::from_bytes(bytes) else { return };
        let Ok(mut run) = resume(&checkpoint) else { return };
        for _ in 0..300 {
            let end = run.time() + 1.0;
            if run.step_until(end, &mut ()).is_err() {
                break;
            }
        }
        let _ = run.checkpoint();
    });
}

#[test]
#[ignore = "started by the test of forged records"]
fn forged_records() {
    let (scratch, study) = done_study("forged");
    let path = scratch.0.join("ramps/0000/0001.record");
    let file = fs::read(&path).unwrap();
    let stride = std::env::var(STRIDE).map_or(1, |stride| stride.parse().unwrap());
    none_panics(forged(&file, stride), |bytes| {
        fs::write(&path, bytes).unwrap();
        let Ok(Some(record)) = study.record(0, 1) else { return };
        let quantity = |sample: &Sample| sample.height;
        let _ = (record.mean(quantity), record.energy_change(), record.thermal_noise(), record.order());
        let _ = (record.densest_layer(), record.profile().count(), record.state().time());
        let _ = resume(record.state());
        // All values have records: this reads them and writes tables.
        let _ = Study::<VibratedBox>::open(&scratch.0).unwrap().run(&Control::default());
    });
}

#[test]
#[ignore = "started by the test of forged values half done"]
fn forged_partials() {
    let (scratch, study) = stopped_study("forged-partials", 8);
    let path = scratch.0.join("ramps/0000/0001.partial");
    let file = fs::read(&path).unwrap();
    let stride = std::env::var(STRIDE).map_or(1, |stride| stride.parse().unwrap());
    none_panics(forged(&file, stride), |bytes| {
        fs::write(&path, bytes).unwrap();
        match run_steps(&study, 8) {
            Ok(summary) => assert!(summary.redone.iter().all(|redone| *redone == path)),
            Err(error) => assert!(error.to_string().contains("0001.partial"), "{error}"),
        }
    });
}

#[test]
fn forged_values_half_done_are_started_again_or_go_on() {
    in_child("forged::forged_partials", &LITTLE, &[(STRIDE, "101")]).assert_success();
}

#[test]
#[ignore = "minutes: many more of them"]
fn all_forged_values_half_done_are_started_again_or_go_on() {
    in_child("forged::forged_partials", &LITTLE, &[(STRIDE, "3")]).assert_success();
}

#[test]
fn forged_checkpoints_are_refused_or_run() {
    in_child("forged::forged_checkpoints", &LITTLE, &[]).assert_success();
}

#[test]
fn forged_records_are_refused_or_read() {
    in_child("forged::forged_records", &LITTLE, &[(STRIDE, "401")]).assert_success();
}

#[test]
#[ignore = "minutes: many more of them"]
fn all_forged_records_are_refused_or_read() {
    in_child("forged::forged_records", &LITTLE, &[(STRIDE, "5")]).assert_success();
}
