//! A study as data.

use std::fmt;

use serde::{Deserialize, Deserializer, Serialize};
use toml::Table;

use super::errors::PlanError;
use super::parameters::{self, place, probe, whole_name};
use super::refinement::{Seen, Step};
use super::{Axis, Experiment, Leg, Protocol, Ramp, Scalar, column};
use crate::quantity::accept;

/// Most values of a study, all ramps together.
const MOST_VALUES: usize = 1_000_000;

/// Largest seed: a plan has no larger integers.
const LARGEST_SEED: u64 = i64::MAX as u64;

/// What a study does, as data: an experiment, how each value is sampled, what is ramped, what is swept, and how often.
///
/// The axes of the sweep span a grid. Each of its points is a ramp, independent of all others, and is done as often as there
/// are repeats, each with a seed of its own; each step of a ramp is a *value*. Without axes there is one ramp, without a ramp
/// one value in each.
///
/// Axes and ramps vary parameters of the experiment by name: that of its field, with those that it is in before it
/// (`base.bi_parabolic.amplitude`). The last part is enough where no other parameter ends so.
///
/// A point is a function of plan, index and seed alone. The seed of a ramp is
/// `$\mathrm{BLAKE3}(\text{seed}, \text{index})$`, the first eight bytes; repeats are the last and fastest part of the index.
///
/// ```
/// use granular_edmd::study::{Plan, Scalar, vibrated_box::VibratedBox};
///
/// let plan: Plan<VibratedBox> = Plan::from_toml(
///     r#"
///     seed = 1
///     experiment = { disks = 100, width = 20.0, height = 50.0, gravity = 0.0156, base.bi_parabolic = { amplitude = 0.1, angular_frequency = 10.0 } }
///     protocol = { settle = 100, samples = 10, every = 10 }
///     ramp = { parameter = "friction", values = [0.01, 0.02, 0.03], course = "up_and_down" }
///     sweep = [{ parameter = "inelasticity", values = [0.0, 0.01] }]
///     "#,
/// )?;
/// assert_eq!((plan.ramps(), plan.values()), (2, 5));
/// assert_eq!(plan.experiment(1, 4)?.friction, 0.01);
/// assert_eq!(plan.parameters(1, 4), [("inelasticity", Scalar::Number(0.01)), ("friction", Scalar::Number(0.01))]);
/// assert_eq!(Plan::from_toml(&plan.to_toml()?)?, plan);
///
/// let error = Plan::<VibratedBox>::from_toml("seed = 1\nsede = 2").unwrap_err();
/// assert!(error.to_string().contains("unknown field `sede`"));
/// # Ok::<(), granular_edmd::study::PlanError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Plan<E> {
    seed: u64,
    #[serde(skip_serializing_if = "is_one")]
    repeats: usize,
    pub(super) experiment: E,
    protocol: Protocol,
    #[serde(skip_serializing_if = "Option::is_none")]
    ramp: Option<Ramp>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    sweep: Vec<Axis>,
    /// The parameters of the experiment by name.
    #[serde(skip)]
    tree: Table,
    /// The whole names of the parameters that vary: of the axes in their order, then of the ramp.
    #[serde(skip)]
    varied: Vec<String>,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes references")]
const fn is_one(count: &usize) -> bool {
    *count == 1
}

impl<E: Experiment> Plan<E> {
    /// Makes the plan of one value.
    ///
    /// # Errors
    /// If the experiment refuses its parameters, the protocol is out of range, or the seed is not below `$2^{63}$`.
    pub fn new(experiment: E, protocol: Protocol, seed: u64) -> Result<Self, PlanError> {
        let (ramp, sweep, tree, varied) = (None, Vec::new(), Table::new(), Vec::new());
        Self { seed, repeats: 1, experiment, protocol, ramp, sweep, tree, varied }.checked()
    }

