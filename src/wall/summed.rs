//! Sums of two motions.

use super::{AccelerationBounds, Motion, WallMotion, WallState};
use crate::quantity::finite;
use crate::{Fingerprint, ParameterError};

/// The sum of two motions.
///
/// Displacements, velocities and bounds on the acceleration add. A piece ends where a piece of either motion
/// ends. The sum has a period if one period is a whole multiple of the other, to the last bit, or if one of
/// the two motions never moves.
///
/// ```
/// use granular_edmd::wall::{Sinusoidal, Summed, WallMotion};
/// let (slow, fast) = (Sinusoidal::new(0.1, 10.0)?, Sinusoidal::new(0.02, 20.0)?);
/// let base = Summed::new(slow, fast)?;
/// assert_eq!(base.state(0.0).velocity, 0.1 * 10.0 + 0.02 * 20.0);
/// assert_eq!(base.period(), slow.period());
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
#[derive(Debug, Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Summed {
    first: Motion,
    second: Motion,
}

impl Summed {
    /// Creates the sum of two motions.
    ///
    /// # Errors
    /// If the sum of the smallest or of the largest displacements is not finite.
    pub fn new(
        first: impl WallMotion + Send + Sync + 'static,
        second: impl WallMotion + Send + Sync + 'static,
    ) -> Result<Self, ParameterError> {
        Self::of(Motion::of(first), Motion::of(second))
    }

    fn of(first: Motion, second: Motion) -> Result<Self, ParameterError> {
        let sum = Self { first, second };
        finite("smallest displacement of a sum", sum.reach().0)?;
        finite("largest displacement of a sum", sum.reach().1)?;
        Ok(sum)
    }
}

/// Returns the period of a motion, or 0 if it never moves.
fn period(motion: &Motion) -> Option<f64> {
    let (low, high) = motion.reach();
    if low == high { Some(0.0) } else { motion.period() }
}

impl WallMotion for Summed {
    fn state(&self, phase: f64) -> WallState {
        let (first, second) = (self.first.state(phase), self.second.state(phase));
        WallState::new(first.displacement + second.displacement, first.velocity + second.velocity)
    }

    fn acceleration(&self, phase: f64) -> AccelerationBounds {
        let (first, second) = (self.first.acceleration(phase), self.second.acceleration(phase));
        let until = first.until.min(second.until);
        AccelerationBounds::new(until, first.min + second.min, first.max + second.max)
    }

    fn reach(&self) -> (f64, f64) {
        let (first, second) = (self.first.reach(), self.second.reach());
        (first.0 + second.0, first.1 + second.1)
    }

    fn period(&self) -> Option<f64> {
        let (first, second) = (period(&self.first)?, period(&self.second)?);
        let (short, long) = (first.min(second), first.max(second));
        (long > 0.0 && (short == 0.0 || long % short == 0.0)).then_some(long)
    }

    fn jumps(&self) -> bool {
        self.first.jumps() || self.second.jumps()
    }

    fn fingerprint(&self) -> Option<Fingerprint> {
        let sum = Fingerprint::of("Summed").part(self.first.fingerprint()?);
        Some(sum.part(self.second.fingerprint()?))
    }
}

crate::gate::from_file! {
    Summed { first: Motion, second: Motion } => Self::of(first, second)
}
