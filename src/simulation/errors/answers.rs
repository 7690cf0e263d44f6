//! Impossible results of rules and boundaries, as errors describe them.

use std::fmt;

use glam::DVec2;
use thiserror::Error;

use crate::collision::{Contact, Impulse};
use crate::error::{Readable, Rounded, RoundedVector};
use crate::observable::Partner;

/// Returns the description of a disk's partner for an error.
pub(super) fn named(partner: Option<Partner>, wall: Option<&str>) -> String {
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
    /// radius is zero or NaN, or whose masses are not positive; or a thermal surface with a tangential mass.
    #[error(
        "the surface of wall {wall} needs a unit normal, a radius other than 0, positive masses, and no tangential mass if it is \
         thermal; it has the normal ({}, {}) and the velocity {}",
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
