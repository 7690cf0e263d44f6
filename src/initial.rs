//! Initial states: where the disks start, and how fast.
//!
//! All places are free of walls: at each, [`Boundary::overlap`](crate::boundary::Boundary::overlap) is `None`
//! at time 0. So the functions work in a boundary of any shape, also one that fills only a part of its
//! interior.

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

/// The disks do not fit, or cannot be placed.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum PlacementError {
    /// A parameter is out of range.
    #[error(transparent)]
    Parameter(#[from] ParameterError),
    /// There is no room for so many disks.
    #[error("there is room for {placed} of {count} disks of radius {radius}")]
    NoRoom {
        /// Count of disks wanted.
        count: usize,
        /// Count of disks that could be placed.
        placed: usize,
        /// Their radius.
        radius: f64,
    },
}

/// Checks that so many disks can be numbered: an open container has room for any number, and a slip of the
/// pen must not cost all memory.
fn countable(count: usize) -> Result<(), ParameterError> {
    accept(count <= MOST_DISKS, "number of disks", "at most 2^28", count as f64).map(|_| ())
}

/// Returns the rectangle in which a center may be; an open top stays open.
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
