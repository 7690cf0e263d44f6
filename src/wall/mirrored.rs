//! The same motion in the opposite direction.

use std::sync::Arc;

use super::{AccelerationBounds, WallMotion, WallState};
use crate::Fingerprint;

/// A motion in the opposite direction, for the wall on the other side of a box that moves as a whole.
pub(super) struct Mirrored(pub(super) Arc<dyn WallMotion + Send + Sync>);

impl WallMotion for Mirrored {
    fn state(&self, phase: f64) -> WallState {
        let state = self.0.state(phase);
        WallState::new(-state.displacement, -state.velocity)
    }

    fn acceleration(&self, phase: f64) -> AccelerationBounds {
        let bounds = self.0.acceleration(phase);
        AccelerationBounds::new(bounds.until, -bounds.max, -bounds.min)
    }

    fn reach(&self) -> (f64, f64) {
        let (low, high) = self.0.reach();
        (-high, -low)
    }

    fn period(&self) -> Option<f64> {
        self.0.period()
    }

    fn fingerprint(&self) -> Option<Fingerprint> {
        Some(Fingerprint::of("Mirrored").part(self.0.fingerprint()?))
    }
}
