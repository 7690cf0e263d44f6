//! Plans: studies as data.

mod checked;
pub(super) mod protocol;
pub(super) mod ramp;
pub(super) mod values;

use std::fmt;

use granular_edmd::quantity::accept;
use serde::{Deserialize, Serialize, Serializer};
use toml::Table;

use super::parameters::{self, Scalar, derived_seed, place, seed_at};
use super::{Experiment, ExperimentError, Leg, PlanError};
use protocol::Protocol;
use ramp::Ramp;
use values::Axis;

/// The plan of a study as data: an experiment, its sampling, its ramp, its sweep, and its number of repeats.
///
/// The axes of the sweep span a grid. Each repeat of each point is a ramp, which has a separate seed and is
/// independent of all other ramps. Each step of a ramp is a *value*. Without axes, the grid has one point.
/// Without a ramp, each point has one value.
///
/// Axes and ramps vary parameters of the experiment by name. The whole name of a parameter consists of the
/// names of the groups that contain it, then its own name (`base.bi_parabolic.amplitude`). The name after the
/// last dot is enough if no other parameter has it.
///
/// A ramp is a function of its parameters, its repeat and the seed, not of the rest of the plan: a larger
/// plan has the same ramps, and so do the parts of a sweep
/// ([`Control::with_earlier_studies`](super::Control::with_earlier_studies)). The seed of a ramp is the first
/// eight bytes of $`\mathrm{BLAKE3}(\text{seed of the point}, \text{repeat})`$. The seed of a point follows
/// in the same way from the plan's seed, and the name and value of each parameter of the sweep. Successive
/// ramp indices first run through the repeats of a point, then move to the next point.
///
/// ```
/// use granular_edmd_study::{Plan, Scalar, vibrated_box::VibratedBox};
///
/// let plan: Plan<VibratedBox> = Plan::from_toml(
///     r#"
///     seed = 1
///     experiment = { disks = 100, width = 20.0, height = 50.0, base.thermal = { temperature = 1.0 } }
///     protocol = { settle = 100, samples = 10, every = 10 }
///     ramp = { parameter = "friction", values = [0.01, 0.02, 0.03], course = "up_and_down" }
///     sweep = [{ parameter = "inelasticity", values = [0.0, 0.01] }]
///     "#,
/// )?;
/// assert_eq!((plan.ramp_count(), plan.value_count()), (2, 5));
/// assert_eq!(plan.experiment(1, 4)?.friction, 0.01);
/// assert_eq!(plan.parameters(1, 4)[0], ("inelasticity", Scalar::Number(0.01)));
/// assert_eq!(plan.parameters(1, 4)[1], ("friction", Scalar::Number(0.01)));
/// assert_eq!(Plan::from_toml(&plan.to_toml()?)?, plan);
///
/// let error = Plan::<VibratedBox>::from_toml("seed = 1\nsede = 2").unwrap_err();
/// assert!(error.to_string().contains("unknown field `sede`"));
/// # Ok::<(), granular_edmd_study::PlanError>(())
/// ```
#[doc(alias("sweep", "TOML"))]
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(try_from = "Parts<E>", bound(deserialize = "E: Experiment"))]
pub struct Plan<E> {
    pub(super) parts: Parts<E>,
    /// The parameters of the experiment by name. Each swept parameter has its first value, in the number type
    /// that the experiment reads.
    tree: Table,
    /// The full names of the parameters that vary: first the axes in their order, then the ramp.
    pub(super) varied: Vec<String>,
}

/// The parts of a plan, as in its file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename = "Plan")]
pub(super) struct Parts<E> {
    seed: u64,
    #[serde(default = "one", skip_serializing_if = "is_one")]
    repeats: usize,
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    end_states: bool,
    pub(super) experiment: E,
    protocol: Protocol,
    #[serde(skip_serializing_if = "Option::is_none")]
    ramp: Option<Ramp>,
    #[serde(default = "Vec::new", skip_serializing_if = "Vec::is_empty")]
    pub(super) sweep: Vec<Axis>,
}

const fn one() -> usize {
    1
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes references")]
const fn is_one(count: &usize) -> bool {
    *count == 1
}

impl<E: Serialize> Serialize for Plan<E> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.parts.serialize(serializer)
    }
}

/// Writes the plan in the form of its file.
impl<E: Experiment> fmt::Display for Plan<E> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.to_toml().map_err(|_| fmt::Error)?)
    }
}

impl<E: Experiment> Plan<E> {
    /// Returns the plan in TOML.
    ///
    /// # Errors
    /// If the plan cannot be written as TOML.
    pub fn to_toml(&self) -> Result<String, PlanError> {
        toml::to_string(self).map_err(|error| PlanError::toml(&error))
    }

    /// Returns the same plan, in which every record keeps the state at the end of its value
    /// ([`Record::checkpoint`](super::Record::checkpoint)).
    ///
    /// Otherwise, a record keeps its end state only if another value starts from this state, since the state
    /// takes most of a record's bytes.
    pub fn with_end_states(mut self) -> Self {
        self.parts.end_states = true;
        self
    }

    /// Returns whether the record of a value keeps the state at its end. In a refined ramp, every record
    /// keeps it, since a bisection may start from any value.
    pub(super) fn keeps_state(&self, value: usize) -> bool {
        self.parts.end_states || self.is_refined() || value + 1 < self.value_count()
    }

