//! Errors of building and running a simulation.

mod answers;
mod build;
mod remedy;
mod run;

<<<<<<< HEAD
pub(super) use answers::Named;
pub use answers::{BoundaryFault, FailedCollision};
pub use build::BuildError;
pub use remedy::Remedy;
pub(super) use run::Outcome;
pub use run::RunError;
=======
use glam::DVec2;
use thiserror::Error;

use super::stall::{Named, Remedy};
use crate::ParameterError;
use crate::boundary::Domain;
use crate::collision::{Contact, Impulse};
use crate::error::{Readable, Rounded, RoundedVector};
use crate::observable::{ObserverError, Partner};

/// An error: the disks, the boundary and the parameters do not fit together.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum BuildError {
    /// A parameter is out of range.
    #[error(transparent)]
    Parameter(#[from] ParameterError),
    /// Times at the start are too coarse for such fast disks: time would stand still.
    #[error(
        "the run cannot start at time {}: times there are {} apart, too coarse for disks that go some tens of \
         diameters in {}; start nearer to 0",
        Readable(*.start), Rounded(*.spacing), Rounded(*.epoch)
    )]
    StartTime {
        /// The start time asked for.
        start: f64,
        /// Distance to the next floating-point number.
        spacing: f64,
        /// Time in which a typical disk goes some tens of diameters.
        epoch: f64,
    },
    /// The boundary's domain is not a rectangle with finite sides and a finite bottom.
    #[error("the domain must have finite sides and a finite bottom; only its top may be infinite: {domain}")]
    Domain {
        /// The domain.
        domain: Domain,
    },
    /// There are more disks than the engine can number.
    #[error("{count} disks are too many: at most {most} are possible")]
    TooManyDisks {
        /// Number of disks.
        count: usize,
        /// Largest number possible.
        most: usize,
    },
    /// The boundary has more walls than the engine can number.
    #[error("{count} walls are too many: at most {most} are possible")]
    TooManyWalls {
        /// Number of walls.
        count: usize,
        /// Largest number possible.
        most: usize,
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
    /// A disk fills a hollow of a wall, up to rounding. Rounding alone would decide whether it gets into it.
    #[error(
        "disk {disk} of radius {} is just as large as the hollow of the wall {wall:?}: make one of them larger",
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
    /// The domain has no area, or its periodic sides are so close that a disk could meet its own image.
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

/// The result of the engine's inner functions. Errors are boxed, so that the usual answer comes back in
/// registers.
pub(super) type Outcome<T> = Result<T, Box<RunError>>;

/// An error: a run cannot go on.
///
/// The simulation keeps the state in which it noticed the error.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum RunError {
    /// The end is before the present, or not finite.
    #[error(
        "the run cannot end at time {}: the end must be finite and not before the present, {}",
        Readable(*.end), Readable(*.time)
    )]
    End {
        /// The end asked for.
        end: f64,
        /// The present.
        time: f64,
    },
    /// The run hardly progresses: disks come to rest, by an inelastic collapse or under gravity, and collide
    /// ever more often.
    #[error(
        "the run stalled at time {}: {events} events took it only {} further; disk {disk}{} is next to collide: \
         {remedy}; docs/rest.md compares the remedies, and Limits::with_least_progress allows less progress",
        Rounded(*.time), Rounded(*.elapsed), Named(*.partner, .wall.as_deref())
    )]
    Stalled {
        /// The present.
        time: f64,
        /// A disk that collides again and again: the next one to do so.
        disk: usize,
        /// The partner of the disk; `None` if no collision is in sight.
        partner: Option<Partner>,
        /// The name of the wall, if the partner is one.
        wall: Option<String>,
        /// Number of events with too little progress.
        events: u64,
        /// Simulated time that these events took.
        elapsed: f64,
        /// The remedy, by what the rule does in these collisions.
        remedy: Remedy,
    },
    /// A rule answered with an impulse that is not finite, or that leads to a motion beyond 1e60.
    #[error("the collision of {0}")]
    NotFinite(Box<FailedCollision>),
    /// The boundary gave an impossible answer.
    #[error("the boundary gave an impossible answer for disk {disk} at time {}: {fault}", Rounded(*.time))]
    Boundary {
        /// The disk about which the engine asked the boundary.
        disk: usize,
        /// The present.
        time: f64,
        /// The answer.
        fault: BoundaryFault,
    },
    /// The scheduler named a disk that does not exist, or a time that was not set.
    #[error(
        "the scheduler names disk {disk}, due at the offset {}, at time {}; {}",
        Readable(*.due), Rounded(*.time),
        .expected.map_or("there is no such disk".to_owned(), |due| format!("it was set to {}", Readable(due)))
    )]
    Scheduler {
        /// The disk that the scheduler named.
        disk: usize,
        /// The offset that the scheduler named.
        due: f64,
        /// The offset that was last set for this disk, if there is such a disk.
        expected: Option<f64>,
        /// The present.
        time: f64,
    },
    /// Times are too coarse to go on: time would stand still.
    #[error(
        "the run cannot go on at time {}: times there are {} apart, too coarse for disks that go some tens of diameters \
         in {}; the run is too late, or its disks have become too fast: does a rule or a wall add energy? \
         collision::laws::check and wall::laws::check try them",
        Readable(*.time), Rounded(*.spacing), Rounded(*.epoch)
    )]
    TimeTooLate {
        /// The present.
        time: f64,
        /// Distance to the next floating-point number.
        spacing: f64,
        /// Time in which a typical disk goes some tens of diameters.
        epoch: f64,
    },
    /// An observer asks for a sample at a time that is not a number, or that is not later than the last
    /// sample.
    #[error(
        "an observer asks for its next sample at time {}, which is not after the last one, at time {}",
        Readable(*.next), Readable(*.time)
    )]
    SampleTime {
        /// The time asked for.
        next: f64,
        /// The present.
        time: f64,
    },
    /// An observer failed.
    #[error("an observer failed at time {}", Rounded(*.time))]
    Observer {
        /// The present.
        time: f64,
        /// The error of the observer.
        source: ObserverError,
    },
}

