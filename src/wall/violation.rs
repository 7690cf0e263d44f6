//! Ways in which a motion breaks its contract.

use thiserror::Error;

/// A way in which a motion breaks its contract.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[non_exhaustive]
pub enum Violation {
    /// The reach is not two finite numbers in order.
    #[error("its reach from {low:?} to {high:?} must be finite and in order")]
    Reach {
        /// Lower end of the reach.
        low: f64,
        /// Upper end of the reach.
        high: f64,
    },
    /// The period is not finite and positive.
    #[error("its period must be finite and positive, but is {period:?}")]
    PeriodValue {
        /// The period.
        period: f64,
    },
    /// An answer is infinite or not a number.
    #[error("at phase {phase:?} its {quantity} is {value:?}")]
    NotFinite {
        /// Name of the quantity.
        quantity: &'static str,
        /// The phase asked for.
        phase: f64,
        /// The answer.
        value: f64,
    },
    /// The bounds of the acceleration are in the wrong order.
    #[error("at phase {phase:?} its lower bound of the acceleration {min:?} is above the upper one, {max:?}")]
    Bounds {
        /// The phase asked for.
        phase: f64,
        /// The lower bound.
        min: f64,
        /// The upper bound.
        max: f64,
    },
    /// A piece does not end later than the phase asked for.
    #[error("the piece of its motion from phase {phase:?} on ends at {until:?}, which is not later")]
    PieceEnd {
        /// The phase asked for.
        phase: f64,
        /// The end of the piece.
        until: f64,
    },
    /// Consecutive pieces advance so little that no search can follow them.
    #[error("{pieces} pieces of its motion lead only from phase {phase:?} to {until:?}: they are too short")]
    ShortPieces {
        /// The phase at which the first begins.
        phase: f64,
        /// The phase at which the last ends.
        until: f64,
        /// Number of pieces.
        pieces: u32,
    },
    /// The displacement is outside the reach.
    #[error("at phase {phase:?} its displacement {displacement:?} is beyond its reach, {low:?} to {high:?}")]
    OutOfReach {
        /// The phase.
        phase: f64,
        /// The displacement.
        displacement: f64,
        /// Smallest displacement of the reach.
        low: f64,
        /// Largest displacement of the reach.
        high: f64,
    },
    /// The velocity changes faster than the bounds of the acceleration allow, or jumps inside a piece.
    #[error(
        "from phase {from:?} to {to:?} its velocity changes by {gain:?}, but the bounds of its acceleration \
         allow {least:?} to {most:?}"
    )]
    Velocity {
        /// The first phase.
        from: f64,
        /// The second phase.
        to: f64,
        /// Change of the velocity.
        gain: f64,
        /// Smallest change within the bounds.
        least: f64,
        /// Largest change within the bounds.
        most: f64,
    },
    /// The displacement is not the integral of the velocity, or jumps inside a piece.
    #[error("from phase {from:?} to {to:?} it advances by {rise:?}, but its velocity says {expected:?}")]
    Displacement {
        /// The first phase.
        from: f64,
        /// The second phase.
        to: f64,
        /// Change of the displacement.
        rise: f64,
        /// Change by the mean velocity.
        expected: f64,
    },
    /// The wall jumps toward the disks.
    #[error("at phase {phase:?}, where a piece ends, it jumps toward the disks by {jump:?}")]
    Jump {
        /// The phase.
        phase: f64,
        /// Length of the jump.
        jump: f64,
    },
    /// The motion does not repeat after its period.
    #[error("with the period {period:?}, the state at phase {later:?} is not that at phase {phase:?}")]
    Period {
        /// The phase.
        phase: f64,
        /// The period.
        period: f64,
        /// A phase some periods later.
        later: f64,
    },
}
