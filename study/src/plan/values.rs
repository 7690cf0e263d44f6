//! The values of a ramp or an axis: a list, or a rule.

use std::collections::HashSet;
use std::fmt;
use std::marker::PhantomData;

use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};

use super::steps::Steps;
use crate::{PlanError, Scalar};

/// Largest number of values that are tried when a plan is made.
pub(crate) const MOST_TRIED: usize = 1024;

/// Returns the indices, out of `count`, that are tried when a plan is made: all if they are few, otherwise
/// the ends and several between them at equal distances. A plan of a million values is thus made as fast as a
/// small plan. The others are refused when their turn comes.
pub(crate) fn tried(count: usize) -> impl Iterator<Item = usize> {
    let tried = count.min(MOST_TRIED);
    (0..tried).map(move |index| index * count.saturating_sub(1) / tried.saturating_sub(1).max(1))
}

/// One or more values of a parameter.
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

    /// Returns the indices of the values that are tried. The values of a list are in any order, so the
    /// indices include the smallest and the largest value: an experiment usually accepts a range.
    pub(super) fn tried(&self) -> impl Iterator<Item = usize> {
        let number = |index: &usize| self.at(*index).into().number().unwrap_or(0.0);
        let order = |one: &usize, other: &usize| number(one).total_cmp(&number(other));
        let all = if matches!(self, Self::List(_)) { 0..self.len() } else { 0..0 };
        let extremes = [all.clone().min_by(order), all.max_by(order)];
        tried(self.len()).chain(extremes.into_iter().flatten())
    }

    /// Checks that there are values, and that they are finite.
    pub(super) fn check(&self, parameter: &str) -> Result<(), PlanError> {
        let Self::List(list) = self else { return Ok(()) };
        if list.is_empty() {
            return Err(PlanError::varied(parameter, "has no values"));
        }
        let mut numbers = list.iter().filter_map(|value| value.clone().into().number());
        match numbers.find(|value| !value.is_finite()) {
            Some(value) => {
                Err(PlanError::varied(parameter, format!("has a value that is not finite: {value}")))
            }
            None => Ok(()),
        }
    }

    /// Returns a value that occurs twice in the list, if any.
    pub(super) fn twice(&self) -> Option<Scalar> {
        let Self::List(list) = self else { return None };
        let mut known = HashSet::with_capacity(list.len());
        let mut all = list.iter().map(|value| value.clone().into());
        // Zero is added so that both zeros count as the same value.
        all.find(|value: &Scalar| {
            !known.insert(match value {
                Scalar::Number(number) => Ok((number + 0.0).to_bits()),
                other => Err(format!("{other:?}")),
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
