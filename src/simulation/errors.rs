//! Errors of building and running a simulation.

mod build;
mod run;

pub use build::BuildError;
pub(super) use run::Outcome;
pub use run::{BoundaryFault, FailedCollision, Remedy, RunError};
