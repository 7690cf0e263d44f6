//! Parameters of any serializable type, by name; their values; and the seeds that follow from these values.

use std::fmt;

use serde::de::{DeserializeOwned, Error as _};
use serde::{Deserialize, Deserializer, Serialize};
use toml::{Table, Value};

use super::errors::{Difference, PlanError, shortened};

/// A single value: of a parameter that varies, or in a cell of a table.
///
/// ```
/// use granular_edmd_study::Scalar;
/// assert_eq!(Scalar::from(0.1).to_string(), "0.1");
/// assert_eq!(Scalar::from(3_u64), Scalar::Integer(3));
/// assert_eq!(Scalar::from("periodic").number(), None);
/// ```
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
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
    /// The message about a value that is not a scalar.
    pub(super) const REFUSED: &str = "a value must be a number, a word or a switch";

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

    /// Returns the same value in the type of `other`, if the conversion is exact: for example, 1.0 becomes
    /// the integer 1.
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

/// Derived code would try one kind after another, and would create an error for each kind that does not fit.
/// For a million values, this takes a second.
impl<'de> Deserialize<'de> for Scalar {
    fn deserialize<D: Deserializer<'de>>(file: D) -> Result<Self, D::Error> {
        Self::of_toml(&Value::deserialize(file)?).ok_or_else(|| D::Error::custom(Self::REFUSED))
    }
}

/// A number, once written, reads back with the same bits. A word is in quotes where a table needs quotes.
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

/// Returns the parameters of an experiment as a tree of names.
pub(super) fn tree(experiment: &impl Serialize) -> Result<Table, PlanError> {
    Table::try_from(experiment).map_err(|error| PlanError::toml(&error))
}

/// Creates an experiment from a tree of names.
pub(super) fn experiment<E: DeserializeOwned>(tree: Table) -> Result<E, String> {
    E::deserialize(Value::Table(tree)).map_err(|error| shortened(&error.to_string()))
}

/// Returns the whole names of all parameters, with dots between the names of groups and fields.
pub(super) fn names(tree: &Table) -> Vec<String> {
    let mut names = Vec::new();
    for (name, value) in tree {
        match value {
            Value::Table(inner) => {
                names.extend(self::names(inner).iter().map(|inner| format!("{name}.{inner}")));
            }
            _ => names.push(name.clone()),
        }
    }
    names
}

/// Returns a parameter by its whole name.
pub(super) fn get<'a>(tree: &'a Table, name: &str) -> Option<&'a Value> {
    match name.split_once('.') {
        None => tree.get(name),
        Some((first, rest)) => get(tree.get(first)?.as_table()?, rest),
    }
}

/// Sets a parameter by its whole name, in the type of the present value. Returns false if any part of the
/// name, except the last, does not name a group.
#[must_use]
pub(super) fn set(tree: &mut Table, name: &str, to: &Scalar) -> bool {
    match name.split_once('.') {
        None => {
            let known = tree.get(name).and_then(Scalar::of_toml);
            let to = known.map_or_else(|| to.clone(), |known| to.clone().like(&known));
            Value::try_from(to).map(|to| tree.insert(name.to_owned(), to)).is_ok()
        }
        Some((first, rest)) => {
            let group = tree.entry(first).or_insert_with(|| Value::Table(Table::new()));
            group.as_table_mut().is_some_and(|group| set(group, rest, to))
        }
    }
}

/// Returns the whole name of a parameter. The name after the last dot is enough if no other parameter has it.
///
/// An unknown name is returned unchanged, since the parameter may have no value yet.
pub(super) fn whole_name(tree: &Table, name: &str) -> Result<String, PlanError> {
    if get(tree, name).is_some() {
        return Ok(name.to_owned());
    }
    let ending = format!(".{name}");
    let mut found: Vec<String> = names(tree).into_iter().filter(|whole| whole.ends_with(&ending)).collect();
    match found.len() {
        0 => Ok(name.to_owned()),
        1 => Ok(found.remove(0)),
        _ => Err(PlanError::Refused(format!("`{name}` may be any of {}", found.join(", ")))),
    }
}

/// Sets a parameter of an experiment, and returns the parameter's value as the experiment then has it. The
/// error says that there is no such parameter, or that the experiment refuses the value.
pub(super) fn probe<E: Serialize + DeserializeOwned>(
    base: &Table,
    parameter: &str,
    name: &str,
    to: &Scalar,
) -> Result<Scalar, PlanError> {
    let mut changed = base.clone();
    let unknown = |reason: &str| {
        let known = names(base).join(", ");
        PlanError::Refused(format!("there is no parameter `{parameter}` ({reason}); there are {known}"))
    };
    if !set(&mut changed, name, to) {
        return Err(unknown("a part of its name is that of a parameter without parts"));
    }
    let tried = get(&changed, name).and_then(Scalar::of_toml).filter(|_| get(base, name).is_some());
    let refused = |reason: String| match tried {
        Some(to) => PlanError::Experiment { place: place(&[(parameter, to)]), source: reason.into() },
        None => unknown(&reason),
    };
    let read = experiment::<E>(changed).map_err(refused)?;
    let found = get(&tree(&read)?, name).and_then(Scalar::of_toml);
    found.ok_or_else(|| unknown("the experiment ignores it"))
}

/// Returns the names and values of parameters as the text of an error.
pub(super) fn place(varied: &[(&str, Scalar)]) -> String {
    let varied: Vec<String> = varied.iter().map(|(name, value)| format!("{name} = {value}")).collect();
    if varied.is_empty() { String::new() } else { format!(" at {}", varied.join(", ")) }
}

/// Returns the fields in which two trees differ.
pub(super) fn differences(old: &Table, new: &Table) -> Vec<Difference> {
    let added = new.keys().filter(|name| !old.contains_key(*name));
    let of = |name: &String| match (old.get(name), new.get(name)) {
        (Some(Value::Table(old)), Some(Value::Table(new))) => {
            let mut inner = differences(old, new);
            for found in &mut inner {
                found.field.insert_str(0, &format!("{name}."));
            }
            inner
        }
        (old, new) if old == new => Vec::new(),
        (old, new) => {
            let [old, new] = [old, new].map(|value| value.map(ToString::to_string));
            vec![Difference { field: name.clone(), old, new }]
        }
    };
    old.keys().chain(added).flat_map(of).collect()
}

/// Returns the seed that follows from a seed and the value of a parameter.
pub(super) fn seed_at(seed: u64, parameter: &str, value: &Scalar) -> u64 {
    let seed = derived(seed, parameter.as_bytes());
    match value {
        // Both zeros are one value.
        Scalar::Number(number) => derived(seed, &(number + 0.0).to_bits().to_le_bytes()),
        other => derived(seed, other.to_string().as_bytes()),
    }
}

/// Returns the first eight bytes of the hash of a seed and these bytes.
pub(super) fn derived(seed: u64, bytes: &[u8]) -> u64 {
    let hash = blake3::Hasher::new().update(&seed.to_le_bytes()).update(bytes).finalize();
    u64::from_le_bytes(hash.as_bytes().as_chunks().0[0])
}
