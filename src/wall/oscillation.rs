//! Fixed walls and periodic motions: bi-parabolic (the paper's), harmonic, triangular, sawtooth.

use std::f64::consts::TAU;

use super::{AccelerationBounds, WallMotion, WallState};
use crate::quantity::{finite, positive};
use crate::{Fingerprint, ParameterError};

/// The motion of a wall that stays at its position.
///
/// ```
/// use granular_edmd::wall::{Fixed, WallMotion};
/// assert_eq!(Fixed.state(3.0).displacement, 0.0);
/// assert_eq!(Fixed.reach(), (0.0, 0.0));
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Fixed;

impl WallMotion for Fixed {
    fn state(&self, _phase: f64) -> WallState {
        WallState::new(0.0, 0.0)
    }

    fn acceleration(&self, _phase: f64) -> AccelerationBounds {
        AccelerationBounds::new(f64::INFINITY, 0.0, 0.0)
    }

    fn reach(&self) -> (f64, f64) {
        (0.0, 0.0)
    }

    fn fingerprint(&self) -> Option<Fingerprint> {
        Some(Fingerprint::of("Fixed"))
    }
}

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
fn steady(phase: f64, length: f64) -> AccelerationBounds {
    AccelerationBounds::new(centered(phase, length).1, 0.0, 0.0)
}

/// The amplitude and period of a motion that is cut into equal pieces of time.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
struct Oscillation {
    pub(super) amplitude: f64,
    angular_frequency: f64,
}

impl Oscillation {
    pub(super) fn new(amplitude: f64, angular_frequency: f64) -> Result<Self, ParameterError> {
        let oscillation = Self {
            amplitude: positive("amplitude", amplitude)?,
            angular_frequency: positive("angular frequency", angular_frequency)?,
        };
        positive("period", oscillation.period())?;
        positive("peak acceleration", amplitude * angular_frequency * angular_frequency)?;
        // The arcs divide by the square of the period, which may vanish.
        finite("peak acceleration", amplitude / (oscillation.period() * oscillation.period()))?;
        Ok(oscillation)
    }

    pub(super) fn period(&self) -> f64 {
        TAU / self.angular_frequency
    }

    /// Returns the fingerprint of the motion of this name.
    pub(super) fn fingerprint(&self, name: &str) -> Fingerprint {
        Fingerprint::of(name).number(self.amplitude).number(self.angular_frequency)
    }
}

/// Returns the number of the piece of length `length` in which `phase` lies, and the phase at which it ends.
#[inline]
pub(super) fn piece(phase: f64, length: f64) -> (f64, f64) {
    let mut number = (phase / length).floor();
    // The end of a piece belongs to the next one. The quotient may be rounded down to the previous piece.
    // The previous piece would end at the requested phase, and a search would make no step.
    if phase >= (number + 1.0) * length {
        number += 1.0;
    }
    (number, (number + 1.0) * length)
}

/// Returns whether a piece number is even.
#[inline]
fn is_even(number: f64) -> bool {
    (0.5 * number).floor() * 2.0 == number
}

crate::gate::from_file! {
    Oscillation { amplitude: f64, angular_frequency: f64 } => Self::new(amplitude, angular_frequency)
}

