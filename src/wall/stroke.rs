//! Pieces of motions at constant speed.

use super::oscillation::{is_even, piece};
use super::{AccelerationBounds, WallState};

/// Returns the number of the stroke of this length in which `phase` lies, and the phase at which it ends.
///
/// All oscillations begin in their middle position, so the middle of stroke 0 is at phase 0.
fn centered(phase: f64, length: f64) -> (f64, f64) {
    let half = 0.5 * length;
    // The first half of a stroke has an odd number, and the second half an even one.
    let number = (0.5 * (piece(phase, half).0 + 1.0)).floor();
    (number, (2.0 * number + 1.0) * half)
}

/// Returns the state in a stroke at constant speed. Each stroke of this length goes from `-amplitude` to
/// `amplitude`, and every second one goes back if the wall `returns`.
pub(super) fn stroke(phase: f64, length: f64, amplitude: f64, returns: bool) -> WallState {
    let (number, _) = centered(phase, length);
    let sign = if returns && !is_even(number) { -1.0 } else { 1.0 };
    // The bound keeps rounding from leaving the reach at the ends of a stroke.
    let share = ((phase - number * length) / length).clamp(-0.5, 0.5);
    WallState::new(2.0 * sign * amplitude * share, 2.0 * sign * amplitude / length)
}

/// Returns bounds of zero acceleration, which hold until the stroke ends.
pub(super) fn steady(phase: f64, length: f64) -> AccelerationBounds {
    AccelerationBounds::new(centered(phase, length).1, 0.0, 0.0)
}
