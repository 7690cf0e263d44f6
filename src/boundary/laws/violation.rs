//! Ways in which a boundary breaks its contract.

use glam::DVec2;
use thiserror::Error;

use crate::Flight;
use crate::boundary::{Domain, Region};

/// A way in which a boundary breaks its contract.
///
/// Times are offsets from the time origin.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum Violation {
    /// The domain is not a rectangle with finite sides and a finite bottom; its top may be infinite.
    #[error("the domain {domain} is not a rectangle with finite sides and a finite bottom")]
    Domain {
        /// The domain.
        domain: Domain,
    },
    /// The interior is not inside the domain.
    #[error("the interior {interior} is not inside the domain {domain}")]
    Interior {
        /// The interior.
        interior: Domain,
        /// The domain.
        domain: Domain,
    },
    /// The domain changes.
    #[error("the domain was {before} and is now {now}")]
    DomainChanged {
        /// The domain at first.
        before: Domain,
        /// The domain now.
        now: Domain,
    },
    /// The number of walls changes.
    #[error("the boundary had {before} walls and now has {now}")]
    WallsChanged {
        /// The number at first.
        before: usize,
        /// The number now.
        now: usize,
    },
    /// The check found no free place for a disk.
    #[error("no place was found where a disk of radius {radius:?} overlaps no wall at time {time:?}")]
    NoRoom {
        /// The radius.
        radius: f64,
        /// The time.
        time: f64,
    },
    /// A disk gets into a wall without a touch.
    #[error("a disk is {depth:?} deep in wall {wall} at {time:?}, before a touch at {found:?}: {flight:?}")]
    LetThrough {
        /// The wall.
        wall: usize,
        /// Depth of the overlap.
        depth: f64,
        /// Time of the overlap.
        time: f64,
        /// Time of the touch that was found, if there was one.
        found: Option<f64>,
        /// The flight.
        flight: Flight,
    },
    /// A disk leaves the domain without a touch.
    #[error("a disk leaves the domain without a touch: at time {time:?} it is at {place:?}, on {flight:?}")]
    LeftDomain {
        /// Center of the disk.
        place: DVec2,
        /// The time.
        time: f64,
        /// The flight.
        flight: Flight,
    },
    /// A touch is before the flight, after its limit, or not a number.
    #[error("a touch at time {time:?} is outside the flight, which ends at {until:?}: {flight:?}")]
    TouchTime {
        /// Time of the touch.
        time: f64,
        /// Limit of the search.
        until: f64,
        /// The flight.
        flight: Flight,
    },
    /// A search for a touch gets no further.
    #[error("the search for a touch gets no further than time {time:?}, on {flight:?}")]
    NoProgress {
        /// The time.
        time: f64,
        /// The flight.
        flight: Flight,
    },
    /// A touch is with a wall that does not exist.
    #[error("a touch names wall {wall}, but there are {count} walls, on {flight:?}")]
    TouchWall {
        /// Index of the wall.
        wall: usize,
        /// Number of walls.
        count: usize,
        /// The flight.
        flight: Flight,
    },
    /// A touch is found where the gap is still open.
    #[error("wall {wall} is touched at time {time:?} where the gap is still open, on {flight:?}")]
    EarlyTouch {
        /// The wall.
        wall: usize,
        /// Time of the touch.
        time: f64,
        /// The flight.
        flight: Flight,
    },
    /// A touch is found while the disk leaves the wall.
    #[error("wall {wall} is touched at time {time:?} while the disk leaves at speed {rate:?}, on {flight:?}")]
    Leaving {
        /// The wall.
        wall: usize,
        /// Speed at which the gap opens.
        rate: f64,
        /// Time of the touch.
        time: f64,
        /// The flight.
        flight: Flight,
    },
    /// A disk touches a wall and approaches it, but the touch is not found.
    #[error("wall {wall} is touched and approached, but no touch is found at once, on {flight:?}")]
    Missed {
        /// The wall.
        wall: usize,
        /// A flight that begins at the touch.
        flight: Flight,
    },
    /// A normal is not a unit vector.
    #[error("at time {time:?}, the normal {normal:?} of wall {wall} at {place:?} is not a unit vector")]
    NormalLength {
        /// The wall.
        wall: usize,
        /// The normal.
        normal: DVec2,
        /// Center of the disk.
        place: DVec2,
        /// The time.
        time: f64,
    },
    /// A disk that is moved along the normal does not come out of the wall.
    #[error("at time {time:?}, the normal {normal:?} does not lead out of wall {wall} at {place:?}")]
    NormalDirection {
        /// The wall.
        wall: usize,
        /// The normal.
        normal: DVec2,
        /// Center of the disk.
        place: DVec2,
        /// The time.
        time: f64,
    },
    /// The velocity of a wall is not finite.
    #[error("the velocity {velocity:?} of wall {wall} is not finite, at time {time:?}")]
    Velocity {
        /// The wall.
        wall: usize,
        /// The velocity.
        velocity: DVec2,
        /// The time.
        time: f64,
    },
    /// `may_touch` is false for a region in which there is a touch.
    #[error("a disk of radius {radius:?} touches at {place:?}, but `may_touch` denies it for {region:?}")]
    MayTouch {
        /// The region.
        region: Region,
        /// Radius of the disk.
        radius: f64,
        /// Center of the disk at the touch.
        place: DVec2,
    },
    /// The same flight, given relative to another time origin, touches at another time.
    #[error("a time origin {shift:?} before {origin:?} moves a touch at {before:?} to {after:?}: {flight:?}")]
    TimeOrigin {
        /// The time origin.
        origin: f64,
        /// Time by which the other origin is earlier.
        shift: f64,
        /// Time of the touch relative to the one origin.
        before: Option<f64>,
        /// Time of the touch found with the other origin, as an offset from the first.
        after: Option<f64>,
        /// The flight.
        flight: Flight,
    },
}
