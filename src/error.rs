//! The error of a parameter that cannot be used.

use thiserror::Error;

/// An error: a parameter lies outside the range in which it has a meaning.
///
/// ```
/// use granular_edmd::collision::Smooth;
/// let error = Smooth::new(0.7).unwrap_err();
/// assert_eq!(error.to_string(), "normal inelasticity must be in [0, 0.5], but is 0.7");
/// assert_eq!(error.value(), 0.7);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[error("{name} must be {requirement}, but is {value}")]
#[non_exhaustive]
pub struct ParameterError {
    name: &'static str,
    requirement: &'static str,
    value: f64,
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
