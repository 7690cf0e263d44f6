//! Checks that every public constructor and every deserialised value passes through.

use crate::ParameterError;

/// `value` if it is finite and above zero.
pub(crate) fn positive(name: &'static str, value: f64) -> Result<f64, ParameterError> {
    accept(value.is_finite() && value > 0.0, name, "finite and positive", value)
}

/// `value` if it is finite and not below zero.
pub(crate) fn non_negative(name: &'static str, value: f64) -> Result<f64, ParameterError> {
    accept(value.is_finite() && value >= 0.0, name, "finite and not negative", value)
}

/// `value` if it is neither infinite nor NaN.
pub(crate) fn finite(name: &'static str, value: f64) -> Result<f64, ParameterError> {
    accept(value.is_finite(), name, "finite", value)
}

/// `value` if `valid` holds, else the error that says what it should have been.
pub(crate) fn accept(
    valid: bool,
    name: &'static str,
    requirement: &'static str,
    value: f64,
) -> Result<f64, ParameterError> {
    if valid { Ok(value) } else { Err(ParameterError::new(name, requirement, value)) }
}
