//! Names of a container's walls, and errors of walls and parts.

use std::fmt;

use thiserror::Error;

use crate::error::Rounded;
use crate::{ParameterError, Violation};

/// A wall of a [`Container`](super::Container).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Wall {
    /// The floor.
    Floor,
    /// The lid.
    Lid,
    /// The left side.
    Left,
    /// The right side.
    Right,
}

impl Wall {
    /// Returns the name of the wall: "floor", "lid", "left" or "right".
    pub const fn name(self) -> &'static str {
        match self {
            Self::Floor => "floor",
            Self::Lid => "lid",
            Self::Left => "left",
            Self::Right => "right",
        }
    }
}

impl fmt::Display for Wall {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.name())
    }
}

/// The error of a wall or a part that cannot be built or changed.
///
/// ```
/// use granular_edmd::boundary::{Container, Wall};
/// use granular_edmd::wall::Fixed;
/// let mut container = Container::open(20.0)?;
/// let error = container.remove_part("gate").unwrap_err();
/// assert_eq!(error.to_string(), "the container has no part \"gate\"; it has none");
/// let error = container.with_motion(Wall::Lid, Fixed).unwrap_err();
/// assert_eq!(error.to_string(), "the container has no wall \"lid\"");
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum WallError {
    /// A parameter is out of range.
    #[error(transparent)]
    Parameter(#[from] ParameterError),
    /// Two neighboring points of a polygon are equal. The first point has the number 0.
    #[error("the points {first} and {second} of the polygon are equal")]
    EqualPoints {
        /// Number of a point.
        first: usize,
        /// Number of the next point.
        second: usize,
    },
    /// A polygon has no area, so it has no inside.
    #[error("the polygon has no area: its points are on one line, or it crosses itself")]
    NoArea,
    /// A polygon crosses or touches itself, so its inside is not defined. Side 0 begins at the first point.
    #[error(
        "the polygon crosses or touches itself: its side from point {first} to the next one meets its side from point \
         {second} to the next one, counted from 0; are the points in order around it?"
    )]
    Crossing {
        /// Number of a side.
        first: usize,
        /// Number of another side.
        second: usize,
    },
    /// The container has no such wall, because it is open above or periodic there.
    #[error("the container has no wall \"{wall}\"")]
    Missing {
        /// The requested wall.
        wall: Wall,
    },
    /// The settings of the wall would be lost, because the wall would be removed or would move differently.
    #[error("the wall \"{wall}\" has settings that would be lost: leave out the earlier setting or this one")]
    Lost {
        /// The wall with the settings.
        wall: Wall,
    },
    /// The motion gives numbers that would break every run.
    #[error("the motion of the wall cannot be used: {violation}")]
    Motion {
        /// The violation of the contract of motions.
        violation: Violation,
    },
    /// The motion jumps back, and disks can be where it jumps.
    #[error("the motion jumps back at times, and would jump into disks")]
    Jump,
    /// The container has no part of this name.
    #[error("the container has no part \"{name}\"; {}", listed(.parts))]
    Unknown {
        /// The name.
        name: String,
        /// The names of the container's parts.
        parts: Vec<String>,
    },
    /// The container has a part or a wall of this name already.
    #[error("the name \"{name}\" already belongs to a part or a wall of the container")]
    Duplicate {
        /// The name.
        name: String,
    },
    /// A part extends over too many periods of the container.
    #[error(
        "the part \"{name}\" extends over {} periods of the container, but at most {most} are possible: \
         let it end earlier",
        Rounded(*.periods)
    )]
    TooManyPeriods {
        /// The name.
        name: String,
        /// Number of periods.
        periods: f64,
        /// Largest number.
        most: f64,
    },
    /// Disks could push a part with a mass by friction along the direction in which it slides.
    #[error(
        "disks would rub the part \"{name}\", which has a mass, along its direction: give it a rule without friction, or \
         only straight sides across its direction that end at the edge of the domain or beyond"
    )]
    Guide {
        /// The name.
        name: String,
    },
}

/// Largest number of names of parts that an error lists.
const LISTED: usize = 8;

/// Returns a sentence that lists the parts of a container.
fn listed(parts: &[String]) -> String {
    let names: Vec<String> = parts.iter().take(LISTED).map(|name| format!("\"{name}\"")).collect();
    match parts.len() {
        0 => "it has none".to_owned(),
        count if count > LISTED => format!("its {count} parts are {}, …", names.join(", ")),
        _ => format!("its parts are {}", names.join(", ")),
    }
}
