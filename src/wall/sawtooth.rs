//! The wall that rises at constant speed and jumps back.

use super::oscillation::{Oscillation, periodic, periodic_answers};
use super::stroke::{steady, stroke};
use super::{AccelerationBounds, WallMotion, WallState};

/// Sawtooth motion: from −A to A in one period at constant speed, then instantly back to −A.
///
/// The speed is $`A\omega/\pi`$. At phase 0 the wall is in its middle position, and half a period later it
/// jumps. A disk always meets the rising wall, as in the theory of gases on fast vibrating walls.
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

periodic!(Sawtooth);

impl WallMotion for Sawtooth {
    fn state(&self, phase: f64) -> WallState {
        stroke(phase, self.oscillation.period(), self.amplitude(), false)
    }

    fn acceleration(&self, phase: f64) -> AccelerationBounds {
        steady(phase, self.oscillation.period())
    }

    fn jumps(&self) -> bool {
        true
    }

    periodic_answers!("Sawtooth");
}
