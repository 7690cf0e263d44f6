//! Axes: the values of a parameter in independent ramps.

use super::values::Values;
use crate::{PlanError, Scalar};

/// A parameter that differs between ramps, so that each of its values starts afresh, independent of all
/// others.
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
    values: Values<Scalar>,
}

crate::gate::from_file! {
    Axis { parameter: String, values: Values<Scalar> } => Self { parameter, values }.checked(), PlanError
}

#[expect(clippy::len_without_is_empty, reason = "an axis has at least one value")]
impl Axis {
    /// Creates an axis of the parameter of this name with these values, in any order.
    ///
    /// # Errors
    /// If there are no values, one is not finite, or one comes twice.
    pub fn new(
        parameter: impl Into<String>,
        values: impl IntoIterator<Item: Into<Scalar>>,
    ) -> Result<Self, PlanError> {
        let values = Values::List(values.into_iter().map(Into::into).collect());
        Self { parameter: parameter.into(), values }.checked()
    }

    fn checked(self) -> Result<Self, PlanError> {
        self.values.check(&self.parameter)?;
        self.check_twice().map(|()| self)
    }

    fn check_twice(&self) -> Result<(), PlanError> {
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

    /// Returns the value of this index, or `None` beyond the last value.
    pub fn value(&self, index: usize) -> Option<Scalar> {
        (index < self.len()).then(|| self.values.at(index))
    }

    /// Returns the indices of the values that are tried when a plan is made.
    pub(super) fn tried(&self) -> impl Iterator<Item = usize> {
        self.values.tried()
    }

    /// Turns the values of a list into the type of the parameter, so that equal plans have equal files.
    /// Values that differ may be one value of that type.
    pub(super) fn set_kind(&mut self, kind: &Scalar) -> Result<(), PlanError> {
        if let Values::List(list) = &mut self.values {
            for value in list {
                *value = value.clone().like(kind);
            }
        }
        self.check_twice()
    }
}
