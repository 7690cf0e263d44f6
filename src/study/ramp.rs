//! The values that a parameter takes, one after the other or side by side.

use std::fmt;

use super::Scalar;
use super::errors::PlanError;
use crate::quantity::positive;

/// The way through the values of a [`Ramp`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Course {
    /// From the smallest value to the largest.
    #[default]
    Up,
    /// From the largest to the smallest.
    Down,
    /// Up, and down again: the largest value comes once, all others twice.
    UpAndDown,
}

/// Direction from which a ramp comes to a value.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Leg {
    /// From below.
    Up,
    /// From above.
    Down,
}

impl fmt::Display for Leg {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.pad(match self {
            Self::Up => "up",
            Self::Down => "down",
        })
    }
}

/// A parameter that changes step by step, each value from the last state of the one before: hysteresis shows.
///
/// ```
/// use granular_edmd::study::{Course, Leg, Ramp};
/// let ramp = Ramp::new("friction", [0.1, 0.2, 0.3], Course::UpAndDown);
/// let path: Vec<(Leg, f64)> = ramp.path().collect();
/// assert_eq!(path[1..4], [(Leg::Up, 0.2), (Leg::Up, 0.3), (Leg::Down, 0.2)]);
/// ```
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Ramp {
    parameter: String,
    values: Vec<f64>,
    #[serde(default)]
    course: Course,
    #[serde(skip_serializing_if = "Option::is_none")]
    refine: Option<Width>,
}

/// Width to which a transition is bisected; in a plan `refine = { relative = 0.01 }`.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Width {
    /// In the unit of the parameter.
    Absolute(f64),
    /// A share of the value itself, for parameters that go over orders of magnitude. All values must be
    /// positive.
    Relative(f64),
}

impl Ramp {
    /// Makes a ramp of the parameter of this name through these values, which increase.
    pub fn new(parameter: impl Into<String>, values: impl Into<Vec<f64>>, course: Course) -> Self {
        Self { parameter: parameter.into(), values: values.into(), course, refine: None }
    }

    /// Returns the same ramp with each transition between two of its values bisected until it is known to
    /// this width.
    ///
    /// Transitions are changes of [`Experiment::state`](super::Experiment::state). Only neighbors of
    /// different states are looked between. A ramp up brackets transitions from below, one down from above.
    /// The values of a bisection come after those of the ramp, each from the last state on the near side.
    pub fn with_refinement(self, width: Width) -> Self {
        Self { refine: Some(width), ..self }
    }

    /// Returns the width to which transitions are bisected.
    pub const fn refine(&self) -> Option<Width> {
        self.refine
    }

    /// Returns whether a value is between the first and the last.
    pub(super) fn spans(&self, at: f64) -> bool {
        self.values.first().is_some_and(|low| *low <= at)
            && self.values.last().is_some_and(|high| at <= *high)
    }

    /// Returns the name of the parameter.
    pub fn parameter(&self) -> &str {
        &self.parameter
    }

    /// Returns its values in the order in which they come.
    pub fn path(&self) -> impl Iterator<Item = (Leg, f64)> {
        (0..self.len()).filter_map(|index| self.at(index))
    }

    /// Returns how many values come.
    pub(super) fn len(&self) -> usize {
        self.ups() + self.downs()
    }

    /// Returns the value of this index, and the way to it.
    pub(super) fn at(&self, index: usize) -> Option<(Leg, f64)> {
        if index < self.ups() {
            return Some((Leg::Up, self.values[index]));
        }
        let downs = &self.values[..self.downs()];
        downs.iter().rev().nth(index - self.ups()).map(|&value| (Leg::Down, value))
    }

    const fn ups(&self) -> usize {
        if matches!(self.course, Course::Down) { 0 } else { self.values.len() }
    }

    const fn downs(&self) -> usize {
        match self.course {
            Course::Up => 0,
            Course::Down => self.values.len(),
            Course::UpAndDown => self.values.len().saturating_sub(1),
        }
    }

    pub(super) fn check(&self) -> Result<(), PlanError> {
        let parameter = || self.parameter.clone();
        if self.values.is_empty() {
            return Err(PlanError::NoValues { parameter: parameter() });
        }
        if let Some(&value) = self.values.iter().find(|value| !value.is_finite()) {
            return Err(PlanError::NotFinite { parameter: parameter(), value });
        }
        if let Some(Width::Absolute(width) | Width::Relative(width)) = self.refine {
            positive("width of a transition", width)?;
        }
        if let Some(Width::Relative(_)) = self.refine {
            positive("value of a ramp with a relative width", self.values[0])?;
        }
        match self.values.windows(2).find(|pair| pair[0] >= pair[1]) {
            Some(pair) => {
                Err(PlanError::NotIncreasing { parameter: parameter(), value: pair[1], before: pair[0] })
            }
            None => Ok(()),
        }
    }
}

/// A parameter that differs between ramps: each of its values starts afresh, independent of all others.
///
/// ```
/// use granular_edmd::study::Axis;
/// assert_eq!(Axis::new("inelasticity", [0.0, 0.01]).values().len(), 2);
/// assert_eq!(Axis::new("sides", ["hard", "periodic"]).parameter(), "sides");
/// ```
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Axis {
    parameter: String,
    values: Vec<Scalar>,
}

impl Axis {
    /// Makes an axis of the parameter of this name with these values, in any order.
    pub fn new(parameter: impl Into<String>, values: impl IntoIterator<Item: Into<Scalar>>) -> Self {
        Self { parameter: parameter.into(), values: values.into_iter().map(Into::into).collect() }
    }

    /// Returns the name of the parameter.
    pub fn parameter(&self) -> &str {
        &self.parameter
    }

    /// Returns its values.
    pub fn values(&self) -> &[Scalar] {
        &self.values
    }

    /// Takes each value as the parameter does, which may know another kind of numbers.
    pub(super) fn set_values(&mut self, values: Vec<Scalar>) {
        self.values = values;
    }

    pub(super) fn check(&self) -> Result<(), PlanError> {
        let parameter = || self.parameter.clone();
        if self.values.is_empty() {
            return Err(PlanError::NoValues { parameter: parameter() });
        }
        match self.values.iter().filter_map(Scalar::number).find(|value| !value.is_finite()) {
            Some(value) => Err(PlanError::NotFinite { parameter: parameter(), value }),
            None => Ok(()),
        }
    }
}
