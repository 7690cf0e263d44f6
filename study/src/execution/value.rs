//! One value of a ramp, from its start to its record. The record is a pure function of the plan, the indices
//! of ramp and value, and the record from which the value starts.

#[cfg(feature = "cli")]
pub(crate) mod play;

use std::path::Path;
use std::time::Duration;

use granular_edmd::Simulation;
use granular_edmd::observable::Observer;
use granular_edmd::random::{Stream, derived_seed};
use granular_edmd::simulation::{Checkpoint, Counters, Limits, RunEnd, RunError};

use crate::errors::{ExperimentError, StudyError, chain};
use crate::experiment::record::Origin;
use crate::experiment::record::{Contents, Cycles, Measured, Outcome, Record};
use crate::plan::ramp::Step;
use crate::sliced::{self, Riders};
use crate::{Experiment, Run, SavedDriving, Start, Study};

/// A value to be run.
pub(crate) struct Value<'a, E: Experiment> {
    pub(super) study: &'a Study<E>,
    pub(super) origin: Origin,
    pub(crate) experiment: E,
    pub(super) step: Step,
    /// The record from which the value starts; `None` for a fresh start.
    pub(super) before: Option<Record<E>>,
}

/// The saved data of an unfinished value.
pub(super) type Partial<E> = Saved<WorkOf<E>>;

/// The work so far, the state of its run and its driving.
pub(super) type Saved<W> = (W, Checkpoint, Option<Vec<u8>>);

type WorkOf<E> = Work<<E as Experiment>::Sample, <E as Experiment>::Observer>;

/// The work of a value so far.
#[derive(Debug, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Work<S, O> {
    pub(super) origin: Origin,
    /// The start of the value.
    start: Cycles,
    steps: u64,
    /// True if the observer has seen the start of a run and not yet its end.
    is_under_way: bool,
    /// Counters at the start of the value.
    counters: Counters,
    measured: Measured<S, O>,
}

/// A value that is being run.
pub(crate) struct Active<'a, E: Experiment> {
    value: &'a Value<'a, E>,
    work: WorkOf<E>,
    run: Run<E>,
    riders: Riders,
}

