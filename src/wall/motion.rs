//! Motions in owned form, forwarding, and checks: finite numbers, and pieces that advance.

use std::any::Any;
use std::fmt;
use std::ops::Deref;
use std::sync::Arc;

use super::{AccelerationBounds, Fixed, Stroke, WallMotion, WallState};
use crate::error::require;
use crate::forward::forward;
use crate::{Fingerprint, Violation};

forward! { WallMotion for [&T, Box<T>, Arc<T>] {
    fn state(&self, phase: f64) -> WallState;
    fn acceleration(&self, phase: f64) -> AccelerationBounds;
    fn reach(&self) -> (f64, f64);
    fn period(&self) -> Option<f64>;
    fn jumps(&self) -> bool;
    fn fingerprint(&self) -> Option<Fingerprint>;
}}

/// A motion whose type can be found at run time, since files hold motions of the crate's types.
pub(crate) trait Owned: WallMotion + Any + Send + Sync {}

impl<M: WallMotion + Any + Send + Sync> Owned for M {}

/// A motion of any type.
#[derive(Clone)]
pub(crate) struct Motion(Arc<dyn Owned>);

impl Motion {
    /// Wraps a motion that passes `check_finite`, or returns the violation.
    pub(crate) fn new<M: WallMotion + Send + Sync + 'static>(motion: M) -> Result<Self, Violation> {
        check_finite(&motion)?;
        Ok(Self::of(motion))
    }

    /// Wraps a motion that is checked elsewhere.
    pub(crate) fn of<M: WallMotion + Send + Sync + 'static>(motion: M) -> Self {
        Self(Arc::new(motion))
    }

    /// Returns the motion of a wall that stays at its position.
    pub(crate) fn none() -> Self {
        Self::of(Fixed)
    }

    /// Returns the motion as a value of unknown type.
    pub(super) fn as_any(&self) -> &dyn Any {
        &*self.0
    }

    /// Returns the piston, if the motion is one.
    pub(crate) fn stroke(&self) -> Option<&Stroke> {
        self.as_any().downcast_ref()
    }

    /// Changes the motion of a piston. Returns whether the motion is a piston's.
    pub(crate) fn change(&mut self, change: impl FnOnce(&Stroke) -> Stroke) -> bool {
        let Some(changed) = self.stroke().map(change) else { return false };
        *self = Self::of(changed);
        true
    }

    /// Returns the phase at a time origin: the origin less whole periods.
    pub(crate) fn phase(&self, origin: f64) -> f64 {
        let (low, high) = self.reach();
        match self.period() {
            // A wall that never moves has the same position at all times. At phase 0, times lose none of
            // their digits. A piston knows its origin itself.
            _ if low == high || self.stroke().is_some() => 0.0,
            // The remainder of two floats is exact, so the phase keeps all its digits, however late the time.
            Some(period) => origin % period,
            None => origin,
        }
    }
}

impl Deref for Motion {
    type Target = dyn Owned;

    #[inline]
    fn deref(&self) -> &Self::Target {
        &*self.0
    }
}

impl fmt::Debug for Motion {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_struct("Motion").field("reach", &self.reach()).finish_non_exhaustive()
    }
}

pub(super) const PART: &str = "wall motion";

/// Number of pieces in a row that together must advance by more than rounding.
const PIECES_IN_A_ROW: u32 = 8;

/// Phases at which a motion without a period is tested.
const PROBES: [f64; 9] = [0.0, 1e-3, 0.1, 1.0, 10.0, 1e2, 1e3, 1e4, 1e6];

