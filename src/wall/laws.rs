//! Checks of a wall motion's contract, for motions of your own.
//!
//! [`check`] tests the whole contract between two phases. [`check_finite`](super::check_finite) tests only
//! that all answers are finite and that pieces advance; a container does this with every motion that it is
//! given.

use super::finite::{check_constants, finite_bounds, finite_state, row_of_pieces};
use super::{AccelerationBounds, Violation, WallMotion, WallState};

/// Number of samples in a piece.
const SAMPLES: u32 = 512;

/// Largest number of pieces that the check follows.
const MOST_PIECES: u32 = 10_000;

/// Allowed rounding, relative to the lengths and speeds from which a number is computed.
const ROUNDING: f64 = 256.0 * f64::EPSILON;

/// Fraction of a piece that is left after its last sample, since the state may jump at the end of a piece.
const LAST: f64 = 1.0 / (1u64 << 20) as f64;

/// Length below which a piece may be an artifact of rounding, relative to its phase and the period.
const SHORT: f64 = 1e-9;

/// Checks that a motion keeps its contract between two phases.
///
/// The check samples each piece that begins between the phases. The state must be finite and within the
/// reach, and the bounds must hold for the change of the velocity between samples. The displacement must be
/// the integral of the velocity. Pieces must advance, and the wall may jump only where one ends, and away
/// from the disks. The motion must repeat after its period. The check can miss a fault that is narrower than
/// a five-hundredth of a piece, so check a motion with one long piece on several short stretches. It refuses
/// a stretch of more than ten thousand pieces.
///
/// # Errors
/// The first violation that the check finds.
///
/// ```
/// use granular_edmd::wall::{AccelerationBounds, Sinusoidal, WallMotion, WallState, laws};
///
/// /// A sine with a mistake in its velocity.
/// struct Mistaken(Sinusoidal);
///
/// impl WallMotion for Mistaken {
///     fn state(&self, phase: f64) -> WallState {
///         let state = self.0.state(phase);
///         WallState::new(state.displacement, 0.9 * state.velocity)
///     }
///     fn acceleration(&self, phase: f64) -> AccelerationBounds {
///         self.0.acceleration(phase)
///     }
///     fn reach(&self) -> (f64, f64) {
///         self.0.reach()
///     }
/// }
///
/// let sine = Sinusoidal::new(0.1, 10.0)?;
/// assert_eq!(laws::check(&sine, -1.0, 3.0), Ok(()));
/// assert!(laws::check(&Mistaken(sine), -1.0, 3.0).is_err());
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
pub fn check<M: WallMotion + ?Sized>(motion: &M, from: f64, to: f64) -> Result<(), Violation> {
    let (low, high) = check_constants(motion)?;
    row_of_pieces(motion, from)?;
    let check = Check { motion, low, high };
    let mut phase = from;
    for _ in 0..MOST_PIECES {
        let until = check.piece(phase, to)?;
        if until >= to {
            return Ok(());
        }
        check.end(phase, until)?;
        phase = until;
    }
    Err(Violation::ShortPieces { phase: from, until: phase, pieces: MOST_PIECES })
}

/// A motion and its reach, under the check.
struct Check<'a, M: ?Sized> {
    motion: &'a M,
    low: f64,
    high: f64,
}

/// A phase, and the state at it.
#[derive(Clone, Copy)]
struct Sample {
    phase: f64,
    state: WallState,
}

