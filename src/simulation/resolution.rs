//! What a collision does to the disks, and how observers are told.

use glam::DVec2;
use rand_xoshiro::Xoshiro256PlusPlus;

use super::bodies::Bodies;
use super::prediction::nearest_image;
use crate::boundary::{Response, Surface, Thermal};
use crate::collision::{Body, CollisionRule, Elastic, Impulse, Material, Regime, collide_bodies};
use crate::observable::{Collision, Partner};
use crate::random::{normal, rayleigh};

/// Who takes part in a collision, and when, as an offset from the epoch.
#[derive(Debug, Clone, Copy)]
pub(super) struct Meeting {
    pub(super) disk: usize,
    pub(super) offset: f64,
    /// Absolute time.
    pub(super) time: f64,
}

/// A rule or a wall answered with a number that is not finite.
pub(super) struct NotFinite;

/// Two disks collide. Returns the event and the overlap at which it found them.
#[inline]
pub(super) fn resolve_pair<R: CollisionRule + ?Sized>(
    bodies: &mut Bodies,
    rule: &R,
    period: f64,
    meeting: Meeting,
    partner: usize,
) -> Result<(Collision, f64), NotFinite> {
    let Meeting { disk, offset, time } = meeting;
    let here = bodies.particles[disk].trajectory.at(offset);
    let mut separation = here - bodies.particles[partner].trajectory.at(offset);
    separation.x = nearest_image(separation.x, period);
    let distance = separation.length();
    let normal = if distance > 0.0 { separation / distance } else { DVec2::Y };
    let since = offset - bodies.spins[disk].last_collision.max(bodies.spins[partner].last_collision);
    let (first, second) = (bodies.body(disk), bodies.body(partner));
    let (material, other) = (bodies.material(disk), bodies.material(partner));
    let outcome = collide_bodies(rule, normal, since, (&first, material), (&second, other));
    let overlap = material.radius + other.radius - distance;
    apply(bodies, disk, &first, &outcome.first, offset)?;
    apply(bodies, partner, &second, &outcome.second, offset)?;
    let collision = Collision {
        time,
        disk,
        partner: Partner::Disk(partner),
        normal,
        position: here + bodies.fall(offset).0,
        distance,
        contact: outcome.contact,
        impulse: outcome.impulse,
        energy_change: outcome.impulse.energy_change(&outcome.contact),
    };
    Ok((collision, overlap))
}

/// A disk collides with a wall.
#[inline]
pub(super) fn resolve_wall<R: CollisionRule + ?Sized>(
    bodies: &mut Bodies,
    rule: &R,
    generator: &mut Xoshiro256PlusPlus,
    surface: &Surface<'_>,
    meeting: Meeting,
    wall: usize,
) -> Result<Collision, NotFinite> {
    let Meeting { disk, offset, time } = meeting;
    let arriving = Body { velocity: bodies.velocity(disk, offset), ..bodies.body(disk) };
    let since = offset - bodies.spins[disk].last_collision;
    let partner = Body { velocity: surface.velocity, angular_velocity: 0.0 };
    let against = |rule: &dyn CollisionRule| {
        collide_bodies(
            rule,
            surface.normal,
            since,
            (&arriving, bodies.material(disk)),
            (&partner, &Material::WALL),
        )
    };
    let mass = 1.0 / bodies.material(disk).inverse_mass;
    let (leaving, contact, impulse) = match surface.response {
        Response::Thermal(thermal) => {
            let inertia = bodies.moment_of_inertia(disk);
            let leaving = emitted(&thermal, &arriving, surface, mass, inertia, generator);
            let kick = (leaving.velocity - arriving.velocity) * mass;
            let impulse = Impulse::new(kick.dot(surface.normal), kick.dot(surface.normal.perp()));
            let contact = against(&Elastic).contact;
            (leaving, contact, impulse)
        }
        Response::Rule(own) => {
            let outcome = against(own);
            (outcome.first, outcome.contact, outcome.impulse)
        }
        Response::Shared => {
            let walls = (&partner, &Material::WALL);
            let outcome =
                collide_bodies(rule, surface.normal, since, (&arriving, bodies.material(disk)), walls);
            (outcome.first, outcome.contact, outcome.impulse)
        }
    };
    let energy_change = kinetic_energy(&leaving, mass, bodies.moment_of_inertia(disk))
        - kinetic_energy(&arriving, mass, bodies.moment_of_inertia(disk));
    apply(bodies, disk, &arriving, &leaving, offset)?;
    Ok(Collision {
        time,
        disk,
        partner: Partner::Wall(wall),
        normal: surface.normal,
        position: bodies.position(disk, offset),
        distance: bodies.material(disk).radius,
        contact,
        impulse,
        energy_change,
    })
}

/// Whether a contact-duration model decided this collision.
#[inline]
pub(super) fn by_contact_duration(collision: &Collision) -> bool {
    collision.impulse.regime() == Regime::ContactDuration
}

/// How a disk leaves a thermal wall.
fn emitted(
    thermal: &Thermal,
    arriving: &Body,
    surface: &Surface<'_>,
    mass: f64,
    inertia: f64,
    generator: &mut Xoshiro256PlusPlus,
) -> Body {
    let speed = (thermal.temperature() / mass).sqrt();
    let outward = surface.normal * (speed * rayleigh(generator));
    let along = surface.normal.perp();
    if thermal.slip() {
        let slip = along * (arriving.velocity - surface.velocity).dot(along);
        return Body { velocity: surface.velocity + outward + slip, ..*arriving };
    }
    Body {
        velocity: surface.velocity + outward + along * (speed * normal(generator)),
        angular_velocity: (thermal.temperature() / inertia).sqrt() * normal(generator),
    }
}

fn kinetic_energy(body: &Body, mass: f64, inertia: f64) -> f64 {
    0.5 * mass * body.velocity.length_squared()
        + 0.5 * inertia * body.angular_velocity * body.angular_velocity
}

#[inline]
fn apply(
    bodies: &mut Bodies,
    disk: usize,
    before: &Body,
    after: &Body,
    offset: f64,
) -> Result<(), NotFinite> {
    let velocity = after.velocity - before.velocity;
    let angular_velocity = after.angular_velocity - before.angular_velocity;
    if !(velocity.x + velocity.y + angular_velocity).is_finite() {
        return Err(NotFinite);
    }
    bodies.kick(disk, velocity, angular_velocity, offset);
    Ok(())
}
