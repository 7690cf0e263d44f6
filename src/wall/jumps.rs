//! Motions that jump.

use super::WallMotion;

/// Returns whether the motion jumps at the end of a piece: its displacement then differs from the value to
/// which its velocity shortly before the end leads.
pub(super) fn seen<M: WallMotion + ?Sized>(motion: &M) -> bool {
    const PIECES: usize = 1000;
    let (low, high) = motion.reach();
    let end = motion.period().unwrap_or(f64::INFINITY);
    let mut phase = 0.0;
    for _ in 0..PIECES {
        let until = motion.acceleration(phase).until;
        if !(until.is_finite() && until > phase) {
            return false;
        }
        let just_before = until - 1e-6 * (until - phase);
        let (before, after) = (motion.state(just_before), motion.state(until));
        let expected = before.displacement + (until - just_before) * before.velocity;
        if (after.displacement - expected).abs() > 1e-6 * (high - low) {
            return true;
        }
        if until >= end {
            return false;
        }
        phase = until;
    }
    false
}
