//! Checks of parameters: the gate that every constructor and every deserialized value passes.
//!
//! Each function returns the value that it was given, or the error that names it. Types of your own use the
//! same functions, so that all parameters of a program fail alike.
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
use std::fmt;
use std::marker::PhantomData;

use crate::ParameterError;

/// Returns `value` if it is finite and above zero.
///
/// # Errors
/// If it is zero, negative, infinite or NaN.
pub fn positive(name: impl Into<Cow<'static, str>>, value: f64) -> Result<f64, ParameterError> {
    Range::POSITIVE.check(name, value)
}

/// Returns `value` if it is finite and not below zero.
///
/// # Errors
/// If it is negative, infinite or NaN.
pub fn non_negative(name: impl Into<Cow<'static, str>>, value: f64) -> Result<f64, ParameterError> {
    Range::NON_NEGATIVE.check(name, value)
}

/// Returns `value` if it is neither infinite nor NaN.
///
/// # Errors
/// If it is infinite or NaN.
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

/// A range of numbers that have a meaning, and its description in words.
#[derive(Clone, Copy)]
pub(crate) struct Range {
    requirement: &'static str,
    contains: fn(f64) -> bool,
}

impl Range {
    pub(crate) const POSITIVE: Self =
        Self::new("finite and positive", |value| value.is_finite() && value > 0.0);
    pub(crate) const NON_NEGATIVE: Self =
        Self::new("finite and not negative", |value| value.is_finite() && value >= 0.0);

    pub(crate) const fn new(requirement: &'static str, contains: fn(f64) -> bool) -> Self {
        Self { requirement, contains }
    }

    fn check(self, name: impl Into<Cow<'static, str>>, value: f64) -> Result<f64, ParameterError> {
        accept((self.contains)(value), name, self.requirement, value)
    }
}

/// A kind of number: its name in errors, and its range. Types without values implement it.
pub(crate) trait Quantity {
    const NAME: &'static str;
    const RANGE: Range;
}

/// A number that has passed the check of its kind. In files it is a plain number, read through the same
/// check.
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "f64", into = "f64", bound = "Q: Quantity"))]
pub(crate) struct Checked<Q>(f64, PhantomData<Q>);

impl<Q: Quantity> Checked<Q> {
    pub(crate) fn new(value: f64) -> Result<Self, ParameterError> {
        Q::RANGE.check(Q::NAME, value).map(|value| Self(value, PhantomData))
    }
}

impl<Q> Checked<Q> {
    #[inline]
    pub(crate) const fn get(self) -> f64 {
        self.0
    }
}

// These traits are written out, because derived ones would require them of `Q`, which has no values to copy
// or compare.

impl<Q> Clone for Checked<Q> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<Q> Copy for Checked<Q> {}

impl<Q> PartialEq for Checked<Q> {
    fn eq(&self, other: &Self) -> bool {
        self.0 == other.0
    }
}

impl<Q> fmt::Debug for Checked<Q> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(formatter)
    }
}

impl<Q: Quantity> TryFrom<f64> for Checked<Q> {
    type Error = ParameterError;

    fn try_from(value: f64) -> Result<Self, ParameterError> {
        Self::new(value)
    }
}

impl<Q> From<Checked<Q>> for f64 {
    fn from(checked: Checked<Q>) -> Self {
        checked.0
    }
}

#[cfg(test)]
mod tests {
    use super::{Checked, Quantity, Range};

    enum Share {}

    impl Quantity for Share {
        const NAME: &'static str = "share";
        const RANGE: Range = Range::new("in [0, 1]", |value| (0.0..=1.0).contains(&value));
    }

    #[test]
    fn a_checked_number_is_a_number() {
        let half = Checked::<Share>::new(0.5).unwrap();
        assert_eq!((half.get(), f64::from(half), format!("{half:?}")), (0.5, 0.5, "0.5".into()));
        let error = Checked::<Share>::try_from(1.5).unwrap_err();
        assert_eq!(error.to_string(), "share must be in [0, 1], but is 1.5");
        assert!(Checked::<Share>::new(f64::NAN).is_err());
    }

    #[cfg(feature = "serde")]
    #[test]
    fn a_file_passes_the_check() {
        let half: Checked<Share> = serde_json::from_str("0.5").unwrap();
        assert_eq!(serde_json::to_string(&half).unwrap(), "0.5");
        let refused = serde_json::from_str::<Checked<Share>>("1.5").unwrap_err();
        assert!(refused.to_string().starts_with("share must be in [0, 1], but is 1.5"));
    }
}
