//! One grain: a disk that moves and rotates.

use std::fmt;

use glam::DVec2;

use crate::ParameterError;
use crate::quantity::{accept, finite, positive};

/// Range of a radius, a mass or a temperature. Products and quotients of a few of them stay finite and
/// normal.
pub(crate) const SCALE: std::ops::RangeInclusive<f64> = 1e-30..=1e30;

/// Smallest velocity about a mean that counts as thermal, relative to all velocities. Below it, differences
/// of velocities are mostly rounding errors.
pub(crate) const LEAST_THERMAL: f64 = 1e-10;

/// Largest overlap that still counts as touching, relative to the distance between the centers at a touch.
/// Positions are rounded, so disks that touch can overlap by this much.
pub(crate) const TOUCHING: f64 = 1e-10;

/// Largest number of disks in a simulation.
pub(crate) const MOST_DISKS: usize = 1 << 28;

/// Largest id that a caller may give. All whole numbers up to it are exact as floating-point numbers.
pub(crate) const LARGEST_ID: u64 = 1 << 53;

/// Largest magnitude of a component of a position or velocity, and of an angular velocity.
pub(crate) const LARGEST: f64 = 1e60;

/// A rotating hard disk: position, velocity, angle, angular velocity, radius, mass, inertia factor, kind and
/// id.
///
/// The moment of inertia is $`I = \beta m R^2`$, where $`\beta = 1/2`$ unless another factor is given.
/// Lengths, times and masses are in any consistent units; the paper takes the diameter and the mass of a disk
/// as units.
///
/// ```
/// use granular_edmd::glam::DVec2;
/// use granular_edmd::Disk;
///
/// let disk = Disk::new(DVec2::new(3.0, 4.0), 0.5)?.with_velocity(DVec2::X)?.with_angular_velocity(2.0)?;
/// assert_eq!(disk.mass(), 1.0);
/// assert_eq!(disk.moment_of_inertia(), 0.125);
/// assert_eq!(disk.translational_energy() + disk.rotational_energy(), 0.75);
/// assert!(Disk::new(DVec2::ZERO, -0.5).is_err());
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Disk {
    position: DVec2,
    velocity: DVec2,
    angle: f64,
    angular_velocity: f64,
    radius: f64,
    mass: f64,
    inertia_factor: f64,
    kind: Kind,
    image: [i32; 2],
    id: u64,
}

impl Disk {
    /// Inertia factor of a homogeneous disk: β = 1/2 in I = β m R².
    pub const HOMOGENEOUS_INERTIA_FACTOR: f64 = 0.5;

    /// Creates a homogeneous disk of mass 1 at rest, of [`Kind::DEFAULT`].
    ///
    /// # Errors
    /// If a component of the position is not finite, or is above 1e60 in magnitude. Also if the radius is not
    /// in `[1e-30, 1e30]`.
    pub fn new(position: DVec2, radius: f64) -> Result<Self, ParameterError> {
        let position = bounded_vector("position", position)?;
        let disk =
            Self::at_rest(scale("radius", radius)?, 1.0, Self::HOMOGENEOUS_INERTIA_FACTOR, Kind::DEFAULT);
        Ok(Self { position, ..disk })
    }

    /// Returns the same disk at this position of its center.
    ///
    /// # Errors
    /// If a component is not finite, or above 1e60 in magnitude.
    pub fn with_position(self, position: DVec2) -> Result<Self, ParameterError> {
        Ok(Self { position: bounded_vector("position", position)?, ..self })
    }

    /// Returns the same disk with this velocity of its center.
    ///
    /// # Errors
    /// If a component is not finite, or above 1e60 in magnitude.
    pub fn with_velocity(self, velocity: DVec2) -> Result<Self, ParameterError> {
        Ok(Self { velocity: bounded_vector("velocity", velocity)?, ..self })
    }

    /// Returns the same disk turned to this angle, in radians, counterclockwise.
    ///
    /// # Errors
    /// If the angle is not finite. The angle may have any magnitude, since it grows during a run.
    pub fn with_angle(self, angle: f64) -> Result<Self, ParameterError> {
        Ok(Self { angle: finite("angle", angle)?, ..self })
    }

    /// Returns the same disk with this angular velocity, in radians per time, counterclockwise.
    ///
    /// # Errors
    /// If the angular velocity is not finite, or above 1e60 in magnitude.
    pub fn with_angular_velocity(self, angular_velocity: f64) -> Result<Self, ParameterError> {
        Ok(Self { angular_velocity: bounded("angular velocity", angular_velocity)?, ..self })
    }

    /// Returns the same disk with this radius. Its mass does not change.
    ///
    /// # Errors
    /// If the radius is not in `[1e-30, 1e30]`.
    pub fn with_radius(self, radius: f64) -> Result<Self, ParameterError> {
        Ok(Self { radius: scale("radius", radius)?, ..self })
    }

