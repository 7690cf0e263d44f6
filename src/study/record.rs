//! Records of finished values.

use std::fmt;

use super::refinement::Seen;
use super::{Experiment, Leg, Plan, Scalar, parameters};
use crate::boundary::Boundary;
use crate::collision::CollisionRule;
use crate::simulation::{Checkpoint, Counters};
use crate::statistics::{BlockedMean, Estimate};

/// Relative rounding of the time at which a run ended.
const TIME_ROUNDING: f64 = 1e-12;

/// The way in which a value ended.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub enum Outcome {
    /// All samples were taken.
    Completed,
    /// The observer ended the value.
    ///
    /// There are only the samples until then. The next value of the ramp starts from the state at that time.
    Stopped {
        /// Time since the start of the ramp.
        time: f64,
    },
    /// Events piled up in vanishing time, as in an inelastic collapse.
    ///
    /// There are only the samples until then. The next value of the ramp starts from the state in which this
    /// one started.
    Stalled {
        /// Time since the start of the ramp.
        time: f64,
        /// Message of the engine.
        reason: String,
    },
    /// The engine gave up for another reason.
    ///
    /// The samples and the next value are as for a stalled value.
    Failed {
        /// Time since the start of the ramp.
        time: f64,
        /// Message of the engine.
        reason: String,
    },
}

impl Outcome {
    /// Returns the outcome in one word.
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Completed => "completed",
            Self::Stopped { .. } => "stopped",
            Self::Stalled { .. } => "stalled",
            Self::Failed { .. } => "failed",
        }
    }

    /// Returns the message of the engine, if it could not finish the value: the outcome is stalled or failed.
    pub fn reason(&self) -> Option<&str> {
        match self {
            Self::Stalled { reason, .. } | Self::Failed { reason, .. } => Some(reason),
            Self::Completed | Self::Stopped { .. } => None,
        }
    }
}

/// A finished value: its parameters, samples, counts and last state.
///
/// Samples, observer and times are those of the measured part, after the value has settled.
#[doc(alias("checkpoint", "restart"))]
pub struct Record<E: Experiment> {
    pub(super) experiment: E,
    pub(super) contents: Contents<E::Sample, E::Observer>,
}

/// A record as it is in its file, without the experiment, which follows from the plan.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub(super) struct Contents<S, O> {
    pub(super) origin: Origin,
    pub(super) leg: Option<Leg>,
    /// Value of the ramped parameter.
    pub(super) at: Option<f64>,
    pub(super) outcome: Outcome,
    pub(super) end: Cycles,
    pub(super) measured: Measured<S, O>,
    pub(super) counters: Counters,
    pub(super) state: Checkpoint,
}

/// The measurements of a value.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub(super) struct Measured<S, O> {
    pub(super) times: Vec<f64>,
    pub(super) samples: Vec<S>,
    pub(super) observer: O,
}

/// The study and the place in it that a file belongs to.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Origin {
    /// Hash of the plan.
    pub(super) study: [u8; 32],
    /// Version of this crate.
    pub(super) version: String,
    pub(super) ramp: usize,
    pub(super) value: usize,
    pub(super) seed: u64,
}

/// A time, as a number of whole cycles since some absolute time. The product of a cycle and a whole number
/// does not drift as a sum of cycles does.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub(super) struct Cycles {
    /// Absolute time from which cycles are counted.
    pub(super) since: f64,
    pub(super) count: u64,
}

impl Cycles {
    pub(super) const START: Self = Self { since: 0.0, count: 0 };

    /// Returns the absolute time after this many more cycles of this length.
    pub(super) fn time(&self, more: f64, cycle: f64) -> f64 {
        self.since + (self.count as f64 + more) * cycle
    }
}

impl<E: Experiment> Record<E> {
    /// Checks that the record can belong to its place in this study. The error says why it cannot.
    pub(super) fn check(&self, plan: &Plan<E>) -> Result<(), String> {
        let Contents { origin, leg, at, outcome, end, measured, state, .. } = &self.contents;
        let protocol = plan.protocol();
        let (most, samples) =
            (protocol.cycles().saturating_mul(origin.value as u64 + 1), measured.samples.len());
        let is_short = *outcome != Outcome::Completed && protocol.samples() > samples as u64;
        check(end.count <= most, "it is longer than the protocol")?;
        let is_full = protocol.samples() == samples as u64;
        check(is_full || is_short, "its samples are not as many as in the protocol")?;
        let is_placed = match plan.step(origin.value) {
            Some((way, value)) => *leg == Some(way) && *at == Some(value),
            None => plan.is_refined() || at.is_none(),
        };
        check(is_placed, "it is on another way through the ramp")?;
        check_state(state, end.time(0.0, self.experiment.cycle()))?;
        measured.check(&self.experiment, state)
    }

    /// Returns the index of the ramp.
    pub const fn ramp_index(&self) -> usize {
        self.contents.origin.ramp
    }

    /// Returns the index of the value in the ramp.
    pub const fn value_index(&self) -> usize {
        self.contents.origin.value
    }

    /// Returns the seed of the ramp.
    pub const fn seed(&self) -> u64 {
        self.contents.origin.seed
    }

