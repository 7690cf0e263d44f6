//! Sums of motions, each scaled and shifted in time.

use super::{AccelerationBounds, Motion, WallMotion, WallState};
use crate::quantity::{accept, finite};
use crate::{Fingerprint, ParameterError};

/// A sum of motions, each with a factor and a start of its own.
///
/// With the factors $`f_i`$, the starts $`t_i`$ and the displacements $`z_i`$,
///
/// ```math
/// z(t) = \sum_i f_i\,z_i(t - t_i) ,
/// ```
///
/// where a [delayed](Self::delayed_until) motion rests until its start. Each method applies to all motions
/// that were combined before.
///
/// ```
/// use granular_edmd::wall::{Combined, Sinusoidal, WallMotion};
///
/// // Two frequencies, which begin at time 50 and are mirrored.
/// let (slow, fast) = (Sinusoidal::new(0.1, 10.0)?, Sinusoidal::new(0.02, 20.0)?);
/// let both = Combined::new(slow).plus(fast)?;
/// assert_eq!(both.period(), slow.period());
/// let base = both.delayed_until(50.0)?.scaled(-1.0)?;
/// assert_eq!((base.state(49.9).displacement, base.state(49.9).velocity), (0.0, 0.0));
/// assert_eq!(base.state(50.0).velocity, -(0.1 * 10.0 + 0.02 * 20.0));
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
#[derive(Debug, Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Combined {
    terms: Vec<Term>,
}

/// A motion in a sum.
#[derive(Debug, Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
struct Term {
    motion: Motion,
    factor: f64,
    /// Absolute time of phase 0.
    start: f64,
    /// Absolute time until which the wall rests.
    rest_until: Option<f64>,
    /// Phase of the motion at time 0.
    #[cfg_attr(feature = "serde", serde(skip))]
    lead: f64,
}

impl Combined {
    /// Creates a sum of this motion alone.
    pub fn new(motion: impl WallMotion + Send + Sync + 'static) -> Self {
        Self::of(Motion::of(motion))
    }

    /// Creates a sum of a motion, or of the terms of a sum, so that the bits do not depend on the nesting.
    pub(crate) fn of(motion: Motion) -> Self {
        if let Some(sum) = motion.held().as_any().downcast_ref::<Self>() {
            return sum.clone();
        }
        Self { terms: vec![Term { motion, factor: 1.0, start: 0.0, rest_until: None, lead: 0.0 }] }
    }

    /// Adds another motion.
    ///
    /// Displacements, velocities and bounds on the acceleration add. The sum has a period if each period is a
    /// whole multiple of the shorter ones, to the last bit.
    ///
    /// # Errors
    /// If the sum of the smallest or of the largest displacements is not finite.
    pub fn plus(mut self, motion: impl WallMotion + Send + Sync + 'static) -> Result<Self, ParameterError> {
        self.terms.extend(Self::new(motion).terms);
        self.checked()
    }

    /// Multiplies the motion by a factor. The factor −1 mirrors it.
    ///
    /// # Errors
    /// If the factor or the largest displacement is not finite. Also if the factor is negative and the motion
    /// jumps, as a [`Sawtooth`](super::Sawtooth) does, since it would jump into disks.
    pub fn scaled(mut self, factor: f64) -> Result<Self, ParameterError> {
        finite("factor of a motion", factor)?;
        for term in &mut self.terms {
            term.factor *= factor;
        }
        self.checked()
    }

    /// Lets the phase count from this absolute time instead of 0.
    ///
    /// A base that replaces another between runs can in this way begin at its own phase 0, without a jump.
    /// The start is not a delay: before it, the wall goes through the phases before 0.
    ///
    /// # Errors
    /// If the time is not finite.
    ///
    /// ```
    /// use granular_edmd::wall::{BiParabolic, Combined, WallMotion};
    ///
    /// let base = Combined::new(BiParabolic::new(0.1, 7.0)?).starting_at(30.0)?;
    /// assert!(base.state(30.0).displacement.abs() < 1e-12);
    /// assert!(base.state(30.0).velocity > 0.0);
    /// # Ok::<(), granular_edmd::ParameterError>(())
    /// ```
    pub fn starting_at(mut self, time: f64) -> Result<Self, ParameterError> {
        for term in &mut self.terms {
            term.start += time;
            term.rest_until = term.rest_until.map(|until| until + time);
        }
        self.checked()
    }

    /// Lets the motion begin at this absolute time. Before it, the wall rests at the displacement of phase 0.
    ///
    /// A delayed motion has no period, so its phase is the time of the run;
    /// [`starting_at`](Self::starting_at) keeps all digits of late times.
    ///
    /// # Errors
    /// If the time is not finite.
    pub fn delayed_until(mut self, time: f64) -> Result<Self, ParameterError> {
        for term in &mut self.terms {
            term.start += time;
            term.rest_until = Some(time + term.rest_until.map_or(0.0, |until| until.max(0.0)));
        }
        self.checked()
    }

