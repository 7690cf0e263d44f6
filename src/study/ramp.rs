//! Ramps and axes: the values that a parameter takes, one after the other or side by side.

use std::fmt;

use super::Scalar;
use super::errors::PlanError;
use crate::quantity::positive;

/// The order in which a [`Ramp`] goes through its values.
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

/// The direction from which a ramp comes to a value.
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

/// A parameter that changes step by step, where each value starts from the last state of the previous one, so
/// that hysteresis shows.
///
/// ```
/// use granular_edmd::study::{Course, Leg, Ramp};
/// let ramp = Ramp::new("friction", [0.1, 0.2, 0.3], Course::UpAndDown);
/// let path: Vec<(Leg, f64)> = ramp.path().collect();
/// assert_eq!(path[1..4], [(Leg::Up, 0.2), (Leg::Up, 0.3), (Leg::Down, 0.2)]);
/// ```
#[doc(alias("hysteresis", "annealing"))]
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

/// The width to which transitions are bisected, in a plan `refine = { relative = 0.01 }`.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Width {
    /// A width in the unit of the parameter.
    Absolute(f64),
    /// A share of the value itself, for parameters that go over orders of magnitude.
    ///
    /// All values must be positive.
    Relative(f64),
}

impl Ramp {
    /// Creates a ramp of the parameter of this name through these values, which must increase.
    pub fn new(parameter: impl Into<String>, values: impl IntoIterator<Item = f64>, course: Course) -> Self {
        Self { parameter: parameter.into(), values: values.into_iter().collect(), course, refine: None }
    }

    /// Returns the same ramp, which bisects each transition between two of its values down to this width.
    ///
    /// A transition is a change of [`Experiment::state`](super::Experiment::state). The ramp looks for
    /// transitions only between neighbors of different states. A ramp up brackets transitions from below, a
    /// ramp down from above. The values of a bisection come after those of the ramp, each from the last state
    /// on the near side.
    pub fn with_refinement(self, width: Width) -> Self {
        Self { refine: Some(width), ..self }
    }

    /// Returns the width to which transitions are bisected, if they are.
    pub const fn refinement(&self) -> Option<Width> {
        self.refine
    }

    /// Returns whether a value lies between the first and the last one.
    pub(super) fn spans(&self, at: f64) -> bool {
        self.values.first().is_some_and(|low| *low <= at)
            && self.values.last().is_some_and(|high| at <= *high)
    }

    /// Returns the name of the parameter.
    pub fn parameter(&self) -> &str {
        &self.parameter
    }

    /// Returns the values in the order in which the ramp comes to them, with the directions.
    pub fn path(&self) -> impl Iterator<Item = (Leg, f64)> {
        (0..self.len()).filter_map(|index| self.at(index))
    }

    /// Returns the number of values that the ramp comes to.
    pub(super) fn len(&self) -> usize {
        self.ups() + self.downs()
    }

    /// Returns the value of this index, and the direction from which the ramp comes to it.
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

/// A parameter that differs between ramps, so that each of its values starts afresh, independent of all
/// others.
///
/// ```
/// use granular_edmd::study::Axis;
/// assert_eq!(Axis::new("inelasticity", [0.0, 0.01]).values().len(), 2);
/// assert_eq!(Axis::new("sides", ["hard", "periodic"]).parameter(), "sides");
/// ```
#[doc(alias("sweep", "parameter scan"))]
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Axis {
    parameter: String,
    values: Vec<Scalar>,
}

impl Axis {
    /// Creates an axis of the parameter of this name with these values, in any order.
    pub fn new(parameter: impl Into<String>, values: impl IntoIterator<Item: Into<Scalar>>) -> Self {
        Self { parameter: parameter.into(), values: values.into_iter().map(Into::into).collect() }
    }

    /// Returns the name of the parameter.
    pub fn parameter(&self) -> &str {
        &self.parameter
    }

    /// Returns the values of the axis.
    pub fn values(&self) -> &[Scalar] {
        &self.values
    }

    /// Replaces the values by the ones that the parameter takes them for, which may be another kind of
    /// number.
    pub(super) fn set_values(&mut self, values: Vec<Scalar>) {
        self.values = values;
    }

    pub(super) fn check(&self) -> Result<(), PlanError> {
        let parameter = || self.parameter.clone();
        if self.values.is_empty() {
            return Err(PlanError::NoValues { parameter: parameter() });
        }
        if let Some(value) = self.values.iter().filter_map(Scalar::number).find(|value| !value.is_finite()) {
            return Err(PlanError::NotFinite { parameter: parameter(), value });
        }
        let twice =
            self.values.iter().enumerate().find(|&(index, value)| self.values[..index].contains(value));
        twice.map_or(Ok(()), |(_, value)| {
            Err(PlanError::Twice { parameter: parameter(), value: value.to_string() })
        })
    }
}