/// Defines a motion over an [`Oscillation`], with its constructor and two getters.
macro_rules! periodic {
    ($(#[$documentation:meta])* $motion:ident) => {
        $(#[$documentation])*
        #[derive(Debug, Clone, Copy, PartialEq)]
        #[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
        #[cfg_attr(feature = "serde", serde(transparent))]
        pub struct $motion {
            oscillation: Oscillation,
        }

        impl $motion {
            /// Creates a motion of this amplitude A and angular frequency ω.
            ///
            /// # Errors
            /// If a number, the period or the peak acceleration is not finite and positive. For a wall at
            /// rest, use [`Fixed`](super::Fixed).
            pub fn new(amplitude: f64, angular_frequency: f64) -> Result<Self, crate::ParameterError> {
                Ok(Self { oscillation: Oscillation::new(amplitude, angular_frequency)? })
            }

            /// Returns the amplitude.
            pub const fn amplitude(&self) -> f64 {
                self.oscillation.amplitude
            }

            /// Returns the angular frequency.
            pub const fn angular_frequency(&self) -> f64 {
                self.oscillation.angular_frequency
            }
        }
    };
}

/// Defines the methods of a motion over an [`Oscillation`] that follow from its name and its two numbers.
macro_rules! periodic_answers {
    ($name:literal) => {
        fn reach(&self) -> (f64, f64) {
            (-self.amplitude(), self.amplitude())
        }

        fn period(&self) -> Option<f64> {
            Some(self.oscillation.period())
        }

        fn fingerprint(&self) -> Option<crate::Fingerprint> {
            Some(self.oscillation.fingerprint($name))
        }
    };
}

periodic! {
    /// Piecewise constant acceleration that mimics a sine, with two parabolic arcs per period (paper, Sec.
    /// III).
    ///
    /// With the half period $`H=\pi/\omega`$ and $`s = t/H`$,
    ///
    /// ```math
    /// z(t) = 4A\,s(1-s)\quad (0\le s<1),\qquad z(t+H) = -z(t),
    /// ```
    ///
    /// so it has the amplitude and the period of $`A\sin\omega t`$. The peak speed is $`4A/H = 4A\omega/\pi`$
    /// and the acceleration is $`\mp 8A/H^2`$. The time of every contact is the root of a parabola, which is
    /// exact and needs no iteration.
    ///
    /// ```
    /// use granular_edmd::wall::{BiParabolic, WallMotion};
    /// let base = BiParabolic::new(0.1, 10.0)?;
    /// let quarter = 0.25 * base.period().unwrap();
    /// assert!((base.state(quarter).displacement - 0.1).abs() < 1e-15);
    /// assert!((base.state(0.0).velocity - 4.0 * 0.1 * 10.0 / std::f64::consts::PI).abs() < 1e-14);
    /// # Ok::<(), granular_edmd::ParameterError>(())
    /// ```
    BiParabolic
}

impl BiParabolic {
    fn arc(&self, phase: f64) -> Arc {
        let length = 0.5 * self.oscillation.period();
        let (number, end) = piece(phase, length);
        let height = if is_even(number) { self.amplitude() } else { -self.amplitude() };
        Arc { start: number * length, end, length, height }
    }
}

/// An arc of the motion, which is a parabola.
struct Arc {
    start: f64,
    end: f64,
    length: f64,
    height: f64,
}

impl WallMotion for BiParabolic {
    fn state(&self, phase: f64) -> WallState {
        let arc = self.arc(phase);
        let share = (phase - arc.start) / arc.length;
        let displacement = 4.0 * arc.height * share * (1.0 - share);
        WallState::new(displacement, 4.0 * arc.height * (1.0 - 2.0 * share) / arc.length)
    }

    fn acceleration(&self, phase: f64) -> AccelerationBounds {
        let arc = self.arc(phase);
        let value = -8.0 * arc.height / (arc.length * arc.length);
        AccelerationBounds::new(arc.end, value, value)
    }

    periodic_answers!("BiParabolic");
}

/// Number of pieces of a period on which the acceleration is bounded. It is a multiple of four, so that the
/// acceleration is monotonic on each piece and the values at its ends are the bounds.
const PIECES: f64 = 16.0;

periodic! {
    /// Harmonic motion, z(t) = A sin ωt.
    ///
    /// ```
    /// use granular_edmd::wall::{Sinusoidal, WallMotion};
    /// let base = Sinusoidal::new(0.1, 10.0)?;
    /// assert_eq!(base.state(0.0).velocity, 1.0);
    /// assert_eq!(base.reach(), (-0.1, 0.1));
    /// # Ok::<(), granular_edmd::ParameterError>(())
    /// ```
    Sinusoidal
}

impl Sinusoidal {
    fn acceleration_at(&self, phase: f64) -> f64 {
        let frequency = self.angular_frequency();
        -self.amplitude() * frequency * frequency * libm::sin(frequency * phase)
    }
}

impl WallMotion for Sinusoidal {
    fn state(&self, phase: f64) -> WallState {
        let frequency = self.angular_frequency();
        let (sine, cosine) = libm::sincos(frequency * phase);
        WallState::new(self.amplitude() * sine, self.amplitude() * frequency * cosine)
    }

    fn acceleration(&self, phase: f64) -> AccelerationBounds {
        let length = self.oscillation.period() / PIECES;
        let (number, until) = piece(phase, length);
        let (start, end) = (self.acceleration_at(number * length), self.acceleration_at(until));
        AccelerationBounds::new(until, start.min(end), start.max(end))
    }

    periodic_answers!("Sinusoidal");
}

periodic! {
    /// Triangular motion: from −A to A in half a period at constant speed, and back at the same speed.
    ///
    /// The speed is $`2A\omega/\pi`$. At phase 0 the wall is in its middle position and rises, as in all
    /// oscillations.
    ///
    /// ```
    /// use granular_edmd::wall::{Triangular, WallMotion};
    /// let base = Triangular::new(0.5, std::f64::consts::TAU)?;
    /// assert_eq!(base.state(0.0).displacement, 0.0);
    /// assert_eq!(base.state(0.125).displacement, 0.25);
    /// assert_eq!(base.state(0.0).velocity, 2.0);
    /// assert_eq!(base.state(0.5).velocity, -2.0);
    /// # Ok::<(), granular_edmd::ParameterError>(())
    /// ```
    Triangular
}

impl WallMotion for Triangular {
    fn state(&self, phase: f64) -> WallState {
        stroke(phase, 0.5 * self.oscillation.period(), self.amplitude(), true)
    }

    fn acceleration(&self, phase: f64) -> AccelerationBounds {
        steady(phase, 0.5 * self.oscillation.period())
    }

    periodic_answers!("Triangular");
}

periodic! {
    /// Sawtooth motion: from −A to A in one period at constant speed, then instantly back to −A.
    ///
    /// The speed is $`A\omega/\pi`$. At phase 0 the wall is in its middle position, and half a period later
    /// it jumps. A disk always meets the rising wall, as in the theory of gases on fast vibrating walls.
    ///
    /// ```
    /// use granular_edmd::wall::{Sawtooth, WallMotion};
    /// let base = Sawtooth::new(0.5, std::f64::consts::TAU)?;
    /// assert_eq!(base.state(0.0).displacement, 0.0);
    /// assert_eq!(base.state(0.5).displacement, -0.5);
    /// assert_eq!(base.state(0.3).velocity, 1.0);
    /// # Ok::<(), granular_edmd::ParameterError>(())
    /// ```
    Sawtooth
}

impl WallMotion for Sawtooth {
    fn state(&self, phase: f64) -> WallState {
        stroke(phase, self.oscillation.period(), self.amplitude(), false)
    }

    fn acceleration(&self, phase: f64) -> AccelerationBounds {
        steady(phase, self.oscillation.period())
    }

    fn jumps(&self) -> bool {
        true
    }

    periodic_answers!("Sawtooth");
}
