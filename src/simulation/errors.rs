//! Errors of building and running a simulation.

mod build;

use std::fmt;

use glam::DVec2;
use thiserror::Error;

use crate::ParameterError;
use crate::collision::{Contact, Impulse};
use crate::error::{Readable, Rounded, RoundedVector};
use crate::observable::{ObserverError, Partner};
pub use build::BuildError;

/// The result of the engine's inner functions. Errors are boxed, so that the usual result is returned in
/// registers.
pub(super) type Outcome<T> = Result<T, Box<RunError>>;

/// The error of a run that cannot continue.
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
        /// The requested end.
        end: f64,
        /// The present.
        time: f64,
    },
    /// The run hardly progresses: disks come to rest, by an inelastic collapse or under gravity, and collide
    /// ever more often.
    #[error(
        "the run stalled at time {}: it advanced by only {} in {events} events; disk {disk}{} is next to collide: \
         {remedy}; docs/rest.md compares the remedies, and Limits::with_least_progress allows less progress",
        Rounded(*.time), Rounded(*.elapsed), named(*.partner, .wall.as_deref())
    )]
    Stalled {
        /// The present.
        time: f64,
        /// The disk that is next to collide.
        disk: usize,
        /// The partner of the disk; `None` if no collision is predicted.
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
    /// A rule returned an impulse that is not finite, or that leads to a motion beyond 1e60.
    #[error("the collision of {0}")]
    NotFinite(Box<FailedCollision>),
    /// The boundary returned an impossible result.
    #[error("the boundary gave an impossible answer for disk {disk} at time {}: {fault}", Rounded(*.time))]
    Boundary {
        /// The disk for which the engine called the boundary.
        disk: usize,
        /// The present.
        time: f64,
        /// The impossible result.
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
        /// The offset that was last set for this disk, or `None` if there is no such disk.
        expected: Option<f64>,
        /// The present.
        time: f64,
    },
    /// The scheduler has lost an event: it named only later events.
    #[error(
        "the scheduler did not name disk {disk}, due at time {}, and the run is at time {}: it lost a time that was \
         set; scheduler::laws::check tries schedulers",
        Rounded(*.due), Rounded(*.time)
    )]
    Overdue {
        /// The disk.
        disk: usize,
        /// The time at which the next event of the disk was due.
        due: f64,
        /// The present.
        time: f64,
    },
    /// A collision away from the surfaces: a disk reaches into its partner by more than rounding, or a wall
    /// is not where its touch was predicted.
    #[error(
        "disk {disk} collides{} at time {} where {}; {}",
        named(Some(*.partner), .wall.as_deref()), Rounded(*.time), misplaced(*.depth), laws_of(*.partner)
    )]
    FalseContact {
        /// The disk.
        disk: usize,
        /// The partner of the disk.
        partner: Partner,
        /// The name of the wall, if the partner is one.
        wall: Option<String>,
        /// Depth to which the disk reaches into its partner. If it is negative, it is a gap: the distance
        /// from the nearest wall, infinite if there is none.
        depth: f64,
        /// The present.
        time: f64,
    },
    /// Times are too coarse for the run to continue: time would stand still.
    #[error(
        "the run cannot go on at time {}: times there are {} apart, too coarse for disks that move tens of diameters \
         in {}; the run is too late, or its disks have become too fast: does a rule or a wall add energy? \
         collision::laws::check and wall::laws::check try them",
        Readable(*.time), Rounded(*.spacing), Rounded(*.epoch)
    )]
    TimeTooLate {
        /// The present.
        time: f64,
        /// Distance to the next floating-point number.
        spacing: f64,
        /// Time in which a typical disk moves tens of diameters.
        epoch: f64,
    },
    /// An observer asks for a sample at a time that is not a number, or that is not later than the last
    /// sample.
    #[error(
        "an observer asks for its next sample at time {}, which is not after the last one, at time {}; \
         its interval may be lost in the rounding of such times",
        Readable(*.next), Readable(*.time)
    )]
    SampleTime {
        /// The requested time.
        next: f64,
        /// The present.
        time: f64,
    },
    /// A kick of a driving failed: it gives an impossible motion, or its time is too late for floating-point
    /// numbers to resolve.
    #[error("a kick failed at time {}", Rounded(*.time))]
    Driving {
        /// The present.
        time: f64,
        /// The cause.
        source: Box<BuildError>,
    },
    /// An inlet cannot continue: its next opening is too late for floating-point numbers to resolve, or there
    /// are no ids left.
    #[error("an inlet failed at time {}", Rounded(*.time))]
    Inlet {
        /// The present.
        time: f64,
        /// The cause.
        source: ParameterError,
    },
    /// A rule, a boundary, a scheduler or an observer panicked in an earlier run, in the midst of an event.
    #[error(
        "a part of the simulation panicked in the midst of an event at time {}, so the next events are not known; \
         resume the run from an earlier checkpoint", Rounded(*.time)
    )]
    Torn {
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

/// Returns the location of a false contact, as its error describes it.
fn misplaced(depth: f64) -> String {
    match depth {
        depth if depth > 0.0 => format!("it reaches {} into it", Rounded(depth)),
        f64::NEG_INFINITY => "there is no wall: does `overlap` know this one?".to_owned(),
        gap => format!("the nearest wall is {} away", Rounded(-gap)),
    }
}

/// Returns the checks that find the faulty part behind a false contact.
fn laws_of(partner: Partner) -> &'static str {
    match partner {
        Partner::Wall(_) => "wall::laws::check tries motions, and boundary::laws::check tries boundaries",
        Partner::Disk(_) => "scheduler::laws::check tries schedulers, and collision::laws::check tries rules",
    }
}

