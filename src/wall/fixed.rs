//! The motion of a wall at rest.

use super::{AccelerationBounds, WallMotion, WallState};
use crate::Fingerprint;

/// The motion of a wall that stays at its position.
///
/// ```
/// use granular_edmd::wall::{Fixed, WallMotion};
/// assert_eq!(Fixed.state(3.0).displacement, 0.0);
/// assert_eq!(Fixed.reach(), (0.0, 0.0));
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Fixed;

impl WallMotion for Fixed {
    fn state(&self, _phase: f64) -> WallState {
        WallState::new(0.0, 0.0)
    }

    fn acceleration(&self, _phase: f64) -> AccelerationBounds {
        AccelerationBounds::new(f64::INFINITY, 0.0, 0.0)
    }

    fn reach(&self) -> (f64, f64) {
        (0.0, 0.0)
    }

    fn fingerprint(&self) -> Option<Fingerprint> {
        Some(Fingerprint::of("Fixed"))
    }
}
