//! The length of each value of a study, and the times of its samples.

use granular_edmd::ParameterError;
use granular_edmd::quantity::accept;

use super::values::from_file;

/// Largest length of a value in cycles, and largest number of samples. Products up to this size are exact.
const MOST: u64 = 1 << 40;

/// The schedule of a value: settle, then sample at equal intervals, always at the same phase of the base.
///
/// All times are in cycles ([`Experiment::cycle`](super::Experiment::cycle)): periods of the base, or units
/// of time if the base does not oscillate.
///
/// ```
/// use granular_edmd_study::Protocol;
/// // The paper: 100 000 oscillations for each value, sampled every 100, the first 500 samples discarded.
/// let protocol = Protocol::new(50_000, 500, 100)?;
/// assert_eq!((protocol.every(), protocol.cycles()), (100, 100_000));
/// assert!(Protocol::new(50_000, 0, 100).is_err());
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Protocol {
    settle: u64,
    samples: u64,
    every: u64,
    /// Phase of the samples in their cycle, in `(0, 1]`.
    pub(crate) phase: f64,
    /// Largest number of collisions in a value, or `None` if there is no limit.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) most_collisions: Option<u64>,
}

from_file! {
    Protocol {
        settle: u64,
        samples: u64,
        every: u64,
        #[serde(default = "end")]
        phase: f64,
        most_collisions: Option<u64>
    } => {
        let protocol = Self::new(settle, samples, every)?.with_phase(phase)?;
        most_collisions.map_or(Ok(protocol), |most| protocol.with_most_collisions(most))
    }, ParameterError
}

const fn end() -> f64 {
    1.0
}

impl Protocol {
    /// Creates the protocol that settles for `settle` cycles, then takes `samples` samples: one at the end of
    /// each interval of `every` cycles.
    ///
    /// # Errors
    /// If there are no samples, the interval is 0, or the whole lasts more than 2^40 cycles.
    pub fn new(settle: u64, samples: u64, every: u64) -> Result<Self, ParameterError> {
        let count = |range: std::ops::RangeInclusive<u64>, name, requirement, value: u64| {
            accept(range.contains(&value), name, requirement, value as f64)
        };
        count(0..=MOST, "settling time in cycles", "at most 2^40", settle)?;
        count(1..=MOST, "number of samples", "in 1..=2^40", samples)?;
        count(1..=MOST, "sampling interval in cycles", "in 1..=2^40", every)?;
        let total = u128::from(settle) + u128::from(samples) * u128::from(every);
        accept(total <= u128::from(MOST), "length of a value in cycles", "at most 2^40", total as f64)?;
        Ok(Self { settle, samples, every, phase: 1.0, most_collisions: None })
    }

    /// Returns the same protocol with samples at this phase of their cycle, in `(0, 1]`; the default is 1,
    /// the end of the cycle.
    ///
    /// # Errors
    /// If the phase is not in this range.
    pub fn with_phase(self, phase: f64) -> Result<Self, ParameterError> {
        accept(phase > 0.0 && phase <= 1.0, "phase of the samples", "in (0, 1]", phase)?;
        Ok(Self { phase, ..self })
    }

    /// Returns the same protocol with at most this number of collisions in a value, of disks with each other
    /// and with walls.
    ///
    /// A value that reaches it ends with [`Outcome::Limited`](crate::Outcome::Limited), so that one value of
    /// a sweep cannot take as long as all others together.
    ///
    /// # Errors
    /// If the number is 0, or above 2^63 − 1, the largest one that a plan can hold.
    pub fn with_most_collisions(self, most: u64) -> Result<Self, ParameterError> {
        let is_possible = (1..=i64::MAX as u64).contains(&most);
        accept(is_possible, "largest number of collisions", "in 1..2^63", most as f64)?;
        Ok(Self { most_collisions: Some(most), ..self })
    }

    /// Returns the number of cycles from a sample to the next.
    pub const fn every(&self) -> u64 {
        self.every
    }

    /// Returns the number of samples of a value.
    pub const fn samples(&self) -> u64 {
        self.samples
    }

    /// Returns the number of cycles that a value lasts.
    pub const fn cycles(&self) -> u64 {
        self.settle.saturating_add(self.samples.saturating_mul(self.every))
    }

    /// Returns the number of steps of a value: first the steps that settle, without a sample, then one step
    /// for each sample.
    pub(crate) const fn steps(&self) -> u64 {
        self.settling_steps() + self.samples
    }

    const fn settling_steps(&self) -> u64 {
        self.settle.div_ceil(self.every)
    }

    /// Returns the number of cycles in `steps` steps.
    pub(crate) fn cycles_of(&self, steps: u64) -> u64 {
        match steps.checked_sub(self.settling_steps()) {
            Some(samples) => self.settle + samples * self.every,
            None => steps * self.every,
        }
    }

    /// Returns the index of the sample with which a step ends; `None` while the value settles.
    pub(crate) const fn sample_of(&self, step: u64) -> Option<u64> {
        step.checked_sub(self.settling_steps())
    }
}
