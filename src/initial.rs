//! Initial states: the positions and velocities at which disks start.
//!
//! No disk is placed into a wall: [`Boundary::overlap`](crate::boundary::Boundary::overlap) is `None` for
//! each at time 0. The functions therefore work in a boundary of any shape, also in one that fills only a
//! part of its interior.

mod lattice;
mod random;
mod velocities;

pub use lattice::lattice;
pub use random::{placed_at_random, random};
pub use velocities::with_maxwellian_velocities;

use thiserror::Error;

use crate::ParameterError;
use crate::boundary::Domain;
use crate::disk::MOST_DISKS;
use crate::quantity::accept;

/// An error: the disks do not fit, or cannot be placed.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum PlacementError {
    /// A parameter is out of range.
    #[error(transparent)]
    Parameter(#[from] ParameterError),
    /// There is no room for so many disks.
    #[error("there is room for {placed} of {count} disks of radius {radius}")]
    NoRoom {
        /// Number of disks wanted.
        count: usize,
        /// Number of disks that could be placed.
        placed: usize,
        /// Radius of the disks.
        radius: f64,
    },
}

/// Checks that so many disks can be numbered. An open container has room for any number, and a mistyped one
/// must not fill the memory.
fn countable(count: usize) -> Result<(), ParameterError> {
    accept(count <= MOST_DISKS, "number of disks", "at most 2^28", count as f64).map(|_| ())
}

/// Returns the rectangle in which a center may lie. An open top stays open.
fn room(interior: &Domain, radius: f64) -> Domain {
    let side = if interior.periodic { 0.0 } else { radius };
    let room = Domain::new(
        interior.left + side,
        interior.right - side,
        interior.bottom + radius,
        interior.top - radius,
    );
    if interior.periodic { room.with_periodic_sides() } else { room }
}