/// A collision whose outcome is a motion with which the engine cannot go on.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct FailedCollision {
    /// The disk.
    pub disk: usize,
    /// The partner of the disk.
    pub partner: Partner,
    /// Name of the wall, if the partner is one.
    pub wall: Option<String>,
    /// The present.
    pub time: f64,
    /// The contact about which the engine asked the rule.
    pub contact: Contact,
    /// The impulse with which the rule answered.
    pub impulse: Impulse,
    /// The reason that the rule gives, if it gives one; see
    /// [`CollisionRule::explain`](crate::collision::CollisionRule::explain).
    pub explanation: Option<String>,
}

impl fmt::Display for FailedCollision {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { disk, time, contact, impulse, .. } = self;
        match self.partner {
            Partner::Disk(other) => write!(formatter, "disks {disk} and {other}")?,
            wall @ Partner::Wall(_) => {
                write!(formatter, "disk {disk}{}", Named(Some(wall), self.wall.as_deref()))?;
            }
        }
        write!(
            formatter,
            " at time {} leads to no finite motion: closing at {} and slipping at {}, the impulse is ({}, {})",
            Rounded(*time),
            Rounded(contact.closing_speed()),
            Rounded(contact.slip_speed()),
            Rounded(impulse.normal()),
            Rounded(impulse.tangential())
        )?;
        match &self.explanation {
            Some(explanation) => write!(formatter, "; the rule says: {explanation}"),
            None => Ok(()),
        }
    }
}

/// An impossible answer of a boundary.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[non_exhaustive]
pub enum BoundaryFault {
    /// A touch before the flight, after the end of the search, or with a wall that does not exist.
    #[error(
        "a touch with wall {wall}, of {walls} walls from 0 on, {} after the start of the flight",
        Rounded(-early_by)
    )]
    Touch {
        /// The wall that the boundary named.
        wall: usize,
        /// Number of walls of the boundary.
        walls: usize,
        /// Time from the touch to the start of the flight; negative for a touch after the start.
        early_by: f64,
    },
    /// A search for a touch that gets no further.
    #[error(
        "the search for a touch gets no further: a wall moves too fast for times as coarse as these, or its motion \
         gives numbers that are not finite; see wall::laws::check and boundary::laws::check"
    )]
    Search,
    /// A surface whose normal is not a unit vector, whose velocity is not finite or is above 1e60, or whose
    /// radius is zero or NaN.
    #[error(
        "the surface of wall {wall} has the normal ({}, {}), which must be a unit vector, and the velocity {}",
        Readable(.normal.x), Readable(.normal.y), RoundedVector(*.velocity)
    )]
    Surface {
        /// The wall.
        wall: usize,
        /// The normal of the surface.
        normal: DVec2,
        /// The velocity of the surface.
        velocity: DVec2,
    },
}
>>>>>>> ec6cf34 (Searches that use up their steps end as a horizon, never as a touch)
