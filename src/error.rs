//! The errors of an unusable parameter, and of a part that breaks the contract of its trait.

use std::borrow::Cow;
use std::fmt;

use glam::DVec2;
use thiserror::Error;

/// The error of a parameter outside the range in which it has a meaning.
///
/// ```
/// use granular_edmd::collision::Smooth;
/// let error = Smooth::from_inelasticity(0.7).unwrap_err();
/// assert_eq!(error.to_string(), "normal inelasticity must be in [0, 0.5], but is 0.7");
/// assert_eq!(error.value(), 0.7);
///
/// let error = Smooth::from_inelasticity(1e300).unwrap_err();
/// assert_eq!(error.to_string(), "normal inelasticity must be in [0, 0.5], but is 1e300");
/// ```
#[derive(Debug, Clone, PartialEq, Error)]
#[error("{name} must be {requirement}, but is {}", Readable(*.value))]
#[non_exhaustive]
pub struct ParameterError {
    name: Cow<'static, str>,
    requirement: Cow<'static, str>,
    value: f64,
}

/// A number shown with all its digits. Very large and very small numbers have an exponent.
///
/// This is the form for numbers that a caller gave, or that are compared with each other in a message.
pub(crate) struct Readable(pub(crate) f64);

impl fmt::Display for Readable {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let size = self.0.abs();
        let is_plain = size == 0.0 || (1e-5..1e15).contains(&size) || !size.is_finite();
        if is_plain { write!(formatter, "{}", self.0) } else { write!(formatter, "{:e}", self.0) }
    }
}

/// A number shown with its first six digits, for times and depths that the crate has computed.
pub(crate) struct Rounded(pub(crate) f64);

impl fmt::Display for Rounded {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        // Reading the number back drops the zeros at its end.
        let rounded = format!("{:.5e}", self.0).parse().unwrap_or(self.0);
        Readable(rounded).fmt(formatter)
    }
}

/// A vector with the first six digits of its components.
pub(crate) struct RoundedVector(pub(crate) DVec2);

impl fmt::Display for RoundedVector {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "({}, {})", Rounded(self.0.x), Rounded(self.0.y))
    }
}

impl ParameterError {
    /// Creates an error for the parameter `name`, which should meet `requirement` but has this `value`.
    ///
    /// The constructor is meant for custom rules, walls and observables, so that all errors of parameters
    /// read alike. The checks of [`quantity`](crate::quantity) create the error for the usual ranges.
    pub fn new(
        name: impl Into<Cow<'static, str>>,
        requirement: impl Into<Cow<'static, str>>,
        value: f64,
    ) -> Self {
        Self { name: name.into(), requirement: requirement.into(), value }
    }

    /// Returns the parameter's name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns the refused value.
    pub const fn value(&self) -> f64 {
        self.value
    }

    /// Returns the condition that the value should have met.
    pub fn requirement(&self) -> &str {
        &self.requirement
    }
}

/// Converts errors of these types into an error that holds its cause in a box.
///
/// A conversion from every type of error would include this type itself, and the standard library has that
/// conversion already.
macro_rules! from_causes {
    ($error:ident from $($cause:ty),+) => {
        $(impl From<$cause> for $error {
            fn from(cause: $cause) -> Self {
                Self(cause.into())
            }
        })+
    };
}

pub(crate) use from_causes;

/// The error of a part that breaks a law, one of the sentences in the contract of its trait.
///
/// All checks of contracts return it, from `collision::laws` to `observable::laws`. The sentence about the
/// fault holds the numbers that reproduce it.
///
/// ```
/// use granular_edmd::collision::{Contact, Impulse, from_fn, laws};
///
/// let glue = from_fn(|_: &Contact| Impulse::new(0.0, 0.0));
/// let violation = laws::check(&glue, &laws::Promises::new()).unwrap_err();
/// assert_eq!((violation.part(), violation.law()), ("collision rule", "separation"));
/// assert!(violation.to_string().starts_with("collision rule, law \"separation\": the impulse (0.0, 0.0) "));
/// ```
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{part}, law \"{law}\": {found}")]
pub struct Violation {
    part: &'static str,
    law: &'static str,
    found: String,
}

impl Violation {
    /// Creates a violation from the kind of the part, such as "boundary", the name of the law, and a sentence
    /// that says what was found.
    pub fn new(part: &'static str, law: &'static str, found: impl Into<String>) -> Self {
        Self { part, law, found: found.into() }
    }

    /// Returns the kind of the part.
    pub const fn part(&self) -> &'static str {
        self.part
    }

    /// Returns the name of the law.
    pub const fn law(&self) -> &'static str {
        self.law
    }

    /// Returns the sentence that says what was found.
    pub fn found(&self) -> &str {
        &self.found
    }
}

/// Returns a violation of this law from the surrounding function, unless the condition holds.
macro_rules! require {
    ($part:expr, $law:expr, $holds:expr; $($found:tt)+) => {
        let holds: bool = $holds;
        if !holds {
            return Err($crate::Violation::new($part, $law, format!($($found)+)));
        }
    };
}

pub(crate) use require;
