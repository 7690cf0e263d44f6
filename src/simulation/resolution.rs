//! Outcomes of collisions: contact, impulse, and the change of each disk's motion. The disks themselves are
//! not changed, except that partners which rounding leaves approaching each other are pushed apart.

use glam::DVec2;
use rand_xoshiro::Xoshiro256PlusPlus;

use super::engine::Engine;
use super::prediction::{are_closing, nearest_image};
use super::state::{Bodies, Clock, Exit, Forecast};
use super::{FailedCollision, RunError, Simulation};
use crate::boundary::{Boundary, Impact, Response, Surface, Thermal};
use crate::collision::{Body, CollisionRule, Impulse, Material, after, collide_bodies, contact_of, momentum};
use crate::disk::LARGEST;
use crate::observable::{Collision, Partner};
use crate::random::{Stream, derived_seed, generator_at, normal, rayleigh};
use crate::scheduler::EventScheduler;

/// Largest difference between the length of a surface's normal and 1.
const UNIT: f64 = 1e-9;

/// Speed along the normal, relative to the whole relative speed, below which rounding may decide its sign.
/// The normal comes from a difference of positions, so its rounding error is ε times the ratio of the
/// vessel's size to the size of the disks.
const GRAZING: f64 = 1e-6;

/// The change of a disk's motion in a collision.
#[derive(Debug, Clone, Copy)]
pub(super) struct Kick {
    /// Differences of the velocity and the angular velocity.
    pub(super) change: Body,
    /// Motion after the collision, with the velocity in the free-fall frame.
    pub(super) after: Body,
}

impl Kick {
    #[inline]
    fn between(before: &Body, after: &Body) -> Self {
        let change = Body {
            velocity: after.velocity - before.velocity,
            angular_velocity: after.angular_velocity - before.angular_velocity,
        };
        Self { change, after: *after }
    }

    /// Returns whether the kick leads to a motion within the engine's bounds.
    pub(super) fn is_possible(&self) -> bool {
        let velocity = self.after.velocity.abs();
        velocity.x <= LARGEST && velocity.y <= LARGEST && self.may_spin()
    }

    /// Returns whether the spin after the kick is within the engine's bounds.
    #[inline]
    pub(super) fn may_spin(&self) -> bool {
        self.after.angular_velocity.abs() <= LARGEST
    }
}

/// Computes the collision of two disks.
///
/// The function is inlined, so that unused results are not even computed.
#[inline(always)]
pub(super) fn resolve_pair<R: CollisionRule + ?Sized>(
    bodies: &Bodies,
    rule: &R,
    periods: DVec2,
    clock: &Clock,
    disk: usize,
    partner: usize,
) -> (Collision, [Kick; 2]) {
    let offset = clock.now;
    let here = bodies.particles[disk].trajectory.at(offset);
    let mut separation = here - bodies.particles[partner].trajectory.at(offset);
    if periods != DVec2::ZERO {
        separation.x = nearest_image(separation.x, periods.x);
        separation.y = nearest_image(separation.y, periods.y);
    }
    let distance = separation.length();
    // Two centers at the same position have no direction between them, and a NaN would spread to both disks.
    let normal = if distance > 0.0 { separation / distance } else { DVec2::Y };
    let since = offset - bodies.spins[disk].last_collision.max(bodies.spins[partner].last_collision);
    let (first, second) = (bodies.body(disk), bodies.body(partner));
    let (material, other) = (bodies.material(disk), bodies.material(partner));
    let outcome = collide_bodies(rule, normal, since, (&first, &material), (&second, &other));
    // The pair was resolved in the free-fall frame, where gravity drops out. Observers see velocities in the
    // container's frame.
    let (fallen, gained) = bodies.fall(offset);
    let collision = Collision {
        time: clock.time(),
        disk,
        ids: [bodies.id(disk), bodies.id(partner)],
        partner: Partner::Disk(partner),
        normal,
        position: here + fallen,
        distance,
        contact: outcome.contact,
        impulse: outcome.impulse,
        velocities: [outcome.first.velocity + gained, outcome.second.velocity + gained],
        energy_change: outcome.impulse.energy_change(&outcome.contact),
    };
    (collision, [Kick::between(&first, &outcome.first), Kick::between(&second, &outcome.second)])
}

/// Returns a disk that a wall has captured. Both move on together, so no energy is added.
#[inline]
fn captured(arriving: &Body, surface: &Surface<'_>, mass: f64) -> Body {
    let (against, normal) = (arriving.velocity - surface.velocity, surface.normal);
    let gained = mass / (mass + surface.mass) * against.dot(normal) * normal;
    Body { velocity: surface.velocity + gained, angular_velocity: 0.0 }
}

