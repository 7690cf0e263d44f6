//! Forwarding: a boxed or borrowed motion is a motion, too.

use std::sync::Arc;

use super::{AccelerationBounds, WallMotion, WallState};
use crate::Fingerprint;
use crate::forward::forward;

forward! { WallMotion for [&T, Box<T>, Arc<T>] {
    fn state(&self, phase: f64) -> WallState;
    fn acceleration(&self, phase: f64) -> AccelerationBounds;
    fn reach(&self) -> (f64, f64);
    fn period(&self) -> Option<f64>;
    fn jumps(&self) -> bool;
    fn fingerprint(&self) -> Option<Fingerprint>;
}}
