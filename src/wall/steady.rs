//! Walls that move at constant speed.

use super::oscillation::{Oscillation, is_even, piece};
use super::{AccelerationBounds, WallMotion, WallState};
use crate::ParameterError;

/// Triangular motion: from `$-A$` to `$A$` in half a period at constant speed, and back at the same speed.
///
/// The speed is `$2A\omega/\pi$`; at time 0 the wall is at its lowest and starts to rise.
///
/// ```
/// use granular_edmd::wall::{Triangular, WallMotion};
/// let base = Triangular::new(0.5, std::f64::consts::TAU)?;
/// assert_eq!(base.state(0.25).displacement, 0.0);
/// assert_eq!(base.state(0.25).velocity, 2.0);
/// assert_eq!(base.state(0.75).velocity, -2.0);
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(transparent))]
pub struct Triangular {
    oscillation: Oscillation,
}

/// Sawtooth motion: from `$-A$` to `$A$` in one period at constant speed, then instantly back to `$-A$`.
///
/// The speed is `$A\omega/\pi$`. A disk only ever meets the rising wall, as in the theory of fast vibrated gases.
///
/// ```
/// use granular_edmd::wall::{Sawtooth, WallMotion};
/// let base = Sawtooth::new(0.5, std::f64::consts::TAU)?;
/// assert_eq!(base.state(0.5).displacement, 0.0);
/// assert_eq!(base.state(1.0).displacement, -0.5);
/// assert_eq!(base.state(0.3).velocity, 1.0);
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(transparent))]
pub struct Sawtooth {
    oscillation: Oscillation,
}

impl Triangular {
    /// A motion of this amplitude `$A$` and angular frequency `$\omega$`.
    ///
    /// # Errors
    /// If one is not finite and positive.
    pub fn new(amplitude: f64, angular_frequency: f64) -> Result<Self, ParameterError> {
        Ok(Self { oscillation: Oscillation::new(amplitude, angular_frequency)? })
    }
}

impl Sawtooth {
    /// A motion of this amplitude `$A$` and angular frequency `$\omega$`.
    ///
    /// # Errors
    /// If one is not finite and positive.
    pub fn new(amplitude: f64, angular_frequency: f64) -> Result<Self, ParameterError> {
        Ok(Self { oscillation: Oscillation::new(amplitude, angular_frequency)? })
    }
}

/// Steady motion from `$-A$` to `$A$` (or back, for a negative amplitude) in pieces of time of this length.
fn stroke(time: f64, length: f64, amplitude: f64) -> WallState {
    let (number, _) = piece(time, length);
    let share = (time - number * length) / length;
    WallState { displacement: amplitude * (2.0 * share - 1.0), velocity: 2.0 * amplitude / length }
}

/// No acceleration until the stroke of this length ends.
fn steady(time: f64, length: f64) -> AccelerationBounds {
    AccelerationBounds { until: piece(time, length).1, min: 0.0, max: 0.0 }
}

impl WallMotion for Triangular {
    fn state(&self, time: f64) -> WallState {
        let length = 0.5 * self.oscillation.period();
        let rising = is_even(piece(time, length).0);
        let amplitude = self.oscillation.amplitude();
        stroke(time, length, if rising { amplitude } else { -amplitude })
    }

    fn acceleration(&self, time: f64) -> AccelerationBounds {
        steady(time, 0.5 * self.oscillation.period())
    }

    fn reach(&self) -> (f64, f64) {
        (-self.oscillation.amplitude(), self.oscillation.amplitude())
    }

    fn period(&self) -> Option<f64> {
        Some(self.oscillation.period())
    }
}

impl WallMotion for Sawtooth {
    fn state(&self, time: f64) -> WallState {
        stroke(time, self.oscillation.period(), self.oscillation.amplitude())
    }

    fn acceleration(&self, time: f64) -> AccelerationBounds {
        steady(time, self.oscillation.period())
    }

    fn reach(&self) -> (f64, f64) {
        (-self.oscillation.amplitude(), self.oscillation.amplitude())
    }

    fn period(&self) -> Option<f64> {
        Some(self.oscillation.period())
    }
}
