//! Bad input and hostile runs: random simulations under every law that must hold, files of any contents,
//! constructors over every kind of number.
//!
//! The seeds are fixed. `PROPTEST_CASES` sets the number of cases, and `PROPTEST_RNG_SEED` sets another seed.
//! With them, these tests become runs of hours (docs/validation.md, “Hostile runs”).

#[path = "../support/cases.rs"]
mod cases;
mod constructors;
mod edits;
mod few;
#[cfg(feature = "serde")]
mod files;
#[cfg(all(feature = "serde", unix))]
mod forged;
#[cfg(all(feature = "serde", unix))]
mod forged_systems;
#[cfg(all(feature = "serde", unix))]
mod forging;
#[cfg(feature = "serde")]
mod intruders;
mod invariants;
mod laws;
#[cfg(all(feature = "serde", unix))]
mod limits;
mod log;
mod random_runs;
mod regressions;
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
