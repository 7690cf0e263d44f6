//! The errors of a run.

use thiserror::Error;

use super::answers::{BoundaryFault, FailedCollision, named};
use super::remedy::Remedy;
use crate::ParameterError;
use crate::error::{Readable, Rounded};
use crate::observable::{ObserverError, Partner};
use crate::simulation::BuildError;

/// The result of the engine's inner functions. Errors are boxed, so that the usual result is returned in
/// registers.
pub(in crate::simulation) type Outcome<T> = Result<T, Box<RunError>>;

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
