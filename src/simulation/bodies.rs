//! The moving disks, as the hot loop wants them.
//!
//! Trajectories are kept in the free-fall frame of a common epoch: the position that a disk would have had at the epoch
//! (time offset 0) on its present flight, and its velocity there, gravity left out. All disks fall alike, so the
//! relative motion of a pair is a straight line with no clock of its own: predicting a pair costs a subtraction and a
//! root, and passing a cell changes nothing. The epoch moves on now and then ([`Bodies::shift`]), so that extrapolation
//! stays short and times keep their digits.

use glam::DVec2;

use super::event::Slot;
use crate::Disk;
use crate::collision::{Body, Material};

/// How far a typical disk goes, or falls, in an epoch, in diameters.
const DIAMETERS: f64 = 64.0;

/// How much faster than the typical disk one may be before it decides how often the epoch moves.
const FASTER: f64 = 16.0;

/// A straight trajectory in the free-fall frame; one row is one 32-byte load.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(align(32))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Trajectory {
    pub(super) position: DVec2,
    pub(super) velocity: DVec2,
}

impl Trajectory {
    /// Position in the free-fall frame at a time offset.
    #[inline]
    pub(super) fn at(&self, offset: f64) -> DVec2 {
        self.position + self.velocity * offset
    }

    /// Position and velocity, for arithmetic on all four at once.
    #[inline]
    pub(super) fn row(&self) -> [f64; 4] {
        [self.position.x, self.position.y, self.velocity.x, self.velocity.y]
    }
}

#[cfg(feature = "serde")]
impl Trajectory {
    pub(super) fn is_finite(&self) -> bool {
        self.position.is_finite() && self.velocity.is_finite()
    }
}

/// What only collisions touch.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Spin {
    /// Angle at the epoch, on the present rotation.
    angle: f64,
    pub(super) angular_velocity: f64,
    /// Time offset of the last collision with anything.
    pub(super) last_collision: f64,
}

#[cfg(feature = "serde")]
impl Spin {
    /// Whether all is finite; the last collision may be infinitely long ago.
    pub(super) fn is_valid(&self) -> bool {
        self.angle.is_finite() && self.angular_velocity.is_finite() && self.last_collision < f64::INFINITY
    }
}

/// What predictions look at, one cache line for a disk: where large systems are slow, it is for the lines that an event touches.
#[derive(Debug, Clone, Copy)]
#[repr(align(64))]
pub(super) struct Particle {
    pub(super) trajectory: Trajectory,
    pub(super) slot: Slot,
}

impl Particle {
    /// A particle with this trajectory whose next event is not known.
    fn new(trajectory: Trajectory) -> Self {
        Self { trajectory, slot: Slot::NEW }
    }
}

#[derive(Debug, Clone)]
pub(super) struct Bodies {
    pub(super) particles: Vec<Particle>,
    pub(super) spins: Vec<Spin>,
    pub(super) gravity: f64,
    kinds: Kinds,
}

/// What does not change about a disk: radius, mass and inertia. Its motion is that of the start.
#[derive(Debug, Clone, Copy)]
struct Kind {
    disk: Disk,
    material: Material,
}

/// One kind for all disks where they are equal, so that it stays in cache.
#[derive(Debug, Clone)]
enum Kinds {
    Same(Kind),
    Each(Vec<Kind>),
}

impl Kinds {
    fn of(disks: &[Disk]) -> Self {
        let kind = |disk: &Disk| Kind { disk: *disk, material: Material::of(disk) };
        match disks.split_first() {
            Some((first, rest)) if rest.iter().all(|disk| is_alike(disk, first)) => Self::Same(kind(first)),
            _ => Self::Each(disks.iter().map(kind).collect()),
        }
    }

    #[inline]
    fn get(&self, disk: usize) -> &Kind {
        match self {
            Self::Same(kind) => kind,
            Self::Each(each) => &each[disk],
        }
    }
}

fn is_alike(disk: &Disk, other: &Disk) -> bool {
    let properties = |disk: &Disk| [disk.radius(), disk.mass(), disk.inertia_factor()];
    properties(disk) == properties(other)
}

impl Bodies {
    pub(super) fn new(disks: &[Disk], gravity: f64) -> Self {
        Self {
            particles: disks
                .iter()
                .map(|disk| Trajectory { position: disk.position(), velocity: disk.velocity() })
                .map(Particle::new)
                .collect(),
            spins: disks
                .iter()
                .map(|disk| Spin {
                    angle: disk.angle(),
                    angular_velocity: disk.angular_velocity(),
                    last_collision: f64::NEG_INFINITY,
                })
                .collect(),
            gravity,
            kinds: Kinds::of(disks),
        }
    }

    /// Bodies that go on where they were saved; disks that are all alike are one.
    #[cfg(feature = "serde")]
    pub(super) fn restored(
        kinds: &[Disk],
        gravity: f64,
        trajectories: &[Trajectory],
        slots: &[Slot],
        spins: Vec<Spin>,
    ) -> Self {
        let particle = |(&trajectory, &slot)| Particle { trajectory, slot };
        let particles = trajectories.iter().zip(slots).map(particle).collect();
        Self { particles, spins, gravity, kinds: Kinds::of(kinds) }
    }

