//! Forwarding: a boxed or borrowed motion is a motion, too.

use std::sync::Arc;

use super::{AccelerationBounds, WallMotion, WallState};
use crate::Fingerprint;

impl<T: WallMotion + ?Sized> WallMotion for &T {
    fn state(&self, phase: f64) -> WallState {
        (**self).state(phase)
    }
    fn acceleration(&self, phase: f64) -> AccelerationBounds {
        (**self).acceleration(phase)
    }
    fn reach(&self) -> (f64, f64) {
        (**self).reach()
    }
    fn period(&self) -> Option<f64> {
        (**self).period()
    }
    fn fingerprint(&self) -> Option<Fingerprint> {
        (**self).fingerprint()
    }
}

impl<T: WallMotion + ?Sized> WallMotion for Box<T> {
    fn state(&self, phase: f64) -> WallState {
        (**self).state(phase)
    }
    fn acceleration(&self, phase: f64) -> AccelerationBounds {
        (**self).acceleration(phase)
    }
    fn reach(&self) -> (f64, f64) {
        (**self).reach()
    }
    fn period(&self) -> Option<f64> {
        (**self).period()
    }
    fn fingerprint(&self) -> Option<Fingerprint> {
        (**self).fingerprint()
    }
}

impl<T: WallMotion + ?Sized> WallMotion for Arc<T> {
    fn state(&self, phase: f64) -> WallState {
        (**self).state(phase)
    }
    fn acceleration(&self, phase: f64) -> AccelerationBounds {
        (**self).acceleration(phase)
    }
    fn reach(&self) -> (f64, f64) {
        (**self).reach()
    }
    fn period(&self) -> Option<f64> {
        (**self).period()
    }
    fn fingerprint(&self) -> Option<Fingerprint> {
        (**self).fingerprint()
    }
}
