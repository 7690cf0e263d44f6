//! Motions that jump.

use super::WallMotion;

/// Tells whether the motion jumps at the end of a piece. The function looks at the first period, or at
/// the first thousand pieces if they are over earlier.
pub(crate) fn jumps<M: WallMotion + ?Sized>(motion: &M) -> bool {
    const PIECES: usize = 1000;
    let (low, high) = motion.reach();
    let end = motion.period().unwrap_or(f64::INFINITY);
    let mut phase = 0.0;
    for _ in 0..PIECES {
        let until = motion.acceleration(phase).until;
        if !(until.is_finite() && until > phase) {
            return false;
        }
        let (before, after) = (motion.state(until.next_down()), motion.state(until));
        if (after.displacement - before.displacement).abs() > 1e-6 * (high - low) {
            return true;
        }
        if until >= end {
            return false;
        }
        phase = until;
    }
    false
}
