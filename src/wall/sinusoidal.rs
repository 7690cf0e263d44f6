//! The harmonic wall.

use super::oscillation::{Oscillation, periodic, periodic_answers, piece};
use super::{AccelerationBounds, WallMotion, WallState};

/// Number of pieces of a period on which the acceleration is bounded. It is a multiple of four, so that the
/// acceleration is monotonic on each piece and the values at its ends are the bounds.
const PIECES: f64 = 16.0;

/// Harmonic motion, z(t) = A sin ωt.
///
/// ```
/// use granular_edmd::wall::{Sinusoidal, WallMotion};
/// let base = Sinusoidal::new(0.1, 10.0)?;
/// assert_eq!(base.state(0.0).velocity, 1.0);
/// assert_eq!(base.reach(), (-0.1, 0.1));
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(transparent))]
pub struct Sinusoidal {
    oscillation: Oscillation,
}

periodic!(Sinusoidal);

impl Sinusoidal {
    fn acceleration_at(&self, phase: f64) -> f64 {
        let frequency = self.angular_frequency();
        -self.amplitude() * frequency * frequency * libm::sin(frequency * phase)
    }
}

impl WallMotion for Sinusoidal {
    fn state(&self, phase: f64) -> WallState {
        let frequency = self.angular_frequency();
        let (sine, cosine) = libm::sincos(frequency * phase);
        WallState::new(self.amplitude() * sine, self.amplitude() * frequency * cosine)
    }

    fn acceleration(&self, phase: f64) -> AccelerationBounds {
        let length = self.oscillation.period() / PIECES;
        let (number, until) = piece(phase, length);
        let (start, end) = (self.acceleration_at(number * length), self.acceleration_at(until));
        AccelerationBounds::new(until, start.min(end), start.max(end))
    }

    periodic_answers!("Sinusoidal");
}
