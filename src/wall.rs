//! Wall motions: the motion of a wall along its normal, and its first touch with a disk.
//!
//! | motion | displacement | source |
//! |---|---|---|
//! | [`Fixed`] | none | |
//! | [`BiParabolic`] | two parabolic arcs per period | paper, Sec. III |
//! | [`Sinusoidal`] | $`A\sin\omega t`$ | |
//! | [`Triangular`] | constant speed up, constant speed down | |
//! | [`Sawtooth`] | constant speed up, instantly back | |
//! | [`Tabulated`] | through given positions at given times, or from one position to another | |
//!
//! All oscillations begin alike: at phase 0 the displacement is 0, and the wall rises.
//!
//! [`Combined`] adds motions, scales them, mirrors them, and lets them begin at another time. The bounds on
//! their acceleration follow automatically:
//!
//! ```
//! use granular_edmd::boundary::{Container, Wall};
//! use granular_edmd::wall::{Combined, Sinusoidal, Tabulated};
//!
//! let shake = Sinusoidal::new(0.1, 10.0)?;
//! let both = Combined::new(shake).plus(Sinusoidal::new(0.02, 30.0)?)?;
//! let container = Container::closed(20.0, 30.0)?
//!     // The grains settle for 50, then two frequencies shake them.
//!     .with_motion(Wall::Floor, both.delayed_until(50.0)?)?
//!     // The lid comes down by 4 from time 80 to 100.
//!     .with_motion(Wall::Lid, Combined::new(Tabulated::from_to(0.0, 4.0, 20.0)?).delayed_until(80.0)?)?
//!     // Both sides move to the right: the normals of two opposite walls are opposite.
//!     .with_motion(Wall::Left, shake)?
//!     .with_motion(Wall::Right, Combined::new(shake).scaled(-1.0)?)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! A [`Piston`] is not a planned motion: the disks push it, and it moves according to its mass, force and
//! spring.
//!
//! [`first_touch`] finds the contact for all of these motions and for custom ones. Apart from position,
//! velocity and reach, it needs only bounds on the acceleration over intervals of time. See [`WallMotion`]
//! for an example, and [`laws`] for a check of a custom motion.

mod combined;
mod first_touch;
mod known;
pub mod laws;
mod motion;
mod oscillation;
mod piston;
mod tabulated;

pub use combined::Combined;
pub use first_touch::{Approach, FirstTouch, first_touch};
pub use known::KnownMotion;
#[cfg(feature = "serde")]
pub(crate) use known::motion_or_piston;
pub(crate) use motion::Motion;
pub use motion::check_finite;
pub use oscillation::{BiParabolic, Fixed, Sawtooth, Sinusoidal, Triangular};
pub use piston::Piston;
pub(crate) use piston::Stroke;
pub use tabulated::Tabulated;

use crate::Fingerprint;

/// The position and velocity of a wall along its normal, which points to the disks.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct WallState {
    /// Displacement from the wall's position at rest.
    pub displacement: f64,
    /// Velocity.
    pub velocity: f64,
}

impl WallState {
    /// Creates a state from its numbers.
    #[inline]
    pub const fn new(displacement: f64, velocity: f64) -> Self {
        Self { displacement, velocity }
    }
}

/// Bounds of a wall's acceleration on a piece of time, from the requested phase to `until`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct AccelerationBounds {
    /// End of the piece: a phase later than the requested one, or infinite for a piece without an end.
    pub until: f64,
    /// Lower bound on the acceleration in the piece.
    pub min: f64,
    /// Upper bound on the acceleration in the piece.
    pub max: f64,
}

impl AccelerationBounds {
    /// Creates bounds that hold until this phase.
    #[inline]
    pub const fn new(until: f64, min: f64, max: f64) -> Self {
        Self { until, min, max }
    }

    /// Creates bounds from the acceleration at this phase and a bound on the jerk, its rate of change.
    ///
    /// The bounds hold for a time of this length: $`a\pm|j|\,\mathit{length}`$. A good length is a sixteenth
    /// of the shortest period in the motion. Shorter pieces cost steps, and so do longer ones, whose bounds
    /// are wide.
    ///
    /// ```
    /// use granular_edmd::wall::{AccelerationBounds, WallMotion, WallState, laws};
    ///
    /// /// The motion sin t sin 2t.
    /// struct Beat;
    ///
    /// impl WallMotion for Beat {
    ///     fn state(&self, t: f64) -> WallState {
    ///         let velocity = t.cos() * (2.0 * t).sin() + 2.0 * t.sin() * (2.0 * t).cos();
    ///         WallState::new(t.sin() * (2.0 * t).sin(), velocity)
    ///     }
    ///     fn acceleration(&self, t: f64) -> AccelerationBounds {
    ///         let now = 4.0 * t.cos() * (2.0 * t).cos() - 5.0 * t.sin() * (2.0 * t).sin();
    ///         // Such a product has a jerk of (1 + 2)³ at most.
    ///         AccelerationBounds::from_jerk(t, now, 27.0, 0.2)
    ///     }
    ///     fn reach(&self) -> (f64, f64) {
    ///         (-1.0, 1.0)
    ///     }
    /// }
    ///
    /// assert_eq!(laws::check(&Beat, 0.0, 20.0), Ok(()));
    /// ```
    pub const fn from_jerk(phase: f64, acceleration: f64, jerk: f64, length: f64) -> Self {
        let change = jerk.abs() * length;
        Self::new(phase + length, acceleration - change, acceleration + change)
    }
}

