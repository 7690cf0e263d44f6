//! The values of a ramp or an axis: a list, or a rule.

use std::collections::HashSet;
use std::fmt;
use std::marker::PhantomData;

use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};

use super::steps::Steps;
use crate::study::errors::PlanError;
use crate::study::scalar::Scalar;

/// Values of a parameter, at least one.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub(super) enum Values<T> {
    List(Vec<T>),
    Rule(Steps),
}

impl<T: Clone + Into<Scalar> + From<f64>> Values<T> {
    pub(super) const fn len(&self) -> usize {
        match self {
            Self::List(list) => list.len(),
            Self::Rule(steps) => steps.count(),
        }
    }

    /// Returns the value of an index below the number of values.
    pub(super) fn at(&self, index: usize) -> T {
        match self {
            Self::List(list) => list[index].clone(),
            Self::Rule(steps) => steps.value(index).into(),
        }
    }

    /// Checks that there are values, and that they are finite.
    pub(super) fn check(&self, parameter: &str) -> Result<(), PlanError> {
        let parameter = || parameter.to_owned();
        let Self::List(list) = self else { return Ok(()) };
        if list.is_empty() {
            return Err(PlanError::NoValues { parameter: parameter() });
        }
        let numbers = list.iter().filter_map(|value| value.clone().into().number());
        match numbers.into_iter().find(|value| !value.is_finite()) {
            Some(value) => Err(PlanError::NotFinite { parameter: parameter(), value }),
            None => Ok(()),
        }
    }

    /// Returns a value that the list has twice.
    pub(super) fn twice(&self) -> Option<Scalar> {
        let Self::List(list) = self else { return None };
        let mut known = HashSet::with_capacity(list.len());
        let mut all = list.iter().map(|value| value.clone().into());
        // Zero is added so that both zeros are one value.
        all.find(|value: &Scalar| {
            !known.insert(match value {
                Scalar::Number(number) => format!("{:?}", number + 0.0),
                other => format!("{other:?}"),
            })
        })
    }
}

/// Reads a list or a rule. Derived code would try both and could not say what is wrong with either.
impl<'de, T: Deserialize<'de>> Deserialize<'de> for Values<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(Reader(PhantomData))
    }
}

struct Reader<T>(PhantomData<T>);

impl<'de, T: Deserialize<'de>> Visitor<'de> for Reader<T> {
    type Value = Values<T>;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("a list of values, or a rule { from, to, step } or { from, to, log }")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<Values<T>, A::Error> {
        Vec::deserialize(SeqAccessDeserializer::new(list)).map(Values::List)
    }

    fn visit_map<A: MapAccess<'de>>(self, rule: A) -> Result<Values<T>, A::Error> {
        Steps::deserialize(MapAccessDeserializer::new(rule)).map(Values::Rule)
    }
}
