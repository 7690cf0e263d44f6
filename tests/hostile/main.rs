//! Bad input and hostile runs: random simulations under every law that must hold, files of any contents,
//! constructors over every kind of number, and faults of the machine.
//!
//! The seeds are fixed. `PROPTEST_CASES` sets the number of cases, and `PROPTEST_RNG_SEED` sets another seed.
//! With them, these tests become runs of hours (docs/validation.md, “Hostile runs”).

#[path = "../support/cases.rs"]
mod cases;
mod constructors;
mod edits;
#[cfg(all(feature = "serde", unix))]
mod faults;
mod few;
#[cfg(feature = "serde")]
mod files;
#[cfg(all(feature = "serde", unix))]
mod forged;
#[cfg(all(feature = "serde", unix))]
mod forged_systems;
mod invariants;
mod laws;
#[cfg(all(feature = "serde", unix))]
mod limits;
mod log;
#[cfg(feature = "serde")]
#[path = "../support/mixture.rs"]
mod mixture;
mod random_runs;
#[cfg(feature = "serde")]
mod records;
mod regressions;
#[cfg(feature = "serde")]
#[path = "../support/report.rs"]
mod report;
#[path = "../support/schedulers.rs"]
mod schedulers;
mod script;
#[cfg(feature = "serde")]
mod specimens;
mod systems;
mod texts;
#[cfg(feature = "serde")]
mod unknown_fields;
mod vessels;
mod walls;
