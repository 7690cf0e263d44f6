//! Errors say each thing once: a message never repeats that of its source, which a report shows after it.
#![cfg(feature = "serde")]

#[path = "support/report.rs"]
mod report;

use std::error::Error;
use std::io;
use std::path::{Path, PathBuf};

use granular_edmd::boundary::{Container, Domain, Part, Wall};
use granular_edmd::collision::Frictional;
use granular_edmd::observable::SampleTimes;
use granular_edmd::simulation::{BuildError, Checkpoint, CheckpointError};
use granular_edmd::study::vibrated_box::{Base, VibratedBox};
use granular_edmd::study::{Plan, PlanError, Protocol, Study, StudyError};
use granular_edmd::trajectory::{self, ExtendedXyz, Recorder, State};
use granular_edmd::{Disk, ParameterError, Simulation, glam::DVec2, initial};
use report::{messages, report};

fn tells_each_thing_once(error: &(dyn Error + 'static)) {
    let said = messages(error);
    for pair in said.windows(2) {
        assert!(!pair[0].contains(&pair[1]), "\"{}\" repeats its source \"{}\"", pair[0], pair[1]);
    }
}

fn plan() -> Plan<VibratedBox> {
    let base = Base::Thermal { temperature: 1.0, slip: false };
    Plan::new(VibratedBox::new(3, 4.0, base).with_height(3.0), Protocol::new(1, 1, 1).unwrap(), 1).unwrap()
}

fn no_parameter() -> ParameterError {
    Frictional::from_inelasticity(0.7, 0.7, 0.1).unwrap_err()
}

/// Returns one of each variant of a study's errors that has a source.
fn study_errors() -> Vec<StudyError> {
    let path = PathBuf::from("study/values.csv");
    let outside = BuildError::Outside { disk: 3, x: 1.0, y: -2.0, domain: Domain::new(0.0, 4.0, 0.0, 4.0) };
    vec![
        StudyError::Plan(PlanError::Parameter(no_parameter())),
        StudyError::Plan(PlanError::Experiment { place: String::new(), source: no_parameter().into() }),
        StudyError::Io {
            action: "write",
            path: path.clone(),
            source: io::Error::other("No space left on device"),
        },
        StudyError::Build { ramp: 1, value: 2, source: outside.into() },
        StudyError::Build { ramp: 1, value: 2, source: BuildError::Parameter(no_parameter()).into() },
        StudyError::Build { ramp: 1, value: 2, source: CheckpointError::Damaged.into() },
        StudyError::Encode { path, source: "too long".into() },
    ]
}

#[test]
fn errors_of_studies_tell_each_thing_once() {
    for error in study_errors() {
        tells_each_thing_once(&error);
    }
}

/// The errors occur as users meet them.
#[test]
fn errors_that_happen_tell_each_thing_once() {
    let container = Container::closed(4.0, 4.0).unwrap();
    let disk = Disk::new(DVec2::new(-9.0, 1.0), 0.5).unwrap();
    let build = Simulation::builder(Frictional::from_inelasticity(0.0, 0.0, 0.1).unwrap(), container.clone())
        .disks(vec![disk]);
    let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("errors-{}", std::process::id()));
    std::fs::write(&file, "a file where a folder should be").unwrap();
    let errors: [Box<dyn Error>; 6] = [
        Box::new(no_parameter()),
        Box::new(build.build().unwrap_err()),
        Box::new(initial::lattice(&container, 1000, 0.5).unwrap_err()),
        Box::new(Container::open(4.0).unwrap().with_temperature(Wall::Lid, thermal()).unwrap_err()),
        Box::new(Plan::<VibratedBox>::from_toml("seed = 1\nsede = 2").unwrap_err()),
        Box::new(Study::create(&file, &plan()).unwrap_err()),
    ];
    std::fs::remove_file(&file).unwrap();
    for error in &errors {
        tells_each_thing_once(error.as_ref());
    }
    let said = report(errors[5].as_ref());
    assert!(said.starts_with("cannot create") && said.contains("errors-"), "{said}");
    assert_eq!(messages(errors[5].as_ref()).len(), 2, "{said}");
}

/// Every function that takes a path names it if the contents of the file are wrong.
#[test]
fn errors_about_contents_name_the_file() {
    let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("contents-{}", std::process::id()));
    std::fs::write(&file, "0 0\n4 4\n4 0\n0 3\n").unwrap();
    let errors: [Box<dyn Error>; 6] = [
        Box::new(Checkpoint::read(&file).unwrap_err()),
        Box::new(Part::polygon_from_file(&file).unwrap_err()),
        Box::new(trajectory::read(&file, State::from_xyz).unwrap_err()),
        Box::new(trajectory::read(&file, State::from_csv).unwrap_err()),
        Box::new(trajectory::read(&file, State::from_lammps_data).unwrap_err()),
        Box::new(Recorder::append(&file, ExtendedXyz, SampleTimes::every(1.0).unwrap()).unwrap_err()),
    ];
    std::fs::remove_file(&file).unwrap();
    for error in &errors {
        tells_each_thing_once(error.as_ref());
        assert!(error.to_string().contains(file.to_str().unwrap()), "{error}");
    }
    let said = report(errors[0].as_ref());
    assert!(said.ends_with(": this is not a checkpoint: it does not begin as one"), "{said}");
    let said = report(errors[1].as_ref());
    assert!(said.contains("crosses or touches itself: its side from point 0"), "{said}");
}

fn thermal() -> granular_edmd::boundary::Thermal {
    granular_edmd::boundary::Thermal::new(1.0).unwrap()
}

#[test]
fn an_error_that_repeats_its_source_is_noticed() {
    #[derive(Debug)]
    struct Twice(io::Error);
    impl std::fmt::Display for Twice {
        fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
            write!(formatter, "cannot write: {}", self.0)
        }
    }
    impl Error for Twice {
        fn source(&self) -> Option<&(dyn Error + 'static)> {
            Some(&self.0)
        }
    }
    let told = std::panic::catch_unwind(|| tells_each_thing_once(&Twice(io::Error::other("full"))));
    assert!(told.is_err());
}
