//! One value of a ramp, from its start to its record: a pure function of specification, index and the record before.

use super::errors::StudyError;
use super::record::{MOST_BINS, Origin, Outcome, Record, check, check_samples, check_state};
use super::rule::Rule;
use super::specification::{Specification, derived_seed};
use super::{Protocol, Sample, System};
use crate::boundary::Container;
use crate::observable::{EnergyChange, HeightProfile, Observer, SampleTimes};
use crate::scheduler::BySize;
use crate::simulation::{BuildError, Checkpoint, CheckpointError, Counters, RunError};
use crate::{ParameterError, Simulation};

/// Height of the profile of an open box, in diameters.
const OPEN_PROFILE: f64 = 256.0;

type Run = Simulation<Rule, Container, BySize>;

/// Which value is to be done.
pub(super) struct Value<'a> {
    pub(super) specification: &'a Specification,
    pub(super) origin: Origin,
    pub(super) system: System,
    /// The record of the value before, if there is one.
    pub(super) before: Option<&'a Record>,
}

/// A value half done, as data.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Partial {
    pub(super) origin: Origin,
    work: Work,
    state: Checkpoint,
}

/// What has been done of a value.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct Work {
    /// Cycles from the start of the ramp to that of the value.
    start: u64,
    steps: u64,
    /// Counters at the start of the value.
    counters: Counters,
    samples: Vec<Sample>,
    /// Sums over the samples of the packing fraction.
    profile: Vec<f64>,
}

/// A value that is being done.
pub(super) struct Active<'a> {
    value: &'a Value<'a>,
    work: Work,
    run: Run,
}

impl<'a> Value<'a> {
    /// Starts the value.
    pub(super) fn begin(&'a self) -> Result<Active<'a>, StudyError> {
        let run = self.first_state()?;
        let (start, counters) = (self.start(), *run.counters());
        let work = Work { start, steps: 0, counters, samples: Vec::new(), profile: Vec::new() };
        Ok(Active { value: self, work, run })
    }

    /// Goes on with the value where it was saved; says why, if that cannot be.
    pub(super) fn go_on(&'a self, Partial { work, state, .. }: Partial) -> Result<Active<'a>, &'static str> {
        work.check(self.protocol())?;
        check(work.start == self.start(), "it starts elsewhere")?;
        check_state(&state, work.start + self.protocol().cycles_of(work.steps), &self.system)?;
        let run = self.resume(&state, &self.system).map_err(|_| "its state cannot go on")?;
        check(Ok(run.gravity()) == self.system.gravity(), "its state has another gravity")?;
        Ok(Active { value: self, work, run })
    }

    /// Cycles from the start of the ramp to that of the value.
    fn start(&self) -> u64 {
        self.before.map_or(0, |record| record.cycles)
    }

    /// The system at the start of the value.
    fn first_state(&self) -> Result<Run, StudyError> {
        let Some(before) = self.before else {
            return self.initial_state();
        };
        let mut run = self.resume(&before.state, &before.system)?;
        if !self.system.has_walls_of(&before.system) {
            let container = self.system.container()?;
            run.set_boundary(container).map_err(|source| self.cannot_start(source))?;
        }
        let gravity = self.parameter(self.system.gravity())?;
        if gravity != run.gravity() {
            self.parameter(run.set_gravity(gravity))?;
        }
        Ok(run)
    }

    fn initial_state(&self) -> Result<Run, StudyError> {
        let rule = self.parameter(self.system.rule())?;
        let seed = self.origin.seed;
        let builder = Simulation::builder(rule, self.system.container()?)
            .disks(self.system.initial_disks(derived_seed(seed, 0))?)
            .gravity(self.parameter(self.system.gravity())?)
            .seed(derived_seed(seed, 1));
        builder.build().map_err(|source| self.cannot_start(source))
    }

    /// A saved state under the rule of this value, in the walls that it was saved in.
    fn resume(&self, state: &Checkpoint, saved: &System) -> Result<Run, StudyError> {
        let rule = self.parameter(self.system.rule())?;
        let run = Simulation::resume(state, rule, saved.container()?)
            .with_another_rule()
            .build()
            .map_err(|source| self.cannot_go_on(source))?;
        if run.len() == saved.disks() {
            return Ok(run);
        }
        Err(self
            .cannot_go_on(CheckpointError::Inconsistent("it has another number of disks than the system")))
    }

    fn parameter<T>(&self, value: Result<T, ParameterError>) -> Result<T, StudyError> {
        value.map_err(|error| self.cannot_start(error.into()))
    }

    fn cannot_start(&self, source: BuildError) -> StudyError {
        StudyError::Build { ramp: self.origin.ramp, value: self.origin.value, source }
    }

    fn cannot_go_on(&self, source: CheckpointError) -> StudyError {
        StudyError::Checkpoint { ramp: self.origin.ramp, value: self.origin.value, source }
    }

    fn protocol(&self) -> &Protocol {
        self.specification.protocol()
    }
}

impl Active<'_> {
    /// How many steps are done.
    pub(super) const fn steps(&self) -> u64 {
        self.work.steps
    }

