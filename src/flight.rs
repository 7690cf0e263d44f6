//! Gravity, and free flight of a disk between two events.

use glam::DVec2;

use crate::disk::bounded;
use crate::quantity::accept;
use crate::{Kind, ParameterError};

/// Gravity: the constant acceleration of all disks in free flight.
///
/// A number stands for gravity that points down, or up if the number is negative; a vector stands for the
/// acceleration itself. Functions that take gravity accept both, and convert them.
///
/// ```
/// use granular_edmd::Gravity;
/// use granular_edmd::glam::DVec2;
///
/// assert_eq!(Gravity::from(2.0).acceleration(), DVec2::new(0.0, -2.0));
/// assert_eq!(Gravity::from(DVec2::new(0.3, -0.4)).downward(), 0.4);
/// // A chute that descends to the right by 30 degrees.
/// let slope = Gravity::tilted(1.0, 30_f64.to_radians())?;
/// assert!((slope.rightward() - 0.5).abs() < 1e-15);
/// assert!(Gravity::tilted(1.0, 30.0).is_err(), "degrees");
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
///
/// Each simulation checks its gravity, when it is built and in
/// [`set_gravity`](crate::Simulation::set_gravity).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct Gravity {
    rightward: f64,
    downward: f64,
}

impl Gravity {
    /// No gravity.
    pub const NONE: Self = Self { rightward: 0.0, downward: 0.0 };

    /// Returns the gravity of this strength in a box that is turned clockwise by `angle`, in radians, so that
    /// the floor descends to the right.
    ///
    /// # Errors
    /// If the angle is beyond a right angle in magnitude: it was probably meant in degrees, and gravity would
    /// pull the disks off the floor. A gravity vector may point in any direction.
    pub fn tilted(strength: f64, angle: f64) -> Result<Self, ParameterError> {
        let is_slope = angle.abs() <= std::f64::consts::FRAC_PI_2;
        accept(is_slope, "angle of a slope", "in radians, at most a right angle", angle)?;
        Ok(Self { rightward: strength * libm::sin(angle), downward: strength * libm::cos(angle) })
    }

    /// Returns the component that points to the right.
    #[inline]
    pub const fn rightward(self) -> f64 {
        self.rightward
    }

    /// Returns the component that points down.
    #[inline]
    pub const fn downward(self) -> f64 {
        self.downward
    }

    /// Returns the acceleration of a disk in free flight.
    #[inline]
    pub const fn acceleration(self) -> DVec2 {
        DVec2::new(self.rightward, -self.downward)
    }

    /// Returns the strength, which is not negative.
    pub fn strength(self) -> f64 {
        libm::hypot(self.rightward, self.downward)
    }

    /// Returns the same gravity with 0 for −0, or an error if a component is not finite or above 1e60 in
    /// magnitude.
    ///
    /// # Errors
    /// If a component is not finite, or above 1e60 in magnitude.
    pub fn checked(self) -> Result<Self, ParameterError> {
        // The time at which a disk leaves a cell contains a division by gravity. At zero gravity, the sign of
        // the resulting infinity decides whether a disk that rises ever comes back.
        let rightward = bounded("gravity to the right", self.rightward)?;
        Ok(Self { rightward: rightward + 0.0, downward: bounded("gravity", self.downward)? + 0.0 })
    }

    /// Returns the component of larger magnitude, for errors.
    pub(crate) fn larger(self) -> f64 {
        if self.rightward.abs() > self.downward.abs() { self.rightward } else { self.downward }
    }
}

impl From<f64> for Gravity {
    fn from(downward: f64) -> Self {
        Self { rightward: 0.0, downward }
    }
}

impl From<DVec2> for Gravity {
    fn from(acceleration: DVec2) -> Self {
        Self { rightward: acceleration.x, downward: -acceleration.y }
    }
}

/// The free flight of a disk at constant acceleration, from a given time on.
///
/// The center moves as $`\vec r(t) = \vec r_0 + \vec v_0 (t-t_0) + \tfrac12\vec a (t-t_0)^2`$. Times are
/// offsets from the time origin that the [`Boundary`](crate::boundary::Boundary) was last given.
///
/// ```
/// use granular_edmd::glam::DVec2;
/// use granular_edmd::Flight;
/// let flight = Flight::new(1.0, DVec2::ZERO, DVec2::new(1.0, 2.0), DVec2::new(0.0, -1.0), 0.5);
/// assert_eq!(flight.position(3.0), DVec2::new(2.0, 2.0));
/// assert_eq!(flight.velocity(3.0), DVec2::new(1.0, 0.0));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Flight {
    time: f64,
    position: DVec2,
    velocity: DVec2,
    acceleration: DVec2,
    radius: f64,
    kind: Kind,
}

impl Flight {
    /// Creates a flight of a disk of the default kind that starts at `time` with this position and velocity
    /// of the center.
    #[inline]
    pub const fn new(time: f64, position: DVec2, velocity: DVec2, acceleration: DVec2, radius: f64) -> Self {
        Self { time, position, velocity, acceleration, radius, kind: Kind::DEFAULT }
    }

    /// Returns the same flight of a disk of another kind.
    #[must_use]
    #[inline]
    pub const fn with_kind(self, kind: Kind) -> Self {
        Self { kind, ..self }
    }

    /// Returns the disk's kind, by which a boundary may decide whether to let the disk pass.
    #[inline]
    pub const fn kind(&self) -> Kind {
        self.kind
    }

    /// Returns the time at which the flight starts.
    #[inline]
    pub const fn time(&self) -> f64 {
        self.time
    }

    /// Returns the disk's radius.
    #[inline]
    pub const fn radius(&self) -> f64 {
        self.radius
    }

    /// Returns the acceleration, which is constant.
    #[inline]
    pub const fn acceleration(&self) -> DVec2 {
        self.acceleration
    }

    /// Returns the position of the center at `time`.
    #[inline]
    pub fn position(&self, time: f64) -> DVec2 {
        let elapsed = time - self.time;
        self.position + (self.velocity + 0.5 * elapsed * self.acceleration) * elapsed
    }

    /// Returns the velocity of the center at `time`.
    #[inline]
    pub fn velocity(&self, time: f64) -> DVec2 {
        self.velocity + (time - self.time) * self.acceleration
    }
}
