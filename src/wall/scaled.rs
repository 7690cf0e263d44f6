//! A motion enlarged, reduced or reversed by a factor.

use super::{AccelerationBounds, Motion, WallMotion, WallState};
use crate::quantity::{accept, finite};
use crate::{Fingerprint, ParameterError};

/// A motion times a factor. The factor −1 mirrors it.
///
/// Displacement, velocity and acceleration are multiplied by the factor.
///
/// ```
/// use granular_edmd::wall::{Scaled, Sinusoidal, WallMotion};
/// let mirrored = Scaled::new(Sinusoidal::new(0.1, 10.0)?, -1.0)?;
/// assert_eq!(mirrored.state(0.0).velocity, -1.0);
/// assert_eq!(Scaled::new(mirrored, -2.0)?.reach(), (-0.2, 0.2));
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
#[derive(Debug, Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Scaled {
    motion: Motion,
    factor: f64,
}

impl Scaled {
    /// Creates the motion times this factor.
    ///
    /// # Errors
    /// If the factor or the largest displacement is not finite. Also if the factor is negative and the motion
    /// jumps, as a [`Sawtooth`](super::Sawtooth) does, since it would jump into disks.
    pub fn new(motion: impl WallMotion + Send + Sync + 'static, factor: f64) -> Result<Self, ParameterError> {
        Self::of(Motion::of(motion), factor)
    }

    pub(crate) fn of(motion: Motion, factor: f64) -> Result<Self, ParameterError> {
        finite("factor of a motion", factor)?;
        accept(factor >= 0.0 || !motion.jumps(), "factor of a motion that jumps", "not negative", factor)?;
        let scaled = Self { motion, factor };
        finite("smallest displacement of a scaled motion", scaled.reach().0)?;
        finite("largest displacement of a scaled motion", scaled.reach().1)?;
        Ok(scaled)
    }

    /// Returns the factor.
    pub const fn factor(&self) -> f64 {
        self.factor
    }

    /// Returns both ends of a range times the factor, in order.
    fn scale(&self, low: f64, high: f64) -> (f64, f64) {
        let (low, high) = (self.factor * low, self.factor * high);
        if self.factor < 0.0 { (high, low) } else { (low, high) }
    }
}

impl WallMotion for Scaled {
    fn state(&self, phase: f64) -> WallState {
        let state = self.motion.state(phase);
        WallState::new(self.factor * state.displacement, self.factor * state.velocity)
    }

    fn acceleration(&self, phase: f64) -> AccelerationBounds {
        let bounds = self.motion.acceleration(phase);
        let (min, max) = self.scale(bounds.min, bounds.max);
        AccelerationBounds::new(bounds.until, min, max)
    }

    fn reach(&self) -> (f64, f64) {
        let (low, high) = self.motion.reach();
        self.scale(low, high)
    }

    fn period(&self) -> Option<f64> {
        self.motion.period()
    }

    fn jumps(&self) -> bool {
        self.factor != 0.0 && self.motion.jumps()
    }

    fn fingerprint(&self) -> Option<Fingerprint> {
        // A mirrored motion keeps the fingerprint that existing checkpoints contain.
        let is_mirrored = self.factor == -1.0;
        let name = if is_mirrored {
            Fingerprint::of("Mirrored")
        } else {
            Fingerprint::of("Scaled").number(self.factor)
        };
        Some(name.part(self.motion.fingerprint()?))
    }
}

crate::gate::from_file! {
    Scaled { motion: Motion, factor: f64 } => Self::of(motion, factor)
}
