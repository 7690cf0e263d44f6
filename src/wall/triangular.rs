//! The wall that moves up and down at constant speed.

use super::oscillation::{Oscillation, periodic, periodic_answers};
use super::stroke::{steady, stroke};
use super::{AccelerationBounds, WallMotion, WallState};

/// Triangular motion: from −A to A in half a period at constant speed, and back at the same speed.
///
/// The speed is $`2A\omega/\pi`$. At phase 0 the wall is in its middle position and rises, as in all
/// oscillations.
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

periodic!(Triangular);

impl WallMotion for Triangular {
    fn state(&self, phase: f64) -> WallState {
        stroke(phase, 0.5 * self.oscillation.period(), self.amplitude(), true)
    }

    fn acceleration(&self, phase: f64) -> AccelerationBounds {
        steady(phase, 0.5 * self.oscillation.period())
    }

    periodic_answers!("Triangular");
}
