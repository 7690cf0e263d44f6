//! Conversions between moving bodies and contacts, and single collisions outside a simulation.

use glam::DVec2;

use super::{CollisionRule, Contact, Impulse};
use crate::{Disk, Kind};

/// The constant properties of a body in a collision: its kind, its size, and its resistance to impulses.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Material {
    /// Distance from the center, about which the body turns, to the surface; 0 for a wall.
    arm: f64,
    /// Radius of the surface, which rules find in the contact; infinite for a straight wall.
    pub(crate) radius: f64,
    pub(crate) inverse_mass: f64,
    /// Velocity of the contact point per tangential impulse, (1 + 1/β)/m.
    tangential_compliance: f64,
    /// Angular velocity per tangential impulse, 1/(β m R).
    spin_response: f64,
    /// Angular velocity per couple, 1/I.
    inverse_inertia: f64,
    pub(crate) kind: Kind,
}

impl Material {
    /// Returns the properties of a wall with this mass against impulses along its normal. An infinite mass
    /// keeps the motion of the wall unchanged.
    pub(crate) fn of_wall(kind: Kind, radius: f64, mass: f64) -> Self {
        Self {
            arm: 0.0,
            radius,
            inverse_mass: 1.0 / mass,
            tangential_compliance: 0.0,
            spin_response: 0.0,
            inverse_inertia: 0.0,
            kind,
        }
    }

    pub(crate) fn of(disk: &Disk) -> Self {
        let (mass, factor) = (disk.mass(), disk.inertia_factor());
        Self {
            arm: disk.radius(),
            radius: disk.radius(),
            inverse_mass: 1.0 / mass,
            tangential_compliance: (1.0 + 1.0 / factor) / mass,
            spin_response: 1.0 / (factor * mass * disk.radius()),
            inverse_inertia: 1.0 / disk.moment_of_inertia(),
            kind: disk.kind(),
        }
    }
}

/// The motion of a body, which a collision changes.
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

/// Returns the contact of two bodies. The `normal` points from the second to the first.
#[inline]
pub(crate) fn contact_of(
    normal: DVec2,
    time_since_last_collision: f64,
    first: (&Body, &Material),
    second: (&Body, &Material),
) -> Contact {
    let approach = second.0.velocity - first.0.velocity;
    let closing = approach.dot(normal);
    // Bodies that touch may be parting, by rounding or because the caller did not check. A rule must not get
    // a negative speed, of which it may take a root. The comparison is also false for NaN, and the result is
    // never −0; `f64::max` may return either zero, depending on the processor.
    let closing = if closing > 0.0 { closing } else { 0.0 };
    let surface = second.1.arm * second.0.angular_velocity + first.1.arm * first.0.angular_velocity;
    let (slip, spin) =
        (approach.dot(normal.perp()) + surface, first.0.angular_velocity - second.0.angular_velocity);
    meeting([first.1, second.1], closing, slip, spin)
        .with_time_since_last_collision(time_since_last_collision)
}

/// Returns the contact of two partners at these speeds of closing and slip, and with this relative spin.
#[inline]
pub(crate) fn meeting([first, second]: [&Material; 2], closing: f64, slip: f64, spin: f64) -> Contact {
    let normal_mass = 1.0 / (first.inverse_mass + second.inverse_mass);
    let tangential_mass = 1.0 / (first.tangential_compliance + second.tangential_compliance);
    let spin_inertia = 1.0 / (first.inverse_inertia + second.inverse_inertia);
    Contact::new(closing, slip, normal_mass, tangential_mass)
        .with_kinds([first.kind, second.kind])
        .with_radii([first.radius, second.radius])
        .with_spin(spin, spin_inertia, first.spin_response - second.spin_response)
}

/// Returns `body` after an impulse along the normal and its perpendicular, and a couple. A tangential impulse
/// changes the spins of both partners in the same sense, a couple in opposite senses.
#[inline]
fn kicked(body: &Body, material: &Material, kick: DVec2, tangential: f64, couple: f64) -> Body {
    let spin = body.angular_velocity - tangential * material.spin_response;
    // The comparison costs nothing for a rule that never gives a couple, since the compiler then knows its
    // result.
    let spin = if couple == 0.0 { spin } else { spin - couple * material.inverse_inertia };
    Body { velocity: body.velocity + kick * material.inverse_mass, angular_velocity: spin }
}

/// Returns the momentum that the first body receives.
#[inline]
pub(crate) fn momentum(normal: DVec2, impulse: &Impulse) -> DVec2 {
    normal * impulse.normal() + normal.perp() * impulse.tangential()
}

/// Returns the first body after an impulse.
#[inline]
pub(crate) fn after(body: &Body, material: &Material, normal: DVec2, impulse: &Impulse) -> Body {
    kicked(body, material, momentum(normal, impulse), impulse.tangential(), impulse.couple())
}

/// Two bodies after a collision, with the contact and the impulse.
pub(crate) struct Outcome {
    pub(crate) first: Body,
    pub(crate) second: Body,
    pub(crate) contact: Contact,
    pub(crate) impulse: Impulse,
}

/// Collides two bodies under `rule`. The `normal` points from the second to the first.
#[inline(always)]
pub(crate) fn collide_bodies<R: CollisionRule + ?Sized>(
    rule: &R,
    normal: DVec2,
    time_since_last_collision: f64,
    first: (&Body, &Material),
    second: (&Body, &Material),
) -> Outcome {
    let contact = contact_of(normal, time_since_last_collision, first, second);
    let impulse = rule.impulse(&contact);
    let back = -momentum(normal, &impulse);
    Outcome {
        first: after(first.0, first.1, normal, &impulse),
        second: kicked(second.0, second.1, back, impulse.tangential(), -impulse.couple()),
        contact,
        impulse,
    }
}

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
        (&wall, &Material::of_wall(Kind::WALL, f64::INFINITY, f64::INFINITY)),
    );
    WallEncounter { disk: moved(disk, outcome.first), contact: outcome.contact, impulse: outcome.impulse }
}

fn moved(disk: &Disk, body: Body) -> Disk {
    disk.with_motion(disk.position(), body.velocity, disk.angle(), body.angular_velocity)
}