    /// Returns the same disk with this mass.
    ///
    /// # Errors
    /// If the mass is not in `[1e-30, 1e30]`.
    pub fn with_mass(self, mass: f64) -> Result<Self, ParameterError> {
        Ok(Self { mass: scale("mass", mass)?, ..self })
    }

    /// Returns the same disk with the moment of inertia I = β m R² for this factor β: 1/2 for a homogeneous
    /// disk, 1 for a ring.
    ///
    /// # Errors
    /// If the factor is not in `[1e-6, 1]`.
    pub fn with_inertia_factor(self, inertia_factor: f64) -> Result<Self, ParameterError> {
        let valid = (1e-6..=1.0).contains(&inertia_factor);
        let inertia_factor = accept(valid, "inertia factor", "in [1e-6, 1]", inertia_factor)?;
        Ok(Self { inertia_factor, ..self })
    }

    /// Returns the same disk with this kind.
    pub const fn with_kind(self, kind: Kind) -> Self {
        Self { kind, ..self }
    }

    /// Returns the same disk with these numbers of periods crossed to the right and up.
    pub const fn with_image(self, image: [i32; 2]) -> Self {
        Self { image, ..self }
    }

    /// Returns the same disk with this id, which identifies the disk as long as it exists.
    ///
    /// A simulation assigns ids, starting with 1, to the disks that have none, so few programs call this
    /// method. The id 0 means that the disk has no id yet.
    ///
    /// # Errors
    /// If the id is above 2^53. Ids stay exact in programs that read tables as floating-point numbers.
    pub fn with_id(self, id: u64) -> Result<Self, ParameterError> {
        accept(id <= LARGEST_ID, "id of a disk", "at most 2^53", id as f64)?;
        Ok(Self { id, ..self })
    }

    /// Returns the position of the center.
    pub const fn position(&self) -> DVec2 {
        self.position
    }

    /// Returns the velocity of the center.
    pub const fn velocity(&self) -> DVec2 {
        self.velocity
    }

    /// Returns the angle in radians, counterclockwise.
    pub const fn angle(&self) -> f64 {
        self.angle
    }

    /// Returns the angular velocity in radians per time, counterclockwise.
    pub const fn angular_velocity(&self) -> f64 {
        self.angular_velocity
    }

    /// Returns the radius.
    pub const fn radius(&self) -> f64 {
        self.radius
    }

    /// Returns the mass.
    pub const fn mass(&self) -> f64 {
        self.mass
    }

    /// Returns the inertia factor β in I = β m R².
    pub const fn inertia_factor(&self) -> f64 {
        self.inertia_factor
    }

    /// Returns the kind.
    pub const fn kind(&self) -> Kind {
        self.kind
    }

    /// Returns the numbers of periods that the disk has crossed to the right and up, minus the numbers
    /// crossed to the left and down.
    ///
    /// Each passage counts as one, even if the period has changed since. After 2³¹ passages the count
    /// continues at −2³¹.
    ///
    /// At periodic sides and ends, [`Domain::unwrapped`](crate::boundary::Domain::unwrapped) turns these
    /// numbers into a position that does not jump.
    pub const fn image(&self) -> [i32; 2] {
        self.image
    }

    /// Returns the id, which identifies the disk as long as it exists, or 0 before a simulation has assigned
    /// one.
    ///
    /// Unlike the index, it stays the same when other disks are removed. Checkpoints and files keep it, and a
    /// run never reuses the id of a removed disk.
    ///
    /// ```
    /// use granular_edmd::prelude::*;
    ///
    /// let disk = |x: f64| Disk::new(DVec2::new(x, 1.0), 0.5);
    /// let disks = [disk(1.0)?, disk(3.0)?, disk(5.0)?];
    /// let mut run = Simulation::builder(Elastic, Container::open(8.0)?).disks(disks).build()?;
    /// let removed = run.remove(|_, disk| disk.id() == 2)?;
    /// assert_eq!((removed[0].id(), run.disks()[1].id(), run.index_of(3)), (2, 3, Some(1)));
    /// run.insert([disk(3.0)?])?;
    /// assert_eq!(run.disks()[2].id(), 4);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub const fn id(&self) -> u64 {
        self.id
    }

    /// Returns the moment of inertia about the center, I = β m R².
    pub fn moment_of_inertia(&self) -> f64 {
        self.inertia_factor * self.mass * self.radius * self.radius
    }

    /// Returns the kinetic energy of the center, ½ m v².
    pub fn translational_energy(&self) -> f64 {
        0.5 * self.mass * self.velocity.length_squared()
    }

    /// Returns the kinetic energy of the rotation, ½ I ω².
    pub fn rotational_energy(&self) -> f64 {
        0.5 * self.moment_of_inertia() * self.angular_velocity * self.angular_velocity
    }

    /// Returns a disk at rest at the origin. The numbers must come from a disk that has passed the checks.
    #[inline]
    pub(crate) const fn at_rest(radius: f64, mass: f64, inertia_factor: f64, kind: Kind) -> Self {
        let (position, velocity) = (DVec2::ZERO, DVec2::ZERO);
        let (angle, angular_velocity, image, id) = (0.0, 0.0, [0; 2], 0);
        Self { position, velocity, angle, angular_velocity, radius, mass, inertia_factor, kind, image, id }
    }

    /// Returns the disk with the id that the engine gave it.
    pub(crate) const fn identified(self, id: u64) -> Self {
        Self { id, ..self }
    }

    /// Returns the disk with the motion that the engine computed for it. The engine has its own checks, so
    /// there are none here.
    pub(crate) fn with_motion(
        self,
        position: DVec2,
        velocity: DVec2,
        angle: f64,
        angular_velocity: f64,
    ) -> Self {
        Self { position, velocity, angle, angular_velocity, ..self }
    }
}

