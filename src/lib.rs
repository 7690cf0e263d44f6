//! Event-driven molecular dynamics of frictional, inelastic, rotating hard disks.

#![cfg_attr(docsrs, feature(doc_cfg))]

pub mod boundary;
pub mod collision;
mod disk;
mod error;
mod flight;
pub mod initial;
pub mod kinetic;
pub mod observable;
mod quantity;
mod random;
mod roots;
pub mod scheduler;
pub mod simulation;
pub mod wall;

pub use disk::{Disk, HOMOGENEOUS};
pub use error::ParameterError;
pub use flight::Flight;
pub use glam;
pub use simulation::Simulation;
