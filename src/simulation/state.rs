//! The state of a run: the disks on their flights, in the form that the hot loop needs, the next event of
//! each, and the time.
//!
//! Trajectories are kept in the free-fall frame of a common epoch. They consist of the position that a disk
//! would have had at the epoch (time offset 0) on its present flight, and of its velocity there, without
//! gravity. All disks fall alike and share the epoch, so the relative motion of a pair is a straight line,
//! and no disk needs its own clock. Predicting a pair costs a subtraction and a root, and a cell crossing
//! does not change the trajectory. The epoch moves forward at intervals ([`Bodies::shift`]), so that
//! extrapolation stays short and times keep their digits.

mod clock;
mod forecast;
mod guard;
mod population;

use glam::DVec2;

use crate::boundary::Domain;
use crate::collision::{Body, Material};
use crate::observable::Moving;
use crate::{Disk, Gravity};
pub(super) use clock::{Clock, Ledger};
pub(super) use forecast::{Earliest, Exit, Forecast};
pub(super) use guard::{FARTHEST, Standstill, effort, least_progress};
pub(super) use population::Identities;
use population::Properties;

/// A straight trajectory in the free-fall frame. One row is one 32-byte load.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(align(32))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Trajectory {
    pub(super) position: DVec2,
    pub(super) velocity: DVec2,
}

impl Trajectory {
    /// Returns the position in the free-fall frame at a time offset.
    #[inline]
    pub(super) fn at(&self, offset: f64) -> DVec2 {
        self.position + self.velocity * offset
    }

    /// Returns position and velocity in a row, for arithmetic on all four numbers together.
    #[inline]
    pub(super) fn row(&self) -> [f64; 4] {
        [self.position.x, self.position.y, self.velocity.x, self.velocity.y]
    }
}

/// The rotation of a disk, which only collisions change.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Spin {
    /// Angle at the epoch, extrapolated with the present rotation.
    pub(super) angle: f64,
    pub(super) angular_velocity: f64,
    /// Time offset of the last collision with anything.
    pub(super) last_collision: f64,
}

impl Spin {
    fn of(disk: &Disk) -> Self {
        Self {
            angle: disk.angle(),
            angular_velocity: disk.angular_velocity(),
            last_collision: f64::NEG_INFINITY,
        }
    }
}

/// All data of a disk that predictions need, in one cache line. In large systems, the time per event depends
/// on the number of cache lines that the event touches.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(align(64))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Particle {
    pub(super) trajectory: Trajectory,
    pub(super) forecast: Forecast,
}

impl Particle {
    /// Creates a particle with this trajectory, whose next event is not known.
    fn new(trajectory: Trajectory) -> Self {
        Self { trajectory, forecast: Forecast::NEW }
    }
}

#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Bodies {
    pub(super) particles: Vec<Particle>,
    pub(super) spins: Vec<Spin>,
    pub(super) gravity: Gravity,
    properties: Properties,
    /// Numbers of periods that each disk has crossed; empty as long as no disk has crossed a period.
    pub(super) images: Vec<[i32; 2]>,
    /// Typical diameter, in which the length of an epoch is measured.
    pub(super) typical_diameter: f64,
    pub(super) identities: Identities,
    /// Initial count of collisions of the next new disk. It is larger than the count of any disk that has
    /// held an index the new disk may get, so old predictions are recognized as outdated.
    pub(super) fresh_count: u32,
    /// True if disks were added or removed since the typical diameter was measured.
    has_changed: bool,
}

impl Bodies {
    pub(super) fn new(disks: &[Disk], gravity: Gravity) -> Self {
        let trajectory = |disk: &Disk| Trajectory { position: disk.position(), velocity: disk.velocity() };
        let particles = disks.iter().map(trajectory).map(Particle::new).collect();
        let spins = disks.iter().map(Spin::of).collect();
        let has_passed = disks.iter().any(|disk| disk.image() != [0; 2]);
        let images = if has_passed { disks.iter().map(Disk::image).collect() } else { Vec::new() };
        let properties = Properties::of(disks);
        let typical_diameter = properties.typical_diameter();
        let identities = Identities::new(disks);
        Self {
            particles,
            spins,
            gravity,
            properties,
            images,
            typical_diameter,
            identities,
            fresh_count: 0,
            has_changed: false,
        }
    }