/// Checks that a motion gives finite numbers and that its pieces advance.
///
/// Every run depends on both.
///
/// The check tries phases in the first period, or between 0 and a million for a motion without a period.
///
/// # Errors
/// The first violation that the check finds.
///
/// ```
/// use granular_edmd::wall::{AccelerationBounds, Fixed, WallMotion, WallState, check_finite};
///
/// /// A motion that divides zero by zero.
/// struct Torn;
///
/// impl WallMotion for Torn {
///     fn state(&self, phase: f64) -> WallState {
///         WallState::new(phase.sin() / phase, 0.0)
///     }
///     fn acceleration(&self, _: f64) -> AccelerationBounds {
///         AccelerationBounds::new(f64::INFINITY, -1.0, 1.0)
///     }
///     fn reach(&self) -> (f64, f64) {
///         (-1.0, 1.0)
///     }
/// }
///
/// assert_eq!(check_finite(&Fixed), Ok(()));
/// assert_eq!(check_finite(&Torn).unwrap_err().found(), "at phase 0.0 its displacement is NaN");
/// ```
pub fn check_finite<M: WallMotion + ?Sized>(motion: &M) -> Result<(), Violation> {
    check_constants(motion)?;
    match motion.period() {
        Some(period) => (0..64).try_for_each(|k| row_of_pieces(motion, period * f64::from(k) / 64.0)),
        None => PROBES.iter().try_for_each(|&phase| row_of_pieces(motion, phase)),
    }
}

/// Checks the reach and the period, and returns the reach.
pub(super) fn check_constants<M: WallMotion + ?Sized>(motion: &M) -> Result<(f64, f64), Violation> {
    let (low, high) = motion.reach();
    let is_ordered = low.is_finite() && high.is_finite() && low <= high;
    require!(PART, "reach", is_ordered; "its reach from {low:?} to {high:?} must be finite and in order");
    let period = motion.period().unwrap_or(1.0);
    let is_possible = period.is_finite() && period > 0.0;
    require!(PART, "period", is_possible; "its period must be finite and positive, but is {period:?}");
    Ok((low, high))
}

/// Follows some pieces from this phase on, and also checks the middle of each piece.
pub(super) fn row_of_pieces<M: WallMotion + ?Sized>(motion: &M, start: f64) -> Result<(), Violation> {
    let mut phase = start;
    for _ in 0..PIECES_IN_A_ROW {
        finite_state(motion, phase)?;
        let until = finite_bounds(motion, phase)?.until;
        if until == f64::INFINITY {
            return Ok(());
        }
        finite_state(motion, phase + 0.5 * (until - phase))?;
        phase = until;
    }
    // The row must advance by more than two floating-point numbers for each piece. No search can follow
    // shorter pieces.
    let least = (0..2 * PIECES_IN_A_ROW).fold(start, |phase, _| phase.next_up());
    require!(PART, "pieces", phase > least;
        "{PIECES_IN_A_ROW} pieces of its motion lead only from phase {start:?} to {phase:?}: they are too short");
    Ok(())
}

pub(super) fn finite_state<M: WallMotion + ?Sized>(motion: &M, phase: f64) -> Result<WallState, Violation> {
    let state = motion.state(phase);
    finite("displacement", state.displacement, phase)?;
    finite("velocity", state.velocity, phase)?;
    Ok(state)
}

/// Returns the bounds at this phase, if they are finite, in order, and hold for some time.
pub(super) fn finite_bounds<M: WallMotion + ?Sized>(
    motion: &M,
    phase: f64,
) -> Result<AccelerationBounds, Violation> {
    let bounds = motion.acceleration(phase);
    finite("lower bound of the acceleration", bounds.min, phase)?;
    finite("upper bound of the acceleration", bounds.max, phase)?;
    let AccelerationBounds { until, min, max } = bounds;
    require!(PART, "bounds", min <= max;
        "at phase {phase:?} its lower bound of the acceleration {min:?} is above the upper one, {max:?}");
    require!(PART, "pieces", until > phase;
        "the piece of its motion from phase {phase:?} on ends at {until:?}, which is not later");
    Ok(bounds)
}

fn finite(quantity: &str, value: f64, phase: f64) -> Result<(), Violation> {
    require!(PART, "finite", value.is_finite(); "at phase {phase:?} its {quantity} is {value:?}");
    Ok(())
}
