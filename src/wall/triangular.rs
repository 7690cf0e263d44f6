//! The wall that moves up and down at constant speed.

use super::oscillation::Oscillation;
use super::stroke::{steady, stroke};
use super::{AccelerationBounds, WallMotion, WallState};
use crate::{Fingerprint, ParameterError};

/// Triangular motion: from −A to A in half a period at constant speed, and back at the same speed.
///
/// The speed is $`2A\omega/\pi`$. At phase 0 the wall is in its middle and rises, as in all oscillations.
///
/// ```
/// use granular_edmd::wall::{Triangular, WallMotion};
/// let base = Triangular::new(0.5, std::f64::consts::TAU)?;
/// assert_eq!(base.state(0.0).displacement, 0.0);
/// assert_eq!(base.state(0.125).displacement, 0.25);
/// assert_eq!(base.state(0.0).velocity, 2.0);
/// assert_eq!(base.state(0.5).velocity, -2.0);
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(transparent))]
pub struct Triangular {
    oscillation: Oscillation,
}

impl Triangular {
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

impl WallMotion for Triangular {
    fn state(&self, phase: f64) -> WallState {
        stroke(phase, 0.5 * self.oscillation.period(), self.amplitude(), true)
    }

    fn acceleration(&self, phase: f64) -> AccelerationBounds {
        steady(phase, 0.5 * self.oscillation.period())
    }

    fn reach(&self) -> (f64, f64) {
        (-self.amplitude(), self.amplitude())
    }

    fn period(&self) -> Option<f64> {
        Some(self.oscillation.period())
    }

    fn fingerprint(&self) -> Option<Fingerprint> {
        Some(self.oscillation.fingerprint("Triangular"))
    }
}