    /// Returns whether all parts are as long as there are disks.
    #[cfg(feature = "serde")]
    pub(super) fn are_whole(&self) -> bool {
        let count = self.len();
        self.spins.len() == count
            && [0, count].contains(&self.images.len())
            && self.identities.suits(count)
            && self.properties.suits(count)
    }

    pub(super) fn len(&self) -> usize {
        self.particles.len()
    }

    /// Returns the next event of a disk, or `None` if there is no such disk.
    #[inline]
    pub(super) fn forecast(&self, disk: usize) -> Option<&Forecast> {
        self.particles.get(disk).map(|particle| &particle.forecast)
    }

    /// Sets the next collision of a disk.
    #[inline(always)]
    pub(super) fn expect(&mut self, disk: usize, earliest: Earliest) {
        let collisions = self.forecast(earliest.partner as usize).map_or(0, |partner| partner.collisions);
        self.particles[disk].forecast.set_collision(earliest, collisions);
    }

    /// Sets when and where the flight of a disk in its cell ends.
    #[inline(always)]
    pub(super) fn exit(&mut self, disk: usize, due: f64, exit: Exit) {
        let forecast = &mut self.particles[disk].forecast;
        (forecast.exit_due, forecast.exit) = (due, exit);
    }

    pub(super) fn id(&self, disk: usize) -> u64 {
        self.identities.of(disk)
    }

    /// Returns the speed in the free-fall frame, which is the scale of a velocity's rounding error.
    pub(super) fn speed(&self, disk: usize) -> f64 {
        self.particles[disk].trajectory.velocity.length()
    }

    #[inline]
    pub(super) fn radius(&self, disk: usize) -> f64 {
        self.properties.radius(disk)
    }

    #[inline]
    pub(super) fn material(&self, disk: usize) -> Material {
        self.properties.material(disk)
    }

    /// Returns the diameter, if all disks have the same one.
    #[inline]
    pub(super) fn common_diameter(&self) -> Option<f64> {
        self.properties.common_diameter()
    }

    /// Returns the displacement and velocity that gravity has added by this time offset.
    #[inline]
    pub(super) fn fall(&self, offset: f64) -> (DVec2, DVec2) {
        let velocity = self.gravity.acceleration() * offset;
        (0.5 * velocity * offset, velocity)
    }

    /// Returns the position in the frame of the container.
    #[inline]
    pub(super) fn position(&self, disk: usize, offset: f64) -> DVec2 {
        self.particles[disk].trajectory.at(offset) + self.fall(offset).0
    }

    /// Returns the velocity in the frame of the container.
    #[inline]
    pub(super) fn velocity(&self, disk: usize, offset: f64) -> DVec2 {
        self.particles[disk].trajectory.velocity + self.fall(offset).1
    }

    /// Returns the motion as a collision of two disks sees it, with velocities in the free-fall frame.
    #[inline]
    pub(super) fn body(&self, disk: usize) -> Body {
        Body {
            velocity: self.particles[disk].trajectory.velocity,
            angular_velocity: self.spins[disk].angular_velocity,
        }
    }

    /// Changes the motion of `disk` by a collision at this time offset. Its position at that time stays
    /// unchanged.
    #[inline]
    pub(super) fn kick(&mut self, disk: usize, change: &Body, offset: f64) {
        self.push(disk, change.velocity, offset);
        let spin = &mut self.spins[disk];
        spin.angular_velocity += change.angular_velocity;
        spin.angle -= change.angular_velocity * offset;
        spin.last_collision = offset;
    }

    /// Changes the velocity of `disk` at this time offset. Its position at that time stays unchanged.
    #[inline]
    pub(super) fn push(&mut self, disk: usize, velocity: DVec2, offset: f64) {
        let trajectory = &mut self.particles[disk].trajectory;
        let before = trajectory.velocity;
        trajectory.velocity += velocity;
        // The position is corrected with the change of the rounded velocity. With the unrounded change, the
        // disk would jump.
        trajectory.position -= (trajectory.velocity - before) * offset;
    }

    /// Brings a disk that has passed these numbers of periods back into the domain.
    #[inline]
    pub(super) fn bring_back(&mut self, disk: usize, passed: [i32; 2], periods: DVec2) {
        if passed != [0; 2] {
            self.bring_back_by(disk, passed, periods);
        }
    }

