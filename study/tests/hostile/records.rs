//! Records and unfinished values with a right checksum and contents that their study cannot have. Each is
//! named.

use std::fs;
use std::path::{Path, PathBuf};

use granular_edmd_study::vibrated_box::{Base, VibratedBox};
use granular_edmd_study::{Control, Course, Plan, Protocol, Ramp, Study, StudyError};

use crate::logs;
use crate::specimens::{CONTENTS_AT, Scratch, sealed};
use crate::studies::{done_study, plan, run_steps, stopped_study};

/// The second value of the small study: its record, or a file of it half done.
struct Specimen {
    scratch: Scratch,
    study: Study<VibratedBox>,
    /// The file, or none for a record.
    path: Option<PathBuf>,
    contents: Vec<u8>,
}

impl Specimen {
    fn record(name: &str) -> Self {
        let (scratch, study) = done_study(name, &plan());
        let contents = logs::record(&scratch.0, 0, 1);
        Self { scratch, study, path: None, contents }
    }

    /// The study is stopped on its way to the value.
    fn partial(name: &str) -> Self {
        let (scratch, study) = stopped_study(name, &plan(), 8);
        let path = scratch.0.join("unfinished/0000-0001");
        let contents = fs::read(&path).unwrap()[CONTENTS_AT..].to_vec();
        Self { scratch, study, path: Some(path), contents }
    }

    /// Writes it with these contents, under a right checksum, into a study that is then opened anew.
    fn write(&mut self, folder: &Path, contents: &[u8]) {
        match &self.path {
            Some(path) => {
                fs::create_dir_all(folder.join("unfinished")).unwrap();
                let head = [b"GRANPART".as_slice(), &6_u32.to_le_bytes(), &[0; 32]].concat();
                fs::write(folder.join("unfinished").join(path.file_name().unwrap()), sealed(&head, contents))
                    .unwrap();
            }
            None => logs::replace(folder, 0, 1, contents),
        }
        self.study = Study::open(folder).unwrap();
    }

    fn forge(&mut self, change: impl FnOnce(&mut Vec<u8>)) {
        let mut contents = self.contents.clone();
        change(&mut contents);
        self.write(&self.scratch.0.clone(), &contents);
    }

    /// Writes it with one number in the place of the last that is another.
    fn put(&mut self, new: f64, old: f64) {
        self.forge(|contents| {
            let (new, old) = (new.to_le_bytes(), old.to_le_bytes());
            let at = contents.windows(8).rposition(|window| window == old).unwrap();
            contents[at..at + 8].copy_from_slice(&new);
        });
    }

    fn assert_damaged(&self, expected: &str) {
        let error = self.study.record(0, 1).unwrap_err();
        let StudyError::Damaged { reason, .. } = &error else { panic!("{error}") };
        assert_eq!(reason.as_str(), format!("value 1 of ramp 0: {expected}"));
    }
}

#[test]
fn a_record_with_impossible_numbers_is_damaged() {
    let mut record = Specimen::record("impossible");
    record.forge(|_| ());
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
    let mut record = Specimen::record("again");
    record.forge(|contents| contents.push(0));
    let summary = record.study.run(&Control::default().with_verification()).unwrap();
    assert_eq!(summary.redone, [record.scratch.0.join("blocks/0000.log")]);
    assert!(logs::record(&record.scratch.0, 0, 1) == record.contents);
}

#[test]
fn files_of_another_plan_are_told_apart() {
    let base = Base::BiParabolic { amplitude: 0.1, angular_frequency: 10.0 };
    let experiment = VibratedBox::new(3, 4.0, base).with_height(3.0).with_contact_duration(1e-3);
    let ramp = Ramp::new("friction", [0.1, 0.2], Course::Up).unwrap();
    let other = Plan::new(experiment, Protocol::new(2, 3, 1).unwrap(), 6).unwrap().with_ramp(ramp).unwrap();
    assert_ne!(other, plan());
    let scratch = Scratch::new("other-plan");
    Study::create(&scratch.0, &other).unwrap().run(&Control::default()).unwrap();
    let mut half_done = Specimen::partial("nor-this");
    logs::forget(&scratch.0, 0, 1);
    half_done.write(&scratch.0, &half_done.contents.clone());
    let error = half_done.study.run(&Control::default()).unwrap_err();
    assert!(is_of_another_plan(&error, "0000-0001"), "{error}");
    fs::remove_dir_all(scratch.0.join("unfinished")).unwrap();
    half_done.study.run(&Control::default()).unwrap();
    let mut record = Specimen::record("not-this-plan");
    record.write(&scratch.0, &record.contents.clone());
    let error = record.study.run(&Control::default().with_verification()).unwrap_err();
    assert!(is_of_another_plan(&error, "0000.log"), "{error}");
}

fn is_of_another_plan(error: &StudyError, file: &str) -> bool {
    let StudyError::Refused { path, reason } = error else { return false };
    path.ends_with(file) && reason.starts_with("is of another plan")
}

#[test]
fn a_value_half_done_that_cannot_be_is_started_again() {
    let expected = Specimen::record("not-half-done");
    let mut partial = Specimen::partial("half-done");
    let contents = partial.contents.clone();
    let folder = partial.scratch.0.clone();
    let forgeries: [Vec<u8>; 4] = [
        [contents.as_slice(), &[0]].concat(),
        contents[..contents.len() / 2].to_vec(),
        Specimen::partial("less-done-than").contents[..50].to_vec(),
        expected.contents.clone(),
    ];
    for forged in forgeries {
        partial.write(&folder, &forged);
        let summary = partial.study.run(&Control::default()).unwrap();
        assert_eq!(summary.redone, [partial.path.clone().unwrap()]);
        assert!(logs::record(&folder, 0, 1) == expected.contents);
        logs::forget(&folder, 0, 1);
    }
    // The unfinished value goes on in its original form.
    partial.write(&folder, &contents);
    assert!(run_steps(&partial.study, u64::MAX).unwrap().redone.is_empty());
    assert!(logs::record(&folder, 0, 1) == expected.contents);
}
