//! A motion that begins at a later time.

use super::{AccelerationBounds, WallMotion, WallState};
use crate::quantity::finite;
use crate::{Fingerprint, ParameterError};

/// A motion that counts its phase from a start of its own, and not from time 0.
///
/// Where one base takes over from another one between runs, it begins at its own phase 0 then, and does not
/// jump. Before its start, it moves as it does after.
///
/// ```
/// use granular_edmd::wall::{BiParabolic, Delayed, WallMotion};
///
/// let base = Delayed::new(BiParabolic::new(0.1, 7.0)?, 30.0)?;
/// assert!(base.state(30.0).displacement.abs() < 1e-12);
/// assert!(base.state(30.0).velocity > 0.0);
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Delayed<M> {
    motion: M,
    start: f64,
    /// Phase of the motion at time 0.
    lead: f64,
}

impl<M: WallMotion> Delayed<M> {
    /// Lets a motion begin at this absolute time.
    ///
    /// # Errors
    /// If the time is not finite.
    pub fn new(motion: M, start: f64) -> Result<Self, ParameterError> {
        let start = finite("start of a motion", start)?;
        let lead = match motion.period() {
            // The remainder is exact, however late the start is. If it is 0, phases are the motion's own.
            Some(period) if start % period != 0.0 => period - start.rem_euclid(period),
            Some(_) => 0.0,
            None => -start,
        };
        Ok(Self { motion, start, lead })
    }

    /// Returns the motion.
    pub const fn motion(&self) -> &M {
        &self.motion
    }

    /// Returns the time at which it begins.
    pub const fn start(&self) -> f64 {
        self.start
    }
}

impl<M: WallMotion> WallMotion for Delayed<M> {
    fn state(&self, phase: f64) -> WallState {
        self.motion.state(phase + self.lead)
    }

    fn acceleration(&self, phase: f64) -> AccelerationBounds {
        let bounds = self.motion.acceleration(phase + self.lead);
        let until = bounds.until - self.lead;
        if until > phase {
            return AccelerationBounds::new(until, bounds.min, bounds.max);
        }
        // The sum was rounded to just before the end of a piece, so the next piece is meant.
        let next = self.motion.acceleration(bounds.until);
        AccelerationBounds::new(next.until - self.lead, next.min, next.max)
    }

    fn reach(&self) -> (f64, f64) {
        self.motion.reach()
    }

    fn period(&self) -> Option<f64> {
        self.motion.period()
    }

    fn fingerprint(&self) -> Option<Fingerprint> {
        Some(Fingerprint::of("Delayed").number(self.start).part(self.motion.fingerprint()?))
    }
}
