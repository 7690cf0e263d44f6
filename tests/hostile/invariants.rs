//! The invariants that hold after every event, seen from outside.

use granular_edmd::Disk;
use granular_edmd::boundary::{Boundary, Probe};
use granular_edmd::collision::laws;
use granular_edmd::glam::DVec2;
use granular_edmd::observable::{Collision, Partner};
use proptest::prelude::*;

use crate::laws::{Kind, Law};
use crate::systems::Run;
use crate::walls::{Conduct, FASTEST, Walls};

type Verdict = Result<(), TestCaseError>;

/// Rounding of what a step computes, relative to the numbers that enter.
const ROUNDING: f64 = 1e-11;

/// Overlap that counts as touching: the engine keeps positions to some 1e-14 of the way since the epoch.
const TOUCHING: f64 = 1e-9;

/// Rounding of a position for each unit of speed, summed up. A disk that a moving wall drives into a corner
/// bounces 1e5 times at once, at speeds of thousands. Each bounce rounds its place to some 1e-16 of the way
/// since the epoch.
const CORNERING: f64 = 1e-11;

/// Speed of bounces that are lower than rounding.
const RESTING: f64 = 1e-7;

/// Returns the possible error of the present time. The time is given as a double, while the engine keeps more
/// digits.
fn time_error(run: &Run) -> f64 {
    4.0 * f64::EPSILON * run.time().abs()
}

/// Returns the distance from the origin to the farthest disk.
pub(crate) fn farthest(run: &Run) -> f64 {
    run.disks().iter().map(|disk| disk.position().length()).fold(0.0, f64::max)
}

/// Checks that all disks are finite, inside the domain and the walls, and apart. No disk has been farther
/// from the origin than `farthest`.
pub(crate) fn check_state(run: &Run, farthest: f64) -> Verdict {
    // A height has fewer digits where disks fall upward out of an open box.
    let touching = TOUCHING + 4.0 * f64::EPSILON * farthest;
    let mut boundary = run.boundary().clone();
    boundary.set_time_origin(run.time());
    let (domain, disks) = (boundary.domain(), run.disks());
    for (index, disk) in disks.iter().enumerate() {
        let (position, speed) = (disk.position(), disk.velocity().length());
        prop_assert!(is_finite(disk), "{disk:?}");
        let slack = touching + CORNERING * speed + time_error(run) * (speed + FASTEST);
        let inside = (domain.left - slack..=domain.right + slack).contains(&position.x)
            && (domain.bottom - slack..=domain.top + slack).contains(&position.y);
        prop_assert!(inside, "disk {index} escaped to {position} from {domain:?}");
        let wall = boundary.overlap(&Probe::new(position, disk.radius(), 0.0));
        prop_assert!(wall.is_none_or(|overlap| overlap.depth < slack), "disk {index} is in a wall: {wall:?}");
        for (other, second) in disks[..index].iter().enumerate() {
            let distance = domain.separation(position, second.position()).length();
            let overlap = disk.radius() + second.radius() - distance;
            prop_assert!(overlap < touching, "disks {other} and {index} overlap by {overlap:e}");
        }
    }
    prop_assert!(run.counters().max_overlap < touching, "{:?}", run.counters());
    Ok(())
}

fn is_finite(disk: &Disk) -> bool {
    let rotation = [disk.angle(), disk.angular_velocity()];
    disk.position().is_finite() && disk.velocity().is_finite() && rotation.iter().all(|part| part.is_finite())
}

/// The disks before and after an event.
pub(crate) struct Change<'a> {
    pub(crate) run: &'a Run,
    pub(crate) walls: &'a Walls,
    pub(crate) law: Law,
    pub(crate) before: &'a [Disk],
    pub(crate) after: &'a [Disk],
    /// Time from one to the other.
    pub(crate) elapsed: f64,
}

