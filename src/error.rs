//! The error of a parameter that cannot be used.

use std::fmt;

use thiserror::Error;

/// An error: a parameter lies outside the range in which it has a meaning.
///
/// ```
/// use granular_edmd::collision::Smooth;
/// let error = Smooth::new(0.7).unwrap_err();
/// assert_eq!(error.to_string(), "normal inelasticity must be in [0, 0.5], but is 0.7");
/// assert_eq!(error.value(), 0.7);
///
/// let error = Smooth::new(1e300).unwrap_err();
/// assert_eq!(error.to_string(), "normal inelasticity must be in [0, 0.5], but is 1e300");
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[error("{name} must be {requirement}, but is {}", Readable(*.value))]
#[non_exhaustive]
pub struct ParameterError {
    name: &'static str,
    requirement: &'static str,
    value: f64,
}

/// A number in a short form that identifies it. Very large and very small numbers have an exponent.
struct Readable(f64);

impl fmt::Display for Readable {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let size = self.0.abs();
        let is_plain = size == 0.0 || (1e-5..1e15).contains(&size) || !size.is_finite();
        if is_plain { write!(formatter, "{}", self.0) } else { write!(formatter, "{:e}", self.0) }
    }
}

impl ParameterError {
    /// Creates an error for the parameter `name`, which should meet `requirement` but has this `value`.
    ///
    /// The constructor is meant for rules, walls and observables of your own, so that all parameters fail
    /// alike. The checks of [`quantity`](crate::quantity) create the error for the usual ranges.
    pub const fn new(name: &'static str, requirement: &'static str, value: f64) -> Self {
        Self { name, requirement, value }
    }

    /// Returns the parameter's name.
    pub const fn name(&self) -> &'static str {
        self.name
    }

    /// Returns the value that was refused.
    pub const fn value(&self) -> f64 {
        self.value
    }

    /// Returns the condition that the value should have met.
    pub const fn requirement(&self) -> &'static str {
        self.requirement
    }
}
