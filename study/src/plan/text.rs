//! Plans as TOML text, which pass the same checks as plans made by a program.

use std::fmt;

use serde::{Deserialize, Deserializer};

use crate::errors::{PlanError, chain};
use crate::{Axis, Experiment, Plan, Protocol, Ramp};

impl<E: Experiment> Plan<E> {
    /// Reads a plan in TOML.
    ///
    /// # Errors
    /// If the text is not TOML, a field is unknown or missing, or a value is refused. The error names it.
    pub fn from_toml(text: &str) -> Result<Self, PlanError> {
        let plan = Self::from_toml_unproven(text)?;
        plan.check_experiments()?;
        Ok(plan)
    }

    /// Reads a plan without a check of its experiments, which is needed only once.
    pub(crate) fn from_toml_unproven(text: &str) -> Result<Self, PlanError> {
        let raw: Raw<E> = toml::from_str(text).map_err(|error| PlanError::toml(&error))?;
        raw.plan().consistent()
    }

    /// Returns the plan in TOML.
    ///
    /// # Errors
    /// If the plan cannot be written as TOML.
    pub fn to_toml(&self) -> Result<String, PlanError> {
        toml::to_string(self).map_err(|error| PlanError::toml(&error))
    }
}

/// Writes the plan in the form of its file.
impl<E: Experiment> fmt::Display for Plan<E> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.to_toml().map_err(|_| fmt::Error)?)
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename = "Plan")]
struct Raw<E> {
    seed: u64,
    #[serde(default = "one")]
    repeats: usize,
    #[serde(default)]
    end_states: bool,
    experiment: E,
    protocol: Protocol,
    ramp: Option<Ramp>,
    #[serde(default = "Vec::new")]
    sweep: Vec<Axis>,
}

const fn one() -> usize {
    1
}

impl<E: Experiment> Raw<E> {
    fn plan(self) -> Plan<E> {
        let Self { seed, repeats, end_states, experiment, protocol, ramp, sweep } = self;
        Plan { repeats, end_states, ramp, sweep, ..Plan::bare(experiment, protocol, seed) }
    }
}

impl<'de, E: Experiment> Deserialize<'de> for Plan<E> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let told = |error: PlanError| serde::de::Error::custom(chain(&error));
        Raw::deserialize(deserializer)?.plan().checked().map_err(told)
    }
}