    /// Returns the same plan with a ramp in each point.
    ///
    /// # Errors
    /// If the parameter cannot be ramped, is swept, or is none of the experiment's, or its values are refused or do not increase.
    pub fn with_ramp(self, ramp: Ramp) -> Result<Self, PlanError> {
        Self { ramp: Some(ramp), ..self }.checked()
    }

    /// Returns the same plan with one more axis; that of the last one changes fastest.
    ///
    /// # Errors
    /// If the parameter varies already or is none of the experiment's, or a value is refused.
    pub fn with_axis(mut self, axis: Axis) -> Result<Self, PlanError> {
        self.sweep.push(axis);
        self.checked()
    }

    /// Returns the same plan with each point done so often, with different seeds.
    ///
    /// # Errors
    /// If it is 0, or there are too many values then.
    pub fn with_repeats(self, repeats: usize) -> Result<Self, PlanError> {
        Self { repeats, ..self }.checked()
    }

    /// Reads a plan in TOML.
    ///
    /// # Errors
    /// If it is not TOML, a field is unknown or missing, or a value is as it should not be; the error names it.
    pub fn from_toml(text: &str) -> Result<Self, PlanError> {
        Self::from_toml_unproven(text)?.proven()
    }

    /// Reads a plan without a look at the experiment of each value: in large plans that takes seconds, and is done once only.
    pub(super) fn from_toml_unproven(text: &str) -> Result<Self, PlanError> {
        let raw: Raw<E> = toml::from_str(text).map_err(|error| PlanError::Toml(error.to_string()))?;
        raw.plan().consistent()
    }

    /// Returns the plan in TOML.
    ///
    /// # Errors
    /// If it cannot be written so.
    pub fn to_toml(&self) -> Result<String, PlanError> {
        toml::to_string(self).map_err(|error| PlanError::Toml(error.to_string()))
    }

    /// Returns how values are sampled.
    pub const fn protocol(&self) -> &Protocol {
        &self.protocol
    }

    /// Returns the seed of all seeds.
    pub const fn seed(&self) -> u64 {
        self.seed
    }

    /// Returns how often each point is done.
    pub const fn repeats(&self) -> usize {
        self.repeats
    }

    /// Returns the number of ramps: points of the grid, each as often as there are repeats.
    pub fn ramps(&self) -> usize {
        self.points() * self.repeats
    }

    /// Returns the number of points of the grid.
    pub fn points(&self) -> usize {
        self.sweep.iter().map(|axis| axis.values().len()).product()
    }

    /// Returns the number of values of each ramp, without those that a refinement adds.
    pub fn values(&self) -> usize {
        self.ramp.as_ref().map_or(1, Ramp::len)
    }

    /// Returns the names of the parameters that vary: of the axes in their order, then of the ramp.
    pub fn varied(&self) -> impl Iterator<Item = &str> {
        let ramped = self.ramp.iter().map(Ramp::parameter);
        self.sweep.iter().map(Axis::parameter).chain(ramped)
    }

    /// Returns the seed of a ramp.
    pub fn ramp_seed(&self, ramp: usize) -> u64 {
        derived_seed(self.seed, ramp as u64)
    }

    /// Returns the way on which a value is come to; `None` without a ramp.
    pub fn leg(&self, value: usize) -> Option<Leg> {
        self.step(value).map(|(leg, _)| leg)
    }

    /// Returns the parameters that vary, and what they are in a value: none for one that there is not.
    pub fn parameters(&self, ramp: usize, value: usize) -> Vec<(&str, Scalar)> {
        if ramp >= self.ramps() || value >= self.values() {
            return Vec::new();
        }
        self.parameters_at(ramp, self.step(value).map(|(_, at)| at))
    }

    /// Returns the parameters that vary, and what they are where the ramped one is `at`.
    pub(super) fn parameters_at(&self, ramp: usize, at: Option<f64>) -> Vec<(&str, Scalar)> {
        let mut rest = ramp / self.repeats;
        let mut found: Vec<(&str, Scalar)> = Vec::with_capacity(self.varied.len());
        for axis in self.sweep.iter().rev() {
            found.push((axis.parameter(), axis.values()[rest % axis.values().len()].clone()));
            rest /= axis.values().len();
        }
        found.reverse();
        let ramped = self.ramp.as_ref().zip(at);
        found.extend(ramped.map(|(ramp, at)| (ramp.parameter(), at.into())));
        found
    }

