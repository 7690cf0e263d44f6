//! Records and unfinished values with a right checksum and contents that their study cannot have. Each is
//! named.

use std::fs;
use std::path::PathBuf;

use granular_edmd_study::vibrated_box::{Base, VibratedBox};
use granular_edmd_study::{Control, Course, Plan, Protocol, Ramp, Study, StudyError};

use crate::specimens::{CONTENTS_AT, Scratch, sealed};
use crate::studies::{done_study, plan, run_steps, stopped_study};

/// A file of a study, and the study.
struct Specimen {
    _scratch: Scratch,
    study: Study<VibratedBox>,
    path: PathBuf,
    file: Vec<u8>,
}

impl Specimen {
    fn new((scratch, study): (Scratch, Study<VibratedBox>), file: &str) -> Self {
        let path = scratch.0.join("ramps/0000").join(file);
        let file = fs::read(&path).unwrap();
        Self { _scratch: scratch, study, path, file }
    }

    /// The second record of the small study.
    fn record(name: &str) -> Self {
        Self::new(done_study(name, &plan()), "0001.record")
    }

    /// The small study, stopped on its way to the second value.
    fn partial(name: &str) -> Self {
        Self::new(stopped_study(name, &plan(), 8), "0001.partial")
    }

    /// Writes the file with its contents changed, under a right checksum.
    fn forge(&self, change: impl FnOnce(&mut Vec<u8>)) {
        let mut contents = self.file[CONTENTS_AT..].to_vec();
        change(&mut contents);
        fs::write(&self.path, sealed(&self.file, &contents)).unwrap();
    }

    /// Writes it with one number in the place of the last that is another.
    fn put(&self, new: f64, old: f64) {
        self.forge(|contents| {
            let (new, old) = (new.to_le_bytes(), old.to_le_bytes());
            let at = contents.windows(8).rposition(|window| window == old).unwrap();
            contents[at..at + 8].copy_from_slice(&new);
        });
    }

    fn assert_damaged(&self, expected: &str) {
        let error = self.study.record(0, 1).unwrap_err();
        let StudyError::Damaged { path, reason, .. } = &error else { panic!("{error}") };
        assert_eq!((path, reason.as_str()), (&self.path, expected));
    }
}

#[test]
fn a_record_with_impossible_numbers_is_damaged() {
    let record = Specimen::record("impossible");
    let sample = record.study.record(0, 1).unwrap().unwrap().samples()[1];
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        record.put(bad, sample.height);
        record.assert_damaged("a sample is not finite");
        record.put(bad, sample.translational_energy);
        record.assert_damaged("a sample is not finite");
    }
    fs::write(&record.path, &record.file).unwrap();
    let time = record.study.record(0, 1).unwrap().unwrap().checkpoint().unwrap().time();
    for bad in [0.0, 2.0 * time, 1e300] {
        // The state has its own checksum.
        record.put(bad, time);
        record.assert_damaged("its contents make no sense");
    }
    record.forge(|contents| contents.push(0));
    record.assert_damaged("there is more in it than there should be");
    record.forge(|contents| contents.truncate(contents.len() - 1));
    record.assert_damaged("its contents make no sense");
}

/// Damaged records are done again: the same bytes as before.
#[test]
fn what_a_forged_record_said_is_done_again() {
    let record = Specimen::record("again");
    let sample = record.study.record(0, 1).unwrap().unwrap().samples()[0];
    record.put(f64::NAN, sample.height);
    let summary = record.study.run(&Control::default().with_verification()).unwrap();
    assert_eq!(summary.redone, std::slice::from_ref(&record.path));
    assert!(fs::read(&record.path).unwrap() == record.file);
}

#[test]
fn files_of_another_plan_are_told_apart() {
    let base = Base::BiParabolic { amplitude: 0.1, angular_frequency: 10.0 };
    let experiment = VibratedBox::new(3, 4.0, base).with_height(3.0).with_contact_duration(1e-3);
    let ramp = Ramp::new("friction", [0.1, 0.2], Course::Up).unwrap();
    let other = Plan::new(experiment, Protocol::new(2, 3, 1).unwrap(), 6).unwrap().with_ramp(ramp).unwrap();
    assert_ne!(other, plan());
    let scratch = Scratch::new("other-plan");
    let study = Study::create(&scratch.0, &other).unwrap();
    study.run(&Control::default()).unwrap();
    for specimen in [Specimen::record("not-this-plan"), Specimen::partial("nor-this")] {
        let name = specimen.path.file_name().unwrap();
        let place = scratch.0.join("ramps/0000").join(name);
        let _ = fs::remove_file(scratch.0.join("ramps/0000/0001.record"));
        fs::write(&place, &specimen.file).unwrap();
        let error = study.run(&Control::default().with_verification()).unwrap_err();
        assert!(matches!(&error, StudyError::Foreign { path } if *path == place), "{error}");
        fs::remove_file(&place).unwrap();
    }
}

#[test]
fn a_value_half_done_that_cannot_be_is_started_again() {
    let expected = Specimen::record("not-half-done");
    let partial = Specimen::partial("half-done");
    let finished = partial.path.with_extension("record");
    let contents = &partial.file[CONTENTS_AT..];
    let forgeries: [Vec<u8>; 4] = [
        [contents, &[0]].concat(),
        contents[..contents.len() / 2].to_vec(),
        Specimen::partial("less-done-than").file[CONTENTS_AT..CONTENTS_AT + 50].to_vec(),
        expected.file[CONTENTS_AT..].to_vec(),
    ];
    for forged in forgeries {
        fs::write(&partial.path, sealed(&partial.file, &forged)).unwrap();
        let summary = partial.study.run(&Control::default().with_verification()).unwrap();
        assert_eq!(summary.redone, std::slice::from_ref(&partial.path));
        assert!(fs::read(&finished).unwrap() == expected.file);
        fs::remove_file(&finished).unwrap();
    }
    fs::remove_file(partial.study.folder().join("done")).unwrap();
    // The unfinished value goes on in its original form.
    fs::write(&partial.path, &partial.file).unwrap();
    assert!(run_steps(&partial.study, u64::MAX).unwrap().redone.is_empty());
    assert!(fs::read(&finished).unwrap() == expected.file);
}

/// The samples and the state of such a value would not be those of the step.
#[test]
fn a_value_half_done_at_another_step_is_started_again() {
    let partial = Specimen::partial("another-step");
    let expected = Specimen::record("another-step-not");
    let finished = partial.path.with_extension("record");
    // The number of steps, three, comes after the cycles of the value before, five.
    let steps = partial.file[CONTENTS_AT..].windows(2).position(|window| window == [5, 3]).unwrap() + 1;
    // Two steps, with the sample of the third taken, are this value, too.
    for bad in [0, 1, 4, 5, 100] {
        partial.forge(|contents| contents[steps] = bad);
        let summary = partial.study.run(&Control::default().with_verification()).unwrap();
        assert_eq!(summary.redone, std::slice::from_ref(&partial.path), "{bad}");
        assert!(fs::read(&finished).unwrap() == expected.file);
        fs::remove_file(&finished).unwrap();
    }
}
