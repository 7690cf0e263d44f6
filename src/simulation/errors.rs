//! Errors of building and running a simulation.

mod answers;
mod build;
mod remedy;
mod run;

pub use answers::{BoundaryFault, FailedCollision};
pub use build::BuildError;
pub use remedy::Remedy;
pub(super) use run::Outcome;
pub use run::RunError;
