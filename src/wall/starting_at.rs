//! A motion whose phase counts from a given time.

use super::{AccelerationBounds, Motion, WallMotion, WallState};
use crate::quantity::finite;
use crate::{Fingerprint, ParameterError};

/// A motion whose phase counts from a given start instead of time 0.
///
/// A base that replaces another between runs can in this way begin at its own phase 0, without a jump. The
/// start is not a delay: before it, the wall goes through the phases before 0.
///
/// ```
/// use granular_edmd::wall::{BiParabolic, StartingAt, WallMotion};
///
/// let base = StartingAt::new(BiParabolic::new(0.1, 7.0)?, 30.0)?;
/// assert!(base.state(30.0).displacement.abs() < 1e-12);
/// assert!(base.state(30.0).velocity > 0.0);
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
#[derive(Debug, Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct StartingAt {
    motion: Motion,
    start: f64,
    /// Phase of the motion at time 0.
    #[cfg_attr(feature = "serde", serde(skip))]
    lead: f64,
}

impl StartingAt {
    /// Creates the motion that has phase 0 at this absolute time.
    ///
    /// # Errors
    /// If the time is not finite.
    pub fn new(motion: impl WallMotion + Send + Sync + 'static, start: f64) -> Result<Self, ParameterError> {
        Self::of(Motion::of(motion), start)
    }

    fn of(motion: Motion, start: f64) -> Result<Self, ParameterError> {
        let start = finite("start of a motion", start)?;
        let lead = match motion.period() {
            // The remainder is exact, however late the start is. If it is 0, the motion keeps its phases.
            Some(period) if start % period != 0.0 => period - start.rem_euclid(period),
            Some(_) => 0.0,
            None => -start,
        };
        Ok(Self { motion, start, lead })
    }

    /// Returns the absolute time at which the motion has phase 0.
    pub const fn start(&self) -> f64 {
        self.start
    }
}

impl WallMotion for StartingAt {
    fn state(&self, phase: f64) -> WallState {
        self.motion.state(late(&self.motion, phase, self.lead))
    }

    fn acceleration(&self, phase: f64) -> AccelerationBounds {
        late_bounds(&self.motion, phase, self.lead)
    }

    fn reach(&self) -> (f64, f64) {
        self.motion.reach()
    }

    fn period(&self) -> Option<f64> {
        self.motion.period()
    }

    fn jumps(&self) -> bool {
        self.motion.jumps()
    }

    fn fingerprint(&self) -> Option<Fingerprint> {
        Some(Fingerprint::of("StartingAt").number(self.start).part(self.motion.fingerprint()?))
    }
}

crate::gate::from_file! {
    StartingAt { motion: Motion, start: f64 } => Self::of(motion, start)
}

/// Largest number of pieces that may end within the rounding error of one phase.
const PIECES: u32 = 8;

/// Returns the bounds of a motion that is ahead by `lead`, at a phase.
pub(super) fn late_bounds(motion: &Motion, phase: f64, lead: f64) -> AccelerationBounds {
    let bounds = motion.acceleration(late(motion, phase, lead));
    AccelerationBounds::new(bounds.until - lead, bounds.min, bounds.max)
}

/// Returns the phase of a motion that is ahead by `lead`. If the sum was rounded to just before the end of a
/// piece, but the phase belongs to the next piece, the result is the start of the next piece.
pub(super) fn late(motion: &Motion, phase: f64, lead: f64) -> f64 {
    let mut late = phase + lead;
    for _ in 0..PIECES {
        let until = motion.acceleration(late).until;
        if until - lead > phase {
            break;
        }
        late = until;
    }
    late
}
