//! The harmonic wall.

use super::oscillation::{Oscillation, piece};
use super::{AccelerationBounds, WallMotion, WallState};
use crate::{Fingerprint, ParameterError};

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

impl Sinusoidal {
    /// Creates a motion of this amplitude A and angular frequency ω.
    ///
    /// # Errors
    /// If a number is not finite and positive, or the period or the peak acceleration would not be.
    pub fn new(amplitude: f64, angular_frequency: f64) -> Result<Self, ParameterError> {
        Ok(Self { oscillation: Oscillation::new(amplitude, angular_frequency)? })
    }

    /// Returns the amplitude.
    pub const fn amplitude(&self) -> f64 {
        self.oscillation.amplitude()
    }

    /// Returns the angular frequency.
    pub const fn angular_frequency(&self) -> f64 {
        self.oscillation.angular_frequency()
    }

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

    fn reach(&self) -> (f64, f64) {
        (-self.amplitude(), self.amplitude())
    }

    fn period(&self) -> Option<f64> {
        Some(self.oscillation.period())
    }
    fn fingerprint(&self) -> Option<Fingerprint> {
        Some(self.oscillation.fingerprint("Sinusoidal"))
    }
}
