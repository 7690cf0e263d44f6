//! Pieces of motions at constant speed.

use super::oscillation::piece;
use super::{AccelerationBounds, WallState};

/// Returns the state in a stroke at constant speed from `-amplitude` to `amplitude`. Each piece of this
/// length is one stroke.
pub(super) fn stroke(phase: f64, length: f64, amplitude: f64) -> WallState {
    let (number, _) = piece(phase, length);
    let share = (phase - number * length) / length;
    WallState::new(amplitude * (2.0 * share - 1.0), 2.0 * amplitude / length)
}

/// Returns bounds of zero acceleration, which hold until the stroke ends.
pub(super) fn steady(phase: f64, length: f64) -> AccelerationBounds {
    AccelerationBounds::new(piece(phase, length).1, 0.0, 0.0)
}