impl<M: WallMotion + ?Sized> Check<'_, M> {
    /// Checks the piece that begins here, up to `to` at most, and returns its end.
    fn piece(&self, start: f64, to: f64) -> Result<f64, Violation> {
        let whole = finite_bounds(self.motion, start)?;
        let length = whole.until.min(to) - start;
        let mut last = self.sample(start)?;
        for k in 1..=SAMPLES {
            let share = if k == SAMPLES { 1.0 - LAST } else { f64::from(k) / f64::from(SAMPLES) };
            let next = self.sample(start + share * length)?;
            let bounds = finite_bounds(self.motion, last.phase)?;
            self.change(last, next, &whole)?;
            if next.phase <= bounds.until {
                self.change(last, next, &bounds)?;
            }
            self.repeats(last.phase + 0.37 * (next.phase - last.phase), length)?;
            last = next;
        }
        Ok(whole.until)
    }

    fn sample(&self, phase: f64) -> Result<Sample, Violation> {
        let state = finite_state(self.motion, phase)?;
        let (displacement, low, high) = (state.displacement, self.low, self.high);
        let slack = ROUNDING * self.length();
        if displacement < low - slack || displacement > high + slack {
            return Err(Violation::OutOfReach { phase, displacement, low, high });
        }
        Ok(Sample { phase, state })
    }

    /// Checks that an acceleration within the bounds can lead from one state to the other.
    fn change(&self, from: Sample, to: Sample, bounds: &AccelerationBounds) -> Result<(), Violation> {
        let wait = to.phase - from.phase;
        let gain = to.state.velocity - from.state.velocity;
        let (least, most) = (bounds.min * wait, bounds.max * wait);
        let slack = self.speed_rounding(from, bounds);
        if gain < least - slack || gain > most + slack {
            return Err(Violation::Velocity { from: from.phase, to: to.phase, gain, least, most });
        }
        let rise = to.state.displacement - from.state.displacement;
        let expected = 0.5 * (from.state.velocity + to.state.velocity) * wait;
        // Given the first and the last velocity, the displacement is extreme if the acceleration is first at
        // one bound and then at the other. It then differs from the displacement at the mean velocity by the
        // area of a triangle, which is at most `spread`.
        let spread = 0.125 * (bounds.max - bounds.min) * wait * wait;
        if (rise - expected).abs() > spread + self.length_rounding(from, bounds) + slack * wait {
            return Err(Violation::Displacement { from: from.phase, to: to.phase, rise, expected });
        }
        Ok(())
    }

    /// Checks that the wall does not jump toward the disks where a piece ends.
    fn end(&self, start: f64, until: f64) -> Result<(), Violation> {
        let bounds = finite_bounds(self.motion, start)?;
        let before = self.sample(until - LAST * (until - start))?;
        let after = self.sample(until)?;
        let wait = until - before.phase;
        let jump = after.state.displacement - before.state.displacement - before.state.velocity * wait;
        let slack = bounds.min.abs().max(bounds.max.abs()) * wait * wait
            + self.length_rounding(before, &bounds)
            + self.speed_rounding(before, &bounds) * wait;
        if jump > slack { Err(Violation::Jump { phase: until, jump }) } else { Ok(()) }
    }

    /// Checks that the motion is the same some periods later, at a phase inside a piece of this length.
    fn repeats(&self, phase: f64, length: f64) -> Result<(), Violation> {
        let Some(period) = self.motion.period() else { return Ok(()) };
        // A piece as short as the rounding of its times may be elsewhere, or missing, in the next period.
        if length < SHORT * (phase.abs() + period) {
            return Ok(());
        }
        let (now, bounds) = (self.sample(phase)?, finite_bounds(self.motion, phase)?);
        for later in [phase + period, phase + 3.0 * period] {
            let (then, then_bounds) = (self.sample(later)?, finite_bounds(self.motion, later)?);
            let moved = (then.state.displacement - now.state.displacement).abs();
            let gained = (then.state.velocity - now.state.velocity).abs();
            let strength = bounds.min.abs().max(bounds.max.abs());
            let changed = (then_bounds.min - bounds.min).abs().max((then_bounds.max - bounds.max).abs());
            let differs = moved > self.length_rounding(then, &bounds)
                || gained > self.speed_rounding(then, &bounds)
                // The times at which pieces end are rounded. The bounds there change with the third
                // derivative, which the motion does not provide.
                || changed > 1e-6 * strength;
            if differs {
                return Err(Violation::Period { phase, period, later });
            }
        }
        Ok(())
    }

    /// Returns the largest magnitude of a displacement within the reach.
    fn length(&self) -> f64 {
        self.low.abs().max(self.high.abs())
    }

    /// Returns the rounding of a displacement: that of its terms, and that of the phase at this speed.
    fn length_rounding(&self, sample: Sample, bounds: &AccelerationBounds) -> f64 {
        let speed = sample.state.velocity.abs() + self.speed_scale(bounds);
        ROUNDING * (self.length() + speed * sample.phase.abs())
    }

    /// Returns the rounding of a velocity: that of its terms, and that of the phase at this acceleration.
    fn speed_rounding(&self, sample: Sample, bounds: &AccelerationBounds) -> f64 {
        let acceleration = bounds.min.abs().max(bounds.max.abs());
        let speed = sample.state.velocity.abs() + self.speed_scale(bounds);
        ROUNDING * (speed + acceleration * sample.phase.abs())
    }

    /// Returns the speed that the acceleration builds up over the reach of the motion. The terms of a
    /// velocity are no smaller than this, even where the velocity passes through zero.
    fn speed_scale(&self, bounds: &AccelerationBounds) -> f64 {
        (bounds.min.abs().max(bounds.max.abs()) * (self.high - self.low)).sqrt()
    }
}
