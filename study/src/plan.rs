//! Plans: studies as data.

pub(super) mod protocol;
pub(super) mod ramp;
pub(super) mod values;

use std::fmt;

use granular_edmd::boundary::Boundary;
use granular_edmd::collision::CollisionRule;
use granular_edmd::observable::Heading;
use granular_edmd::quantity::accept;
use protocol::Protocol;
use ramp::Ramp;
use serde::{Deserialize, Serialize, Serializer};
use values::{Axis, tried};

use super::errors::chain;
use super::experiment::{Column, OF_TABLES, Table, error_names};
use super::parameters::{self, Scalar, derived, place, probe, seed_at, whole_name};
use super::{Experiment, ExperimentError, Leg, PlanError};

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
    tree: toml::Table,
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

    /// Returns the number of repeats of each point.
    pub const fn repeats(&self) -> usize {
        self.parts.repeats
    }

    /// Returns the number of ramps, which is the number of points times the number of repeats.
    pub fn ramp_count(&self) -> usize {
        self.point_count() * self.parts.repeats
    }

    /// Returns the number of points of the grid.
    pub(super) fn point_count(&self) -> usize {
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
        derived(point, &((ramp % self.parts.repeats) as u64).to_le_bytes())
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

/// The names of the tables of every study.
const TABLES: [&str; 5] = ["values", "samples", "points", "transitions", "columns"];

/// The columns of [`OF_TABLES`] that only some tables have. Other tables may have columns of these names.
const OF_SOME: [&str; 3] = ["time", "from_state", "to_state"];

/// Largest number of values of a study, in all ramps together.
const MOST_VALUES: usize = 1_000_000;

/// Largest seed: a plan cannot hold larger integers.
const LARGEST_SEED: u64 = i64::MAX as u64;

impl<E: Experiment> TryFrom<Parts<E>> for Plan<E> {
    type Error = String;

    fn try_from(parts: Parts<E>) -> Result<Self, String> {
        parts.checked().map_err(|error| chain(&error))
    }
}

impl<E: Experiment> Parts<E> {
    /// Returns the plan, or an error if it cannot be run.
    fn checked(self) -> Result<Plan<E>, PlanError> {
        let plan = self.consistent()?;
        plan.check_experiments()?;
        Ok(plan)
    }

    /// Returns the plan, or an error if one of its parts is not valid.
    fn consistent(self) -> Result<Plan<E>, PlanError> {
        accept(self.seed <= LARGEST_SEED, "seed", "below 2^63", self.seed as f64)?;
        accept(self.repeats > 0, "number of repeats", "at least 1", self.repeats as f64)?;
        let tree = parameters::tree(&self.experiment)?;
        let mut plan = Plan { parts: self, tree, varied: Vec::new() };
        plan.check_count()?;
        plan.varied = plan.varied().map(|name| whole_name(&plan.tree, name)).collect::<Result<_, _>>()?;
        plan.check_varied()?;
        plan.try_names()?;
        check_names::<E>(&plan.varied().collect::<Vec<_>>())?;
        Ok(plan)
    }
}

impl<E: Experiment> Plan<E> {
    /// Creates the plan of one value.
    ///
    /// # Errors
    /// If the experiment refuses its parameters, the protocol is out of range, or the seed is not below
    /// $`2^{63}`$.
    pub fn new(experiment: E, protocol: Protocol, seed: u64) -> Result<Self, PlanError> {
        let (ramp, sweep) = (None, Vec::new());
        Parts { seed, repeats: 1, end_states: false, experiment, protocol, ramp, sweep }.checked()
    }

    /// Reads a plan in TOML.
    ///
    /// # Errors
    /// If the text is not TOML, a field is unknown or missing, or a value is refused. The error names the
    /// field or the value.
    pub fn from_toml(text: &str) -> Result<Self, PlanError> {
        let plan = Self::from_toml_unproven(text)?;
        plan.check_experiments()?;
        Ok(plan)
    }

    /// Reads a plan without checking its experiments: they were checked when the plan was written to its
    /// folder.
    pub(crate) fn from_toml_unproven(text: &str) -> Result<Self, PlanError> {
        let parts: Parts<E> = toml::from_str(text).map_err(|error| PlanError::toml(&error))?;
        parts.consistent()
    }

    /// Returns the same plan with a ramp at each point.
    ///
    /// # Errors
    /// If the parameter cannot be ramped, is swept already, or does not belong to the experiment, or if its
    /// values are refused or do not increase.
    pub fn with_ramp(self, ramp: Ramp) -> Result<Self, PlanError> {
        Parts { ramp: Some(ramp), ..self.parts }.checked()
    }

    /// Returns the same plan with one more axis.
    ///
    /// The value of the last axis changes fastest.
    ///
    /// # Errors
    /// If the parameter varies already or does not belong to the experiment, or if a value is refused.
    pub fn with_axis(mut self, axis: Axis) -> Result<Self, PlanError> {
        self.parts.sweep.push(axis);
        self.parts.checked()
    }

    /// Returns the same plan with `repeats` repeats of each point, each with another seed.
    ///
    /// # Errors
    /// If the number is 0, or the plan then has too many values.
    pub fn with_repeats(self, repeats: usize) -> Result<Self, PlanError> {
        Parts { repeats, ..self.parts }.checked()
    }

    /// Checks that no parameter varies twice, and that the ramped parameter can be ramped.
    fn check_varied(&self) -> Result<(), PlanError> {
        let twice = self.varied.iter().enumerate().find(|&(index, name)| self.varied[..index].contains(name));
        if let Some((_, parameter)) = twice {
            let reason = "varies twice: each parameter can be ramped or swept once";
            return Err(PlanError::varied(parameter, reason));
        }
        match (&self.parts.ramp, self.varied.last()) {
            (Some(ramp), Some(name)) if !E::can_be_ramped(name) => Err(not_rampable(ramp)),
            _ => Ok(()),
        }
    }

    /// Sets each parameter that varies to its first value. This checks that the parameter exists, and shows
    /// in which type the experiment reads its values.
    fn try_names(&mut self) -> Result<(), PlanError> {
        for (axis, name) in self.parts.sweep.iter_mut().zip(&self.varied) {
            let Some(first) = axis.value(0) else { continue };
            let kind = probe::<E>(&self.tree, axis.parameter(), name, &first)?;
            // Equal plans have equal files. Values that differ may become the same value of this type.
            axis.values.set_kind(&kind);
            axis.check()?;
            let _ = parameters::set(&mut self.tree, name, &kind);
        }
        if let (Some(ramp), Some(name)) = (&self.parts.ramp, self.varied.last())
            && let Some((_, at)) = ramp.at(0)
        {
            probe::<E>(&self.tree, ramp.parameter(), name, &at.into())?;
        }
        Ok(())
    }

    fn check_count(&self) -> Result<(), PlanError> {
        let lengths = self.parts.sweep.iter().map(Axis::len).chain([self.value_count(), self.parts.repeats]);
        let count = lengths.map(|length| length as u128).fold(1_u128, u128::saturating_mul);
        if count > MOST_VALUES as u128 {
            let reason = format!("ramps and values are too many: at most {MOST_VALUES} are possible");
            return Err(PlanError::Refused(format!("{count} {reason}")));
        }
        Ok(())
    }

    /// Checks that the experiment accepts the parameters of each value, or of a selection if there are many
    /// values.
    pub(crate) fn check_experiments(&self) -> Result<(), PlanError> {
        let values = self.value_count();
        let all = tried(self.point_count() * values);
        for (ramp, value) in all.map(|index| (index / values * self.parts.repeats, index % values)) {
            self.sound_experiment(ramp, self.at(value))?;
        }
        self.check_disks()?;
        self.check_ramp()
    }

    /// Checks that the ramped parameter changes more than the disks at the start of the simulation, since a
    /// ramp keeps its disks.
    fn check_ramp(&self) -> Result<(), PlanError> {
        let (Some(ramp), true) = (&self.parts.ramp, self.value_count() > 1) else { return Ok(()) };
        let [first_at, next_at] = [0, 1].map(|value| self.at(value));
        let refused = |source| self.refused(0, next_at, source);
        let (first, next) = (self.experiment_at(0, first_at)?, self.experiment_at(0, next_at)?);
        if first.disks(0).map_err(refused)? == next.disks(0).map_err(refused)? {
            return Ok(());
        }
        let mut run = first.build(0).map_err(refused)?;
        let before = run.checkpoint();
        next.change(&mut run).map_err(refused)?;
        // Without fingerprints, the rule and the walls may have changed.
        let are_known = run.rule().fingerprint().is_some() && run.boundary().fingerprint().is_some();
        let is_same = are_known && E::cycle(&first) == E::cycle(&next) && run.checkpoint() == before;
        if is_same { Err(not_rampable(ramp)) } else { Ok(()) }
    }

    /// Checks that the disks fit at the first point, and along each axis at the tried values.
    fn check_disks(&self) -> Result<(), PlanError> {
        let mut stride = self.ramp_count();
        let mut ramps = vec![0];
        for axis in &self.parts.sweep {
            stride /= axis.len();
            ramps.extend(axis.values.tried().filter(|index| *index > 0).map(|index| index * stride));
        }
        for ramp in ramps {
            let disks = self.sound_experiment(ramp, self.at(0))?.disks(0);
            disks.map_err(|source| self.refused(ramp, self.at(0), source))?;
        }
        Ok(())
    }
}

fn not_rampable(ramp: &Ramp) -> PlanError {
    PlanError::varied(ramp.parameter(), "cannot be ramped with the disks in place; sweep it instead")
}

/// Checks that the names of an experiment's columns and tables are valid, unique, and different from the
/// names of varied parameters and built-in columns.
fn check_names<E: Experiment>(varied: &[&str]) -> Result<(), PlanError> {
    let (columns, tables) = (E::columns(), E::tables());
    let names = OF_TABLES.iter().map(|(name, _)| *name);
    let of_all: Vec<&str> = names.filter(|name| !OF_SOME.contains(name)).collect();
    let taken = [of_all.as_slice(), varied].concat();
    let in_samples = columns.iter().filter(|column| column.in_samples).map(Column::name);
    check_each("column", &in_samples.collect::<Vec<_>>(), &[taken.as_slice(), &["time"]].concat())?;
    let in_values = columns.iter().filter(|column| column.in_values);
    let with_errors = in_values.clone().filter(|column| column.has_error());
    let errors: Vec<String> = with_errors.flat_map(|column| error_names(column.name())).collect();
    let errors: Vec<&str> = errors.iter().map(String::as_str).collect();
    let in_values: Vec<&str> = in_values.map(Column::name).collect();
    check_each("column", &in_values, &[taken.as_slice(), &errors].concat())?;
    let all = [of_all.as_slice(), &["time"], &errors].concat();
    if let Some(name) = varied.iter().find(|name| all.contains(name)) {
        return Err(refused("varied parameter", name, "a column of the tables has it"));
    }
    for table in &tables {
        check_each("column", &table.columns().iter().map(Heading::name).collect::<Vec<_>>(), &taken)?;
    }
    check_each("table", &tables.iter().map(Table::name).collect::<Vec<_>>(), &TABLES)
}

fn check_each(what: &str, names: &[&str], taken: &[&str]) -> Result<(), PlanError> {
    for (index, name) in names.iter().enumerate() {
        let is_plain = |letter: char| letter.is_ascii_alphanumeric() || letter == '_';
        if name.is_empty() || !name.chars().all(is_plain) {
            return Err(refused(what, name, "it must be of letters, digits and underscores"));
        }
        if taken.contains(name) || names[..index].contains(name) {
            return Err(refused(what, name, "another one has it"));
        }
    }
    Ok(())
}

fn refused(what: &str, name: &str, reason: &str) -> PlanError {
    PlanError::Refused(format!("{name:?} cannot be the name of a {what}: {reason}"))
}
