//! Errors say each thing once: a message never repeats that of its source, which a report shows after it.
#![cfg(feature = "serde")]

use std::error::Error;
use std::io;
use std::path::Path;

use granular_edmd::boundary::{Container, Wall, WallError};
use granular_edmd::collision::Frictional;
use granular_edmd::observable::SampleTimes;
use granular_edmd::simulation::{BoundaryFault, Checkpoint};
use granular_edmd::{Disk, ParameterError, Simulation, glam::DVec2, initial};
use granular_edmd_files::{ExtendedXyz, Reader, Recorder};
use support::report::{messages, report};

fn tells_each_thing_once(error: &(dyn Error + 'static)) {
    let said = messages(error);
    for pair in said.windows(2) {
        assert!(!pair[0].contains(&pair[1]), "\"{}\" repeats its source \"{}\"", pair[0], pair[1]);
    }
}

fn no_parameter() -> ParameterError {
    Frictional::from_inelasticity(0.7, 0.7, 0.1).unwrap_err()
}

/// The errors occur as users meet them.
#[test]
fn errors_that_happen_tell_each_thing_once() {
    let container = Container::closed(4.0, 4.0).unwrap();
    let disk = Disk::new(DVec2::new(-9.0, 1.0), 0.5).unwrap();
    let build = Simulation::builder(Frictional::from_inelasticity(0.0, 0.0, 0.1).unwrap(), container.clone())
        .disks(vec![disk]);
    let errors: [Box<dyn Error>; 4] = [
        Box::new(no_parameter()),
        Box::new(build.build().unwrap_err()),
        Box::new(initial::lattice(&container, 1000, 0.5).unwrap_err()),
        Box::new(Container::open(4.0).unwrap().with_temperature(Wall::Lid, thermal()).unwrap_err()),
    ];
    for error in &errors {
        tells_each_thing_once(error.as_ref());
    }
}

/// Every function that takes a path names it if the contents of the file are wrong.
#[test]
fn errors_about_contents_name_the_file() {
    let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("contents-{}", std::process::id()));
    std::fs::write(&file, "0 0\n4 4\n4 0\n0 3\n").unwrap();
    let errors: [Box<dyn Error>; 3] = [
        Box::new(Checkpoint::read(&file).unwrap_err()),
        Box::new(Reader::new().read(&file).unwrap_err()),
        Box::new(Recorder::append(&file, ExtendedXyz, SampleTimes::every(1.0).unwrap()).unwrap_err()),
    ];
    std::fs::remove_file(&file).unwrap();
    for error in &errors {
        tells_each_thing_once(error.as_ref());
        assert!(error.to_string().contains(file.to_str().unwrap()), "{error}");
    }
    let said = report(errors[0].as_ref());
    assert!(said.ends_with(": this is not a checkpoint: it does not begin like one"), "{said}");
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

/// Returns a number as a message about periods shows it.
fn rounded(number: f64) -> String {
    let error = WallError::TooManyPeriods { name: String::new(), periods: number, most: 64.0 };
    let said = error.to_string();
    said.split(' ').nth(5).unwrap().to_owned()
}

#[test]
fn numbers_in_messages_are_short() {
    assert_eq!([0.0, 3.0, -0.5, 20.0, 1e60].map(rounded), ["0", "3", "-0.5", "20", "1e60"]);
    assert_eq!([0.1 + 0.2, 1.0 / 3.0, 123_456_789.0].map(rounded), ["0.3", "0.333333", "123457000"]);
    assert_eq!([f64::NAN, f64::INFINITY, 1.0 / 3e8].map(rounded), ["NaN", "inf", "3.33333e-9"]);
    let velocity = DVec2::new(-1e300, 0.7);
    let vector = BoundaryFault::Surface { wall: 0, normal: DVec2::Y, velocity };
    assert!(vector.to_string().ends_with("(-1e300, 0.7)"), "{vector}");
    for number in [f64::MAX, f64::MIN_POSITIVE, -f64::MAX / 3.0] {
        let said = ParameterError::new("n", "other", number).to_string();
        assert!(said.len() - "n must be other, but is ".len() <= 24 && rounded(number).len() <= 13);
    }
}
