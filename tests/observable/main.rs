//! Observables of known states, observers against the bare list of collisions, their contract, and their
//! files.

mod chance;
#[cfg(feature = "serde")]
mod measurements;
mod measures;
mod observables;
mod observers;
mod profiles_and_fields;
mod right;
mod stress_and_velocities;
mod tables;
mod transport;