/// Computes the collision of a disk with a wall.
#[inline]
pub(super) fn resolve_wall<R: CollisionRule + ?Sized>(
    engine: &Engine,
    rule: &R,
    surface: &Surface<'_>,
    clock: &Clock,
    disk: usize,
    index: usize,
) -> (Collision, Kick) {
    let (bodies, offset) = (&engine.bodies, clock.now);
    let material = bodies.material(disk);
    let (mass, inertia) = (1.0 / material.inverse_mass, bodies.moment_of_inertia(disk));
    let arriving = Body { velocity: bodies.velocity(disk, offset), ..bodies.body(disk) };
    let since = offset - bodies.spins[disk].last_collision;
    let partner = &Body { velocity: surface.velocity, angular_velocity: surface.angular_velocity };
    let wall = &Material::of_wall(surface.kind, surface.radius, surface.mass);
    let contact = contact_of(surface.normal, since, (&arriving, &material), (partner, wall));
    let kicked_by = |impulse: Impulse| (after(&arriving, &material, surface.normal, &impulse), impulse);
    // Thermal walls and sinks decide the motion, and the impulse follows from it.
    let leading_to = |leaving: Body| {
        let kick = (leaving.velocity - arriving.velocity) * mass;
        (leaving, Impulse::new(kick.dot(surface.normal), kick.dot(surface.normal.perp())))
    };
    let (leaving, impulse) = match surface.response {
        Response::Thermal(thermal) => {
            let properties = [mass, inertia, material.radius];
            let random = &mut of_collision(engine.seed, bodies, clock, disk);
            leading_to(emitted(&thermal, &arriving, surface, properties, random))
        }
        Response::Absorbing => leading_to(captured(&arriving, surface, mass)),
        Response::Rule(own) => kicked_by(own.impulse(&contact)),
        Response::Shared => kicked_by(rule.impulse(&contact)),
    };
    let collision = Collision {
        time: clock.time(),
        disk,
        ids: [bodies.id(disk), 0],
        partner: Partner::Wall(index),
        normal: surface.normal,
        position: bodies.position(disk, offset),
        distance: bodies.radius(disk),
        contact,
        impulse,
        velocities: [leaving.velocity, velocity_after(surface, &impulse)],
        energy_change: kinetic_energy(&leaving, mass, inertia) - kinetic_energy(&arriving, mass, inertia),
    };
    let mut kick = Kick::between(&arriving, &leaving);
    // The wall was met in the container's frame, and disks keep their velocities in the free-fall frame.
    kick.after.velocity = bodies.particles[disk].trajectory.velocity + kick.change.velocity;
    (collision, kick)
}

/// Returns whether an impulse changes the velocity of a surface.
#[inline]
pub(super) fn has_mass(surface: &Surface<'_>) -> bool {
    surface.mass != f64::INFINITY
}

/// Returns the velocity of a wall's surface after an impulse, which changes only a wall with a mass.
fn velocity_after(surface: &Surface<'_>, impulse: &Impulse) -> DVec2 {
    if has_mass(surface) {
        surface.velocity - surface.normal * (impulse.normal() / surface.mass)
    } else {
        surface.velocity
    }
}

/// Returns whether two disks part so fast after a collision that rounding cannot make them approach. Nearly
/// all do.
#[inline]
pub(super) fn is_parting(normal: DVec2, kicks: &[Kick; 2]) -> bool {
    let velocity = (kicks[0].after.velocity - kicks[1].after.velocity).abs();
    (kicks[0].after.velocity - kicks[1].after.velocity).dot(normal) > GRAZING * (velocity.x + velocity.y)
}

/// Returns whether a surface's normal is a unit vector, its velocities are possible for a disk, its radius is
/// neither zero nor NaN, and its mass is positive.
pub(super) fn is_possible(surface: &Surface<'_>) -> bool {
    let velocity = surface.velocity.abs();
    let is_curved = surface.radius.abs() > 0.0;
    let turns = surface.angular_velocity.abs() <= LARGEST;
    (surface.normal.length() - 1.0).abs() <= UNIT
        && velocity.x <= LARGEST
        && velocity.y <= LARGEST
        && is_curved
        && surface.mass > 0.0
        && turns
}

/// Returns the error of a collision whose outcome is not a possible motion.
#[cold]
pub(super) fn failed(collision: &Collision, wall: Option<String>) -> RunError {
    let Collision { disk, partner, time, contact, impulse, .. } = *collision;
    RunError::NotFinite(Box::new(FailedCollision { disk, partner, wall, time, contact, impulse }))
}

/// Returns the impact that a wall receives in a collision at this offset.
#[inline]
pub(super) fn impact_of(collision: &Collision, wall: usize, offset: f64) -> Impact {
    let impulse = collision.impulse;
    Impact::new(wall, -momentum(collision.normal, &impulse), collision.partner_position(), offset)
}

/// Returns the random numbers for a disk's present collision, which do not depend on the order of events.
fn of_collision(seed: u64, bodies: &Bodies, clock: &Clock, disk: usize) -> Xoshiro256PlusPlus {
    // The count distinguishes two collisions at one time, and the time distinguishes them after the count has
    // wrapped around.
    let count = bodies.particles[disk].forecast.collisions;
    generator_at(
        derived_seed(seed, Stream::Walls, bodies.id(disk)),
        Stream::Walls,
        count.into(),
        clock.time(),
    )
}