    /// Returns the experiment of a value.
    ///
    /// # Errors
    /// If there are not so many ramps or values.
    pub fn experiment(&self, ramp: usize, value: usize) -> Result<E, PlanError> {
        accept(ramp < self.ramps(), "index of a ramp", "below the number of ramps", ramp as f64)?;
        accept(value < self.values(), "index of a value", "below the number of values", value as f64)?;
        self.experiment_of(&self.parameters(ramp, value))
    }

    /// Returns the experiment where the ramped parameter is `at`.
    pub(super) fn experiment_at(&self, ramp: usize, at: Option<f64>) -> Result<E, PlanError> {
        self.experiment_of(&self.parameters_at(ramp, at))
    }

    /// Returns the ramp of each point, if there is one.
    pub const fn ramp(&self) -> Option<&Ramp> {
        self.ramp.as_ref()
    }

    /// Returns the next value of a ramp after those that are done; `None` if there is none.
    pub(super) fn next(&self, seen: &[Seen]) -> Option<Step> {
        match &self.ramp {
            Some(ramp) => ramp.next(seen),
            None => seen.is_empty().then_some(Step { leg: None, at: None, before: None }),
        }
    }

    fn experiment_of(&self, varied: &[(&str, Scalar)]) -> Result<E, PlanError> {
        let mut tree = self.tree.clone();
        for (name, (_, to)) in self.varied.iter().zip(varied) {
            let to = parameters::get(&tree, name).map_or_else(|| to.clone(), |known| to.clone().like(known));
            // Names were tried when the plan was made.
            let _ = parameters::set(&mut tree, name, &to);
        }
        let refused = |reason: String| Self::refused(varied, reason.into());
        parameters::experiment(tree).map_err(refused)
    }

    fn refused(varied: &[(&str, Scalar)], source: super::ExperimentError) -> PlanError {
        let varied: Vec<(&str, &Scalar)> = varied.iter().map(|(name, value)| (*name, value)).collect();
        PlanError::Experiment { place: place(&varied), source }
    }

    pub(super) fn step(&self, value: usize) -> Option<(Leg, f64)> {
        self.ramp.as_ref().and_then(|ramp| ramp.at(value))
    }

    /// Returns the plan, if it can be carried out.
    fn checked(self) -> Result<Self, PlanError> {
        self.consistent()?.proven()
    }

    /// Returns the plan, if the experiment takes the parameters of each value.
    pub(super) fn proven(self) -> Result<Self, PlanError> {
        self.check_experiments()?;
        Ok(self)
    }

    /// Returns the plan, if its parts are each as they should be.
    fn consistent(mut self) -> Result<Self, PlanError> {
        accept(self.seed <= LARGEST_SEED, "seed", "below 2^63", self.seed as f64)?;
        accept(self.repeats > 0, "number of repeats", "at least 1", self.repeats as f64)?;
        self.protocol.check()?;
        column::check_names::<E>(&self.varied().collect::<Vec<_>>())?;
        self.tree = parameters::tree(&self.experiment)?;
        self.ramp.iter().try_for_each(Ramp::check)?;
        self.sweep.iter().try_for_each(Axis::check)?;
        self.check_count()?;
        self.varied = self.varied().map(|name| whole_name(&self.tree, name)).collect::<Result<_, _>>()?;
        self.check_varied()?;
        self.try_names()?;
        Ok(self)
    }

