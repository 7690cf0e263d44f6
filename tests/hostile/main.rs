//! Bad input and hostile runs: random simulations under every law that must hold, files of any contents,
//! constructors over every kind of number.
//!
//! The seeds are fixed. `PROPTEST_CASES` sets the number of cases, and `PROPTEST_RNG_SEED` sets another seed.
//! With them, these tests become runs of hours (docs/validation.md, “Hostile runs”).

mod constructors;
mod few;
#[cfg(feature = "serde")]
mod files;
mod invariants;
mod laws;
mod log;
mod random_runs;
mod regressions;
mod script;
#[cfg(feature = "serde")]
mod specimens;
mod systems;
mod vessels;
mod walls;
