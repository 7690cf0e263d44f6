//! Motions in owned form, and forwarding: a boxed or borrowed motion is a motion, too.

use super::{AccelerationBounds, Fixed, Stroke, WallMotion, WallState, check_finite};
use crate::forward::forward;
use crate::{Fingerprint, Violation};
use std::any::Any;
use std::fmt;
use std::ops::Deref;
use std::sync::Arc;

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

    /// Returns the phase at a time origin: the origin less whole periods.
    pub(crate) fn phase(&self, origin: f64) -> f64 {
        let (low, high) = self.reach();
        match self.period() {
            // A wall that never moves has the same position at all times. At phase 0, times lose none of
            // their digits.
            _ if low == high => 0.0,
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
