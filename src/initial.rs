//! Initial states: the positions and velocities with which disks start.
//!
//! | function | disks | where |
//! |---|---|---|
//! | [`lattice`], [`triangular_lattice`] | equal ones | a square or triangular lattice from the floor up |
//! | [`even_lattice`] | equal ones | a square lattice over the whole interior |
//! | [`placed_in_rows`] | any | rows, small ones on top of each other |
//! | [`scattered`], [`scattered_mix`] | equal ones, any | random positions, up to an area fraction of 0.5 |
//! | [`packed_mix`] | any | random positions, up to an area fraction of 0.8 |
//!
//! A [`Reader`](https://docs.rs/granular-edmd-files) of the package `granular-edmd-files` reads disks from
//! files of other programs.
//!
//! [`Radii`] draws radii from distributions, and [`disks_from_radii`] makes disks of them.
//! [`with_maxwellian_velocities`] sets disks in motion, and [`without_drift`] stops their center of mass. To
//! place disks around other disks, put the other disks into the container as
//! [pegs](crate::boundary::Container::with_pegs).
//!
//! The functions place no disk in a wall: at time 0,
//! [`Boundary::overlap`](crate::boundary::Boundary::overlap) is `None` for each disk. They therefore work in
//! a boundary of any shape, even if it leaves only some of its interior free.

mod draws;
mod lattice;
mod packed;
mod scattered;

pub use draws::{Radii, disks_from_radii, with_maxwellian_velocities, without_drift};
pub use lattice::{even_lattice, lattice, placed_in_rows, triangular_lattice};
pub use packed::packed_mix;
pub use scattered::{scattered, scattered_mix};

use glam::DVec2;
use thiserror::Error;

use crate::ParameterError;
use crate::boundary::Domain;
use crate::disk::countable;
use crate::error::Readable;
use crate::quantity::accept;
use crate::simulation::{BuildError, FEWEST};

/// The error of the functions that place disks.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum PlacementError {
    /// A parameter is out of range.
    #[error(transparent)]
    Parameter(#[from] ParameterError),
    /// There is no room for all disks.
    #[error("there is room for {placed} of {count} disks of radius {} in {interior}", Readable(*.radius))]
    NoRoom {
        /// Number of requested disks.
        count: usize,
        /// Number of disks that could be placed.
        placed: usize,
        /// Radius of the disks.
        radius: f64,
        /// Interior of the boundary, up to the height to which disks were placed.
        interior: Domain,
    },
    /// No random position was found for a disk.
    #[error(
        "random positions were found for {placed} of {count} disks of radius {} in {interior}, after all larger \
         disks; `initial::packed_mix` packs them more densely", Readable(*.radius)
    )]
    NoPosition {
        /// Number of disks of this radius.
        count: usize,
        /// Number of them that have positions.
        placed: usize,
        /// Radius of the disk. All larger disks have positions.
        radius: f64,
        /// Interior of the boundary, up to the height to which disks were placed.
        interior: Domain,
    },
    /// A period of the domain is too short for a simulation of these disks: a disk would meet another disk
    /// and its image at the same time.
    #[error(
        "a simulation needs periods of more than four diameters, but the period is {} and the diameter {}",
        Readable(*.period), Readable(*.diameter)
    )]
    ShortPeriod {
        /// The shorter period.
        period: f64,
        /// Diameter of the largest disk.
        diameter: f64,
    },
    /// The disks jam before they have their full radii.
    #[error("the disks jam at the area fraction {reached:.4}: they would need {wanted:.4}")]
    Jammed {
        /// Area fraction of the disks in the room when they jammed.
        reached: f64,
        /// Area fraction that the disks would have at their full radii.
        wanted: f64,
    },
    /// The engine, which moves the disks while they are packed, refuses them or the boundary.
    #[error(transparent)]
    Build(#[from] BuildError),
    /// The engine stopped while it packed the disks, since the boundary breaks its contract.
    #[error("while disks were packed, {reason}")]
    Run {
        /// Message of the engine.
        reason: String,
    },
}

/// Smallest distance between neighbors, in diameters.
const CLOSE: f64 = 1.000_1;

/// Returns the distances between neighbors to try, in diameters, from loose to close.
fn spacings() -> impl Iterator<Item = f64> {
    const LOOSE: f64 = 1.4;
    (0..=40).map(|k| LOOSE + (CLOSE - LOOSE) * f64::from(k) / 40.0)
}

/// Checks that the periods of a domain suit disks of this radius. The engine would refuse them later.
fn check_periods(domain: &Domain, radius: f64) -> Result<(), PlacementError> {
    let (DVec2 { x, y }, diameter) = (domain.periods(), 2.0 * radius);
    let short = [x, y].into_iter().find(|&period| period > 0.0 && period <= FEWEST * diameter);
    short.map_or(Ok(()), |period| Err(PlacementError::ShortPeriod { period, diameter }))
}

/// Cuts the interior of a boundary at a height above its bottom. A box that is periodic upward and cut below
/// its top is no longer periodic there.
fn cut(interior: Domain, below: f64) -> Result<Domain, ParameterError> {
    let is_within = below.is_finite() && below > interior.bottom;
    let below = accept(is_within, "height", "finite and above the bottom of the interior", below)?;
    let periodic_ends = interior.periodic_ends && below >= interior.top;
    Ok(Domain { top: interior.top.min(below), periodic_ends, ..interior })
}

/// Returns the rectangle in which a center may lie. An open top stays open.
fn room(interior: &Domain, radius: f64) -> Domain {
    let side = if interior.periodic_sides { 0.0 } else { radius };
    let end = if interior.periodic_ends { 0.0 } else { radius };
    let Domain { left, right, bottom, top, .. } = *interior;
    Domain { left: left + side, right: right - side, bottom: bottom + end, top: top - end, ..*interior }
}
