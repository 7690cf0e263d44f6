//! The events of a run, as its caller sees them.

/// A collision, as [`Simulation::step_until`](crate::Simulation::step_until) returns it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Event {
    /// Two disks collided.
    Collision {
        /// The disk whose event it was.
        disk: usize,
        /// The partner of the disk.
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

/// The reason why a run ended without an error.
///
/// The run can continue from there, with the same bits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum RunEnd {
    /// The run came to the end time.
    Time,
    /// An observer stopped the run; see [`Observer::verdict`](crate::observable::Observer::verdict).
    Observer,
    /// The run reached its largest number of collisions; see
    /// [`Limits::with_most_collisions`](super::Limits::with_most_collisions).
    Collisions,
    /// The run reached its largest wall-clock time; see
    /// [`Limits::with_wall_clock`](super::Limits::with_wall_clock).
    WallClock,
    /// The flag that interrupts the run was set; see
    /// [`Limits::with_interrupt`](super::Limits::with_interrupt).
    Interrupted,
}

/// The numbers of events since the simulation was built.
///
/// The engine handles five kinds of events. The two kinds of collisions are physics, and observers see them.
/// Cell crossings, outdated predictions and horizons are bookkeeping, and only these counts show them.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct Counters {
    /// Collisions of two disks.
    pub disk_collisions: u64,
    /// Collisions of a disk with a wall.
    pub wall_collisions: u64,
    /// Collisions, with disks or walls, that a contact-duration model made elastic.
    pub contact_duration_collisions: u64,
    /// Of all collisions that a contact-duration model made elastic, the longest time since a partner's
    /// previous collision. It is just below the model's duration.
    pub longest_contact: f64,
    /// Collisions whose surfaces parted at the least speed of
    /// [`LeastRebound`](crate::collision::LeastRebound).
    pub least_rebound_collisions: u64,
    /// Sum of the energies gained in those of these collisions that gained energy, friction included.
    pub energy_of_rebounds: f64,
    /// Passages of disks from one neighbor cell to another.
    pub cell_crossings: u64,
    /// Predicted collisions that were out of date when they were due, since the partner had had another
    /// collision. The engine predicted them anew.
    pub repredictions: u64,
    /// Searches for a wall that found no touch up to their horizon, and were continued from there.
    pub horizons: u64,
    /// Changes of the size of the neighbor cells. Each change predicts all events anew.
    pub cell_resizes: u64,
    /// Largest overlap of two disks at a collision. An overlap larger than rounding ends the run.
    pub max_overlap: f64,
    /// Largest overlap of a disk and a wall at a collision. An overlap larger than rounding ends the run.
    pub max_wall_overlap: f64,
    /// Disks that sinks removed.
    pub removals: u64,
    /// Disks that inlets added.
    pub insertions: u64,
}

impl Counters {
    /// Returns the counts since `earlier`.
    ///
    /// The largest overlaps and the longest contact cover the whole run.
    #[must_use]
    pub fn since(&self, earlier: &Self) -> Self {
        let since = |count: fn(&Self) -> u64| count(self).saturating_sub(count(earlier));
        Self {
            disk_collisions: since(|counters| counters.disk_collisions),
            wall_collisions: since(|counters| counters.wall_collisions),
            contact_duration_collisions: since(|counters| counters.contact_duration_collisions),
            least_rebound_collisions: since(|counters| counters.least_rebound_collisions),
            energy_of_rebounds: self.energy_of_rebounds - earlier.energy_of_rebounds,
            cell_crossings: since(|counters| counters.cell_crossings),
            repredictions: since(|counters| counters.repredictions),
            horizons: since(|counters| counters.horizons),
            cell_resizes: since(|counters| counters.cell_resizes),
            removals: since(|counters| counters.removals),
            insertions: since(|counters| counters.insertions),
            ..*self
        }
    }

    /// Returns the number of collisions, with disks or walls.
    pub const fn collisions(&self) -> u64 {
        self.disk_collisions + self.wall_collisions
    }

    /// Returns the number of all events.
    pub const fn events(&self) -> u64 {
        self.collisions() + self.cell_crossings + self.repredictions + self.horizons
    }
}
