//! What the engine does next with a disk, and what it has done so far.

/// What [`Simulation::step`](super::Simulation::step) did.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Event {
    /// Two disks collided.
    Collision {
        /// The disk whose event it was.
        disk: usize,
        /// Its partner.
        partner: usize,
    },
    /// A disk collided with a wall.
    WallCollision {
        /// The disk.
        disk: usize,
        /// The wall, an index into [`Boundary::wall_name`](crate::boundary::Boundary::wall_name).
        wall: usize,
    },
    /// A disk passed from one neighbour cell to another: no physics.
    CellCrossing {
        /// The disk.
        disk: usize,
    },
    /// A disk's partner had collided with another meanwhile, and the disk's next collision was predicted anew; or all events were,
    /// for neighbour cells of another size. No physics.
    Repredicted {
        /// The disk.
        disk: usize,
    },
}

/// What happened since the simulation was built.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct Counters {
    /// Collisions of two disks.
    pub collisions: u64,
    /// Collisions of a disk with a wall.
    pub wall_collisions: u64,
    /// Collisions, with disks or walls, that a contact-duration model made elastic.
    pub contact_duration_collisions: u64,
    /// Passages from one neighbour cell to another.
    pub cell_crossings: u64,
    /// Predictions that were out of date when they came up.
    pub repredictions: u64,
    /// Largest overlap of two disks at a collision: rounding, unless something is wrong.
    pub max_overlap: f64,
}

/// More events than any run has.
#[cfg(feature = "serde")]
pub(super) const MOST_COUNTED: u64 = 1 << 60;

#[cfg(feature = "serde")]
impl Counters {
    /// Whether a run can have come to this, and can go on counting.
    pub(super) fn are_valid(&self) -> bool {
        let Self { collisions, wall_collisions, contact_duration_collisions, .. } = *self;
        let counts = [collisions, wall_collisions, contact_duration_collisions];
        counts.iter().chain([&self.cell_crossings, &self.repredictions]).all(|&count| count <= MOST_COUNTED)
            && self.max_overlap >= 0.0
    }
}

/// The earliest collision of a disk that is known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Earliest {
    pub(super) due: f64,
    pub(super) partner: u32,
}

impl Earliest {
    pub(super) const NONE: Self = Self { due: f64::INFINITY, partner: u32::MAX };
}

/// How a disk's flight in its cell ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) enum Exit {
    Left,
    Right,
    Down,
    Up,
    /// It does not end yet: the search for a wall looked only so far ahead.
    Stay,
    Wall,
}

impl Exit {
    /// The edges by whether they are crossed vertically, and whether to the right or upward.
    pub(super) const EDGES: [[Self; 2]; 2] = [[Self::Left, Self::Right], [Self::Down, Self::Up]];

    /// Columns to the right and rows up; computed, since a branch on it would be a toss of a coin with four sides.
    #[inline]
    pub(super) fn direction(self) -> (i32, i32) {
        let right = i32::from(self == Self::Right) - i32::from(self == Self::Left);
        let up = i32::from(self == Self::Up) - i32::from(self == Self::Down);
        (right, up)
    }
}

/// The next event of a disk: with the earliest partner known, or the end of its flight in its cell.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Slot {
    /// When it collides with `partner`, if neither collides before.
    pub(super) collision_due: f64,
    /// When its flight in its cell ends.
    pub(super) exit_due: f64,
    pub(super) partner: u32,
    /// The partner's count when this was predicted: if it differs, the prediction is out of date.
    pub(super) partner_collisions: u32,
    /// The disk's own count of collisions with anything.
    pub(super) collisions: u32,
    pub(super) exit: Exit,
    /// The wall, if the flight ends there.
    pub(super) wall: u16,
}

impl Slot {
    pub(super) const NEW: Self = Self {
        collision_due: f64::INFINITY,
        exit_due: f64::INFINITY,
        partner: u32::MAX,
        partner_collisions: 0,
        collisions: 0,
        exit: Exit::Stay,
        wall: 0,
    };

    /// The next collision is this one, with a partner that has collided so often.
    #[inline]
    pub(super) fn meet(&mut self, earliest: Earliest, partner_collisions: u32) {
        self.collision_due = earliest.due;
        self.partner = earliest.partner;
        self.partner_collisions = partner_collisions;
    }

    /// The epoch has moved.
    pub(super) fn shift(&mut self, by: f64) {
        self.collision_due -= by;
        self.exit_due -= by;
    }

    #[inline]
    pub(super) fn due(&self) -> f64 {
        if self.collision_due <= self.exit_due { self.collision_due } else { self.exit_due }
    }
}
