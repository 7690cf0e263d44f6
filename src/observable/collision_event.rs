//! Collisions, as an observer sees them.

use glam::DVec2;

use crate::collision::{Contact, Impulse};

/// The partner of a disk in a collision.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Partner {
    /// Another disk, by its index.
    Disk(usize),
    /// A wall, by its index in the boundary.
    Wall(usize),
}

/// A collision that has just happened.
///
/// At a thermal wall, the contact describes the arriving disk, and the impulse is the whole impulse on that
/// disk. The wall also draws a new spin for the disk; only [`Self::energy_change`] includes the energy of
/// this spin.
///
/// ```
/// use granular_edmd::collision::{Contact, Impulse};
/// use granular_edmd::glam::DVec2;
/// use granular_edmd::observable::{Collision, EnergyChange, Observer, Partner};
///
/// // An observer sees a collision of two disks, without a simulation.
/// let (contact, impulse) = (Contact::new(2.0, 0.0, 1.0, 1.0 / 3.0), Impulse::new(3.0, 0.0));
/// let mut energy_change = EnergyChange::default();
/// energy_change.on_collision(&Collision::new(0.5, 7, Partner::Disk(8), contact, impulse));
/// assert_eq!(energy_change.disks().mean(), -1.5);
///
/// let mut collision = Collision::new(0.5, 7, Partner::Disk(8), contact, impulse);
/// collision.position = DVec2::new(2.0, 3.0);
/// assert_eq!(collision.partner_position(), DVec2::new(2.0, 2.0));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Collision {
    /// Absolute time of the collision. A run until this time includes the collision.
    pub time: f64,
    /// Index of the disk among all disks of the run, at this time. In a snapshot of some of the disks, or of
    /// another time if disks come and go, its index may be another one; its [id](Self::ids) is the same.
    pub disk: usize,
    /// [Ids](crate::Disk::id) of the disk and of its partner; 0 for a wall.
    pub ids: [u64; 2],
    /// Partner of the disk.
    pub partner: Partner,
    /// Unit vector from the partner to the disk.
    pub normal: DVec2,
    /// Position of the disk's center.
    pub position: DVec2,
    /// Distance between the centers, or between the center and the wall.
    pub distance: f64,
    /// The contact in which the surfaces met, before the impulse.
    pub contact: Contact,
    /// The impulse on the disk.
    pub impulse: Impulse,
    /// Velocities of the disk and of its partner after the collision; for a wall, the velocity of its
    /// surface.
    pub velocities: [DVec2; 2],
    /// Change of the kinetic energy of the disk, and of its partner if that is a disk.
    ///
    /// A moving wall gives energy to the disk or takes energy from it. [`Impulse::energy_change`] is the
    /// change in the frame of the wall.
    pub energy_change: f64,
}

impl Collision {
    /// Creates a collision for tests of observers.
    ///
    /// The engine fills all fields itself.
    ///
    /// The fields without an argument have simple values; set the fields that matter. The normal points up,
    /// the position is the origin, the velocities and the ids are 0, and the disks have radius 1/2 (a
    /// `distance` of 1, or of 1/2 to a wall). The `energy_change` follows from the impulse, which is right
    /// for two disks and for a wall at rest.
    pub fn new(time: f64, disk: usize, partner: Partner, contact: Contact, impulse: Impulse) -> Self {
        let distance = match partner {
            Partner::Disk(_) => 1.0,
            Partner::Wall(_) => 0.5,
        };
        let energy_change = impulse.energy_change(&contact);
        let (normal, position) = (DVec2::Y, DVec2::ZERO);
        let (ids, velocities) = ([0; 2], [DVec2::ZERO; 2]);
        Self {
            time,
            disk,
            ids,
            partner,
            normal,
            position,
            distance,
            contact,
            impulse,
            velocities,
            energy_change,
        }
    }

    /// Adds the impulse and the work of a push along the normal that changes the disk's velocity from
    /// `before` to `after`.
    pub(crate) fn add_push(&mut self, before: DVec2, after: DVec2, inverse_mass: f64) {
        self.velocities[0] = after;
        let momentum = (after - before) / inverse_mass;
        self.energy_change += momentum.dot(0.5 * (before + after));
        let normal = self.impulse.normal() + momentum.dot(self.normal);
        self.impulse = self.impulse.with_normal(normal);
    }

    /// Returns the position of the partner: the center of a disk, or the point where a wall is touched.
    ///
    /// At periodic sides, the disk may touch an image of the partner. The image's position is then returned.
    pub fn partner_position(&self) -> DVec2 {
        self.position - self.normal * self.distance
    }
}