impl<'a, E: Experiment> Value<'a, E> {
    /// Starts the value, or continues it from a record with fewer samples, if the record keeps the state.
    pub(super) fn begin(&'a self, shorter: Option<Record<E>>) -> Result<Active<'a, E>, StudyError> {
        let run = self.first_state()?;
        if let Some(Contents { outcome: Outcome::Completed, measured, state: Some(state), driving, .. }) =
            shorter.map(|record| record.contents)
        {
            let (protocol, found) = (self.study.plan.protocol(), measured.samples.len() as u64);
            if let Some(missing) = protocol.samples().checked_sub(found) {
                let work = self.work(&run, protocol.steps() - missing, measured);
                match self.go_on((work, state, driving), self.study.folder()) {
                    Err(StudyError::Damaged { .. }) => {}
                    made => return made,
                }
            }
        }
        let mut active = self.begin_alone(run)?;
        active.riders.companion = self.companion(active.run.time(), false)?;
        Ok(active)
    }

    /// Starts the value from its first state, without a companion.
    fn begin_alone(&'a self, run: Run<E>) -> Result<Active<'a, E>, StudyError> {
        let observer = self.experiment.observer().map_err(|source| self.cannot_start(source))?;
        let work = self.work(&run, 0, Measured { times: Vec::new(), samples: Vec::new(), observer });
        let riders = Riders { driving: self.driving()?, ..Riders::default() };
        Ok(Active { value: self, work, run, riders })
    }

    /// Returns the work after these steps of a run that is in its first state.
    fn work(&self, first: &Run<E>, steps: u64, measured: Measured<E::Sample, E::Observer>) -> WorkOf<E> {
        Work {
            origin: self.origin.clone(),
            start: self.start(),
            steps,
            is_under_way: false,
            counters: *first.counters(),
            measured,
        }
    }

    /// Returns the driving at the start of the value.
    fn driving(&self) -> Result<Option<Box<dyn SavedDriving>>, StudyError> {
        let seed = derived_seed(self.origin.seed, Stream::Studies, self.origin.value as u64);
        self.experiment.driving(seed).map_err(|source| self.cannot_start(source))
    }

    /// Returns the companion from this time on.
    fn companion(&self, time: f64, is_resumed: bool) -> Result<Option<Box<dyn Observer>>, StudyError> {
        let Origin { ramp, value, seed, .. } = self.origin;
        let start = Start { folder: self.study.folder(), ramp, value, seed, time, is_resumed };
        self.experiment.companion(&start).map_err(|source| self.cannot_start(source))
    }

    /// Returns whether the record of the same value in another study contains all data for the record of this
    /// value.
    pub(super) fn is_finished_by(&self, Record { contents, .. }: &Record<E>) -> bool {
        let (samples, all) = (contents.measured.samples.len() as u64, self.study.plan.protocol().samples());
        let is_whole = if contents.outcome == Outcome::Completed { samples == all } else { samples < all };
        is_whole && (contents.state.is_some() || !self.study.plan.keeps_state(self.origin.value))
    }

    /// Returns the record of this value, made from the record of the same value in another study.
    pub(super) fn taken_over(&self, Record { contents, .. }: Record<E>) -> Record<E> {
        let origin = Origin { maker: contents.origin.maker, ..self.origin.clone() };
        let keeps = self.study.plan.keeps_state(self.origin.value);
        let (state, driving) = (contents.state.filter(|_| keeps), contents.driving.filter(|_| keeps));
        let contents = Contents { origin, state, driving, ..contents };
        Record { experiment: self.experiment.clone(), contents }
    }

    /// Continues the value where it was saved.
    ///
    /// # Errors
    /// If the data saved in `path` do not belong to this value, or the companion cannot be created.
    pub(super) fn go_on(&'a self, partial: Partial<E>, path: &Path) -> Result<Active<'a, E>, StudyError> {
        let mut driving = self.driving()?;
        let is_loaded = match (&mut driving, &partial.2) {
            (Some(driving), Some(bytes)) => driving.load(bytes).is_ok(),
            (driving, bytes) => driving.is_none() && bytes.is_none(),
        };
        let (work, state, _) = partial;
        let run =
            Self::resume(&state, &self.experiment).ok().filter(|_| is_loaded && work.start == self.start());
        let run = run.filter(|run| run.gravity() == self.experiment.gravity());
        let run = run.ok_or_else(|| StudyError::damaged(path, "its state cannot go on"))?;
        let companion = self.companion(run.time(), true)?;
        let riders = Riders { driving, companion, is_under_way: false };
        Ok(Active { value: self, work, run, riders })
    }

    /// Returns the time at which the value starts. It continues the count of whole cycles if the length of a
    /// cycle has not changed.
    fn start(&self) -> Cycles {
        let Some(before) = &self.before else { return Cycles::START };
        let (end, cycle) = (before.contents.end, before.experiment.cycle());
        if cycle == self.experiment.cycle() { end } else { Cycles { since: end.time(0.0, cycle), count: 0 } }
    }

    /// Returns the simulation at the start of the value.
    fn first_state(&self) -> Result<Run<E>, StudyError> {
        let Some(before) = &self.before else {
            return self.experiment.build(self.origin.seed).map_err(|source| self.cannot_start(source));
        };
        let state =
            before.checkpoint().ok_or_else(|| self.cannot_start("the value before keeps no state".into()))?;
        let run = Self::resume(state, &before.experiment);
        let mut run = run.map_err(|source| self.cannot_start(source))?;
        self.experiment.change(&mut run).map_err(|source| self.cannot_start(source))?;
        Ok(run)
    }

    /// Resumes a saved state with the rule and the walls of the experiment with which it was saved.
    fn resume(state: &Checkpoint, saved: &E) -> Result<Run<E>, ExperimentError> {
        Ok(Simulation::resume(state, saved.rule()?, saved.boundary()?).build()?)
    }

    fn cannot_start(&self, source: ExperimentError) -> StudyError {
        StudyError::Build { ramp: self.origin.ramp, value: self.origin.value, source }
    }
}

impl<E: Experiment> Active<'_, E> {
    /// Returns the number of finished steps.
    pub(super) const fn steps(&self) -> u64 {
        self.work.steps
    }

    pub(super) fn is_done(&self) -> bool {
        self.work.steps >= self.value.study.plan.protocol().steps()
    }

    /// Runs the next step, which settles or takes a sample, for at most the wall-clock time `slice`. Returns
    /// whether the step is done; if not, the next call continues the step, with the same bits. The error is
    /// the outcome of a value that ends early.
    pub(super) fn step(&mut self, slice: Duration) -> Result<bool, Outcome> {
        let ended = self.advance(slice, f64::INFINITY);
        let time = self.run.time();
        match ended {
            Ok(RunEnd::Time) => Ok(true),
            Ok(RunEnd::WallClock) => Ok(false),
            Ok(RunEnd::Collisions) => {
                let most = self.value.study.plan.protocol().most_collisions.unwrap_or(u64::MAX);
                Err(self
                    .limited(format!("it has reached the limit of {most} collisions with disks and walls")))
            }
            Ok(_) => Err(Outcome::Stopped { time }),
            Err(error @ RunError::Stalled { .. }) => Err(Outcome::Stalled { time, reason: chain(&error) }),
            Err(error) => Err(Outcome::Failed { time, reason: chain(&error) }),
        }
    }

    /// Returns the outcome of a value that has reached a limit now.
    pub(super) fn limited(&self, reason: String) -> Outcome {
        Outcome::Limited { time: self.run.time(), reason }
    }

    /// Runs the next step to its end, and takes its sample on the way if the step has one. The time `until`
    /// may end the run earlier.
    fn advance(&mut self, slice: Duration, until: f64) -> Result<RunEnd, RunError> {
        let (protocol, cycle) = (self.value.study.plan.protocol(), self.value.experiment.cycle());
        let (most, before) = (protocol.most_collisions.unwrap_or(u64::MAX), self.work.counters);
        let end = protocol.cycles_of(self.work.steps + 1) as f64;
        let [sample_time, end] =
            [end - (1.0 - protocol.phase), end].map(|cycles| self.work.start.time(cycles, cycle));
        let limits = |run: &Run<E>, end: f64| {
            let left = most.saturating_sub(run.counters().since(&before).collisions());
            Limits::until(end.min(until)).with_wall_clock(slice).with_most_collisions(left)
        };
        let Work { measured: Measured { times, samples, observer }, is_under_way, steps, .. } =
            &mut self.work;
        let (run, riders) = (&mut self.run, &mut self.riders);
        let ended = if let Some(sample) = protocol.sample_of(*steps) {
            // A slice may have ended between the sample and the end of the step.
            if samples.len() as u64 == sample {
                let ended = sliced::run(run, &limits(run, sample_time), riders, observer, is_under_way)?;
                if ended != RunEnd::Time || until < sample_time {
                    return Ok(ended);
                }
                let snapshot = run.snapshot();
                times.push(snapshot.time());
                samples.push(self.value.experiment.sample(&snapshot, observer));
            }
            sliced::run(run, &limits(run, end), riders, observer, is_under_way)?
        } else {
            sliced::run(run, &limits(run, end), riders, &mut (), is_under_way)?
        };
        if ended == RunEnd::Time && until >= end {
            *steps += 1;
        }
        Ok(ended)
    }

    /// Returns the data from which the unfinished value can continue later.
    pub(super) fn partial(&self) -> Result<Saved<&WorkOf<E>>, ExperimentError> {
        Ok((&self.work, self.run.checkpoint(), self.riders.saved()?))
    }

    /// Returns the record of the value after its last step. If the value stalled, failed or reached a limit,
    /// the record holds the state in which the value started, and the next value starts from this state.
    pub(super) fn record(self, outcome: Outcome) -> Result<Record<E>, StudyError> {
        let Self { value, work, run, riders } = self;
        let (start, cycles) = (work.start, value.study.plan.protocol().cycles());
        let (end, state) = match outcome {
            Outcome::Completed => (Cycles { count: start.count + cycles, ..start }, run.checkpoint()),
            Outcome::Stopped { time } => (Cycles { since: time, count: 0 }, run.checkpoint()),
            _ => (start, value.first_state()?.checkpoint()),
        };
        let driving = riders.saved().map_err(|source| value.cannot_start(source))?;
        let parts = [state.rule(), state.boundary()];
        let state = value.study.plan.keeps_state(value.origin.value).then_some(state);
        let contents = Contents {
            origin: work.origin,
            leg: value.step.leg,
            at: value.step.at,
            outcome,
            end,
            measured: work.measured,
            counters: run.counters().since(&work.counters),
            warnings: run.warnings().iter().map(ToString::to_string).collect(),
            parts,
            driving: driving.filter(|_| state.is_some()),
            state,
        };
        Ok(Record { experiment: value.experiment.clone(), contents })
    }
}
