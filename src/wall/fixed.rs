//! The wall that does not move.

use super::{AccelerationBounds, WallMotion, WallState};

/// No motion.
///
/// ```
/// use granular_edmd::wall::{Fixed, WallMotion};
/// assert_eq!(Fixed.state(3.0).displacement, 0.0);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Fixed;

impl WallMotion for Fixed {
    fn state(&self, _time: f64) -> WallState {
        WallState { displacement: 0.0, velocity: 0.0 }
    }

    fn acceleration(&self, _time: f64) -> AccelerationBounds {
        AccelerationBounds { until: f64::INFINITY, min: 0.0, max: 0.0 }
    }

    fn reach(&self) -> (f64, f64) {
        (0.0, 0.0)
    }

    fn period(&self) -> Option<f64> {
        // It repeats after any time: after the least, nothing is left of a late one, and no digit is lost to it.
        Some(f64::MIN_POSITIVE)
    }
}
