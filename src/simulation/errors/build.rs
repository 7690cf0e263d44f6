//! The errors of building a simulation.

use glam::DVec2;
use thiserror::Error;

use crate::ParameterError;
use crate::boundary::Domain;
use crate::error::{Readable, Rounded};

/// The error of a simulation whose disks, boundary and parameters do not fit together.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum BuildError {
    /// A parameter is out of range.
    #[error(transparent)]
    Parameter(#[from] ParameterError),
    /// Times at the start are too coarse for such fast disks: time would stand still.
    #[error(
        "the run cannot start at time {}: times there are {} apart, too coarse for disks that move tens of \
         diameters in {}; start nearer to 0",
        Readable(*.start), Rounded(*.spacing), Rounded(*.epoch)
    )]
    StartTime {
        /// The requested start time.
        start: f64,
        /// Distance to the next floating-point number.
        spacing: f64,
        /// Time in which a typical disk moves tens of diameters.
        epoch: f64,
    },
    /// The boundary's domain is not a rectangle with finite sides and a finite bottom.
    #[error("the domain must have finite sides and a finite bottom; only its top may be infinite: {domain}")]
    Domain {
        /// The domain.
        domain: Domain,
    },
    /// A disk is outside the boundary's domain.
    #[error("disk {disk} at ({}, {}) is outside the domain: {domain}", Readable(*.x), Readable(*.y))]
    Outside {
        /// Index of the disk.
        disk: usize,
        /// Horizontal position of its center.
        x: f64,
        /// Vertical position of its center.
        y: f64,
        /// The domain.
        domain: Domain,
    },
    /// A disk overlaps a wall.
    #[error(
        "disk {disk} at ({}, {}) overlaps the wall {wall:?} by {}",
        Readable(*.x), Readable(*.y), Rounded(*.depth)
    )]
    OverlapsWall {
        /// Index of the disk.
        disk: usize,
        /// Horizontal position of its center.
        x: f64,
        /// Vertical position of its center.
        y: f64,
        /// The wall's name.
        wall: String,
        /// Depth of the overlap.
        depth: f64,
    },
    /// A disk fills a hollow of a wall, up to rounding. Rounding alone would decide whether the disk gets
    /// into the hollow.
    #[error(
        "disk {disk} of radius {} is exactly as large as the hollow of the wall {wall:?}: make one of them larger",
        Readable(*.radius)
    )]
    TightFit {
        /// Index of the disk.
        disk: usize,
        /// Radius of the disk.
        radius: f64,
        /// The wall's name.
        wall: String,
    },
    /// Two disks overlap.
    #[error(
        "disks {first} and {second} at ({}, {}) and ({}, {}) overlap by {}",
        Readable(.positions[0].x), Readable(.positions[0].y), Readable(.positions[1].x), Readable(.positions[1].y),
        Rounded(*.depth)
    )]
    Overlap {
        /// Index of the first disk.
        first: usize,
        /// Index of the second disk.
        second: usize,
        /// Positions of their centers.
        positions: [DVec2; 2],
        /// Depth of the overlap.
        depth: f64,
    },
    /// Two disks have the same id.
    #[error("disks {first} and {second} both have the id {id}: give the new one the id 0")]
    SameId {
        /// The id.
        id: u64,
        /// Index of the first disk.
        first: usize,
        /// Index of the second disk.
        second: usize,
    },
    /// The domain has no area, or its periodic sides are so close that a disk could meet two images of
    /// another.
    #[error(
        "a domain of width {} and height {} is too small for disks of diameter {}: \
         where it is periodic, it must be longer than four diameters",
        Readable(*.width), Readable(*.height), Readable(*.diameter)
    )]
    DomainTooSmall {
        /// Width of the domain.
        width: f64,
        /// Height of the domain.
        height: f64,
        /// Diameter of the largest disk.
        diameter: f64,
    },
}