    /// Checks that no parameter varies twice, and that the ramped one can be.
    fn check_varied(&self) -> Result<(), PlanError> {
        let twice = self.varied.iter().enumerate().find(|&(index, name)| self.varied[..index].contains(name));
        if let Some((_, parameter)) = twice {
            return Err(PlanError::VariesTwice { parameter: parameter.clone() });
        }
        match (&self.ramp, self.varied.last()) {
            (Some(ramp), Some(name)) if !E::can_be_ramped(name) => {
                Err(PlanError::NotRampable { parameter: ramp.parameter().to_owned() })
            }
            _ => Ok(()),
        }
    }

    /// Sets each parameter that varies for itself: that there is one of this name, and what its values become.
    fn try_names(&mut self) -> Result<(), PlanError> {
        for (axis, name) in self.sweep.iter_mut().zip(&self.varied) {
            let tried = axis.values().iter().map(|to| probe::<E>(&self.tree, axis.parameter(), name, to));
            let values = tried.collect::<Result<_, _>>()?;
            axis.set_values(values);
        }
        if let (Some(ramp), Some(name)) = (&self.ramp, self.varied.last())
            && let Some((_, at)) = ramp.at(0)
        {
            probe::<E>(&self.tree, ramp.parameter(), name, &at.into())?;
        }
        Ok(())
    }

    fn check_count(&self) -> Result<(), PlanError> {
        let lengths = self.sweep.iter().map(|axis| axis.values().len()).chain([self.values(), self.repeats]);
        let count = lengths.map(|length| length as u128).fold(1_u128, u128::saturating_mul);
        if count > MOST_VALUES as u128 {
            return Err(PlanError::TooMany { count, most: MOST_VALUES });
        }
        Ok(())
    }

    /// Checks that the experiment takes the parameters of each value.
    fn check_experiments(&self) -> Result<(), PlanError> {
        self.experiment.check().map_err(|source| Self::refused(&[], source))?;
        for ramp in (0..self.ramps()).step_by(self.repeats) {
            for value in 0..self.values() {
                let varied = self.parameters(ramp, value);
                self.experiment_of(&varied)?.check().map_err(|source| Self::refused(&varied, source))?;
            }
        }
        self.check_disks()
    }

    /// Checks that the disks fit in: at the first value of all axes, and at each value of each one.
    fn check_disks(&self) -> Result<(), PlanError> {
        let mut stride = self.ramps();
        let mut ramps = vec![0];
        for axis in &self.sweep {
            stride /= axis.values().len();
            ramps.extend((1..axis.values().len()).map(|index| index * stride));
        }
        for ramp in ramps {
            let varied = self.parameters(ramp, 0);
            self.experiment_of(&varied)?.disks(0).map_err(|source| Self::refused(&varied, source))?;
        }
        Ok(())
    }
}

/// The plan as in its file.
impl<E: Experiment> fmt::Display for Plan<E> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.to_toml().map_err(|_| fmt::Error)?)
    }
}

/// Returns a seed for one of many things that need one.
pub(super) fn derived_seed(seed: u64, index: u64) -> u64 {
    let bytes = [seed.to_le_bytes(), index.to_le_bytes()].concat();
    let hash = blake3::hash(&bytes);
    let mut first = [0; 8];
    first.copy_from_slice(&hash.as_bytes()[..8]);
    u64::from_le_bytes(first)
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename = "Plan")]
struct Raw<E> {
    seed: u64,
    #[serde(default = "one")]
    repeats: usize,
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
        let Self { seed, repeats, experiment, protocol, ramp, sweep } = self;
        Plan { seed, repeats, experiment, protocol, ramp, sweep, tree: Table::new(), varied: Vec::new() }
    }
}

impl<'de, E: Experiment> Deserialize<'de> for Plan<E> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let told = |error: PlanError| {
            let sources = std::iter::successors(std::error::Error::source(&error), |&source| source.source());
            let told: Vec<String> =
                std::iter::once(error.to_string()).chain(sources.map(ToString::to_string)).collect();
            serde::de::Error::custom(told.join(": "))
        };
        Raw::deserialize(deserializer)?.plan().checked().map_err(told)
    }
}
