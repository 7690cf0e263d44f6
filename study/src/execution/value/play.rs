//! Values that are played again: the code that runs the values of a study runs them, beside an observer of
//! the caller instead of the experiment's companion, and nothing is saved.

use std::time::Duration;

use granular_edmd::observable::Observer;
use granular_edmd::simulation::{RunEnd, RunError};

use super::{Active, Value};
use crate::{Experiment, PlanError, Run, Study, StudyError};

/// Longest wall-clock time of a slice.
const SLICE: Duration = Duration::from_millis(200);

impl<E: Experiment> Study<E> {
    /// Returns the first value of a ramp, without a look into the study's folder.
    pub(crate) fn first(&self, ramp: usize) -> Result<Value<'_, E>, StudyError> {
        let step = self.plan.next(&[]).ok_or_else(|| PlanError::Refused("the plan has no values".into()))?;
        let experiment = self.plan.experiment_at(ramp, step.at)?;
        Ok(Value { study: self, origin: self.origin(ramp, 0), experiment, step, before: None })
    }

    /// Finds a value of the study.
    pub(crate) fn find(&self, ramp: usize, value: usize) -> Result<Value<'_, E>, StudyError> {
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
        Ok(Value { study: self, origin: self.origin(ramp, value), experiment, step, before })
    }
}

impl<'a, E: Experiment> Value<'a, E> {
    /// Returns the simulation at the start of the value, and the time at which the protocol ends the value.
    pub(crate) fn at_start(&self) -> Result<(Run<E>, f64), StudyError> {
        let cycles = self.study.plan.protocol().cycles() as f64;
        Ok((self.first_state()?, self.start().time(cycles, self.experiment.cycle())))
    }

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

    /// Plays a slice, at most to the absolute time `until`, and returns whether more is to come until then.
    ///
    /// # Errors
    /// The error with which the value ends.
    pub(crate) fn play(&mut self, until: f64) -> Result<bool, RunError> {
        let (protocol, steps) = (self.value.study.plan.protocol(), self.work.steps);
        let start = self.work.start.time(protocol.cycles_of(steps) as f64, self.value.experiment.cycle());
        if self.is_done() || start >= until {
            return Ok(false);
        }
        Ok(match self.advance(SLICE, until)? {
            RunEnd::WallClock => true,
            RunEnd::Time => self.work.steps > steps && !self.is_done(),
            _ => false,
        })
    }
}