    /// Returns the protocol by which values are sampled.
    pub const fn protocol(&self) -> &Protocol {
        &self.parts.protocol
    }

    /// Returns the seed from which all other seeds follow.
    pub const fn seed(&self) -> u64 {
        self.parts.seed
    }

    /// Returns the number of repeats of each point.
    pub const fn repeats(&self) -> usize {
        self.parts.repeats
    }

    /// Returns the number of ramps, which is the number of points times the number of repeats.
    pub fn ramp_count(&self) -> usize {
        self.point_count() * self.parts.repeats
    }

    /// Returns the number of points of the grid.
    pub fn point_count(&self) -> usize {
        self.parts.sweep.iter().map(Axis::len).product()
    }

    /// Returns the number of values of each ramp, without the values that a refinement adds.
    pub fn value_count(&self) -> usize {
        self.parts.ramp.as_ref().map_or(1, Ramp::len)
    }

    /// Returns the names of the parameters that vary: first the axes in their order, then the ramp.
    pub fn varied(&self) -> impl Iterator<Item = &str> {
        let ramped = self.parts.ramp.iter().map(Ramp::parameter);
        self.parts.sweep.iter().map(Axis::parameter).chain(ramped)
    }

    /// Returns the seed of a ramp.
    pub fn ramp_seed(&self, ramp: usize) -> u64 {
        let parameters = self.parameters_at(ramp, None);
        let mut swept: Vec<_> = self.varied.iter().zip(&parameters).collect();
        // The order of the axes does not matter.
        swept.sort_by_key(|(name, _)| *name);
        let point = swept.iter().fold(self.parts.seed, |seed, (name, (_, value))| seed_at(seed, name, value));
        derived_seed(point, (ramp % self.parts.repeats) as u64)
    }

    /// Returns the parameters that vary, with their settings in the given value. The list is empty if there
    /// is no such value.
    pub fn parameters(&self, ramp: usize, value: usize) -> Vec<(&str, Scalar)> {
        if ramp >= self.ramp_count() || value >= self.value_count() {
            return Vec::new();
        }
        self.parameters_at(ramp, self.at(value))
    }

    /// Returns the parameters that vary, with the ramped parameter at `at`.
    pub(super) fn parameters_at(&self, ramp: usize, at: Option<f64>) -> Vec<(&str, Scalar)> {
        let mut rest = ramp / self.parts.repeats;
        let mut found: Vec<(&str, Scalar)> = Vec::with_capacity(self.varied.len());
        for (axis, name) in self.parts.sweep.iter().zip(&self.varied).rev() {
            let kind = parameters::get(&self.tree, name).and_then(Scalar::of_toml);
            let value = axis.value(rest % axis.len()).zip(kind);
            found.extend(value.map(|(value, kind)| (axis.parameter(), value.like(&kind))));
            rest /= axis.len();
        }
        found.reverse();
        let ramped = self.parts.ramp.as_ref().zip(at);
        found.extend(ramped.map(|(ramp, at)| (ramp.parameter(), at.into())));
        found
    }

    /// Returns the experiment of a value.
    ///
    /// # Errors
    /// If there is no such ramp or value.
    pub fn experiment(&self, ramp: usize, value: usize) -> Result<E, PlanError> {
        accept(ramp < self.ramp_count(), "index of a ramp", "below the number of ramps", ramp as f64)?;
        accept(value < self.value_count(), "index of a value", "below the number of values", value as f64)?;
        self.experiment_at(ramp, self.at(value))
    }

    /// Returns the experiment where the ramped parameter is `at`.
    pub(super) fn experiment_at(&self, ramp: usize, at: Option<f64>) -> Result<E, PlanError> {
        let (mut tree, varied) = (self.tree.clone(), self.parameters_at(ramp, at));
        for (name, (_, to)) in self.varied.iter().zip(&varied) {
            // The names were checked when the plan was made, so this succeeds.
            let _ = parameters::set(&mut tree, name, to);
        }
        parameters::experiment(tree).map_err(|reason| self.refused(ramp, at, reason.into()))
    }

    /// Returns the experiment where the ramped parameter is `at`, or the error with which the experiment
    /// rejects its parameters.
    pub(super) fn sound_experiment(&self, ramp: usize, at: Option<f64>) -> Result<E, PlanError> {
        let experiment = self.experiment_at(ramp, at)?;
        experiment.check().map_err(|source| self.refused(ramp, at, source))?;
        Ok(experiment)
    }

    fn refused(&self, ramp: usize, at: Option<f64>, source: ExperimentError) -> PlanError {
        PlanError::Experiment { place: place(&self.parameters_at(ramp, at)), source }
    }

    /// Returns the ramp of each point, or `None` if the plan has no ramp.
    pub const fn ramp(&self) -> Option<&Ramp> {
        self.parts.ramp.as_ref()
    }

    /// Returns whether ramps bisect transitions, and therefore have more values than the plan lists.
    pub(super) fn is_refined(&self) -> bool {
        self.parts.ramp.as_ref().is_some_and(|ramp| ramp.refine.is_some())
    }

    /// Returns the ramped parameter at a value that the plan lists.
    fn at(&self, value: usize) -> Option<f64> {
        self.step(value).map(|(_, at)| at)
    }

    pub(super) fn step(&self, value: usize) -> Option<(Leg, f64)> {
        self.parts.ramp.as_ref().and_then(|ramp| ramp.at(value))
    }
}