/// The motion of a wall along its normal.
///
/// # Phases
/// The methods of a motion take *phases*. For a motion without a period, the phase is the absolute time of
/// the run. For a motion with a period, the phase is the absolute time less some whole periods, which keeps
/// all digits of late times. It is below one period in magnitude when an epoch of the run begins, grows as
/// the epoch goes on, and is negative only in runs that begin at a negative time. A motion whose smallest and
/// largest displacements are equal never moves, and receives only small phases, whatever the time.
///
/// # Contract
/// An implementation guarantees, for every phase:
/// 1. [`state`](Self::state) and [`acceleration`](Self::acceleration) give finite numbers, and the same ones
///    each time they are called with the same phase. Only `until` may be infinite.
/// 2. The displacement lies within [`reach`](Self::reach).
/// 3. A piece ends later than the requested phase, and its bounds hold for the acceleration up to its end.
/// 4. Inside a piece, displacement and velocity are continuous, the acceleration jumps a few times at most,
///    and the displacement is the integral of the velocity, to $`10^{-8}`$ of the distance moved. At the end
///    of a piece, the velocity may jump. The displacement may jump there, too, but only away from the disks.
///    The state at that phase is the state after the jump.
/// 5. If there is a [`period`](Self::period), the whole motion repeats after it.
/// 6. [`jumps`](Self::jumps) is true if the displacement jumps at the end of any piece.
/// 7. Motions with equal [fingerprints](Self::fingerprint) move alike, and motions of one type made from
///    equal numbers have equal fingerprints.
///
/// [`laws::check`] tests the first six between two phases. A container calls the methods in any order and
/// from any thread.
///
/// # Motions that break the contract
/// [`Container::with_motion`](crate::boundary::Container::with_motion) refuses a motion that gives a number
/// that is not finite at one of the phases that it tries, none of them negative. [`first_touch`] always ends,
/// even if the motion breaks the contract; its documentation says how. Bounds that are too small, a reach
/// that is too small or a jump toward the disks let disks pass into the wall, which the engine notices at the
/// next collision with it. Bounds that are too large only cost time.
///
/// ```
/// use granular_edmd::wall::{
///     AccelerationBounds, Approach, FirstTouch, WallMotion, WallState, first_touch, laws,
/// };
///
/// /// A piston that starts at time 0 and accelerates until it has moved by 1.
/// struct Piston;
///
/// impl WallMotion for Piston {
///     fn state(&self, phase: f64) -> WallState {
///         let t = phase.clamp(0.0, 1.0);
///         WallState::new(t * t, if t < 1.0 { 2.0 * t } else { 0.0 })
///     }
///     fn acceleration(&self, phase: f64) -> AccelerationBounds {
///         match phase {
///             t if t < 0.0 => AccelerationBounds::new(0.0, 0.0, 0.0),
///             t if t < 1.0 => AccelerationBounds::new(1.0, 2.0, 2.0),
///             _ => AccelerationBounds::new(f64::INFINITY, 0.0, 0.0),
///         }
///     }
///     fn reach(&self) -> (f64, f64) {
///         (0.0, 1.0)
///     }
/// }
///
/// let resting = Approach::new(0.0, 0.25, 0.0, 0.0);
/// assert_eq!(first_touch(&Piston, &resting, 10.0), FirstTouch::At(0.5));
/// assert_eq!(laws::check(&Piston, -2.0, 5.0), Ok(()));
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not the motion of a wall",
    label = "not a wall motion",
    note = "take one of `granular_edmd::wall`, such as `BiParabolic` or `Fixed`",
    note = "or implement `WallMotion`: state, bounds of the acceleration, and reach"
)]
pub trait WallMotion {
    /// Returns displacement and velocity at `phase`.
    fn state(&self, phase: f64) -> WallState;

    /// Returns bounds on the acceleration from `phase` to the end of the piece in which it lies.
    fn acceleration(&self, phase: f64) -> AccelerationBounds;

    /// Returns the smallest and the largest displacement.
    ///
    /// The range should be narrow, since flights above the largest displacement are skipped without a search.
    fn reach(&self) -> (f64, f64);

    /// Returns the period, finite and positive, if the motion has one.
    fn period(&self) -> Option<f64> {
        None
    }

    /// Returns whether the displacement jumps where a piece ends, as for a [`Sawtooth`]; by default, it does
    /// not.
    fn jumps(&self) -> bool {
        false
    }

    /// Returns the fingerprint of the motion: its name and all numbers that decide how it moves.
    ///
    /// Checkpoints compare the fingerprint when a run is resumed. If a motion has none, its boundary has none
    /// either and is not compared.
    fn fingerprint(&self) -> Option<Fingerprint> {
        None
    }
}
