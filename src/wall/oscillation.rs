//! Amplitude and period, which all periodic motions share.

use std::f64::consts::TAU;

use crate::quantity::{finite, positive};
use crate::{Fingerprint, ParameterError};

/// The amplitude and period of a motion that is cut into equal pieces of time.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub(super) struct Oscillation {
    pub(super) amplitude: f64,
    pub(super) angular_frequency: f64,
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
pub(super) fn is_even(number: f64) -> bool {
    (0.5 * number).floor() * 2.0 == number
}

crate::gate::from_file! {
    Oscillation { amplitude: f64, angular_frequency: f64 } => Self::new(amplitude, angular_frequency)
}

/// Defines the constructor and the two getters of a motion over an [`Oscillation`].
macro_rules! periodic {
    ($motion:ident) => {
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

pub(super) use {periodic, periodic_answers};
