//! The values of a parameter: a list, or a rule, which takes the same memory for any number of values. The
//! values of an axis.

use std::collections::HashSet;

use granular_edmd::ParameterError;
use granular_edmd::quantity::{accept, finite, positive};
use serde::{Deserialize, Serialize};

use crate::PlanError;
use crate::parameters::Scalar;

/// Implements `Deserialize`: reads exactly these fields, then evaluates the expression.
///
/// A derived `Deserialize` would fill private fields with numbers that no constructor accepts.
macro_rules! from_file {
    ($name:ident { $($(#[$attribute:meta])* $field:ident: $type:ty),+ } => $checked:expr, $error:ty) => {
        impl<'de> serde::Deserialize<'de> for $name {
            fn deserialize<D: serde::Deserializer<'de>>(file: D) -> Result<Self, D::Error> {
                // The mirror has the same name as the type, since errors of formats show this name.
                #[derive(serde::Deserialize)]
                #[serde(deny_unknown_fields)]
                struct $name {
                    $($(#[$attribute])* $field: $type,)+
                }
                let $name { $($field),+ } = serde::Deserialize::deserialize(file)?;
                let checked = || -> Result<Self, $error> { $checked };
                checked().map_err(serde::de::Error::custom)
            }
        }
    };
}

pub(super) use from_file;

/// A parameter that differs between ramps. Each of its values starts afresh, independent of all other values.
///
/// ```
/// use granular_edmd_study::Axis;
/// assert_eq!(Axis::new("inelasticity", [0.0, 0.01])?.len(), 2);
/// assert_eq!(Axis::new("sides", ["hard", "periodic"])?.parameter(), "sides");
/// # Ok::<(), granular_edmd_study::PlanError>(())
/// ```
#[doc(alias("sweep", "parameter scan"))]
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Axis {
    parameter: String,
    pub(super) values: Values,
}

from_file! {
    Axis { parameter: String, values: Values } => {
        let axis = Self { parameter, values };
        axis.check().map(|()| axis)
    }, PlanError
}

#[expect(clippy::len_without_is_empty, reason = "an axis has at least one value")]
impl Axis {
    /// Creates an axis on which the parameter with this name takes the given values, in any order.
    ///
    /// # Errors
    /// If there are no values, a value is not finite, or a value occurs twice.
    pub fn new(
        parameter: impl Into<String>,
        values: impl IntoIterator<Item: Into<Scalar>>,
    ) -> Result<Self, PlanError> {
        let axis = Self { parameter: parameter.into(), values: Values::list(values) };
        axis.check().map(|()| axis)
    }

    /// Checks that there are values, that they are finite, and that they differ.
    pub(super) fn check(&self) -> Result<(), PlanError> {
        self.values.check(&self.parameter)?;
        let Some(value) = self.values.twice() else { return Ok(()) };
        let reason =
            format!("takes the value {value} twice; for several runs of each value give the plan repeats");
        Err(PlanError::varied(&self.parameter, reason))
    }

    /// Returns the name of the parameter.
    pub fn parameter(&self) -> &str {
        &self.parameter
    }

    /// Returns the number of values.
    pub const fn len(&self) -> usize {
        self.values.len()
    }

    /// Returns the value with this index, or `None` beyond the last value.
    pub fn value(&self, index: usize) -> Option<Scalar> {
        self.values.at(index)
    }
}

/// Largest number of values that are checked when a plan is made.
pub(crate) const MOST_TRIED: usize = 1024;

/// Returns the indices below `count` of the values that are checked when a plan is made: all if there are at
/// most [`MOST_TRIED`], and otherwise this number, evenly spread, with the first and the last. A plan of a
/// million values is thus made quickly. The other values are checked when they are run.
pub(crate) fn tried(count: usize) -> impl Iterator<Item = usize> {
    let tried = count.min(MOST_TRIED);
    (0..tried).map(move |index| index * count.saturating_sub(1) / tried.saturating_sub(1).max(1))
}

/// One or more values of a parameter.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged, try_from = "toml::Value")]
pub(super) enum Values {
    List(Vec<Scalar>),
    Rule(Steps),
}

/// Derived code would try a list, then a rule, and its error could not say what is wrong with either.
impl TryFrom<toml::Value> for Values {
    type Error = String;

    fn try_from(value: toml::Value) -> Result<Self, String> {
        match value {
            toml::Value::Array(list) => {
                let scalars = list.iter().map(|value| Scalar::of_toml(value).ok_or(Scalar::REFUSED));
                Ok(Self::List(scalars.collect::<Result<_, _>>()?))
            }
            toml::Value::Table(rule) => rule.try_into().map(Self::Rule).map_err(|error| error.to_string()),
            other => Err(format!(
                "{other} is neither a list of values nor a rule {{ from, to, step }} or {{ from, to, log }}"
            )),
        }
    }
}

impl Values {
    /// Creates a list of values.
    pub(super) fn list(values: impl IntoIterator<Item: Into<Scalar>>) -> Self {
        Self::List(values.into_iter().map(Into::into).collect())
    }

    pub(super) const fn len(&self) -> usize {
        match self {
            Self::List(list) => list.len(),
            Self::Rule(steps) => steps.count,
        }
    }

    /// Returns the value with this index, or `None` beyond the last value.
    pub(super) fn at(&self, index: usize) -> Option<Scalar> {
        match self {
            Self::List(list) => list.get(index).cloned(),
            Self::Rule(steps) => (index < steps.count).then(|| steps.value(index).into()),
        }
    }

    /// Converts the values of a list to the type of `kind`.
    pub(super) fn set_kind(&mut self, kind: &Scalar) {
        if let Self::List(list) = self {
            for value in list {
                *value = std::mem::replace(value, Scalar::Flag(false)).like(kind);
            }
        }
    }

    /// Returns the indices of the values that are checked. They include the smallest and the largest value,
    /// wherever these are in a list, since an experiment usually accepts a range.
    pub(super) fn tried(&self) -> impl Iterator<Item = usize> {
        let number = |index: &usize| self.at(*index).and_then(|value| value.number()).unwrap_or(0.0);
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
        let Some(value) = list.iter().filter_map(Scalar::number).find(|value| !value.is_finite()) else {
            return Ok(());
        };
        Err(PlanError::varied(parameter, format!("has a value that is not finite: {value}")))
    }

    /// Returns a value that occurs twice in the list, or `None` if there is none.
    fn twice(&self) -> Option<&Scalar> {
        let Self::List(list) = self else { return None };
        let mut known = HashSet::with_capacity(list.len());
        // Zero is added so that both zeros count as the same value.
        list.iter().find(|value| {
            !known.insert(match value {
                Scalar::Number(number) => Ok((number + 0.0).to_bits()),
                other => Err(format!("{other:?}")),
            })
        })
    }
}

/// Largest number of values that a rule may give: beyond 2⁵³, a double cannot represent every integer.
const MOST: f64 = 9_007_199_254_740_992.0;

/// Fraction of a step by which the last step may miss the end. This tolerance allows for rounding, since
/// neither 0.1 nor 1/3 is exactly a double.
const ROUNDING: f64 = 1e-9;

/// Increasing values that follow from a rule, in place of a list in a plan:
/// `{ from = 0.0, to = 1.0, step = 0.1 }` for equal steps, `{ from = 1e-3, to = 1.0, log = 31 }` for 31
/// values in equal ratios.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub(super) struct Steps {
    from: f64,
    to: f64,
    /// The difference of neighbors, or `None` for equal ratios.
    #[serde(skip_serializing_if = "Option::is_none")]
    step: Option<f64>,
    /// The number of values, if they are in equal ratios.
    #[serde(skip_serializing_if = "Option::is_none")]
    log: Option<usize>,
    #[serde(skip)]
    count: usize,
}

from_file! {
    Steps { from: f64, to: f64, step: Option<f64>, log: Option<usize> } => match (step, log) {
        (Some(step), None) => Self::linear(from, to, step),
        (None, Some(count)) => Self::logarithmic(from, to, count),
        (step, _) => {
            let given = if step.is_some() { 2.0 } else { 0.0 };
            Err(ParameterError::new("number of `step` and `log` beside `from` and `to`", "1", given))
        }
    }, ParameterError
}

impl Steps {
    /// Creates values in equal steps from `from` on. The last value is `to` if a whole number of steps
    /// reaches it.
    ///
    /// # Errors
    /// If a number is not finite, the step is not positive or below the rounding of the values, or `to` is
    /// below `from`.
    fn linear(from: f64, to: f64, step: f64) -> Result<Self, ParameterError> {
        finite("first value", from)?;
        finite("last value", to)?;
        positive("step", step)?;
        accept(to >= from, "last value", "at least the first one", to)?;
        let largest = from.abs().max(to.abs());
        accept(largest.next_up() - largest <= step, "step", "above the rounding of the values", step)?;
        let steps = libm::floor((to - from) / step + ROUNDING);
        accept(steps < MOST, "number of steps", "below 2^53", steps)?;
        Ok(Self { from, to, step: Some(step), log: None, count: steps as usize + 1 })
    }

    /// Creates `count` values in equal ratios, the first and the last included.
    ///
    /// # Errors
    /// If the first value is not positive, the last value is not finite or not above the first, their ratio
    /// is not finite, `count` is below 2, or `count` is so large that neighbors would be equal.
    fn logarithmic(from: f64, to: f64, count: usize) -> Result<Self, ParameterError> {
        positive("first value", from)?;
        positive("last value", to)?;
        accept(to > from, "last value", "above the first one", to)?;
        let ratio = to / from;
        accept(ratio.is_finite(), "last value over the first one", "finite", ratio)?;
        accept(count >= 2, "number of values", "at least 2", count as f64)?;
        let is_resolved = libm::log(ratio) / (count - 1) as f64 >= 4.0 * f64::EPSILON;
        accept(is_resolved, "number of values", "so small that neighbors differ", count as f64)?;
        Ok(Self { from, to, step: None, log: Some(count), count })
    }

    /// Returns the value of an index below the number of values.
    ///
    /// Each value is computed from its index, not from the previous value, so rounding errors do not
    /// accumulate. Where a reader of the plan expects a decimal fraction, the value is one.
    fn value(&self, index: usize) -> f64 {
        match self.step {
            Some(step) => self.decimal(index, step),
            None if index + 1 == self.count => self.to,
            None => self.in_ratio(index as f64 / (self.count - 1) as f64),
        }
    }

    /// Returns the value at a share of the way, in equal ratios. A value that differs from a number of few
    /// digits by rounding alone is that number: 100, not 99.99999999999999.
    fn in_ratio(&self, share: f64) -> f64 {
        let ratio = self.to / self.from;
        let value = self.from * libm::pow(ratio, share);
        let near = format!("{value:.11e}").parse().unwrap_or(value);
        let logarithm = libm::log(ratio);
        // The rounding of the share counts as often as the logarithm says. Neighbors stay different values.
        let rounding = (f64::EPSILON * (4.0 + logarithm)).min(0.25 * logarithm / (self.count - 1) as f64);
        if (near - value).abs() <= rounding * value { near } else { value }
    }

    /// Returns a value in equal steps. If the first value and the step are decimal fractions, so is the
    /// result: 0.07, not 0.06999999999999999.
    fn decimal(&self, index: usize, step: f64) -> f64 {
        let value = self.from + index as f64 * step;
        let is_close = |near: &f64| (near - value).abs() <= ROUNDING * step;
        if index == 0 || (index + 1 == self.count && is_close(&self.to)) {
            return if index == 0 { self.from } else { self.to };
        }
        let largest = self.from.abs().max(self.to.abs());
        let places = (14.0 - libm::floor(libm::log10(largest))).clamp(0.0, 300.0) as usize;
        let rounded = |number: f64| format!("{number:.places$}").parse::<f64>().unwrap_or(number);
        let are_decimal = [self.from, step].iter().all(|&number| rounded(number) == number);
        let near = Some(rounded(value)).filter(|near| are_decimal && is_close(near));
        // Adding 0 turns -0 into 0.
        near.unwrap_or(value) + 0.0
    }
}