    /// Returns the version of this crate that made the record.
    pub fn version(&self) -> &str {
        &self.contents.origin.version
    }

    /// Returns the direction from which the ramp came to the value; `None` without a ramp.
    pub const fn leg(&self) -> Option<Leg> {
        self.contents.leg
    }

    /// Returns the value of the ramped parameter; `None` without a ramp.
    pub const fn ramped_value(&self) -> Option<f64> {
        self.contents.at
    }

    /// Returns the parts of the record on which the path of the ramp depends.
    pub(super) fn seen(&self) -> Seen {
        Seen { leg: self.leg(), at: self.ramped_value(), state: E::state(self) }
    }

    /// Returns the experiment, with the parameters of this value.
    pub const fn experiment(&self) -> &E {
        &self.experiment
    }

    /// Returns a parameter of the experiment by its name, as in a [`Plan`]; `None` if there is no parameter
    /// of this name.
    pub fn parameter(&self, name: &str) -> Option<Scalar> {
        let tree = parameters::tree(&self.experiment).ok()?;
        let name = parameters::whole_name(&tree, name).ok()?;
        parameters::get(&tree, &name).and_then(Scalar::of_toml)
    }

    /// Returns the way in which the value ended.
    pub const fn outcome(&self) -> &Outcome {
        &self.contents.outcome
    }

    /// Returns the samples.
    pub fn samples(&self) -> &[E::Sample] {
        &self.contents.measured.samples
    }

    /// Returns the times of the samples, since the start of the ramp.
    pub fn times(&self) -> &[f64] {
        &self.contents.measured.times
    }

    /// Returns the observer as it was at the end.
    pub const fn observer(&self) -> &E::Observer {
        &self.contents.measured.observer
    }

    /// Returns the counters of the value, settling included.
    ///
    /// The largest overlap is that since the start of the ramp.
    pub const fn counters(&self) -> &Counters {
        &self.contents.counters
    }

    /// Returns the state at the end of the value.
    pub const fn checkpoint(&self) -> &Checkpoint {
        &self.contents.state
    }

    /// Returns the part of the simulation that the experiment now makes differently than when the value was
    /// done, if there is one. Parts without fingerprints cannot be told apart.
    pub(super) fn changed_part(&self) -> Option<&'static str> {
        let (rule, boundary) = self.contents.state.parts();
        if self.experiment.rule().is_ok_and(|now| now.fingerprint().as_ref() != rule) {
            Some("rule")
        } else if self.experiment.boundary().is_ok_and(|now| now.fingerprint().as_ref() != boundary) {
            Some("boundary")
        } else {
            None
        }
    }

    /// Returns the mean of a quantity over the samples, with an error that accounts for their correlation.
    ///
    /// The mean is NaN without samples, and the error is NaN for fewer than two.
    pub fn mean(&self, quantity: impl Fn(&E::Sample) -> f64) -> Estimate {
        self.samples().iter().map(quantity).collect::<BlockedMean>().estimate()
    }

    /// Returns the mean of the column of this name; `None` if there is no such column, or it has no error.
    pub fn estimate(&self, column: &str) -> Option<Estimate> {
        let columns = E::columns();
        let mut named = columns.iter().filter(|known| known.name() == column);
        named.find_map(|known| known.estimate(self))
    }
}

impl<E: Experiment + Clone> Clone for Record<E>
where
    E::Sample: Clone,
    E::Observer: Clone,
{
    fn clone(&self) -> Self {
        Self { experiment: self.experiment.clone(), contents: self.contents.clone() }
    }
}

impl<E: Experiment + PartialEq> PartialEq for Record<E>
where
    E::Sample: PartialEq,
    E::Observer: PartialEq,
{
    fn eq(&self, other: &Self) -> bool {
        self.experiment == other.experiment && self.contents == other.contents
    }
}

impl<E: Experiment> fmt::Debug for Record<E> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut debug = formatter.debug_struct("Record");
        debug.field("origin", &self.contents.origin).field("outcome", &self.contents.outcome);
        debug.field("samples", &self.samples().len()).finish_non_exhaustive()
    }
}

impl<S, O> Measured<S, O> {
    /// Checks that the times, the samples and the observer can have been measured.
    pub(super) fn check<E>(&self, experiment: &E, state: &Checkpoint) -> Result<(), String>
    where
        E: Experiment<Sample = S, Observer = O>,
    {
        check(self.times.len() == self.samples.len(), "its times are not as many as its samples")?;
        check(self.times.iter().all(|time| time.is_finite()), "a time is not finite")?;
        check(self.times.is_sorted(), "its times are out of order")?;
        experiment.check_measured(&self.samples, &self.observer, state).map_err(|reason| reason.to_string())
    }
}

pub(super) fn check(valid: bool, reason: &'static str) -> Result<(), &'static str> {
    if valid { Ok(()) } else { Err(reason) }
}

/// Checks that a state is that of this time.
pub(super) fn check_state(state: &Checkpoint, time: f64) -> Result<(), &'static str> {
    check((state.time() - time).abs() <= TIME_ROUNDING * time, "its state is of another time")
}