impl Change<'_> {
    /// Returns the velocity with which a disk came to the event.
    fn arriving(&self, disk: usize) -> DVec2 {
        self.before[disk].velocity() + self.run.gravity().acceleration() * self.elapsed
    }

    fn time_error(&self) -> f64 {
        time_error(self.run)
    }

    /// Checks that a disk without a collision flies freely: nothing else has touched it.
    pub(crate) fn check_flight(&self, disk: usize) -> Verdict {
        let (old, new) = (&self.before[disk], &self.after[disk]);
        let fall = 0.5 * self.run.gravity().acceleration() * self.elapsed * self.elapsed;
        let expected = old.position() + old.velocity() * self.elapsed + fall;
        let missed = self.run.boundary().domain().separation(expected, new.position()).length();
        let (way, speed) = (self.elapsed * old.velocity().length(), new.velocity().length());
        let slack = ROUNDING * (1.0 + new.position().length() + way) + self.time_error() * speed;
        prop_assert!(missed <= slack, "disk {disk} is off its flight by {missed:e}");
        self.check_velocity(disk, DVec2::ZERO)?;
        prop_assert_eq!(old.angular_velocity(), new.angular_velocity());
        Ok(())
    }

    /// Checks that the velocity of a disk has changed by this.
    fn check_velocity(&self, disk: usize, kick: DVec2) -> Verdict {
        let missed = (self.after[disk].velocity() - self.arriving(disk) - kick).length();
        let scale = self.before[disk].velocity().length() + self.after[disk].velocity().length();
        let slack = ROUNDING * (1.0 + scale) + self.time_error() * self.run.gravity().strength();
        prop_assert!(missed <= slack, "the velocity of disk {disk} is wrong by {missed:e}");
        Ok(())
    }

    /// Checks that a collision conserves momentum and angular momentum, and changes the energy as it reports
    /// and as its law allows.
    pub(crate) fn check_collision(&self, collision: &Collision) -> Verdict {
        prop_assert_eq!(collision.time, self.run.time());
        prop_assert!((collision.normal.length() - 1.0).abs() < ROUNDING, "{:?}", collision);
        match collision.partner {
            Partner::Disk(partner) => {
                self.check_kick(collision, collision.disk, 1.0)?;
                self.check_kick(collision, partner, -1.0)?;
                let told = collision.impulse.energy_change(&collision.contact);
                self.check_energy(collision, &[collision.disk, partner])?;
                prop_assert_eq!(collision.energy_change, told);
                check_law(collision, self.law)
            }
            Partner::Wall(wall) => {
                self.check_energy(collision, &[collision.disk])?;
                match self.walls.conduct(wall) {
                    Conduct::Thermal(_) => return Ok(()),
                    Conduct::Shared => check_law(collision, self.law)?,
                    Conduct::Own(law) => check_law(collision, law)?,
                }
                self.check_kick(collision, collision.disk, 1.0)
            }
        }
    }

    /// Checks that the disk got the impulse at the point of contact.
    fn check_kick(&self, collision: &Collision, disk: usize, sign: f64) -> Verdict {
        let (normal, tangential) = (collision.impulse.normal(), collision.impulse.tangential());
        let impulse = collision.normal * normal + collision.normal.perp() * tangential;
        let (old, new) = (&self.before[disk], &self.after[disk]);
        self.check_velocity(disk, sign * impulse / old.mass())?;
        let turned = new.angular_velocity() - old.angular_velocity();
        let expected = -tangential * old.radius() / old.moment_of_inertia();
        let slack = ROUNDING * (1.0 + old.angular_velocity().abs() + new.angular_velocity().abs());
        prop_assert!((turned - expected).abs() <= slack, "disk {disk} turns by {turned}, not {expected}");
        Ok(())
    }

    /// Checks that the energy of these disks changes as the collision reports.
    fn check_energy(&self, collision: &Collision, disks: &[usize]) -> Verdict {
        let (mut change, mut scale) = (0.0, f64::MIN_POSITIVE);
        for &disk in disks {
            let (old, new) = (&self.before[disk], &self.after[disk]);
            let came = 0.5 * old.mass() * self.arriving(disk).length_squared() + old.rotational_energy();
            let left = new.translational_energy() + new.rotational_energy();
            change += left - came;
            let fall = new.mass() * self.arriving(disk).length() * self.run.gravity().strength();
            scale += ROUNDING * (left + came) + fall * self.time_error();
        }
        let missed = (change - collision.energy_change).abs();
        prop_assert!(missed <= scale, "energy is off by {missed:e} of {change}: {collision:?}");
        Ok(())
    }
}

/// Checks that the law allows the impulse, and that no energy is lost if the law is elastic.
fn check_law(collision: &Collision, law: Law) -> Verdict {
    let contact = &collision.contact;
    if contact.closing_speed() <= 0.0 {
        // In bounces lower than rounding, the partners are almost at rest.
        prop_assert!(contact.closing_speed() > -RESTING, "partners that part collide: {collision:?}");
        return Ok(());
    }
    let verdict = laws::check_impulse(contact, collision.impulse);
    prop_assert!(verdict.is_ok(), "{verdict:?}: {collision:?}");
    if law.kind == Kind::Elastic {
        let change = collision.impulse.energy_change(contact).abs();
        prop_assert!(change <= 1e-12 * contact.available_energy(), "an elastic rule changes {change:e}");
    }
    Ok(())
}
