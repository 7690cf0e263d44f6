//! Ramps: the successive values of a parameter in one run.

use granular_edmd::quantity::positive;
use serde::{Deserialize, Serialize};

use super::values::Values;
use crate::{Leg, PlanError, Scalar};

/// The order in which a [`Ramp`] goes through its values.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Course {
    /// From the smallest value to the largest.
    #[default]
    Up,
    /// From the largest to the smallest.
    Down,
    /// Up, then down again: the largest value comes once, and all other values twice.
    UpAndDown,
}

/// A parameter that changes step by step. Each value starts from the last state of the previous value, so
/// that hysteresis shows.
///
/// ```
/// use granular_edmd_study::{Course, Leg, Ramp};
/// let ramp = Ramp::new("friction", [0.1, 0.2, 0.3], Course::UpAndDown)?;
/// let path: Vec<(Leg, f64)> = ramp.path().collect();
/// assert_eq!(path[1..4], [(Leg::Up, 0.2), (Leg::Up, 0.3), (Leg::Down, 0.2)]);
/// assert!(Ramp::new("friction", [0.2, 0.1], Course::Up).is_err());
/// # Ok::<(), granular_edmd_study::PlanError>(())
/// ```
#[doc(alias("hysteresis", "annealing"))]
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Ramp {
    parameter: String,
    values: Values<f64>,
    course: Course,
    #[serde(skip_serializing_if = "Option::is_none")]
    refine: Option<Width>,
}

crate::gate::from_file! {
    Ramp {
        parameter: String,
        values: Values<f64>,
        #[serde(default)]
        course: Course,
        refine: Option<Width>
    } => {
        let ramp = Self { parameter, values, course, refine: None }.checked()?;
        match refine {
            Some(width) => ramp.with_refinement(width),
            None => Ok(ramp),
        }
    }, PlanError
}

/// The width to which transitions are bisected, in a plan `refine = { relative = 0.01 }`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Width {
    /// A width in the unit of the parameter.
    Absolute(f64),
    /// A fraction of the value itself, for parameters that span orders of magnitude.
    ///
    /// All values must be positive.
    Relative(f64),
}

impl Ramp {
    /// Creates a ramp of the parameter of this name through these values, which must increase.
    ///
    /// # Errors
    /// If there are no values, or they are not finite or do not increase.
    pub fn new(
        parameter: impl Into<String>,
        values: impl IntoIterator<Item = f64>,
        course: Course,
    ) -> Result<Self, PlanError> {
        let values = Values::List(values.into_iter().collect());
        Self { parameter: parameter.into(), values, course, refine: None }.checked()
    }

    fn checked(self) -> Result<Self, PlanError> {
        self.values.check(&self.parameter)?;
        let Values::List(values) = &self.values else { return Ok(self) };
        let Some(pair) = values.windows(2).find(|pair| pair[0] >= pair[1]) else { return Ok(self) };
        let [before, value] = [pair[0], pair[1]].map(Scalar::from);
        let reason = format!(
            "has {value} after {before}: the values of a ramp must increase; say `course` for the way"
        );
        Err(PlanError::varied(&self.parameter, reason))
    }

    /// Returns the same ramp with bisection of each transition between two of its values, down to this width.
    ///
    /// A transition is a change of [`Experiment::state`](super::Experiment::state). The ramp looks for
    /// transitions only between neighbors of different states. A ramp up brackets transitions from below, a
    /// ramp down from above. The values of a bisection come after the values of the ramp, each from the last
    /// state on the near side.
    ///
    /// # Errors
    /// If the width is not positive, or is relative and a value of the ramp is not positive.
    pub fn with_refinement(self, width: Width) -> Result<Self, PlanError> {
        let (Width::Absolute(number) | Width::Relative(number)) = width;
        positive("width of a transition", number)?;
        if let Width::Relative(_) = width {
            positive("value of a ramp with a relative width", self.values.at(0))?;
        }
        Ok(Self { refine: Some(width), ..self })
    }

    /// Returns the width to which transitions are bisected, or `None` without bisection.
    pub(crate) const fn refinement(&self) -> Option<Width> {
        self.refine
    }

    /// Returns whether a value lies between the first and the last value of the ramp.
    pub(crate) fn spans(&self, at: f64) -> bool {
        self.values.at(0) <= at && at <= self.values.at(self.values.len() - 1)
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
        match self.course {
            Course::Up | Course::Down => self.values.len(),
            Course::UpAndDown => (2 * self.values.len()).saturating_sub(1),
        }
    }

    /// Returns the value of this index, and the direction from which the ramp comes to it.
    pub(super) fn at(&self, index: usize) -> Option<(Leg, f64)> {
        if self.course != Course::Down && index < self.values.len() {
            return Some((Leg::Up, self.values.at(index)));
        }
        let from_below = self.len().checked_sub(index + 1)?;
        Some((Leg::Down, self.values.at(from_below)))
    }
}
