//! From moving bodies to a contact, and from an impulse back to velocities.

use glam::DVec2;

use super::{CollisionRule, Contact, Impulse};
use crate::Disk;

/// What a collision needs to know of a body at rest: how far its surface is and how it resists.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Material {
    pub(crate) radius: f64,
    pub(crate) inverse_mass: f64,
    /// `$(1 + 1/\beta)/m$`: velocity of the contact point per tangential impulse.
    tangential_compliance: f64,
    /// `$1/(\beta m R)$`: angular velocity per tangential impulse.
    spin_response: f64,
}

impl Material {
    /// A wall: it takes any impulse and does not move.
    pub(crate) const WALL: Self =
        Self { radius: 0.0, inverse_mass: 0.0, tangential_compliance: 0.0, spin_response: 0.0 };

    pub(crate) fn of(disk: &Disk) -> Self {
        let (mass, factor) = (disk.mass(), disk.inertia_factor());
        Self {
            radius: disk.radius(),
            inverse_mass: 1.0 / mass,
            tangential_compliance: (1.0 + 1.0 / factor) / mass,
            spin_response: 1.0 / (factor * mass * disk.radius()),
        }
    }
}

/// The motion that a collision changes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Body {
    pub(crate) velocity: DVec2,
    pub(crate) angular_velocity: f64,
}

impl Body {
    pub(crate) fn of(disk: &Disk) -> Self {
        Self { velocity: disk.velocity(), angular_velocity: disk.angular_velocity() }
    }
}

/// The contact of two bodies, `normal` pointing from the second to the first.
#[inline]
fn contact(normal: DVec2, first: (&Body, &Material), second: (&Body, &Material)) -> Contact {
    let approach = second.0.velocity - first.0.velocity;
    let surface = second.1.radius * second.0.angular_velocity + first.1.radius * first.0.angular_velocity;
    let (normal_mass, tangential_mass) = (
        1.0 / (first.1.inverse_mass + second.1.inverse_mass),
        1.0 / (first.1.tangential_compliance + second.1.tangential_compliance),
    );
    Contact::new(approach.dot(normal), approach.dot(normal.perp()) + surface, normal_mass, tangential_mass)
}

/// `body` after an impulse along the normal and its perpendicular; both partners of a collision turn the same way.
#[inline]
fn kicked(body: &Body, material: &Material, kick: DVec2, tangential: f64) -> Body {
    Body {
        velocity: body.velocity + kick * material.inverse_mass,
        angular_velocity: body.angular_velocity - tangential * material.spin_response,
    }
}

/// The outcome of a meeting: both bodies after it, with what happened between them.
pub(crate) struct Outcome {
    pub(crate) first: Body,
    pub(crate) second: Body,
    pub(crate) contact: Contact,
    pub(crate) impulse: Impulse,
}

/// Two bodies meet, `normal` pointing from the second to the first.
#[inline(always)]
pub(crate) fn meet<R: CollisionRule + ?Sized>(
    rule: &R,
    normal: DVec2,
    time_since_last_collision: f64,
    first: (&Body, &Material),
    second: (&Body, &Material),
) -> Outcome {
    let contact = contact(normal, first, second).with_time_since_last_collision(time_since_last_collision);
    let impulse = rule.impulse(&contact);
    let kick = normal * impulse.normal() + normal.perp() * impulse.tangential();
    Outcome {
        first: kicked(first.0, first.1, kick, impulse.tangential()),
        second: kicked(second.0, second.1, -kick, impulse.tangential()),
        contact,
        impulse,
    }
}

/// Both disks after a collision under `rule`, with the contact and the impulse on the first (paper, Eq. (2)).
///
/// The normal is taken from their centres; that they touch and approach is not checked. Useful to test rules.
///
/// ```
/// use glam::DVec2;
/// use granular_edmd::Disk;
/// use granular_edmd::collision::{Elastic, collide};
///
/// let left = Disk::new(DVec2::ZERO, 0.5)?.with_velocity(DVec2::X)?;
/// let right = Disk::new(DVec2::X, 0.5)?;
/// let (left, right, _, _) = collide(&Elastic, &left, &right);
/// assert_eq!((left.velocity(), right.velocity()), (DVec2::ZERO, DVec2::X));
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
pub fn collide<R: CollisionRule + ?Sized>(
    rule: &R,
    first: &Disk,
    second: &Disk,
) -> (Disk, Disk, Contact, Impulse) {
    let normal = (first.position() - second.position()).normalize_or(DVec2::Y);
    let outcome = meet(
        rule,
        normal,
        f64::INFINITY,
        (&Body::of(first), &Material::of(first)),
        (&Body::of(second), &Material::of(second)),
    );
    (moved(first, outcome.first), moved(second, outcome.second), outcome.contact, outcome.impulse)
}

/// The disk after a collision with a wall that moves at `wall_velocity`; `normal` points from the wall to the disk.
///
/// ```
/// use glam::DVec2;
/// use granular_edmd::Disk;
/// use granular_edmd::collision::{Elastic, collide_with_wall};
///
/// let disk = Disk::new(DVec2::ZERO, 0.5)?.with_velocity(-DVec2::Y)?;
/// let (disk, _, _) = collide_with_wall(&Elastic, &disk, DVec2::Y, DVec2::new(0.0, 0.5));
/// assert_eq!(disk.velocity(), DVec2::new(0.0, 2.0));
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
pub fn collide_with_wall<R: CollisionRule + ?Sized>(
    rule: &R,
    disk: &Disk,
    normal: DVec2,
    wall_velocity: DVec2,
) -> (Disk, Contact, Impulse) {
    let wall = Body { velocity: wall_velocity, angular_velocity: 0.0 };
    let outcome =
        meet(rule, normal, f64::INFINITY, (&Body::of(disk), &Material::of(disk)), (&wall, &Material::WALL));
    (moved(disk, outcome.first), outcome.contact, outcome.impulse)
}

fn moved(disk: &Disk, body: Body) -> Disk {
    disk.with_motion(disk.position(), body.velocity, disk.angle(), body.angular_velocity)
}