/// Returns the motion with which a disk leaves a thermal wall.
fn emitted(
    thermal: &Thermal,
    arriving: &Body,
    surface: &Surface<'_>,
    [mass, inertia, radius]: [f64; 3],
    generator: &mut Xoshiro256PlusPlus,
) -> Body {
    let speed = (thermal.temperature() / mass).sqrt();
    // The speed is weighted by the flux, since fast disks cross a plane more often. With half a Gaussian, an
    // elastic gas would settle below the wall's temperature.
    let outward = surface.normal * (speed * rayleigh(generator));
    let base = if surface.mass.is_finite() {
        // A piston recoils, so the relative speed is drawn for the reduced mass, and the center of mass keeps
        // its velocity. Otherwise, the gas and the piston would be hotter than the wall.
        let share = surface.mass / (mass + surface.mass);
        let closing = surface.normal * (arriving.velocity - surface.velocity).dot(surface.normal);
        surface.velocity + (1.0 - share) * closing + outward * share.sqrt()
    } else {
        surface.velocity + outward
    };
    let along = surface.normal.perp();
    if thermal.slip() {
        let slip = along * (arriving.velocity - surface.velocity).dot(along);
        return Body { velocity: base + slip, ..*arriving };
    }
    let emitted = Body {
        velocity: base + along * (speed * normal(generator)),
        angular_velocity: (thermal.temperature() / inertia).sqrt() * normal(generator),
    };
    match surface.angular_velocity {
        0.0 => emitted,
        // The gas behind a turning wall turns with the wall: this is its velocity at the center of the disk.
        turning => Body {
            velocity: emitted.velocity + turning * radius * along,
            angular_velocity: emitted.angular_velocity + turning,
        },
    }
}

fn kinetic_energy(body: &Body, mass: f64, inertia: f64) -> f64 {
    0.5 * mass * body.velocity.length_squared()
        + 0.5 * inertia * body.angular_velocity * body.angular_velocity
}

/// Largest number of pushes, each twice as strong as the last, with which two partners are made to part. If
/// these fail, the pushes remain: about 4e-9 of the speeds.
const MOST_NUDGES: u32 = 24;

/// Closing speed after a collision, relative to the speeds of the disks, above which it is not a rounding
/// error: the rule leaves the disks approaching on purpose.
const WANTED: f64 = 1e-9;

impl<R: CollisionRule, B: Boundary, S: EventScheduler> Simulation<R, B, S> {
    /// Makes a disk leave a wall if the engine and the boundary disagree about its motion.
    ///
    /// Because its speed is rounded, a disk can part from the wall in the engine's arithmetic and approach it
    /// in the boundary's. A disk that rests on a wall does not part from it, and stays unchanged. The pushes
    /// are added to the collision, so that its impulse and energy are the impulse and energy that the disk
    /// receives.
    #[cold]
    #[inline(never)]
    pub(super) fn leave_wall(&mut self, disk: usize, wall: usize, collision: &mut Collision) {
        let now = self.engine.clock.now;
        for doubling in 0..MOST_NUDGES {
            let Forecast { exit, exit_due, wall: next, .. } = *self.engine.forecast(disk);
            if exit != Exit::Wall || exit_due > now || usize::from(next) != wall {
                return;
            }
            // The speed relative to the wall is a difference of speeds, so it has the rounding error of these
            // speeds.
            let fallen = self.engine.bodies.fall(now).1.length();
            let scale = f64::EPSILON * (self.engine.bodies.speed(disk) + fallen);
            let before = self.engine.bodies.velocity(disk, now);
            self.engine.bodies.push(disk, collision.normal * (f64::from(1_u32 << doubling) * scale), now);
            let after = self.engine.bodies.velocity(disk, now);
            collision.add_push(before, after, self.engine.bodies.material(disk).inverse_mass);
            self.find_next(disk);
        }
    }
}

impl Engine {
    /// Makes two disks part if their relative speed after a collision is zero, or if rounding lets them
    /// approach.
    ///
    /// Velocities are rounded relative to themselves, not to their difference. A rule that takes all of the
    /// closing speed leaves about 1e-17 of it, of either sign. Disks that touch and still approach collide
    /// immediately, again and again. Therefore, the speed at which the disks part is raised in steps of its
    /// rounding error, until the prediction sees them part.
    #[cold]
    #[inline(never)]
    pub(super) fn part(&mut self, disk: usize, partner: usize, normal: DVec2, left: f64) {
        let masses = [disk, partner].map(|disk| self.bodies.material(disk).inverse_mass);
        let (periods, now) = (self.cells.grid.periods, self.clock.now);
        let speed = self.bodies.speed(disk) + self.bodies.speed(partner);
        if left > WANTED * speed {
            return;
        }
        for doubling in 0..MOST_NUDGES {
            if !are_closing(&self.bodies, periods, disk, partner, now) {
                return;
            }
            let push = normal * (f64::from(1_u32 << doubling) * f64::EPSILON * speed);
            // The push is shared as an impulse would be, so that momentum is conserved.
            let total = masses[0] + masses[1];
            self.bodies.push(disk, push * (masses[0] / total), now);
            self.bodies.push(partner, -push * (masses[1] / total), now);
        }
    }
}
