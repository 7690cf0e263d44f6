//! Wall motions: how a wall moves along its normal, and when a disk first touches it.
//!
//! | motion | displacement | source |
//! |---|---|---|
//! | [`Fixed`] | none | |
//! | [`BiParabolic`] | two parabolic arcs a period | paper, Sec. III |
//! | [`Sinusoidal`] | `$A\sin\omega t$` | |
//! | [`Triangular`] | constant speed up, constant speed down | |
//! | [`Sawtooth`] | constant speed up, instantly back | |
//!
//! [`first_touch`] finds the contact for all of them and for yours: it needs bounds of the acceleration on pieces of
//! time, nothing more. See [`WallMotion`] for an example.

mod bi_parabolic;
mod first_touch;
mod fixed;
mod oscillation;
mod sinusoidal;
mod steady;

pub use bi_parabolic::BiParabolic;
pub use first_touch::{Approach, first_touch};
pub use fixed::Fixed;
pub use sinusoidal::Sinusoidal;
pub use steady::{Sawtooth, Triangular};

/// Where a wall is and how fast it moves, along its normal (which points to the disks).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WallState {
    /// Displacement from the wall's place at rest.
    pub displacement: f64,
    /// Velocity.
    pub velocity: f64,
}

/// Bounds of a wall's acceleration on the piece of time from the one asked for to `until`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AccelerationBounds {
    /// End of the piece, later than the time asked for; what it means if it is not, [`first_touch`] says.
    pub until: f64,
    /// No acceleration on the piece is below this.
    pub min: f64,
    /// No acceleration on the piece is above this.
    pub max: f64,
}

/// The motion of a wall along its normal.
///
/// # Contract
/// - Inside a piece ([`Self::acceleration`]) displacement and velocity are continuous. At the end of a piece the
///   velocity may jump, and the displacement may jump away from the disks; `state` at that time is the one after.
/// - `reach` bounds the displacement at all times.
/// - If `period` is given, `state` and `acceleration` repeat after it, and times are passed reduced by whole periods:
///   that is how late times keep all their digits.
///
/// ```
/// use granular_edmd::wall::{AccelerationBounds, Approach, WallMotion, WallState, first_touch};
///
/// /// A piston that starts at time 0 and accelerates until it has moved by 1.
/// struct Piston;
///
/// impl WallMotion for Piston {
///     fn state(&self, time: f64) -> WallState {
///         let t = time.clamp(0.0, 1.0);
///         WallState { displacement: t * t, velocity: if t < 1.0 { 2.0 * t } else { 0.0 } }
///     }
///     fn acceleration(&self, time: f64) -> AccelerationBounds {
///         let (until, value) = match time {
///             t if t < 0.0 => (0.0, 0.0),
///             t if t < 1.0 => (1.0, 2.0),
///             _ => (f64::INFINITY, 0.0),
///         };
///         AccelerationBounds { until, min: value, max: value }
///     }
///     fn reach(&self) -> (f64, f64) {
///         (0.0, 1.0)
///     }
/// }
///
/// let resting = Approach::new(0.0, 0.25, 0.0, 0.0);
/// assert_eq!(first_touch(&Piston, &resting, 10.0), Some(0.5));
/// ```
pub trait WallMotion {
    /// Displacement and velocity at `time`.
    fn state(&self, time: f64) -> WallState;

    /// Bounds of the acceleration from `time` to the end of the piece that `time` lies in.
    fn acceleration(&self, time: f64) -> AccelerationBounds;

    /// Smallest and largest displacement.
    fn reach(&self) -> (f64, f64);

    /// The period, if the motion has one.
    fn period(&self) -> Option<f64> {
        None
    }
}

impl<T: WallMotion + ?Sized> WallMotion for &T {
    fn state(&self, time: f64) -> WallState {
        (**self).state(time)
    }
    fn acceleration(&self, time: f64) -> AccelerationBounds {
        (**self).acceleration(time)
    }
    fn reach(&self) -> (f64, f64) {
        (**self).reach()
    }
    fn period(&self) -> Option<f64> {
        (**self).period()
    }
}

impl<T: WallMotion + ?Sized> WallMotion for Box<T> {
    fn state(&self, time: f64) -> WallState {
        (**self).state(time)
    }
    fn acceleration(&self, time: f64) -> AccelerationBounds {
        (**self).acceleration(time)
    }
    fn reach(&self) -> (f64, f64) {
        (**self).reach()
    }
    fn period(&self) -> Option<f64> {
        (**self).period()
    }
}