    /// What [`Self::restored`] takes.
    #[cfg(feature = "serde")]
    pub(super) fn kinds(&self) -> Vec<Disk> {
        match &self.kinds {
            Kinds::Same(kind) => vec![kind.disk],
            Kinds::Each(each) => each.iter().map(|kind| kind.disk).collect(),
        }
    }

    pub(super) fn largest_radius(&self) -> f64 {
        match &self.kinds {
            Kinds::Same(kind) => kind.disk.radius(),
            Kinds::Each(each) => each.iter().map(|kind| kind.disk.radius()).fold(0.0, f64::max),
        }
    }

    pub(super) fn len(&self) -> usize {
        self.particles.len()
    }

    #[inline]
    pub(super) fn material(&self, disk: usize) -> &Material {
        &self.kinds.get(disk).material
    }

    /// The diameter, if all disks have the same.
    #[inline]
    pub(super) fn common_diameter(&self) -> Option<f64> {
        match &self.kinds {
            Kinds::Same(kind) => Some(2.0 * kind.material.radius),
            Kinds::Each(_) => None,
        }
    }

    /// Displacement and velocity that gravity has added by this time offset.
    #[inline]
    pub(super) fn fall(&self, offset: f64) -> (DVec2, DVec2) {
        let velocity = -self.gravity * offset;
        (DVec2::new(0.0, 0.5 * velocity * offset), DVec2::new(0.0, velocity))
    }

    /// Position in the frame of the container.
    #[inline]
    pub(super) fn position(&self, disk: usize, offset: f64) -> DVec2 {
        self.particles[disk].trajectory.at(offset) + self.fall(offset).0
    }

    /// Velocity in the frame of the container.
    #[inline]
    pub(super) fn velocity(&self, disk: usize, offset: f64) -> DVec2 {
        self.particles[disk].trajectory.velocity + self.fall(offset).1
    }

    /// Motion as a collision of two disks sees it: velocities in the free-fall frame.
    #[inline]
    pub(super) fn body(&self, disk: usize) -> Body {
        Body {
            velocity: self.particles[disk].trajectory.velocity,
            angular_velocity: self.spins[disk].angular_velocity,
        }
    }

    /// A collision at this time offset changes the motion of `disk`; where it is stays as it was.
    #[inline]
    pub(super) fn kick(&mut self, disk: usize, velocity: DVec2, angular_velocity: f64, offset: f64) {
        let trajectory = &mut self.particles[disk].trajectory;
        let before = trajectory.velocity;
        trajectory.velocity += velocity;
        // What the velocity changed by after rounding, or the disk would jump.
        trajectory.position -= (trajectory.velocity - before) * offset;
        let spin = &mut self.spins[disk];
        spin.angular_velocity += angular_velocity;
        spin.angle -= angular_velocity * offset;
        spin.last_collision = offset;
    }

    #[inline]
    pub(super) fn moment_of_inertia(&self, disk: usize) -> f64 {
        self.kinds.get(disk).disk.moment_of_inertia()
    }

    /// The disk as the outside world knows it.
    pub(super) fn disk(&self, disk: usize, offset: f64) -> Disk {
        let spin = &self.spins[disk];
        self.kinds.get(disk).disk.with_motion(
            self.position(disk, offset),
            self.velocity(disk, offset),
            spin.angle + spin.angular_velocity * offset,
            spin.angular_velocity,
        )
    }

    /// Moves the epoch by this much.
    pub(super) fn shift(&mut self, by: f64) {
        let (fallen, gained) = self.fall(by);
        for Particle { trajectory, slot } in &mut self.particles {
            slot.shift(by);
            trajectory.position = trajectory.at(by) + fallen;
            trajectory.velocity += gained;
        }
        for spin in &mut self.spins {
            spin.angle += spin.angular_velocity * by;
            spin.last_collision -= by;
        }
    }

    /// How far the epoch may be left behind: until a typical disk has gone, or fallen, some tens of diameters, and none
    /// [`FASTER`] times as far.
    pub(super) fn epoch_length(&self) -> f64 {
        let squares = || self.particles.iter().map(|particle| particle.trajectory.velocity.length_squared());
        let typical = (squares().sum::<f64>() / self.len() as f64).sqrt();
        self.epoch_length_at(typical.max(squares().fold(0.0, f64::max).sqrt() / FASTER))
    }

    /// Whether a disk goes further in an epoch of this length than any should: a collision can make it faster than all were.
    #[inline]
    pub(super) fn outruns(&self, disk: usize, epoch_length: f64) -> bool {
        let most = FASTER * DIAMETERS * 2.0 * self.material(0).radius;
        let way = self.particles[disk].trajectory.velocity * epoch_length;
        way.length_squared() > most * most
    }

    /// How far the epoch may be left behind for this disk.
    #[cold]
    pub(super) fn epoch_length_of(&self, disk: usize) -> f64 {
        self.epoch_length_at(self.particles[disk].trajectory.velocity.length() / FASTER)
    }

    /// A power of two, so that epochs add up without rounding.
    fn epoch_length_at(&self, speed: f64) -> f64 {
        if self.len() == 0 {
            return 1.0;
        }
        let diameter = 2.0 * self.material(0).radius;
        let length = DIAMETERS * diameter / (speed + (DIAMETERS * self.gravity.abs() * diameter).sqrt());
        if length.is_finite() && length > 0.0 {
            length.log2().floor().clamp(-900.0, 900.0).exp2()
        } else {
            1.0
        }
    }
}
