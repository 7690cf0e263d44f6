//! Values that are played again: the code that runs the values of a study runs them, beside an observer of
//! the caller instead of the experiment's companion, and nothing is saved.

use std::path::Path;
use std::time::Duration;

use granular_edmd::observable::Observer;
use granular_edmd::simulation::{RunEnd, RunError};

use super::{Active, Value};
use crate::experiment::record::Record;
use crate::folder::Folder;
use crate::plan::ramp::Step;
use crate::{Experiment, Plan, PlanError, Run, Study, StudyError};

/// Longest wall-clock time of a slice.
const SLICE: Duration = Duration::from_millis(200);

/// A value whose start is known.
pub(crate) struct Found<E: Experiment> {
    study: Study<E>,
    ramp: usize,
    value: usize,
    step: Step,
    before: Option<Record<E>>,
    experiment: E,
}

impl<E: Experiment> Found<E> {
    /// Finds the first value of a ramp of a plan that has no folder.
    pub(crate) fn first(path: &Path, plan: Plan<E>, ramp: usize) -> Result<Self, StudyError> {
        let step = plan.next(&[]).ok_or_else(|| PlanError::Refused("the plan has no values".into()))?;
        let experiment = plan.experiment_at(ramp, step.at)?;
        // A study reads and writes its folder only when it is asked to.
        let study = Study::in_folder(Folder::new(path)?, plan)?;
        Ok(Self { study, ramp, value: 0, step, before: None, experiment })
    }

    pub(crate) const fn experiment(&self) -> &E {
        &self.experiment
    }

    /// Returns the simulation at the start of the value, and the time at which the protocol ends the value.
    pub(crate) fn start(&self) -> Result<(Run<E>, f64), StudyError> {
        let (value, cycles) = (self.value(), self.study.plan.protocol().cycles() as f64);
        Ok((value.first_state()?, value.start().time(cycles, self.experiment.cycle())))
    }

    pub(crate) fn value(&self) -> Value<'_, E> {
        let Self { study, experiment, step, before, .. } = self;
        let origin = study.origin(self.ramp, self.value);
        Value { study, origin, experiment: experiment.clone(), step: *step, before: before.as_ref() }
    }
}

impl<E: Experiment> Study<E> {
    /// Finds a value of the study.
    pub(crate) fn find(self, ramp: usize, value: usize) -> Result<Found<E>, StudyError> {
        let before = self.ramp_records(ramp).take(value).map(|record| Ok(self.plan.seen(&record?)));
        let seen: Vec<_> = before.collect::<Result<_, StudyError>>()?;
        let next = self.plan.next(&seen);
        let reason = if next.is_some() { "values before it are finished" } else { "values are in the ramp" };
        let absent = || format!("only {} {reason}", seen.len()).into();
        let step = next.filter(|_| seen.len() == value);
        let step = step.ok_or_else(|| StudyError::Build { ramp, value, source: absent() })?;
        // Other code may give other results.
        if self.record(ramp, value)?.is_some_and(|record| !self.is_ours(&record.contents.origin)) {
            return Err(StudyError::changed(self.folder(), "revision"));
        }
        let before = step.before.map(|before| self.record(ramp, before)).transpose()?.flatten();
        let experiment = self.plan.experiment_at(ramp, step.at)?;
        Ok(Found { study: self, ramp, value, step, before, experiment })
    }
}

/// The reason why a run pauses.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Pause {
    /// A slice or a step has ended.
    Slice,
    /// The time that was asked for is reached.
    Reached,
    /// The value has ended.
    Over,
}

impl<'a, E: Experiment> Value<'a, E> {
    /// Begins the value in its first state, with this companion.
    pub(crate) fn played(
        &'a self,
        run: Run<E>,
        companion: Box<dyn Observer>,
    ) -> Result<Active<'a, E>, StudyError> {
        let mut active = self.begin_alone(run)?;
        active.riders.companion = Some(companion);
        Ok(active)
    }
}

impl<E: Experiment> Active<'_, E> {
    pub(crate) const fn run(&self) -> &Run<E> {
        &self.run
    }

    /// Plays on, at most to the absolute time `until`.
    ///
    /// # Errors
    /// The error with which the value ends.
    pub(crate) fn play(&mut self, until: f64) -> Result<Pause, RunError> {
        let (protocol, steps) = (self.value.study.plan.protocol(), self.work.steps);
        let start = self.work.start.time(protocol.cycles_of(steps) as f64, self.value.experiment.cycle());
        if self.is_done() {
            return Ok(Pause::Over);
        }
        if start >= until {
            return Ok(Pause::Reached);
        }
        Ok(match self.advance(SLICE, until)? {
            RunEnd::WallClock => Pause::Slice,
            RunEnd::Time if self.is_done() => Pause::Over,
            RunEnd::Time if self.work.steps > steps => Pause::Slice,
            RunEnd::Time => Pause::Reached,
            _ => Pause::Over,
        })
    }
}
