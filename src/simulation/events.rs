//! Events that a run is made of, as its caller sees them.

/// A collision that [`Simulation::step_until`](crate::Simulation::step_until) did.
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
        /// The wall, below [`Boundary::wall_count`](crate::boundary::Boundary::wall_count).
        wall: usize,
    },
}

/// The cause that ended a run without an error.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum RunEnd {
    /// The run came to the end time.
    Time,
    /// An observer stopped it: [`Observer::verdict`](crate::observable::Observer::verdict). It can go on from there, with the
    /// same bits.
    Observer,
}

/// Numbers of events since the simulation was built.
///
/// The engine does five kinds of events: the two kinds of collisions are physics and are told to observers; passages, out-of-date
/// predictions and horizons are bookkeeping that nobody but these counts sees.
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
    /// Passages of a disk from one neighbor cell to another.
    pub cell_crossings: u64,
    /// Predicted collisions whose partner had collided with another disk when they came up; they were predicted anew.
    pub repredictions: u64,
    /// Searches for a wall that found none so far ahead, and were taken up again.
    pub horizons: u64,
    /// Changes of the size of the neighbor cells; all events are predicted anew then.
    pub cell_resizes: u64,
    /// Largest overlap of two disks at a collision: rounding, unless something is wrong.
    pub max_overlap: f64,
    /// Largest overlap of a disk and a wall at a collision: rounding, unless something is wrong.
    pub max_wall_overlap: f64,
}

impl Counters {
    /// Counts since `earlier`; the largest overlaps are those of the whole run.
    #[must_use]
    pub const fn since(&self, earlier: &Self) -> Self {
        Self {
            collisions: self.collisions.saturating_sub(earlier.collisions),
            wall_collisions: self.wall_collisions.saturating_sub(earlier.wall_collisions),
            contact_duration_collisions: self
                .contact_duration_collisions
                .saturating_sub(earlier.contact_duration_collisions),
            cell_crossings: self.cell_crossings.saturating_sub(earlier.cell_crossings),
            repredictions: self.repredictions.saturating_sub(earlier.repredictions),
            horizons: self.horizons.saturating_sub(earlier.horizons),
            cell_resizes: self.cell_resizes.saturating_sub(earlier.cell_resizes),
            max_overlap: self.max_overlap,
            max_wall_overlap: self.max_wall_overlap,
        }
    }

    /// Number of all events.
    pub const fn events(&self) -> u64 {
        self.collisions + self.wall_collisions + self.cell_crossings + self.repredictions + self.horizons
    }
}
