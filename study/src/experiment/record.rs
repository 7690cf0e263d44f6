//! Records of finished values, and the origin of a record: the study, the ramp and the value, and the code
//! that made the record.

use std::fmt;

use granular_edmd::Fingerprint;
use granular_edmd::boundary::Boundary;
use granular_edmd::collision::CollisionRule;
use granular_edmd::simulation::{Checkpoint, Counters};
use granular_edmd::statistics::{BlockedMean, Estimate};

use crate::Experiment;
use crate::parameters::{self, Scalar};

/// A finished value: its parameters, samples and counters, and its last state if the plan keeps it.
///
/// The samples, their times and the observer belong to the measured part of the value, after settling.
#[doc(alias("checkpoint", "restart"))]
#[derive(Clone, PartialEq)]
pub struct Record<E: Experiment> {
    pub(crate) experiment: E,
    pub(crate) contents: Contents<E::Sample, E::Observer>,
}

impl<E: Experiment> Record<E> {
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

    /// Returns the direction from which the ramp came to the value; `None` without a ramp.
    pub const fn leg(&self) -> Option<Leg> {
        self.contents.leg
    }

    /// Returns the value of the ramped parameter; `None` without a ramp.
    pub const fn ramped_value(&self) -> Option<f64> {
        self.contents.at
    }

    /// Returns the experiment, with the parameters of this value.
    pub const fn experiment(&self) -> &E {
        &self.experiment
    }

    /// Returns a parameter of the experiment by its name, as in a [`Plan`](crate::Plan), or `None` if there
    /// is no parameter of this name.
    pub fn parameter(&self, name: &str) -> Option<Scalar> {
        let tree = parameters::tree(&self.experiment).ok()?;
        let name = parameters::whole_name(&tree, name).ok()?;
        parameters::get(&tree, &name).and_then(Scalar::of_toml)
    }

    /// Returns the outcome of the value.
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

    /// Returns the observer, as it was at the end of the value.
    pub const fn observer(&self) -> &E::Observer {
        &self.contents.measured.observer
    }

    /// Returns the counters of the value, settling included.
    ///
    /// Only the largest overlap covers the whole ramp so far, not just this value.
    pub const fn counters(&self) -> &Counters {
        &self.contents.counters
    }

    /// Returns the [warnings](granular_edmd::Simulation::warnings) of the simulation at the end of the value.
    pub fn warnings(&self) -> &[String] {
        &self.contents.warnings
    }

    /// Returns the state at the end of the value; `None` if the record does not keep it
    /// ([`Plan::with_end_states`](crate::Plan::with_end_states)).
    pub const fn checkpoint(&self) -> Option<&Checkpoint> {
        self.contents.state.as_ref()
    }

    /// Returns the name of the part (the rule or the walls) that differs from the part with which the value
    /// was run. Two rules without fingerprints cannot be distinguished, nor two sets of walls.
    pub(crate) fn changed_part(&self) -> Option<&'static str> {
        let [rule, boundary] = self.contents.parts;
        if self.experiment.rule().is_ok_and(|now| now.fingerprint() != rule) {
            Some("rule")
        } else if self.experiment.boundary().is_ok_and(|now| now.fingerprint() != boundary) {
            Some("boundary")
        } else {
            None
        }
    }

    /// Returns the mean of a quantity over the samples, with an error that accounts for their correlation.
    ///
    /// The mean is NaN without samples, and the error is NaN for fewer than two samples.
    pub fn mean(&self, quantity: impl Fn(&E::Sample) -> f64) -> Estimate {
        self.samples().iter().map(quantity).collect::<BlockedMean>().estimate()
    }

    /// Returns the mean of the column of this name, or `None` if no column of this name has an error.
    pub fn estimate(&self, column: &str) -> Option<Estimate> {
        let columns = E::columns();
        let named = columns.iter().filter(|known| known.name() == column && known.has_error());
        // If the tables of samples and of values each have such a column, the latter counts.
        named.max_by_key(|known| known.in_values)?.estimate(self)
    }
}

impl<E: Experiment> fmt::Debug for Record<E> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut debug = formatter.debug_struct("Record");
        debug.field("origin", &self.contents.origin).field("outcome", &self.contents.outcome);
        debug.field("samples", &self.samples().len()).finish_non_exhaustive()
    }
}

