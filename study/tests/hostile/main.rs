//! Bad input of studies: plans and files of any contents, and faults of the machine.
//!
//! The seeds are fixed. `PROPTEST_CASES` sets the number of cases, and `PROPTEST_RNG_SEED` sets another seed.

mod cuts;
mod edits;
#[cfg(unix)]
mod faults;
mod files;
#[cfg(unix)]
mod limits;
#[path = "../support/logs.rs"]
mod logs;
#[path = "../support/mixture.rs"]
mod mixture;
mod numbers;
mod records;
#[allow(dead_code, reason = "shared with the tests of the core")]
mod specimens;
mod studies;
mod unknown_fields;
