//! The next event of each disk.

/// The earliest known collision of a disk.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::simulation) struct Earliest {
    pub(in crate::simulation) due: f64,
    pub(in crate::simulation) partner: u32,
}

impl Earliest {
    pub(in crate::simulation) const NONE: Self = Self { due: f64::INFINITY, partner: u32::MAX };
}

/// The end of a disk's flight in its cell: an edge, a wall or a horizon.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(in crate::simulation) enum Exit {
    Left,
    Right,
    Down,
    Up,
    /// No end yet: the search for a wall found no touch up to its horizon.
    Horizon,
    Wall,
    /// The boundary returned an impossible touch. The run ends when this event is due.
    Impossible,
}

impl Exit {
    /// The edges by axis (sideways, vertical) and sense (negative, positive).
    pub(in crate::simulation) const EDGES: [[Self; 2]; 2] =
        [[Self::Left, Self::Right], [Self::Down, Self::Up]];

    /// Returns the step to the neighbor cell: columns to the right, and rows up. The numbers are computed,
    /// since a branch would be a coin toss between four ways.
    #[inline]
    pub(in crate::simulation) fn direction(self) -> (i32, i32) {
        let right = i32::from(self == Self::Right) - i32::from(self == Self::Left);
        let up = i32::from(self == Self::Up) - i32::from(self == Self::Down);
        (right, up)
    }

    /// Returns whether the flight continues in a neighbor cell.
    #[inline]
    pub(in crate::simulation) fn is_passage(self) -> bool {
        matches!(self, Self::Left | Self::Right | Self::Down | Self::Up)
    }
}

/// The next event of a disk: a collision with the earliest partner known, or the end of its flight in its
/// cell.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(in crate::simulation) struct Forecast {
    /// The offset at which the disk collides with `partner`, if neither collides before.
    pub(in crate::simulation) collision_due: f64,
    /// The offset at which the flight of the disk in its cell ends.
    pub(in crate::simulation) exit_due: f64,
    pub(in crate::simulation) partner: u32,
    /// The partner's count of collisions when this collision was predicted. If the count differs now, the
    /// prediction is out of date.
    pub(in crate::simulation) partner_collisions: u32,
    /// The disk's own count of collisions with anything.
    pub(in crate::simulation) collisions: u32,
    pub(in crate::simulation) exit: Exit,
    /// The wall, if the flight ends at one.
    pub(in crate::simulation) wall: u16,
}

impl Forecast {
    pub(in crate::simulation) const NEW: Self = Self {
        collision_due: f64::INFINITY,
        exit_due: f64::INFINITY,
        partner: u32::MAX,
        partner_collisions: 0,
        collisions: 0,
        exit: Exit::Horizon,
        wall: 0,
    };

    /// Returns whether the collision comes first. At equal times, the collision wins, since disks come before
    /// walls and cells.
    #[inline]
    pub(in crate::simulation) fn is_collision(&self) -> bool {
        self.collision_due <= self.exit_due
    }

    /// Returns the offset of the next event.
    #[inline]
    pub(in crate::simulation) fn due(&self) -> f64 {
        if self.is_collision() { self.collision_due } else { self.exit_due }
    }

    /// Sets the next collision, together with the partner's present count of collisions.
    #[inline]
    pub(in crate::simulation) fn set_collision(&mut self, earliest: Earliest, partner_collisions: u32) {
        self.collision_due = earliest.due;
        self.partner = earliest.partner;
        self.partner_collisions = partner_collisions;
    }

    /// Counts a collision of the disk itself, which makes all predictions with the disk out of date.
    #[inline]
    pub(in crate::simulation) fn count_collision(&mut self) {
        self.collisions = self.collisions.wrapping_add(1);
    }

    /// Converts all offsets to an epoch that is later by this time.
    pub(in crate::simulation) fn shift(&mut self, by: f64) {
        self.collision_due -= by;
        self.exit_due -= by;
    }
}
