//! Planted faults, by which the conformance checks are judged: parts that break the contracts of their
//! traits.

#![expect(clippy::type_complexity, reason = "a fault is a function in the place of a method")]

#[expect(dead_code, reason = "a measurement of the checks takes the parts; here they are only counted")]
mod faults;

use std::collections::HashSet;

use faults::blind;

#[test]
fn the_catalogue_has_many_faults_and_no_name_twice() {
    let names = blind::names();
    assert!(names.len() >= 160, "{} faults", names.len());
    let mut seen = HashSet::new();
    for name in &names {
        assert!(seen.insert(name), "two faults are called {name:?}");
    }
}
