//! Names of a container's walls, and errors about walls.

use std::fmt;

use thiserror::Error;

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

/// The error of a change that a wall does not allow.
///
/// ```
/// use granular_edmd::boundary::{Container, Wall};
/// use granular_edmd::wall::Fixed;
/// let error = Container::open(20.0)?.with_motion(Wall::Lid, Fixed).unwrap_err();
/// assert_eq!(error.to_string(), "the container has no wall \"lid\"");
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum WallError {
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
    #[error("the motion of the wall \"{wall}\" cannot be used: {violation}")]
    Motion {
        /// The wall.
        wall: Wall,
        /// The violation of the contract of motions.
        violation: Violation,
    },
    /// The motion jumps back, and the wall on the other side would jump into the disks.
    #[error("the motion jumps back at times, and would move the wall \"{wall}\" into disks")]
    Jump {
        /// The wall that would jump.
        wall: Wall,
    },
    /// The surface speed is not finite.
    #[error(transparent)]
    Parameter(#[from] ParameterError),
}
