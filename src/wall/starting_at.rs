//! A motion whose phase counts from a given time.

use super::{AccelerationBounds, WallMotion, WallState, jumps};
use crate::quantity::finite;
use crate::{Fingerprint, ParameterError};

/// A motion whose phase counts from a given start instead of time 0.
///
/// A base that replaces another between runs can in this way begin at its own phase 0, without a jump. The
/// start is no delay: before it, the wall goes through the phases before 0.
///
/// ```
/// use granular_edmd::wall::{BiParabolic, StartingAt, WallMotion};
///
/// let base = StartingAt::new(BiParabolic::new(0.1, 7.0)?, 30.0)?;
/// assert!(base.state(30.0).displacement.abs() < 1e-12);
/// assert!(base.state(30.0).velocity > 0.0);
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StartingAt<M> {
    motion: M,
    start: f64,
    /// Phase of the motion at time 0.
    lead: f64,
    jumps: bool,
}

impl<M: WallMotion> StartingAt<M> {
    /// Creates the motion that has phase 0 at this absolute time.
    ///
    /// # Errors
    /// If the time is not finite.
    pub fn new(motion: M, start: f64) -> Result<Self, ParameterError> {
        let start = finite("start of a motion", start)?;
        let lead = match motion.period() {
            // The remainder is exact, however late the start is. If it is 0, the phases are those of the
            // motion itself.
            Some(period) if start % period != 0.0 => period - start.rem_euclid(period),
            Some(_) => 0.0,
            None => -start,
        };
        let jumps = jumps(&motion);
        Ok(Self { motion, start, lead, jumps })
    }

    /// Returns the motion.
    pub const fn motion(&self) -> &M {
        &self.motion
    }

    /// Returns the absolute time at which the motion has phase 0.
    pub const fn start(&self) -> f64 {
        self.start
    }
}

impl<M: WallMotion> WallMotion for StartingAt<M> {
    fn state(&self, phase: f64) -> WallState {
        late_state(&self.motion, phase, self.lead, self.jumps)
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

    fn fingerprint(&self) -> Option<Fingerprint> {
        Some(Fingerprint::of("StartingAt").number(self.start).part(self.motion.fingerprint()?))
    }
}

/// Returns the state at a phase of a motion that is ahead by `lead`.
pub(super) fn late_state<M: WallMotion + ?Sized>(
    motion: &M,
    phase: f64,
    lead: f64,
    jumps: bool,
) -> WallState {
    let late = phase + lead;
    // As in `late_bounds`. A motion that does not jump has almost the same state in both pieces.
    let until = if jumps { motion.acceleration(late).until } else { f64::INFINITY };
    motion.state(if until - lead > phase { late } else { until })
}

/// Returns the bounds at a phase of a motion that is ahead by `lead`.
pub(super) fn late_bounds<M: WallMotion + ?Sized>(motion: &M, phase: f64, lead: f64) -> AccelerationBounds {
    let bounds = motion.acceleration(phase + lead);
    let until = bounds.until - lead;
    if until > phase {
        return AccelerationBounds::new(until, bounds.min, bounds.max);
    }
    // The sum was rounded to just before the end of a piece, but the phase belongs to the next piece.
    let next = motion.acceleration(bounds.until);
    AccelerationBounds::new(next.until - lead, next.min, next.max)
}