    pub(super) fn is_done(&self) -> bool {
        self.work.steps >= self.value.protocol().steps()
    }

    /// Does the next step: settles on, or takes a sample.
    pub(super) fn step(&mut self) -> Result<(), RunError> {
        let protocol = self.value.protocol();
        let step = self.work.steps;
        let cycle = self.value.system.cycle();
        let end = (self.work.start + protocol.end_of(step)) as f64;
        if protocol.is_sampled(step) {
            self.sample((end - protocol.lead()) * cycle, end * cycle)?;
        } else {
            self.run.run_until(end * cycle, &mut ())?;
        }
        self.work.steps += 1;
        Ok(())
    }

    fn sample(&mut self, time: f64, end: f64) -> Result<(), RunError> {
        let mut change = EnergyChange::default();
        self.run.run_until(time, &mut change)?;
        let sample = Sample::of(&self.run.snapshot());
        let profile = self.profile();
        self.run.run_until(end, &mut change)?;
        self.work.samples.push(sample.with_collisions(&change));
        self.work.add_profile(&profile);
        Ok(())
    }

    /// The packing fraction by height now.
    fn profile(&mut self) -> Vec<f64> {
        let snapshot = self.run.snapshot();
        let top = snapshot.domain().top.min(MOST_BINS as f64);
        let bins = if snapshot.domain().top.is_finite() { top.ceil() } else { OPEN_PROFILE };
        let profile = SampleTimes::every(1.0)
            .and_then(|times| HeightProfile::new(0.0, bins, bins as usize, times))
            .map(|mut profile| {
                profile.on_sample(&snapshot);
                profile.iter().map(|(_, fraction)| fraction).collect()
            });
        // A height that is positive makes a profile.
        profile.unwrap_or_default()
    }

    /// The value as data, to go on with later.
    pub(super) fn partial(&self) -> Partial {
        Partial { origin: self.value.origin.clone(), work: self.work.clone(), state: self.run.checkpoint() }
    }

    /// The record of a value that is done.
    pub(super) fn record(self) -> Record {
        let cycles = self.work.start + self.value.protocol().cycles();
        let state = self.run.checkpoint();
        self.into_record(Outcome::Completed, cycles, state)
    }

    /// The record of a value that the engine could not finish: the next one starts as this one did.
    pub(super) fn failed(self, error: &RunError) -> Result<Record, StudyError> {
        let (time, reason) = (self.run.time(), error.to_string());
        let outcome = match error {
            RunError::Stalled { .. } => Outcome::Stalled { time, reason },
            _ => Outcome::Failed { time, reason },
        };
        let (start, state) = (self.work.start, self.value.first_state()?.checkpoint());
        Ok(self.into_record(outcome, start, state))
    }

    fn into_record(self, outcome: Outcome, cycles: u64, state: Checkpoint) -> Record {
        let Self { value, work, run } = self;
        let samples = work.samples.len() as f64;
        Record {
            origin: value.origin.clone(),
            leg: value.specification.leg(value.origin.value),
            system: value.system.clone(),
            outcome,
            cycles,
            profile: work.profile.iter().map(|sum| sum / samples).collect(),
            samples: work.samples,
            counters: run.counters().since(&work.counters),
            state,
        }
    }
}

impl Work {
    /// That it is what a value can be at some step.
    fn check(&self, protocol: &Protocol) -> Result<(), &'static str> {
        check(self.steps <= protocol.steps(), "it is longer than the protocol")?;
        let samples = protocol.samples_of(self.steps);
        check(samples == self.samples.len() as u64, "its samples are not as many as its steps")?;
        check_samples(&self.samples, &self.profile)
    }

    fn add_profile(&mut self, profile: &[f64]) {
        self.profile.resize(profile.len(), 0.0);
        self.profile.iter_mut().zip(profile).for_each(|(sum, fraction)| *sum += fraction);
    }
}
