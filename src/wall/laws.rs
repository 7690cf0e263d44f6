//! Checks of a wall motion's contract, for custom motions.
//!
//! [`check`] tests the contract between two phases, except for fingerprints. [`check_finite`] tests only that
//! all numbers are finite and that pieces advance; a container runs this check on every motion.

use super::motion::{PART, check_constants, finite_bounds, finite_state, row_of_pieces};
use super::{AccelerationBounds, WallMotion, WallState, check_finite};
use crate::Violation;
use crate::error::require;

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

/// Allowed difference between the displacement and the integral of the velocity, relative to the distance
/// moved, and the number of samples in a piece near which the acceleration may jump.
const EXACT: f64 = 1e-8;
const JUMPS: u32 = 8;

/// Fraction of a piece over which the acceleration at its ends is first measured, and number of these
/// measurements, each over half of the previous fraction.
const SLOPE: f64 = 3e-4;
const STEPS: i32 = 12;

/// Checks that a motion keeps its contract between two phases.
///
/// The check samples each piece that begins between the phases. The state must be finite and within the
/// reach, and the bounds must hold for the change of the velocity between samples. The displacement must be
/// the integral of the velocity. Pieces must advance. The wall may jump only where a piece ends, only away
/// from the disks, and only if the motion declares jumps. The motion must repeat after its period, and return
/// the same values when it is called again. The check can miss a fault that is narrower than a five-hundredth
/// of a piece, so check a motion with one long piece in several short intervals. It refuses an interval of
/// more than ten thousand pieces. The page "Validation" says which planted faults the check finds.
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
    check_finite(motion)?;
    row_of_pieces(motion, from)?;
    let check = Check { motion, low, high, jumps: motion.jumps() };
    let mut phase = from;
    for _ in 0..MOST_PIECES {
        let until = check.piece(phase, to)?;
        if until >= to {
            return Ok(());
        }
        check.end(phase, until)?;
        phase = until;
    }
    let sentence = format!("{MOST_PIECES} pieces of its motion lead only from phase {from:?} to {phase:?}");
    Err(Violation::new(PART, "pieces", sentence))
}

/// The checked motion, and its reach.
struct Check<'a, M: ?Sized> {
    motion: &'a M,
    low: f64,
    high: f64,
    jumps: bool,
}

