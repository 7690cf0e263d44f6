//! What can go wrong when a simulation is built or run.

use thiserror::Error;

use crate::ParameterError;

/// The disks, the boundary and the parameters do not fit together.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum BuildError {
    /// A parameter is out of range.
    #[error(transparent)]
    Parameter(#[from] ParameterError),
    /// There are more disks than the engine can number.
    #[error("{count} disks are too many: at most {most} are possible")]
    TooManyDisks {
        /// How many there are.
        count: usize,
        /// How many there may be.
        most: usize,
    },
    /// The boundary has more walls than the engine can number.
    #[error("{count} walls are too many: at most {most} are possible")]
    TooManyWalls {
        /// How many there are.
        count: usize,
        /// How many there may be.
        most: usize,
    },
    /// A disk is outside the boundary's domain.
    #[error("disk {disk} at ({x}, {y}) is outside the domain")]
    Outside {
        /// Its index.
        disk: usize,
        /// Its position.
        x: f64,
        /// Its position.
        y: f64,
    },
    /// A disk overlaps a wall.
    #[error("disk {disk} at ({x}, {y}) overlaps the wall {wall:?} by {depth}")]
    OverlapsWall {
        /// Its index.
        disk: usize,
        /// Its position.
        x: f64,
        /// Its position.
        y: f64,
        /// The wall's name.
        wall: String,
        /// By how much.
        depth: f64,
    },
    /// Two disks overlap.
    #[error("disks {first} and {second} overlap by {depth}")]
    Overlap {
        /// Index of the first.
        first: usize,
        /// Index of the second.
        second: usize,
        /// By how much.
        depth: f64,
    },
    /// The domain has no area, or periodic sides too close for a disk not to meet its own image.
    #[error("a domain of width {width} and height {height} is too small for disks of diameter {diameter}")]
    DomainTooSmall {
        /// Its width.
        width: f64,
        /// Its height.
        height: f64,
        /// Diameter of the largest disk.
        diameter: f64,
    },
}

/// A run cannot go on. The simulation keeps the state that it had when it noticed.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum RunError {
    /// The end is before the present, or not finite.
    #[error("the run cannot end at time {end}: it is at time {time}")]
    End {
        /// The end asked for.
        end: f64,
        /// The present.
        time: f64,
    },
    /// Events pile up in vanishing time: inelastic collapse, or a disk that rests on a wall.
    #[error(
        "{events} events without progress at time {time}, the last of disk {disk}: inelastic collapse, which the rule \
         ContactDuration prevents, or a disk at rest on a wall"
    )]
    Stalled {
        /// The present.
        time: f64,
        /// The disk whose event was last.
        disk: usize,
        /// How many events there were without progress.
        events: u64,
    },
    /// A rule or a wall answered with a number that is not finite.
    #[error("the collision of disk {disk} at time {time} gave it a velocity that is not finite")]
    NotFinite {
        /// The disk.
        disk: usize,
        /// The present.
        time: f64,
    },
    /// After a sample an observer asked for the next one at a time that is not later.
    #[error("an observer asks for a sample at time {next}, having just had one at {time}")]
    SampleTime {
        /// The time asked for.
        next: f64,
        /// The present.
        time: f64,
    },
}
