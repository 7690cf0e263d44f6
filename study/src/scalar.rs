//! Numbers, words and switches: settings of parameters and cells of tables.

use std::fmt;

/// A single value of a parameter that varies, or of a cell in a table.
///
/// ```
/// use granular_edmd_study::Scalar;
/// assert_eq!(Scalar::from(0.1).to_string(), "0.1");
/// assert_eq!(Scalar::from(3_u64), Scalar::Integer(3));
/// assert_eq!(Scalar::from("periodic").number(), None);
/// ```
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(untagged, try_from = "toml::Value")]
#[non_exhaustive]
pub enum Scalar {
    /// Yes or no.
    Flag(bool),
    /// A whole number.
    Integer(i64),
    /// A number.
    Number(f64),
    /// A word, such as the name of a choice.
    Text(String),
}

impl Scalar {
    /// Returns the number, or `None` for a word or a switch.
    pub const fn number(&self) -> Option<f64> {
        match self {
            Self::Number(number) => Some(*number),
            Self::Integer(number) => Some(*number as f64),
            Self::Flag(_) | Self::Text(_) => None,
        }
    }

    /// Returns the scalar of a TOML value; `None` for a table, a list or a date.
    pub(super) fn of_toml(value: &toml::Value) -> Option<Self> {
        match value {
            toml::Value::Boolean(flag) => Some(Self::Flag(*flag)),
            toml::Value::Integer(number) => Some(Self::Integer(*number)),
            toml::Value::Float(number) => Some(Self::Number(*number)),
            toml::Value::String(text) => Some(Self::Text(text.clone())),
            _ => None,
        }
    }

    /// Returns the same value in the type of `other`, if nothing is lost: 1.0 becomes the integer 1, for
    /// example.
    pub(super) fn like(self, other: &Self) -> Self {
        /// Largest magnitude up to which a double represents all whole numbers.
        const EXACT: f64 = 9_007_199_254_740_992.0;
        match (other, self) {
            (Self::Integer(_), Self::Number(number)) if number.abs() <= EXACT && number.trunc() == number => {
                Self::Integer(number as i64)
            }
            (Self::Number(_), Self::Integer(number)) => Self::Number(number as f64),
            (_, same) => same,
        }
    }
}

/// Derived code would try one kind after another and make an error for each kind that does not fit, which
/// takes a second for a million values.
impl TryFrom<toml::Value> for Scalar {
    type Error = &'static str;

    fn try_from(value: toml::Value) -> Result<Self, Self::Error> {
        Self::of_toml(&value).ok_or("a value must be a number, a word or a switch")
    }
}

/// Reading numbers back gives the same bits; words are in quotes where a table needs quotes.
impl fmt::Display for Scalar {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Flag(flag) => write!(formatter, "{flag}"),
            Self::Integer(number) => write!(formatter, "{number}"),
            Self::Number(number) => write!(formatter, "{number:?}"),
            Self::Text(text) if text.contains([',', '"', '\n', '\r']) => {
                write!(formatter, "\"{}\"", text.replace('"', "\"\""))
            }
            Self::Text(text) => formatter.write_str(text),
        }
    }
}

/// Numbers too large for a table become the largest number that it takes.
impl From<u64> for Scalar {
    fn from(number: u64) -> Self {
        Self::Integer(i64::try_from(number).unwrap_or(i64::MAX))
    }
}

/// Numbers too large for a table become the largest number that it takes.
impl From<usize> for Scalar {
    fn from(number: usize) -> Self {
        Self::from(number as u64)
    }
}

macro_rules! from {
    ($($value:ty => $kind:ident),*) => {$(
        impl From<$value> for Scalar {
            fn from(value: $value) -> Self {
                Self::$kind(value.into())
            }
        }
    )*};
}

from! { bool => Flag, i32 => Integer, i64 => Integer, f64 => Number, &str => Text, String => Text }
