//! Observables of known states, observers against the bare list of collisions, their contract, and their
//! files.

mod chance;
mod crossings;
#[cfg(feature = "serde")]
mod measurements;
mod measures;
mod observables;
mod observers;
mod profiles_and_fields;
mod right;
mod settings;
mod stress_and_velocities;
mod tables;
mod walls_by_kind;
