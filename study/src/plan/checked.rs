//! New plans, made by a program or read from a file. All checks are made here, so that a faulty plan does not
//! make a run fail later.

use granular_edmd::boundary::Boundary;
use granular_edmd::collision::CollisionRule;
use granular_edmd::observable::Heading;
use granular_edmd::quantity::accept;

use super::protocol::Protocol;
use super::ramp::Ramp;
use super::values::{Axis, tried};
use super::{Parts, Plan};
use crate::errors::chain;
use crate::experiment::columns::{Column, OF_TABLES, Table, error_names};
use crate::parameters::{self, probe, whole_name};
use crate::{Experiment, PlanError};

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
    pub(super) fn checked(self) -> Result<Plan<E>, PlanError> {
        let plan = self.consistent()?;
        plan.check_experiments()?;
        Ok(plan)
    }

    /// Returns the plan, or an error if one of its parts is not valid.
    pub(super) fn consistent(self) -> Result<Plan<E>, PlanError> {
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
