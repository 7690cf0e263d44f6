//! Single collisions of disks, outside a simulation.

use glam::DVec2;

use super::body::{Body, Material, collide_bodies};
use super::{CollisionRule, Contact, Impulse};
use crate::{Disk, Kind};

/// Two disks after their collision, with the contact and the impulse; returned by [`collide`].
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Encounter {
    /// The first disk after the collision.
    pub first: Disk,
    /// The second disk after the collision.
    pub second: Disk,
    /// The contact that the rule received.
    pub contact: Contact,
    /// The impulse on the first disk; the second received its opposite.
    pub impulse: Impulse,
}

/// A disk after its collision with a wall, with the contact and the impulse; returned by
/// [`collide_with_wall`].
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct WallEncounter {
    /// The disk after the collision.
    pub disk: Disk,
    /// The contact that the rule received.
    pub contact: Contact,
    /// The impulse on the disk.
    pub impulse: Impulse,
}

/// Collides two disks under `rule` (paper, Eq. (2)), as a simulation does.
///
/// The function is useful in tests of rules.
///
/// The normal comes from the centers of the disks; the function does not check that the disks touch. If the
/// disks part, the closing speed is zero.
///
/// ```
/// use granular_edmd::glam::DVec2;
/// use granular_edmd::Disk;
/// use granular_edmd::collision::{Elastic, collide};
///
/// let left = Disk::new(DVec2::ZERO, 0.5)?.with_velocity(DVec2::X)?;
/// let right = Disk::new(DVec2::X, 0.5)?;
/// let encounter = collide(&Elastic, &left, &right);
/// assert_eq!(encounter.first.velocity(), DVec2::ZERO);
/// assert_eq!(encounter.second.velocity(), DVec2::X);
/// assert_eq!(encounter.contact.closing_speed(), 1.0);
/// assert_eq!(encounter.impulse.normal(), 1.0);
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
pub fn collide<R: CollisionRule + ?Sized>(rule: &R, first: &Disk, second: &Disk) -> Encounter {
    collide_after(f64::INFINITY, rule, first, second)
}

/// Collides two disks at this time after the latest collision of either.
pub(crate) fn collide_after<R: CollisionRule + ?Sized>(
    time_since_last_collision: f64,
    rule: &R,
    first: &Disk,
    second: &Disk,
) -> Encounter {
    let normal = (first.position() - second.position()).normalize_or(DVec2::Y);
    let outcome = collide_bodies(
        rule,
        normal,
        time_since_last_collision,
        (&Body::of(first), &Material::of(first)),
        (&Body::of(second), &Material::of(second)),
    );
    Encounter {
        first: moved(first, outcome.first),
        second: moved(second, outcome.second),
        contact: outcome.contact,
        impulse: outcome.impulse,
    }
}

/// Collides a disk under `rule` with a wall that moves at `wall_velocity`, as a simulation does.
///
/// The unit vector `normal` points from the wall to the disk. If the disk leaves the wall, the closing speed
/// is zero. The wall is straight and has the kind [`Kind::WALL`].
///
/// ```
/// use granular_edmd::glam::DVec2;
/// use granular_edmd::Disk;
/// use granular_edmd::collision::{Elastic, collide_with_wall};
///
/// let disk = Disk::new(DVec2::ZERO, 0.5)?.with_velocity(-DVec2::Y)?;
/// let encounter = collide_with_wall(&Elastic, &disk, DVec2::Y, DVec2::new(0.0, 0.5));
/// assert_eq!(encounter.disk.velocity(), DVec2::new(0.0, 2.0));
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
pub fn collide_with_wall<R: CollisionRule + ?Sized>(
    rule: &R,
    disk: &Disk,
    normal: DVec2,
    wall_velocity: DVec2,
) -> WallEncounter {
    let arriving = (&Body::of(disk), &Material::of(disk));
    let wall = Body { velocity: wall_velocity, angular_velocity: 0.0 };
    let outcome = collide_bodies(
        rule,
        normal,
        f64::INFINITY,
        arriving,
        (&wall, &Material::of_wall(Kind::WALL, f64::INFINITY, [f64::INFINITY; 2])),
    );
    WallEncounter { disk: moved(disk, outcome.first), contact: outcome.contact, impulse: outcome.impulse }
}

fn moved(disk: &Disk, body: Body) -> Disk {
    disk.with_motion(disk.position(), body.velocity, disk.angle(), body.angular_velocity)
}
