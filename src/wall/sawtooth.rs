//! The wall that rises at constant speed and jumps back.

use super::oscillation::Oscillation;
use super::stroke::{steady, stroke};
use super::{AccelerationBounds, WallMotion, WallState};
use crate::{Fingerprint, ParameterError};

/// Sawtooth motion: from −A to A in one period at constant speed, then instantly back to −A.
///
/// The speed is $`A\omega/\pi`$. At phase 0 the wall is in its middle, and half a period later it jumps. A
/// disk always meets the rising wall, as in the theory of gases on fast vibrating walls.
///
/// ```
/// use granular_edmd::wall::{Sawtooth, WallMotion};
/// let base = Sawtooth::new(0.5, std::f64::consts::TAU)?;
/// assert_eq!(base.state(0.0).displacement, 0.0);
/// assert_eq!(base.state(0.5).displacement, -0.5);
/// assert_eq!(base.state(0.3).velocity, 1.0);
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(transparent))]
pub struct Sawtooth {
    oscillation: Oscillation,
}

impl Sawtooth {
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
}

impl WallMotion for Sawtooth {
    fn state(&self, phase: f64) -> WallState {
        stroke(phase, self.oscillation.period(), self.amplitude(), false)
    }

    fn acceleration(&self, phase: f64) -> AccelerationBounds {
        steady(phase, self.oscillation.period())
    }

    fn reach(&self) -> (f64, f64) {
        (-self.amplitude(), self.amplitude())
    }

    fn period(&self) -> Option<f64> {
        Some(self.oscillation.period())
    }

    fn fingerprint(&self) -> Option<Fingerprint> {
        Some(self.oscillation.fingerprint("Sawtooth"))
    }
}
