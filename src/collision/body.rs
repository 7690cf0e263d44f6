//! Conversions from moving bodies to a contact, and from an impulse back to velocities.

use glam::DVec2;

use super::{CollisionRule, Contact, Impulse};
use crate::{Disk, Kind};

/// The constant properties of a body in a collision: its kind, its size, and its resistance to impulses.
#[derive(Debug, Clone, Copy, PartialEq)]
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
    /// Returns the properties of a wall with these masses against impulses along its normal and along its
    /// surface. Infinite masses keep the motion of the wall unchanged. A curved wall with a mass along its
    /// surface turns about the center of the surface.
    pub(crate) fn of_wall(kind: Kind, radius: f64, [normal, tangential]: [f64; 2]) -> Self {
        let (inverse_mass, tangential_compliance) = (1.0 / normal, 1.0 / tangential);
        // In this order, an infinite radius gives zeros and never infinity times zero.
        let spin_response = tangential_compliance / radius;
        let inverse_inertia = spin_response / radius;
        Self { arm: 0.0, radius, inverse_mass, tangential_compliance, spin_response, inverse_inertia, kind }
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
    let (normal_mass, tangential_mass) = (
        1.0 / (first.1.inverse_mass + second.1.inverse_mass),
        1.0 / (first.1.tangential_compliance + second.1.tangential_compliance),
    );
    Contact::new(closing, approach.dot(normal.perp()) + surface, normal_mass, tangential_mass)
        .with_kinds([first.1.kind, second.1.kind])
        .with_radii([first.1.radius, second.1.radius])
        .with_spin(
            first.0.angular_velocity - second.0.angular_velocity,
            1.0 / (first.1.inverse_inertia + second.1.inverse_inertia),
            first.1.spin_response - second.1.spin_response,
        )
        .with_time_since_last_collision(time_since_last_collision)
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
