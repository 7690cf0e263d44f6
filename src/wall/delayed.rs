//! A motion that begins at a given time.

use super::starting_at::{late, late_bounds};
use super::{AccelerationBounds, Motion, WallMotion, WallState};
use crate::quantity::finite;
use crate::{Fingerprint, ParameterError};

/// A motion that begins at a given time; before this time, the wall is at rest.
///
/// With the start $`t_0`$, and $`z`$ the displacement of the motion,
///
/// ```math
/// z_d(t) = z(0)\quad (t < t_0),\qquad z_d(t) = z(t - t_0)\quad (t\ge t_0).
/// ```
///
/// [`StartingAt`](super::StartingAt) has no rest before the start. It also keeps all digits of late times: a
/// delayed motion has no period, so its phase is the time of the run.
///
/// ```
/// use granular_edmd::wall::{Delayed, Sinusoidal, WallMotion};
/// let base = Delayed::new(Sinusoidal::new(0.1, 10.0)?, 5.0)?;
/// assert_eq!((base.state(4.9).displacement, base.state(4.9).velocity), (0.0, 0.0));
/// assert_eq!(base.state(5.0).velocity, 1.0);
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
#[derive(Debug, Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Delayed {
    motion: Motion,
    start: f64,
}

impl Delayed {
    /// Creates the motion that has phase 0 at this time, and is at rest before it.
    ///
    /// # Errors
    /// If the time is not finite.
    pub fn new(motion: impl WallMotion + Send + Sync + 'static, start: f64) -> Result<Self, ParameterError> {
        Self::of(Motion::of(motion), start)
    }

    fn of(motion: Motion, start: f64) -> Result<Self, ParameterError> {
        Ok(Self { motion, start: finite("start of a motion", start)? })
    }

    /// Returns the time at which the motion begins.
    pub const fn start(&self) -> f64 {
        self.start
    }
}

impl WallMotion for Delayed {
    fn state(&self, phase: f64) -> WallState {
        if phase < self.start {
            return WallState::new(self.motion.state(0.0).displacement, 0.0);
        }
        self.motion.state(late(&self.motion, phase, -self.start))
    }

    fn acceleration(&self, phase: f64) -> AccelerationBounds {
        if phase < self.start {
            return AccelerationBounds::new(self.start, 0.0, 0.0);
        }
        late_bounds(&self.motion, phase, -self.start)
    }

    fn reach(&self) -> (f64, f64) {
        self.motion.reach()
    }

    fn jumps(&self) -> bool {
        self.motion.jumps()
    }

    fn fingerprint(&self) -> Option<Fingerprint> {
        Some(Fingerprint::of("Delayed").number(self.start).part(self.motion.fingerprint()?))
    }
}

crate::gate::from_file! {
    Delayed { motion: Motion, start: f64 } => Self::of(motion, start)
}
