//! Temporary files have names that no other file has.
#![cfg(feature = "serde")]

use std::collections::HashSet;
use std::ffi::OsStr;

use granular_edmd::file::{is_temporary, unique_name};

#[test]
fn names_are_unique_and_recognized() {
    let names: HashSet<String> = (0..1000).map(|_| unique_name()).collect();
    assert_eq!(names.len(), 1000);
    assert!(names.iter().all(|name| is_temporary(OsStr::new(name))));
}

#[test]
fn names_of_others_are_not_ours() {
    let ours = "granular-edmd-12-0-0123456789abcdef.tmp";
    assert!(is_temporary(OsStr::new(ours)));
    let others = [
        "data.tmp",
        "0001.record.4711.tmp",
        "granular-edmd-.tmp",
        "granular-edmd-12-0-0123456789abcdef.tmp.bak",
        "granular-edmd-12-0-0123456789abcdef",
        "granular-edmd-12-0-0123456789abcde.tmp",
        "granular-edmd-12-0-0123456789abcdeg.tmp",
        "granular-edmd-12--0123456789abcdef.tmp",
        "granular-edmd-x-0-0123456789abcdef.tmp",
        "granular-edmd-1-2-0-0123456789abcdef.tmp",
        "my granular-edmd-12-0-0123456789abcdef.tmp",
    ];
    assert!(others.iter().all(|name| !is_temporary(OsStr::new(name))));
}
