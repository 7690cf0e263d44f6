//! Checks of parameters: the gate that every constructor and every deserialized value passes.
//!
//! Each function returns the value that it was given, or an error that names the value. Custom types use the
//! same functions, so that all errors of parameters in a program read alike.
//!
//! ```
//! use granular_edmd::{ParameterError, quantity};
//!
//! #[derive(Debug)]
//! struct Viscoelastic {
//!     loss: f64,
//! }
//!
//! impl Viscoelastic {
//!     fn new(loss: f64) -> Result<Self, ParameterError> {
//!         Ok(Self { loss: quantity::non_negative("loss", loss)? })
//!     }
//! }
//!
//! assert_eq!(Viscoelastic::new(0.1)?.loss, 0.1);
//! let error = Viscoelastic::new(-1.0).unwrap_err();
//! assert_eq!(error.to_string(), "loss must be finite and not negative, but is -1");
//! # Ok::<(), ParameterError>(())
//! ```

use std::borrow::Cow;

use crate::ParameterError;

/// Returns `value` if it is finite and above zero.
///
/// # Errors
/// If the value is zero, negative, infinite or NaN.
pub fn positive(name: impl Into<Cow<'static, str>>, value: f64) -> Result<f64, ParameterError> {
    accept(value.is_finite() && value > 0.0, name, "finite and positive", value)
}

/// Returns `value` if it is finite and not below zero.
///
/// # Errors
/// If the value is negative, infinite or NaN.
pub fn non_negative(name: impl Into<Cow<'static, str>>, value: f64) -> Result<f64, ParameterError> {
    accept(value.is_finite() && value >= 0.0, name, "finite and not negative", value)
}

/// Returns `value` if it is neither infinite nor NaN.
///
/// # Errors
/// If the value is infinite or NaN.
pub fn finite(name: impl Into<Cow<'static, str>>, value: f64) -> Result<f64, ParameterError> {
    accept(value.is_finite(), name, "finite", value)
}

/// Returns `value` if `valid` holds, and otherwise an error that states the condition.
///
/// ```
/// use granular_edmd::quantity::accept;
/// let percentage = 120.0;
/// let error = accept(percentage <= 100.0, "percentage", "at most 100", percentage).unwrap_err();
/// assert_eq!(error.to_string(), "percentage must be at most 100, but is 120");
/// ```
///
/// # Errors
/// If `valid` does not hold.
pub fn accept(
    valid: bool,
    name: impl Into<Cow<'static, str>>,
    requirement: impl Into<Cow<'static, str>>,
    value: f64,
) -> Result<f64, ParameterError> {
    if valid { Ok(value) } else { Err(ParameterError::new(name, requirement, value)) }
}