pub(crate) fn scale(name: &'static str, value: f64) -> Result<f64, ParameterError> {
    positive(name, value)?;
    accept(SCALE.contains(&value), name, "in [1e-30, 1e30]", value)
}

/// Checks that the engine can number `count` disks. An open container has room for any number, and a mistyped
/// number must not fill the memory.
pub(crate) fn countable(count: usize) -> Result<(), ParameterError> {
    accept(count <= MOST_DISKS, "number of disks", "at most 2^28", count as f64).map(drop)
}

pub(crate) fn bounded(name: &'static str, value: f64) -> Result<f64, ParameterError> {
    accept(value.abs() <= LARGEST, name, "finite and at most 1e60 in magnitude", value)
}

pub(crate) fn bounded_vector(name: &'static str, vector: DVec2) -> Result<DVec2, ParameterError> {
    Ok(DVec2::new(bounded(name, vector.x)?, bounded(name, vector.y)?))
}

/// Returns the disks with their ids, or with the ids 1, 2, 3, … if some have no id, because they do not come
/// from a simulation.
pub(crate) fn numbered(disks: &[Disk]) -> impl Iterator<Item = (u64, &Disk)> {
    let are_known = disks.iter().all(|disk| disk.id() != 0);
    disks.iter().zip(1_u64..).map(move |(disk, number)| (if are_known { disk.id() } else { number }, disk))
}

crate::gate::from_file! {
    Disk {
        position: DVec2, velocity: DVec2, angle: f64, angular_velocity: f64, radius: f64, mass: f64,
        inertia_factor: f64, #[serde(default)] kind: Kind, #[serde(default)] image: [i32; 2],
        #[serde(default)] id: u64
     } => Self::new(position, radius)?
            .with_velocity(velocity)?
            .with_angle(angle)?
            .with_angular_velocity(angular_velocity)?
            .with_mass(mass)?
            .with_inertia_factor(inertia_factor)
            .and_then(|disk| disk.with_kind(kind).with_image(image).with_id(id))
}

/// The kind (species, material) of a disk or a wall, as a number of your choice.
///
/// A kind changes nothing by itself: radius and mass belong to the disk. Rules find the kinds of both
/// partners in the [`Contact`](crate::collision::Contact), so steel and glass can have different friction
/// ([`RulesByKind`](crate::collision::RulesByKind)). Observers can be restricted to disks of one kind
/// ([`OfKind`](crate::observable::OfKind)). Disks have [`Kind::DEFAULT`] unless another is given, and walls
/// have [`Kind::WALL`].
///
/// ```
/// use granular_edmd::glam::DVec2;
/// use granular_edmd::{Disk, Kind};
///
/// const STEEL: Kind = Kind::new(1);
/// let ball = Disk::new(DVec2::ZERO, 0.5)?.with_kind(STEEL);
/// assert_eq!(ball.kind(), STEEL);
/// assert_eq!((STEEL.to_string(), Kind::WALL.to_string()), ("1".to_owned(), "wall".to_owned()));
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(transparent))]
pub struct Kind(u16);

impl Kind {
    /// The default kind of disks: number 0.
    pub const DEFAULT: Self = Self(0);

    /// The default kind of walls: number 65535.
    pub const WALL: Self = Self(u16::MAX);

    /// Creates the kind with this number.
    pub const fn new(number: u16) -> Self {
        Self(number)
    }

    /// Returns the number.
    pub const fn number(self) -> u16 {
        self.0
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        if *self == Self::WALL { formatter.write_str("wall") } else { self.0.fmt(formatter) }
    }
}
