//! Event-driven molecular dynamics of frictional, inelastic, rotating hard disks.

#![cfg_attr(docsrs, feature(doc_cfg))]

pub mod collision;
mod disk;
mod error;
pub mod kinetic;
mod quantity;
mod random;

pub use disk::{Disk, HOMOGENEOUS};
pub use error::ParameterError;
pub use glam;
