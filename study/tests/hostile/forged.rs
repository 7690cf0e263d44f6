//! Records and unfinished values whose checksum is right and whose contents are wrong. Each is refused, or
//! takes part in its study.

use std::fs;

use granular_edmd_study::vibrated_box::Sample;
use granular_edmd_study::{Control, Experiment, Plan, Record, Study};

use crate::forging::{LITTLE, STRIDE, forged, none_panics, stride};
use crate::limits::in_child;
use crate::logs;
use crate::specimens::{CONTENTS_AT, resume};
use crate::studies::{done_study, own_plan, plan, run_steps, stopped_study};

#[test]
#[ignore = "started by the test of forged records"]
fn forged_records() {
    forge_records("forged", &plan(), |record| {
        let quantity = |sample: &Sample| sample.height;
        let _ = (record.mean(quantity), record.energy_change(), record.thermal_noise(), record.order());
        let _ = (
            record.densest_layer(),
            record.profile().count(),
            record.checkpoint().map(granular_edmd::simulation::Checkpoint::time),
        );
        let _ = record.checkpoint().map(resume);
    });
    forge_records("forged-own", &own_plan(), |record| {
        let _ = (record.mean(|sample| sample.angular_momentum), record.estimate("risen"), record.observer());
    });
}

/// Reads all forgeries of a record; what is accepted is looked at, and takes part in the study.
fn forge_records<E: Experiment>(name: &str, plan: &Plan<E>, look: impl Fn(&Record<E>)) {
    let (scratch, study) = done_study(name, plan);
    drop(study);
    let file = [&[0; CONTENTS_AT], logs::record(&scratch.0, 0, 1).as_slice()].concat();
    none_panics(forged(&file, stride()), |bytes| {
        logs::replace(&scratch.0, 0, 1, &bytes[CONTENTS_AT..]);
        let study = Study::<E>::open(&scratch.0).unwrap();
        let Ok(Some(record)) = study.record(0, 1) else { return };
        look(&record);
        // All values have records, so this call reads them and writes tables.
        let _ = study.run(&Control::default().with_verification());
    });
}

#[test]
#[ignore = "started by the test of forged values half done"]
fn forged_partials() {
    forge_partials("forged-partials", &plan());
    forge_partials("forged-own-partials", &own_plan());
}

fn forge_partials<E: Experiment>(name: &str, plan: &Plan<E>) {
    let (scratch, study) = stopped_study(name, plan, 8);
    let path = scratch.0.join("unfinished/0000-0001");
    let file = fs::read(&path).unwrap();
    none_panics(forged(&file, stride()), |bytes| {
        fs::write(&path, bytes).unwrap();
        match run_steps(&study, 8) {
            Ok(summary) => assert!(summary.redone.iter().all(|redone| *redone == path)),
            Err(error) => assert!(error.to_string().contains("0000-0001"), "{error}"),
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
fn forged_records_are_refused_or_read() {
    in_child("forged::forged_records", &LITTLE, &[(STRIDE, "401")]).assert_success();
}

#[test]
#[ignore = "minutes: many more of them"]
fn all_forged_records_are_refused_or_read() {
    in_child("forged::forged_records", &LITTLE, &[(STRIDE, "5")]).assert_success();
}
