//! Names of a container's walls.

use std::fmt;

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