/// A phase, and the state at it.
#[derive(Debug, Clone, Copy, PartialEq)]
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
        let mut jumps = 0;
        let mut answers = vec![last];
        for k in 1..=SAMPLES {
            let share = if k == SAMPLES { 1.0 - LAST } else { f64::from(k) / f64::from(SAMPLES) };
            let next = self.sample(start + share * length)?;
            let bounds = finite_bounds(self.motion, last.phase)?;
            self.change(last, next, &whole)?;
            if next.phase <= bounds.until {
                self.change(last, next, &bounds)?;
            }
            if last.state.velocity * next.state.velocity < 0.0 {
                self.extreme(last, next)?;
            }
            jumps += u32::from(!self.is_integral(last, next, &whole)?);
            require!(PART, "displacement", jumps <= JUMPS;
                "between the phases {start:?} and {:?} its displacement is not the integral of its velocity",
                next.phase);
            self.repeats(last.phase + 0.37 * (next.phase - last.phase), length)?;
            answers.push(next);
            last = next;
        }
        self.strength(start, length, &whole)?;
        for sample in answers.iter().rev() {
            let again = self.sample(sample.phase)?;
            require!(PART, "repeatable", again == *sample; "{sample:?} is {again:?} when asked for again");
        }
        Ok(whole.until)
    }

    fn sample(&self, phase: f64) -> Result<Sample, Violation> {
        let state = finite_state(self.motion, phase)?;
        let (displacement, low, high) = (state.displacement, self.low, self.high);
        let slack = ROUNDING * self.length();
        let is_inside = displacement >= low - slack && displacement <= high + slack;
        require!(PART, "reach", is_inside;
            "at phase {phase:?} its displacement {displacement:?} is beyond its reach, {low:?} to {high:?}");
        Ok(Sample { phase, state })
    }

    /// Checks the reach where the velocity changes its sign between two samples.
    fn extreme(&self, from: Sample, to: Sample) -> Result<(), Violation> {
        let (mut low, mut high) = (from.phase, to.phase);
        for _ in 0..30 {
            let middle = self.sample(0.5 * (low + high))?;
            if middle.state.velocity * from.state.velocity > 0.0 {
                low = middle.phase;
            } else {
                high = middle.phase;
            }
        }
        Ok(())
    }

    /// Checks that an acceleration within the bounds can lead from one state to the other.
    fn change(&self, from: Sample, to: Sample, bounds: &AccelerationBounds) -> Result<(), Violation> {
        let wait = to.phase - from.phase;
        let gain = to.state.velocity - from.state.velocity;
        let (least, most) = (bounds.min * wait, bounds.max * wait);
        let slack = self.speed_rounding(from, bounds);
        let is_within = gain >= least - slack && gain <= most + slack;
        let [start, end] = [from.phase, to.phase];
        require!(PART, "bounds", is_within;
            "from phase {start:?} to {end:?} its velocity changes by {gain:?}, but the bounds of its \
             acceleration allow {least:?} to {most:?}");
        let rise = to.state.displacement - from.state.displacement;
        let expected = 0.5 * (from.state.velocity + to.state.velocity) * wait;
        // Given the first and the last velocity, the displacement is extreme if the acceleration is first at
        // one bound and then at the other. It then differs from the displacement at the mean velocity by the
        // area of a triangle, which is at most `spread`.
        let spread = 0.125 * (bounds.max - bounds.min) * wait * wait;
        let is_integral =
            (rise - expected).abs() <= spread + self.length_rounding(from, bounds) + slack * wait;
        require!(PART, "displacement", is_integral;
            "from phase {start:?} to {end:?} it advances by {rise:?}, but its velocity says {expected:?}");
        Ok(())
    }

    /// Returns whether the displacement between two samples is the integral of the velocity, as it is if the
    /// acceleration is smooth there (Simpson's rule).
    fn is_integral(&self, from: Sample, to: Sample, bounds: &AccelerationBounds) -> Result<bool, Violation> {
        let wait = to.phase - from.phase;
        // If the velocity changes much between samples, the rule is not exact enough.
        if 0.5 * (bounds.max - bounds.min) * wait > 0.05 * self.speed_scale(bounds) {
            return Ok(true);
        }
        let middle = self.sample(from.phase + 0.5 * wait)?.state.velocity;
        let (first, last) = (from.state.velocity, to.state.velocity);
        let expected = (first + 4.0 * middle + last) * wait / 6.0;
        let trapezoid = 0.5 * (first + last) * wait;
        let rise = to.state.displacement - from.state.displacement;
        let slack = EXACT * middle.abs() * wait
            + 0.01 * (expected - trapezoid).abs()
            + self.length_rounding(from, bounds)
            + self.speed_rounding(from, bounds) * wait;
        Ok((rise - expected).abs() <= slack)
    }

    /// Checks that the bounds hold for the acceleration at both ends of a piece, from the velocity there.
    ///
    /// The slope of the velocity is measured over ever shorter steps. Where the acceleration is smooth, half
    /// of a step leaves an error a quarter as large, so three slopes in a row show the error of the last: it
    /// is a fifteenth of the sum of their differences. If a step is not short enough for this, or the
    /// acceleration jumps within it, these differences are large. Twice their sum is allowed, plus the
    /// rounding error.
    fn strength(&self, start: f64, length: f64, bounds: &AccelerationBounds) -> Result<(), Violation> {
        if length < SHORT * (1.0 + start.abs()) {
            return Ok(());
        }
        let AccelerationBounds { min, max, .. } = *bounds;
        let end = start + (1.0 - LAST) * length;
        for (place, step) in [(start, SLOPE * length), (end, -SLOPE * length)] {
            let slope = |halvings: i32| self.slope(place, libm::scalbn(step, -halvings), bounds);
            let slopes = (0..STEPS).map(slope).collect::<Result<Vec<_>, _>>()?;
            for three in slopes.windows(3) {
                let [(first, _), (second, _), (slope, rounding)] = [three[0], three[1], three[2]];
                let slack = 2.0 * ((first - second).abs() + (second - slope).abs()) + rounding;
                let is_beyond = slope < min - slack || slope > max + slack;
                require!(PART, "bounds", !is_beyond;
                    "at phase {place:?} its velocity has the slope {slope:?} ± {slack:?}, beyond its bounds \
                     {min:?} and {max:?}");
            }
        }
        Ok(())
    }

    /// Returns the slope of the velocity at the start of two steps, exact if the acceleration is linear
    /// there, and the rounding error of the slope.
    fn slope(&self, place: f64, step: f64, bounds: &AccelerationBounds) -> Result<(f64, f64), Violation> {
        let [now, next, last] = [0.0, 1.0, 2.0].map(|count| place + count * step);
        let [now, next, last] = [self.sample(now)?, self.sample(next)?, self.sample(last)?];
        let step = next.phase - now.phase;
        let [here, there, far] = [now, next, last].map(|sample| sample.state.velocity);
        let rounding = 4.0 * self.speed_rounding(now, bounds) / step.abs();
        Ok(((4.0 * there - 3.0 * here - far) / (2.0 * step), rounding))
    }

    /// Checks that the wall does not jump toward the disks where a piece ends, and that the motion declares
    /// jumps.
    fn end(&self, start: f64, until: f64) -> Result<(), Violation> {
        let bounds = finite_bounds(self.motion, start)?;
        let before = self.sample(until - LAST * (until - start))?;
        let after = self.sample(until)?;
        let wait = until - before.phase;
        let jump = after.state.displacement - before.state.displacement - before.state.velocity * wait;
        let slack = bounds.min.abs().max(bounds.max.abs()) * wait * wait
            + self.length_rounding(before, &bounds)
            + self.speed_rounding(before, &bounds) * wait;
        require!(PART, "jump", jump <= slack;
            "at phase {until:?}, where a piece ends, it jumps toward the disks by {jump:?}");
        let is_told = self.jumps || jump >= -slack - 1e-6 * (self.high - self.low);
        require!(PART, "jump", is_told;
            "at phase {until:?} it jumps by {jump:?}, but says that it never jumps");
        Ok(())
    }

    /// Checks that the motion is the same some periods later, at a phase inside a piece of this length.
    fn repeats(&self, phase: f64, length: f64) -> Result<(), Violation> {
        let Some(period) = self.motion.period() else { return Ok(()) };
        // A piece as short as the rounding error of its times may be elsewhere, or missing, in the next
        // period.
        if length < SHORT * (phase.abs() + period) {
            return Ok(());
        }
        let (now, bounds) = (self.sample(phase)?, finite_bounds(self.motion, phase)?);
        for later in [1.0, 3.0, 17.0, 250.0].map(|count| phase + count * period) {
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
            require!(PART, "period", !differs;
                "with the period {period:?}, the state at phase {later:?} differs from the state at phase \
                 {phase:?}");
        }
        Ok(())
    }

    /// Returns the largest magnitude of a displacement within the reach.
    fn length(&self) -> f64 {
        self.low.abs().max(self.high.abs())
    }

    /// Returns the rounding error of a displacement: the error of its terms, plus the speed times the error
    /// of the phase.
    fn length_rounding(&self, sample: Sample, bounds: &AccelerationBounds) -> f64 {
        let speed = sample.state.velocity.abs() + self.speed_scale(bounds);
        ROUNDING * (self.length() + speed * sample.phase.abs())
    }

    /// Returns the rounding error of a velocity: the error of its terms, plus the acceleration times the
    /// error of the phase.
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