/// Returns the description of a disk's partner for an error.
fn named(partner: Option<Partner>, wall: Option<&str>) -> String {
    match (partner, wall) {
        (Some(Partner::Disk(other)), _) => format!(" with disk {other}"),
        (Some(Partner::Wall(_)), Some(name)) => format!(" with the wall {name:?}"),
        (Some(Partner::Wall(wall)), None) => format!(" with wall {wall}"),
        (None, _) => String::new(),
    }
}

/// A collision after which a motion is outside the engine's bounds.
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
    /// The contact that the engine passed to the rule.
    pub contact: Contact,
    /// The impulse that the rule returned.
    pub impulse: Impulse,
}

impl fmt::Display for FailedCollision {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { disk, time, contact, impulse, .. } = self;
        match self.partner {
            Partner::Disk(other) => write!(formatter, "disks {disk} and {other}")?,
            wall @ Partner::Wall(_) => {
                write!(formatter, "disk {disk}{}", named(Some(wall), self.wall.as_deref()))?;
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
        )
    }
}

/// An impossible result of a boundary.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[non_exhaustive]
pub enum BoundaryFault {
    /// A search for a touch that makes no progress.
    #[error(
        "the search for a touch gets no further: a wall moves too fast for times as coarse as these, or its motion \
         gives numbers that are not finite; see wall::laws::check and boundary::laws::check"
    )]
    Search,
    /// A touch before the flight, after the end of the search, or with a wall that does not exist.
    #[error(
        "a touch with wall {wall} {} after the start of the flight; there are {walls} walls, counted from 0",
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
    /// A surface whose normal is not a unit vector, whose velocity is not finite or is above 1e60, whose
    /// radius is zero or NaN, or whose mass is not positive.
    #[error(
        "the surface of wall {wall} needs a unit normal, a radius other than 0, and a positive mass; it has the normal ({}, {}) and the velocity {}",
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
    /// A wall with a mass that did not take the impulse of a disk, or moved without
    /// [`Reaction::Moved`](crate::boundary::Reaction::Moved).
    #[error(
        "wall {wall} has a mass; after the impulse of the disk, its velocity should be {} and is {}; `react` must apply \
         the impulse and answer `Reaction::Moved`, or the surface have no mass: see boundary::laws::check",
        RoundedVector(*.expected), RoundedVector(*.found)
    )]
    Reaction {
        /// The wall.
        wall: usize,
        /// The velocity that the impulse and the masses give.
        expected: DVec2,
        /// The velocity of the surface after the reaction.
        found: DVec2,
    },
    /// A disk outside the domain: the boundary missed its touch with a wall.
    #[error("no touch, but the disk is at ({}, {}), outside the domain; see boundary::laws::check", Rounded(*.x), Rounded(*.y))]
    Outside {
        /// Horizontal position of the disk's center.
        x: f64,
        /// Vertical position of the disk's center.
        y: f64,
    },
}

/// The remedy for a run that stalled, which depends on what the rule does in collisions as slow as the last
/// ones.
///
/// The page `docs/rest.md` of the repository compares the remedies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Remedy {
    /// Slow collisions lose energy, so disks that come to rest collide ever more often. The remedy is to make
    /// slow collisions, or collisions in quick succession, elastic, or to set a least speed at which surfaces
    /// part.
    ElasticWhenSlow,
    /// The contact-duration model is at work, with a duration so short that disks at rest collide too often.
    LongerContactDuration,
    /// Slow collisions already lose no energy, yet the run stalls: a disk is at rest or squeezed, so that its
    /// collisions are too slow, or walls keep driving it.
    FasterDisks,
    /// The rule leaves disks approaching each other.
    PushApart,
    /// The surface of the wall has another velocity than the wall's geometry, so that disks are hit again
    /// immediately.
    WallVelocity,
    /// The wall has a mass and rests on a stop, which absorbs what the disk gives the wall, so the disk loses
    /// energy under any rule ([`Piston`](crate::wall::Piston)).
    WallOnStop,
    /// The rule gains energy, so disks become ever faster.
    EnergyGain,
    /// The run advances, but more slowly than
    /// [`Limits::with_least_progress`](crate::simulation::Limits::with_least_progress) asks.
    LessProgress,
    /// No collision is predicted: the boundary or the scheduler names events that do not advance the run.
    OtherParts,
}

impl fmt::Display for Remedy {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::ElasticWhenSlow => {
                "matter that comes to rest, an inelastic collapse, or disks that walls squeeze; remedies are a contact \
                 duration (the rule ContactDuration), the rules LeastRebound and ElasticBelow, or more room"
            }
            Self::LongerContactDuration => {
                "matter at rest under a short contact duration; a longer one helps, or the rule LeastRebound"
            }
            Self::FasterDisks => {
                "a disk at rest or squeezed, whose collisions lose nothing but are too slow; a faster start, more room, or \
                 the rule LeastRebound with a higher speed helps; a disk that walls drive needs a rule that loses \
                 energy; for custom walls see boundary::laws::check"
            }
            Self::PushApart => "the rule does not push the disks apart; see collision::laws::check",
            Self::WallVelocity => {
                "the wall does not move at the velocity of its surface; boundary::laws::check compares the two"
            }
            Self::WallOnStop => {
                "the wall rests on a stop, which absorbs the impulse of each disk: a disk of mass m leaves a wall of mass M \
                 with (M - m)/(M + m) of its speed, even under Elastic; a wall without a mass, a heavier one, or one \
                 that its force does not press against the stop helps"
            }
            Self::EnergyGain => "the rule gains energy, so disks become ever faster; see collision::laws::check",
            Self::LessProgress => "time advances, but the least progress that was asked for is larger",
            Self::OtherParts => "no collision is in sight; does the boundary or the scheduler advance?",
        })
    }
}
