//! Planted faults, by which the conformance checks are judged: parts that break the contracts of their
//! traits.

#![expect(clippy::type_complexity, reason = "a fault is a function in the place of a method")]

mod alarms;
mod faults;
mod shares;
mod survivors;

use std::collections::HashSet;

use faults::{blind, informed};

#[test]
fn the_catalogue_has_many_faults_and_no_name_twice() {
    let names = [blind::names(), informed::names()].concat();
    assert!(names.len() >= 300, "{} faults", names.len());
    let mut seen = HashSet::new();
    for name in &names {
        assert!(seen.insert(name), "two faults are called {name:?}");
    }
}
