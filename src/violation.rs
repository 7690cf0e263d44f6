//! The error of a part that breaks the contract of its trait.

use thiserror::Error;

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