/// The outcome of a value.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub enum Outcome {
    /// All samples were taken.
    Completed,
    /// The observer ended the value.
    ///
    /// The record has only the samples taken before this. The next value of the ramp starts from the state at
    /// `time`.
    Stopped {
        /// Time since the start of the ramp.
        time: f64,
    },
    /// Time hardly advanced, as in an inelastic collapse.
    ///
    /// The record has only the samples taken before the stall. The next value of the ramp starts from the
    /// state in which this value started.
    Stalled {
        /// Time since the start of the ramp.
        time: f64,
        /// Message of the engine.
        reason: String,
    },
    /// The value reached the collision limit of its [protocol](crate::Protocol::with_most_collisions) or the
    /// time limit of a [control](crate::Control::with_most_seconds).
    ///
    /// The samples and the next value are as for a stalled value.
    Limited {
        /// Time since the start of the ramp.
        time: f64,
        /// The limit.
        reason: String,
    },
    /// The engine or an observer returned another error.
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
            Self::Limited { .. } => "limited",
            Self::Failed { .. } => "failed",
        }
    }

    /// Returns the reason if the value stalled, failed or reached a limit, and otherwise `None`.
    pub fn reason(&self) -> Option<&str> {
        match self {
            Self::Stalled { reason, .. } | Self::Failed { reason, .. } | Self::Limited { reason, .. } => {
                Some(reason)
            }
            Self::Completed | Self::Stopped { .. } => None,
        }
    }
}

/// The part of a record that is stored in a log. The experiment is not stored, since it follows from the
/// plan.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub(crate) struct Contents<S, O> {
    pub(crate) origin: Origin,
    pub(crate) leg: Option<Leg>,
    /// Value of the ramped parameter.
    pub(crate) at: Option<f64>,
    pub(crate) outcome: Outcome,
    pub(crate) end: Cycles,
    pub(crate) measured: Measured<S, O>,
    pub(crate) counters: Counters,
    pub(crate) warnings: Vec<String>,
    /// Fingerprints of the rule and the walls that made the value.
    pub(crate) parts: [Option<Fingerprint>; 2],
    /// The state and the driving at the end, if the plan keeps them.
    pub(crate) state: Option<Checkpoint>,
    pub(crate) driving: Option<Vec<u8>>,
}

/// The measurements of a value.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub(crate) struct Measured<S, O> {
    pub(crate) times: Vec<f64>,
    pub(crate) samples: Vec<S>,
    pub(crate) observer: O,
}

/// A time, as a number of whole cycles since some absolute time. Unlike a sum of cycles, the product of a
/// cycle and a whole number does not drift.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub(crate) struct Cycles {
    /// Absolute time from which cycles are counted.
    pub(crate) since: f64,
    pub(crate) count: u64,
}

impl Cycles {
    pub(crate) const START: Self = Self { since: 0.0, count: 0 };

    /// Returns the absolute time after further cycles of this length.
    pub(crate) fn time(&self, more: f64, cycle: f64) -> f64 {
        self.since + (self.count as f64 + more) * cycle
    }
}

/// The study, ramp and value to which a file belongs.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Origin {
    /// Hash of the plan.
    pub(crate) study: [u8; 32],
    pub(crate) maker: Maker,
    pub(crate) ramp: usize,
    pub(crate) value: usize,
    pub(crate) seed: u64,
}

/// The code that made a record.
///
/// Two makers with the same results number, revision and columns give the same results, whatever their
/// versions are.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Maker {
    /// Version of this crate.
    pub(crate) version: String,
    /// The crate's [`RESULTS`](granular_edmd::RESULTS).
    pub(crate) results: u32,
    /// The revision of the experiment.
    pub(crate) revision: Fingerprint,
    /// Fingerprint of the names and units in all tables, so that an experiment need not change its revision
    /// with them.
    pub(crate) columns: Fingerprint,
}

impl Maker {
    /// Returns, as one word, the numbers by which a study decides whether it accepts the code.
    pub(crate) fn key(&self) -> String {
        format!("{}:{}:{}", self.results, self.revision, self.columns)
    }

    /// Returns the cell of a table that names the maker.
    pub(crate) fn cell(&self) -> String {
        format!("{} results={} revision={}", self.version, self.results, self.revision)
    }
}

/// The direction from which a ramp comes to a value.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Leg {
    /// From below.
    Up,
    /// From above.
    Down,
}

impl fmt::Display for Leg {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.pad(match self {
            Self::Up => "up",
            Self::Down => "down",
        })
    }
}