    /// Checks all numbers, and finds the phases at time 0.
    fn checked(mut self) -> Result<Self, ParameterError> {
        for term in &mut self.terms {
            finite("start of a motion", term.start)?;
            finite("rest of a motion", term.rest_until.unwrap_or_default())?;
            finite("factor of a motion", term.factor)?;
            let is_safe = term.factor >= 0.0 || !term.motion.jumps();
            accept(is_safe, "factor of a motion that jumps", "not negative", term.factor)?;
            term.lead = term.lead();
        }
        finite("smallest displacement of a motion", self.reach().0)?;
        finite("largest displacement of a motion", self.reach().1)?;
        Ok(self)
    }
}

impl WallMotion for Combined {
    fn state(&self, phase: f64) -> WallState {
        let sum = |a: WallState, b: WallState| {
            WallState::new(a.displacement + b.displacement, a.velocity + b.velocity)
        };
        let states = self.terms.iter().map(|term| term.state(phase));
        states.reduce(sum).unwrap_or(WallState::new(0.0, 0.0))
    }

    fn acceleration(&self, phase: f64) -> AccelerationBounds {
        let sum = |a: AccelerationBounds, b: AccelerationBounds| {
            AccelerationBounds::new(a.until.min(b.until), a.min + b.min, a.max + b.max)
        };
        let bounds = self.terms.iter().map(|term| term.acceleration(phase));
        bounds.reduce(sum).unwrap_or(AccelerationBounds::new(f64::INFINITY, 0.0, 0.0))
    }

    fn reach(&self) -> (f64, f64) {
        let reaches = self.terms.iter().map(Term::reach);
        reaches.reduce(|a, b| (a.0 + b.0, a.1 + b.1)).unwrap_or((0.0, 0.0))
    }

    fn period(&self) -> Option<f64> {
        let common = self.terms.iter().try_fold(0.0, |common: f64, term| {
            let (short, long) = (common.min(term.period()?), common.max(term.period()?));
            (short == 0.0 || long % short == 0.0).then_some(long)
        })?;
        (common > 0.0).then_some(common)
    }

    fn jumps(&self) -> bool {
        self.terms.iter().any(|term| term.factor != 0.0 && term.motion.jumps())
    }

    fn fingerprint(&self) -> Option<Fingerprint> {
        self.terms.iter().try_fold(Fingerprint::of("Combined"), |sum, term| {
            let rest = term.rest_until.unwrap_or(f64::NEG_INFINITY);
            Some(sum.part(term.motion.fingerprint()?).number(term.factor).number(term.start).number(rest))
        })
    }
}

impl Term {
    fn lead(&self) -> f64 {
        match self.motion.period().filter(|_| self.rest_until.is_none()) {
            // The remainder is exact, however late the start is. If it is 0, the motion keeps its phases.
            Some(period) if self.start % period != 0.0 => period - self.start.rem_euclid(period),
            Some(_) => 0.0,
            None => -self.start,
        }
    }

    /// Returns the time until which the wall rests, if that is later than this phase.
    fn rest(&self, phase: f64) -> Option<f64> {
        self.rest_until.filter(|&until| phase < until)
    }

    fn state(&self, phase: f64) -> WallState {
        let state = match self.rest(phase) {
            Some(until) => WallState::new(self.motion.state(until - self.start).displacement, 0.0),
            None => self.motion.state(self.late(phase)),
        };
        WallState::new(self.factor * state.displacement, self.factor * state.velocity)
    }

    fn acceleration(&self, phase: f64) -> AccelerationBounds {
        if let Some(until) = self.rest(phase) {
            return AccelerationBounds::new(until, 0.0, 0.0);
        }
        let bounds = self.motion.acceleration(self.late(phase));
        let (min, max) = self.scale(bounds.min, bounds.max);
        AccelerationBounds::new(bounds.until - self.lead, min, max)
    }

    fn reach(&self) -> (f64, f64) {
        let (low, high) = self.motion.reach();
        self.scale(low, high)
    }

    /// Returns the period, or 0 if the wall never moves.
    fn period(&self) -> Option<f64> {
        let (low, high) = self.motion.reach();
        if low == high { Some(0.0) } else { self.motion.period().filter(|_| self.rest_until.is_none()) }
    }

    /// Returns both ends of a range times the factor, in order.
    fn scale(&self, low: f64, high: f64) -> (f64, f64) {
        let (low, high) = (self.factor * low, self.factor * high);
        if self.factor < 0.0 { (high, low) } else { (low, high) }
    }

    /// Returns the phase of the motion. If the sum was rounded to just before the end of a piece, but the
    /// phase belongs to the next piece, the result is the start of the next piece.
    fn late(&self, phase: f64) -> f64 {
        /// Largest number of pieces that may end within the rounding error of one phase.
        const PIECES: u32 = 8;
        let mut late = phase + self.lead;
        for _ in 0..PIECES {
            let until = self.motion.acceleration(late).until;
            if until - self.lead > phase {
                break;
            }
            late = until;
        }
        late
    }
}

crate::gate::from_file! {
    Combined { terms: Vec<Term> } => Self { terms }.checked()
}

crate::gate::from_file! {
    Term { motion: Motion, factor: f64, start: f64, rest_until: Option<f64> } =>
        Ok(Self { motion, factor, start, rest_until, lead: 0.0 })
}
