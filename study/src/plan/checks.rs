//! Checks of a new plan, so that its faults do not make a run fail later.

use granular_edmd::boundary::Boundary;
use granular_edmd::collision::CollisionRule;
use granular_edmd::quantity::accept;

use super::values::{Axis, tried};
use super::{Parts, Plan};
use crate::experiment::{Experiment, columns};
use crate::parameters::{self, probe, whole_name};
use crate::{PlanError, Ramp};

/// Largest number of values of a study, in all ramps together.
const MOST_VALUES: usize = 1_000_000;

/// Largest seed: a plan has no larger integers.
const LARGEST_SEED: u64 = i64::MAX as u64;

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
        let mut plan = Plan { parts: self, tree, varied: Vec::new(), kinds: Vec::new() };
        plan.check_count()?;
        plan.varied = plan.varied().map(|name| whole_name(&plan.tree, name)).collect::<Result<_, _>>()?;
        plan.check_varied()?;
        plan.try_names()?;
        columns::check_names::<E>(&plan.varied().collect::<Vec<_>>())?;
        Ok(plan)
    }
}

impl<E: Experiment> Plan<E> {
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

    /// Sets each parameter that varies to its first value, to check that it exists and to see the kind of its
    /// values as the experiment reads them.
    fn try_names(&mut self) -> Result<(), PlanError> {
        for (axis, name) in self.parts.sweep.iter_mut().zip(&self.varied) {
            let Some(first) = axis.value(0) else { continue };
            let kind = probe::<E>(&self.tree, axis.parameter(), name, &first)?;
            axis.set_kind(&kind)?;
            self.kinds.push(kind);
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
        // With parameters that vary, the experiment as it stands is never run, and need not be possible.
        if self.varied.is_empty() {
            self.parts.experiment.check().map_err(|source| Self::refused(&[], source))?;
        }
        let values = self.value_count();
        let all = tried(self.point_count() * values);
        for (ramp, value) in all.map(|index| (index / values * self.parts.repeats, index % values)) {
            self.sound_experiment(&self.parameters(ramp, value))?;
        }
        self.check_disks()?;
        self.check_ramp()
    }

    /// Checks that the ramped parameter changes the simulation, and not only the disks at its start, which
    /// stay the same along a ramp.
    fn check_ramp(&self) -> Result<(), PlanError> {
        let (Some(ramp), true) = (&self.parts.ramp, self.value_count() > 1) else { return Ok(()) };
        let varied = self.parameters(0, 1);
        let refused = |source| Self::refused(&varied, source);
        let first = self.experiment_of(&self.parameters(0, 0))?;
        let next = self.experiment_of(&varied)?;
        if first.disks(0).map_err(refused)? == next.disks(0).map_err(refused)? {
            return Ok(());
        }
        let mut run = first.build(0).map_err(refused)?;
        let before = run.checkpoint();
        next.change(&mut run).map_err(refused)?;
        // Parts without fingerprints may have changed.
        let told = run.rule().fingerprint().is_some() && run.boundary().fingerprint().is_some();
        let is_same = told && E::cycle(&first) == E::cycle(&next) && run.checkpoint() == before;
        if is_same { Err(not_rampable(ramp)) } else { Ok(()) }
    }

    /// Checks that the disks fit at the first point, and along each axis at the tried values.
    fn check_disks(&self) -> Result<(), PlanError> {
        let mut stride = self.ramp_count();
        let mut ramps = vec![0];
        for axis in &self.parts.sweep {
            stride /= axis.len();
            ramps.extend(axis.tried().filter(|index| *index > 0).map(|index| index * stride));
        }
        for ramp in ramps {
            let varied = self.parameters(ramp, 0);
            let disks = self.sound_experiment(&varied)?.disks(0);
            disks.map_err(|source| Self::refused(&varied, source))?;
        }
        Ok(())
    }
}

fn not_rampable(ramp: &Ramp) -> PlanError {
    PlanError::varied(ramp.parameter(), "cannot be ramped with the disks in place; sweep it instead")
}
