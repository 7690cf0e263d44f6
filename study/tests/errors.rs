//! Errors say each thing once: a message never repeats that of its source, which a report shows after it.

use std::error::Error;
use std::io;
use std::path::{Path, PathBuf};

use granular_edmd::ParameterError;
use granular_edmd::boundary::Domain;
use granular_edmd::collision::Frictional;
use granular_edmd::simulation::{BuildError, CheckpointError};
use granular_edmd_study::vibrated_box::{Base, VibratedBox};
use granular_edmd_study::{Plan, PlanError, Protocol, Study, StudyError};
use support::report::{messages, report};

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

#[test]
fn errors_that_happen_tell_each_thing_once() {
    let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("errors-{}", std::process::id()));
    std::fs::write(&file, "a file where a folder should be").unwrap();
    let no_plan = Plan::<VibratedBox>::from_toml("seed = 1\nsede = 2").unwrap_err();
    let no_folder = Study::create(&file, &plan()).unwrap_err();
    std::fs::remove_file(&file).unwrap();
    tells_each_thing_once(&no_plan);
    tells_each_thing_once(&no_folder);
    let said = report(&no_folder);
    assert!(said.starts_with("cannot create") && said.contains("errors-"), "{said}");
    assert_eq!(messages(&no_folder).len(), 2, "{said}");
}
