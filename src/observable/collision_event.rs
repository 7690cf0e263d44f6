//! A collision as an observer sees it.

use glam::DVec2;

use crate::collision::{Contact, Impulse};

/// What a disk collided with.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Partner {
    /// Another disk, by its index.
    Disk(usize),
    /// A wall, by its index into [`Boundary::wall_name`](crate::boundary::Boundary::wall_name).
    Wall(usize),
}

/// A collision that has just happened.
///
/// For a thermal wall the contact is that of the arriving disk, and the impulse is what the disk received in all;
/// its rotation is redrawn, too, and only [`Self::energy_change`] knows by how much.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Collision {
    /// When.
    pub time: f64,
    /// The disk.
    pub disk: usize,
    /// Its partner.
    pub partner: Partner,
    /// Unit vector from the partner to the disk.
    pub normal: DVec2,
    /// Position of the disk's centre.
    pub position: DVec2,
    /// Distance of the centres; for a wall, of the centre and the wall.
    pub distance: f64,
    /// How the surfaces met.
    pub contact: Contact,
    /// The impulse on the disk.
    pub impulse: Impulse,
    /// Change of the kinetic energy of the disk and a partner disk. A moving wall gives or takes energy; what is lost
    /// in its frame is [`Impulse::energy_change`].
    pub energy_change: f64,
}
