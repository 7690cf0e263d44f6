//! Free flight of a disk between two events.

use glam::DVec2;

use crate::Kind;

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
