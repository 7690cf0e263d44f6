//! Kinds of disks and walls, by which rules and observers distinguish them.

use std::fmt;

/// The kind (species, material) of a disk or a wall, as a number of your choice.
///
/// A kind changes nothing by itself: radius and mass belong to the disk. Rules find the kinds of both
/// partners in the [`Contact`](crate::collision::Contact), so steel and glass can have different friction
/// ([`RulesByKind`](crate::collision::RulesByKind)). Observers can be restricted to disks of one kind
/// ([`OfKind`](crate::observable::OfKind)). Disks have [`Kind::DEFAULT`] unless another is given, and walls
/// have [`Kind::WALL`].
///
/// ```
/// use granular_edmd::glam::DVec2;
/// use granular_edmd::{Disk, Kind};
///
/// const STEEL: Kind = Kind::new(1);
/// let ball = Disk::new(DVec2::ZERO, 0.5)?.with_kind(STEEL);
/// assert_eq!(ball.kind(), STEEL);
/// assert_eq!((STEEL.to_string(), Kind::WALL.to_string()), ("1".to_owned(), "wall".to_owned()));
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(transparent))]
pub struct Kind(u16);

impl Kind {
    /// The default kind of disks: number 0.
    pub const DEFAULT: Self = Self(0);

    /// The default kind of walls: number 65535.
    pub const WALL: Self = Self(u16::MAX);

    /// Creates the kind with this number.
    pub const fn new(number: u16) -> Self {
        Self(number)
    }

    /// Returns the number.
    pub const fn number(self) -> u16 {
        self.0
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        if *self == Self::WALL { formatter.write_str("wall") } else { self.0.fmt(formatter) }
    }
}
