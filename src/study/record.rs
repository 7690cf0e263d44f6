//! What is kept of a finished value.

use super::{Leg, Sample, Specification, System};
use crate::analysis::thermal_noise;
use crate::observable::{ConvectionOrder, DenseLayer};
use crate::simulation::{Checkpoint, Counters};
use crate::statistics::{BlockedMean, Estimate};

/// Largest number of bins of a profile: of one diameter each.
pub(super) const MOST_BINS: usize = 65_536;

/// Rounding of a time that was run to, relative to it.
const TIME_ROUNDING: f64 = 1e-12;

/// How a value ended.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub enum Outcome {
    /// All samples were taken.
    Completed,
    /// Events piled up in vanishing time, as in an inelastic collapse: there are only the samples until then.
    /// The next value of the ramp starts from the state in which this one did.
    Stalled {
        /// When, since the start of the ramp.
        time: f64,
        /// What the engine said.
        reason: String,
    },
    /// The engine gave up for another reason; else as stalled.
    Failed {
        /// When, since the start of the ramp.
        time: f64,
        /// What the engine said.
        reason: String,
    },
}

impl Outcome {
    /// A word for it.
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Completed => "completed",
            Self::Stalled { .. } => "stalled",
            Self::Failed { .. } => "failed",
        }
    }
}

/// A finished value: its parameters, samples, counts and last state.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Record {
    pub(super) origin: Origin,
    pub(super) leg: Option<Leg>,
    pub(super) system: System,
    pub(super) outcome: Outcome,
    /// Cycles since the start of the ramp.
    pub(super) cycles: u64,
    pub(super) samples: Vec<Sample>,
    /// Packing fraction by height, in bins of one diameter.
    pub(super) profile: Vec<f64>,
    pub(super) counters: Counters,
    pub(super) state: Checkpoint,
}

/// Which study and place a file is of.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Origin {
    /// Hash of the specification.
    pub(super) study: [u8; 32],
    /// Version of this crate.
    pub(super) version: String,
    pub(super) ramp: usize,
    pub(super) value: usize,
    pub(super) seed: u64,
}

impl Record {
    /// That it is what its place in this study can hold; why not, else.
    pub(super) fn check(&self, study: &Specification) -> Result<(), &'static str> {
        let Origin { ramp, value, .. } = self.origin;
        let protocol = study.protocol();
        let most = protocol.cycles().saturating_mul(value as u64 + 1);
        let expected = protocol.samples() == self.samples.len() as u64;
        let is_short = self.outcome != Outcome::Completed && protocol.samples() > self.samples.len() as u64;
        check(self.cycles <= most, "it is longer than the protocol")?;
        check(expected || is_short, "its samples are not as many as in the protocol")?;
        check(study.system(ramp, value).as_ref() == Ok(&self.system), "its system is of another value")?;
        check(study.leg(value) == self.leg, "it is on another way through the ramp")?;
        check_state(&self.state, self.cycles, &self.system)?;
        check_samples(&self.samples, &self.profile)
    }

    /// Index of its ramp.
    pub const fn ramp(&self) -> usize {
        self.origin.ramp
    }

    /// Its index in the ramp.
    pub const fn value(&self) -> usize {
        self.origin.value
    }

    /// The seed of its ramp.
    pub const fn seed(&self) -> u64 {
        self.origin.seed
    }

    /// The version of this crate that made it.
    pub fn version(&self) -> &str {
        &self.origin.version
    }

    /// The way on which it was come to; `None` without a ramp.
    pub const fn leg(&self) -> Option<Leg> {
        self.leg
    }

    /// The system, with the parameters of this value.
    pub const fn system(&self) -> &System {
        &self.system
    }

    /// How it ended.
    pub const fn outcome(&self) -> &Outcome {
        &self.outcome
    }

    /// Its samples.
    pub fn samples(&self) -> &[Sample] {
        &self.samples
    }

    /// What happened in it, settling included; the largest overlap is that since the start of the ramp.
    pub const fn counters(&self) -> &Counters {
        &self.counters
    }

    /// The state at its end.
    pub const fn state(&self) -> &Checkpoint {
        &self.state
    }

    /// `$(\Psi_1, \Psi_2)$` of each sample.
    pub fn order(&self) -> Vec<ConvectionOrder> {
        let order = |sample: &Sample| ConvectionOrder::new(sample.one_roll, sample.two_rolls);
        self.samples.iter().map(order).collect()
    }

    /// Packing fraction by height, averaged over the samples: heights of the middles of bins of one diameter,
    /// and fractions.
    pub fn profile(&self) -> impl Iterator<Item = (f64, f64)> {
        self.profile.iter().enumerate().map(|(bin, &fraction)| (bin as f64 + 0.5, fraction))
    }

    /// The densest layer of the profile; `None` without samples.
    pub fn densest_layer(&self) -> Option<DenseLayer> {
        DenseLayer::among(self.profile())
    }

    /// Returns the mean of a quantity over the samples, with an error that knows that they are correlated.
    ///
    /// NaN is the mean of no samples, and the error of fewer than two.
    pub fn mean(&self, quantity: impl Fn(&Sample) -> f64) -> Estimate {
        self.samples.iter().map(quantity).collect::<BlockedMean>().estimate()
    }

    /// Returns the mean energy change in a collision of two disks, each collision counting alike.
    pub fn energy_change(&self) -> Estimate {
        let collisions: f64 = self.samples.iter().map(|sample| sample.collisions as f64).sum();
        let total: f64 = self.samples.iter().map(|s| s.collisions as f64 * s.energy_change).sum();
        let mean = total / collisions;
        let per_sample = collisions / self.samples.len() as f64;
        // The error of a ratio is that of the mean residual, over the mean number of collisions.
        self.mean(|s| s.collisions as f64 * (s.energy_change - mean) / per_sample).about(mean)
    }

    /// Standard deviation of `$\Psi_1$` and `$\Psi_2$` in a gas at rest of this temperature,
    /// `$\sqrt{T_y/2N}$`.
    pub fn thermal_noise(&self) -> f64 {
        let temperature = self.mean(|sample| sample.vertical_temperature).mean();
        thermal_noise(temperature, 1.0, self.system.disks()).unwrap_or(f64::NAN)
    }
}

pub(super) fn check(valid: bool, reason: &'static str) -> Result<(), &'static str> {
    if valid { Ok(()) } else { Err(reason) }
}

/// That a state is of the time so many cycles after the start of its ramp.
pub(super) fn check_state(state: &Checkpoint, cycles: u64, system: &System) -> Result<(), &'static str> {
    let time = cycles as f64 * system.cycle();
    check((state.time() - time).abs() <= TIME_ROUNDING * time, "its state is of another time")
}

/// That what was measured can be.
pub(super) fn check_samples(samples: &[Sample], profile: &[f64]) -> Result<(), &'static str> {
    check(samples.iter().all(Sample::is_finite), "a sample is not finite")?;
    let is_fraction = |fraction: &f64| fraction.is_finite() && *fraction >= 0.0;
    check(profile.iter().all(is_fraction), "a packing fraction is negative or not finite")?;
    check(profile.len() <= MOST_BINS, "its profile is higher than any")
}