    #[cold]
    fn bring_back_by(&mut self, disk: usize, passed: [i32; 2], periods: DVec2) {
        self.particles[disk].trajectory.position -= periods * DVec2::from(passed.map(f64::from));
        self.images.resize(self.particles.len(), [0; 2]);
        let image = &mut self.images[disk];
        *image = [image[0].wrapping_add(passed[0]), image[1].wrapping_add(passed[1])];
    }

    #[inline]
    pub(super) fn moment_of_inertia(&self, disk: usize) -> f64 {
        self.properties.model(disk).moment_of_inertia()
    }

    /// Returns a disk at this time offset, as it appears in the public API.
    pub(super) fn disk(&self, disk: usize, offset: f64) -> Disk {
        let spin = &self.spins[disk];
        let image = self.images.get(disk).copied().unwrap_or_default();
        self.properties.model(disk).with_image(image).identified(self.id(disk)).with_motion(
            self.position(disk, offset),
            self.velocity(disk, offset),
            spin.angle + spin.angular_velocity * offset,
            spin.angular_velocity,
        )
    }

    /// Returns all disks at this time offset, as they appear in the public API.
    pub(super) fn disks(&self, offset: f64) -> Vec<Disk> {
        (0..self.len()).map(|disk| self.disk(disk, offset)).collect()
    }

    /// Returns the kinetic and potential energy of all disks, and the sum of the magnitudes of its terms,
    /// which bounds its rounding. Positions are unwrapped, so a disk that falls across a periodic edge keeps
    /// its energy.
    pub(super) fn energy(&self, offset: f64, domain: &Domain) -> [f64; 2] {
        let pull = self.gravity.acceleration();
        let disks = (0..self.len()).map(|disk| self.disk(disk, offset));
        disks.fold([0.0; 2], |[energy, size], disk| {
            let kinetic = disk.translational_energy() + disk.rotational_energy();
            let released = disk.mass() * pull.dot(domain.unwrapped(&disk));
            [energy + (kinetic - released), size + (kinetic + released.abs())]
        })
    }

    /// Moves the epoch forward by this time.
    pub(super) fn shift(&mut self, by: f64) {
        let (fallen, gained) = self.fall(by);
        for Particle { trajectory, forecast } in &mut self.particles {
            forecast.shift(by);
            trajectory.position = trajectory.at(by) + fallen;
            trajectory.velocity += gained;
        }
        for spin in &mut self.spins {
            spin.angle += spin.angular_velocity * by;
            spin.last_collision -= by;
        }
    }

    /// Replaces the present disks by the given ones, with their states at this time offset. The ids and
    /// last-collision times of the present disks are kept.
    pub(super) fn replace(&mut self, disks: &[Disk], offset: f64) {
        self.properties = Properties::of(disks);
        self.typical_diameter = self.properties.typical_diameter();
        if disks.iter().any(|disk| disk.image() != [0; 2]) || !self.images.is_empty() {
            self.images = disks.iter().map(Disk::image).collect();
        }
        let (fallen, gained) = self.fall(offset);
        for ((disk, particle), spin) in disks.iter().zip(&mut self.particles).zip(&mut self.spins) {
            let velocity = disk.velocity() - gained;
            let position = disk.position() - fallen - velocity * offset;
            particle.trajectory = Trajectory { position, velocity };
            let angle = disk.angle() - disk.angular_velocity() * offset;
            *spin = Spin { angle, angular_velocity: disk.angular_velocity(), ..*spin };
        }
    }

    /// Sets gravity to another value from this offset on. The motion at that time stays unchanged.
    pub(super) fn set_gravity(&mut self, gravity: Gravity, offset: f64) {
        let gained = (gravity.downward() - self.gravity.downward()) * offset;
        let pushed = (gravity.rightward() - self.gravity.rightward()) * offset;
        // The new flight leads to the same position and velocity under the new gravity.
        for particle in &mut self.particles {
            particle.trajectory.velocity.y += gained;
            particle.trajectory.position.y -= 0.5 * gained * offset;
            particle.trajectory.velocity.x -= pushed;
            particle.trajectory.position.x += 0.5 * pushed * offset;
        }
        self.gravity = gravity;
    }
}

impl Moving for Bodies {
    fn count(&self) -> usize {
        self.len()
    }

    fn copies(&self, offset: f64) -> Vec<Disk> {
        self.disks(offset)
    }
}
