//! Means with errors, and means of repeats.

use std::fmt;

/// Smallest number of independent samples from which an error can be trusted.
///
/// In one case in a thousand, blocks made from 50 independent samples look like blocks made from 120 or more.
/// If half of this number were enough, every tenth series of 30 independent samples would be called
/// converged, with an error too small by a third.
pub(super) const FEWEST_INDEPENDENT: f64 = 120.0;

/// A mean of samples with its standard error, and whether that error can be trusted.
///
/// The error of correlated samples is taken from blocks ([`BlockedMean`](super::BlockedMean),
/// [`block_average`](super::block_average)). A series too short for that gives an estimate that is not
/// converged: its error is then a lower bound. An estimate from samples that are independent, or are assumed
/// to be, says so.
///
/// A precision in the format string sets the number of decimals of the mean and the error. Without a
/// precision, the error has two significant digits. A note on the basis of the error follows in words.
///
/// ```
/// use granular_edmd::statistics::{RunningMean, block_average};
/// let alternating: Vec<f64> = (0..1000).map(|k| f64::from(k % 2)).collect();
/// assert_eq!(block_average(&alternating)?.to_string(), "0.50000 ± 0.00000");
/// // A single jump: a series of this length does not show how often jumps occur.
/// let jump: Vec<f64> = (0..64).map(|k| f64::from(k / 32)).collect();
/// let estimate = block_average(&jump)?;
/// assert!(!estimate.is_converged());
/// assert_eq!(format!("{estimate:.2}"), "0.50 ± 0.50 (not converged: a lower bound)");
/// let independent: RunningMean = [1.0, 2.0, 3.0].into_iter().collect();
/// assert_eq!(independent.estimate().to_string(), "2.00 ± 0.58 (independent samples)");
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Estimate {
    #[cfg_attr(feature = "serde", serde(serialize_with = "crate::gate::if_finite"))]
    mean: f64,
    #[cfg_attr(feature = "serde", serde(serialize_with = "crate::gate::if_finite"))]
    standard_error: f64,
    samples: u64,
    correlated_samples: f64,
    basis: Basis,
}

/// The basis of an error.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
enum Basis {
    /// The samples were assumed to be independent.
    Independent,
    /// The error comes from blocks that were long enough.
    Blocks,
    /// No block was long enough; this is the largest error found.
    ShortBlocks,
}

impl Estimate {
    /// Creates the mean and error of independent samples.
    pub(crate) fn independent(mean: f64, standard_error: f64, samples: u64) -> Self {
        Self::of(mean, standard_error, samples, 1.0, Basis::Independent)
    }

    /// Creates the mean and error of correlated samples, from blocks.
    pub(crate) fn blocked(
        mean: f64,
        standard_error: f64,
        samples: u64,
        correlated_samples: f64,
        converged: bool,
    ) -> Self {
        let basis = if converged { Basis::Blocks } else { Basis::ShortBlocks };
        Self::of(mean, standard_error, samples, correlated_samples, basis)
    }

    fn of(mean: f64, standard_error: f64, samples: u64, correlated_samples: f64, basis: Basis) -> Self {
        let mean = if samples == 0 { f64::NAN } else { mean };
        let standard_error = if samples < 2 { f64::NAN } else { standard_error };
        Self { mean, standard_error, samples, correlated_samples, basis }
    }

    /// Returns an estimate with this mean and the same error.
    ///
    /// The error of a ratio, for example, is the error of the mean of its residuals.
    pub fn about(self, mean: f64) -> Self {
        Self { mean, ..self }
    }

    /// Returns the estimate for samples that are all multiplied by a factor.
    pub(crate) fn scaled(self, factor: f64) -> Self {
        let standard_error = self.standard_error * factor.abs();
        Self { mean: self.mean * factor, standard_error, ..self }
    }

    /// Returns the mean; NaN without samples.
    pub const fn mean(&self) -> f64 {
        self.mean
    }

    /// Returns the standard error of the mean; NaN for fewer than two samples.
    pub const fn standard_error(&self) -> f64 {
        self.standard_error
    }

    /// Returns the number of samples.
    pub const fn samples(&self) -> u64 {
        self.samples
    }

    /// Returns the number of consecutive samples that carry as much information as one independent sample.
    ///
    /// The number is $`1 + 2\sum_k\rho_k`$ for autocorrelations $`\rho_k`$. It is 1 if the samples are taken
    /// as independent, or if all are equal.
    pub const fn correlated_samples(&self) -> f64 {
        self.correlated_samples
    }

    /// Returns the number of independent samples with the same information: the number of samples divided by
    /// [`correlated_samples`](Self::correlated_samples), and at most the number of samples.
    pub fn independent_samples(&self) -> f64 {
        self.samples as f64 / self.correlated_samples.max(1.0)
    }

    /// Returns whether the error can be trusted.
    ///
    /// If not, the error is only a lower bound: the series is too short for its correlations (see the table
    /// of [`block_average`](super::block_average)), all samples are equal, a sample is NaN, or there are
    /// fewer than two samples.
    pub const fn is_converged(&self) -> bool {
        let are_equal = self.standard_error == 0.0 && matches!(self.basis, Basis::Independent);
        let is_known = self.standard_error >= 0.0 && !are_equal;
        self.samples >= 2 && !matches!(self.basis, Basis::ShortBlocks) && is_known && !self.mean.is_nan()
    }

    /// Returns the number of decimals with which the error shows two digits.
    fn decimals(&self) -> usize {
        const MOST: usize = 17;
        let mut shown = self.standard_error;
        if shown == 0.0 || !shown.is_finite() {
            return 5;
        }
        let mut decimals = 0;
        // An error of 9.95 or more prints with two digits already.
        while shown < 9.95 && decimals < MOST {
            shown *= 10.0;
            decimals += 1;
        }
        decimals
    }
}

impl fmt::Display for Estimate {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let digits = formatter.precision().unwrap_or_else(|| self.decimals());
        write!(formatter, "{:.digits$} ± {:.digits$}", self.mean, self.standard_error)?;
        match (self.samples, self.basis) {
            (0 | 1, _) => formatter.write_str(" (too few samples for an error)"),
            (_, Basis::ShortBlocks | Basis::Independent) if self.standard_error == 0.0 => {
                formatter.write_str(" (all samples are equal)")
            }
            (_, Basis::Independent) => formatter.write_str(" (independent samples)"),
            (_, Basis::Blocks) => Ok(()),
            (_, Basis::ShortBlocks) => formatter.write_str(" (not converged: a lower bound)"),
        }
    }
}

crate::gate::from_file! {
    Estimate {
        mean: Option<f64>, standard_error: Option<f64>, samples: u64, correlated_samples: f64, basis: Basis
    } => {
        use crate::quantity::{accept, finite, non_negative};
        let fits = mean.is_some() == (samples > 0) && standard_error.is_some() == (samples > 1);
        let requirement = "consistent with its mean and its error";
        accept(fits, "samples of an estimate", requirement, samples as f64)?;
        finite("mean", mean.unwrap_or(0.0))?;
        non_negative("standard error", standard_error.unwrap_or(0.0))?;
        non_negative("number of correlated samples", correlated_samples)?;
        let (mean, standard_error) = (mean.unwrap_or(f64::NAN), standard_error.unwrap_or(f64::NAN));
        Ok(Self { mean, standard_error, samples, correlated_samples, basis })
    }
}

/// Smallest number of repeats whose scatter is meaningful: eight, as with blocks. The limit is slightly
/// lower, so that the lengths of the eight may differ a little.
const ENOUGH: f64 = 7.5;

/// Variance between runs, relative to the variance that their errors explain, above which the runs differ.
const DIFFERENT: f64 = 4.0;

impl Estimate {
    /// Combines the estimates of several independent runs into one, as if all samples were of one run.
    ///
    /// Runs are independent if their seeds differ: of the initial states, of drivings, and of the
    /// [stochastic walls](crate::simulation::SimulationBuilder::seed).
    ///
    /// Each run is weighted by the number of its samples. The error is the larger of two errors. One follows
    /// from the errors of the runs, and the other from the scatter of their means,
    ///
    /// ```math
    /// \epsilon^2 = \max\left(\sum_i w_i^2\epsilon_i^2,\; \frac{1}{k-1}\sum_i w_i(\bar x_i-\bar x)^2\right),
    /// \quad w_i = n_i/n .
    /// ```
    ///
    /// Here, $`k`$ is the number of runs. If the second error is more than twice the first, the runs found
    /// different states, and a long run is worth no more than a short one: $`k`$ is then
    /// $`1/\sum_i w_i^2`$, which is smaller if the lengths differ.
    ///
    /// The scatter reveals changes for which a single run is too short, such as the reversal of a roll. The
    /// scatter of two or three runs, however, may be small by chance; the errors of the runs then count. The
    /// estimate has converged if the runs agree and the estimates of all have converged, if $`k`$ is about
    /// eight or more, or if the runs together have 120 independent samples by this error, the number that a
    /// single run needs. It has not converged if all samples are equal. Runs without samples are left out. If
    /// all runs have the same mean and the same error, they are the same run, which counts once.
    ///
    /// ```
    /// use granular_edmd::statistics::{Estimate, block_average};
    /// let chaos = std::iter::successors(Some(0.3), |x| Some(4.0 * x * (1.0 - x)));
    /// let chaos: Vec<f64> = chaos.take(4096).collect();
    /// let runs = chaos.chunks(1024).map(block_average).collect::<Result<Vec<_>, _>>()?;
    /// let together = Estimate::over_repeats(runs.iter().copied());
    /// assert_eq!(together.samples(), 4096);
    /// assert!(together.is_converged() && together.standard_error() < runs[0].standard_error());
    ///
    /// // Two runs that found different states: two numbers, however many samples each has.
    /// let run = |level: f64| chaos[..1024].iter().map(|x| level + 0.01 * x).collect::<Vec<_>>();
    /// let together = Estimate::over_repeats([block_average(&run(0.0))?, block_average(&run(1.0))?]);
    /// assert!((together.standard_error() - 0.5).abs() < 0.01);
    /// assert!(together.independent_samples() < 1.1);
    /// # Ok::<(), granular_edmd::ParameterError>(())
    /// ```
    pub fn over_repeats(runs: impl IntoIterator<Item = Self>) -> Self {
        let runs: Vec<Self> = runs.into_iter().filter(|run| run.samples() > 0).collect();
        if let [run] = runs[..] {
            return run;
        }
        let samples: u64 = runs.iter().map(Self::samples).sum();
        let is_equal =
            |run: &Self| run.mean() == runs[0].mean() && (run.samples() == 1 || run.standard_error() == 0.0);
        if samples > 1 && runs.iter().all(is_equal) {
            return Self::blocked(runs[0].mean(), 0.0, samples, samples as f64, false);
        }
        let is_same = |run: &Self| {
            (run.mean(), run.standard_error(), run.samples())
                == (runs[0].mean(), runs[0].standard_error(), runs[0].samples())
        };
        if !runs.is_empty() && runs.iter().all(is_same) {
            return runs[0];
        }
        let weighted = |value: &dyn Fn(&Self) -> f64| -> f64 {
            runs.iter().map(|run| run.samples() as f64 / samples as f64 * value(run)).sum()
        };
        let mean = weighted(&Self::mean);
        let scatter = weighted(&|run| (run.mean() - mean) * (run.mean() - mean));
        let within = weighted(&|run| {
            run.samples() as f64 / samples as f64 * run.standard_error() * run.standard_error()
        });
        let count = runs.len() as f64;
        // In this form, the effective number of runs of equal lengths is exact.
        let squares: f64 = runs.iter().map(|run| run.samples() as f64 * run.samples() as f64).sum();
        let effective = samples as f64 * samples as f64 / squares;
        let differ = scatter / (count - 1.0) > DIFFERENT * within;
        let count = if differ { effective } else { count };
        let between = scatter / (count - 1.0);
        // The error of a run of one sample is NaN, which `max` ignores.
        let error = between.max(within).sqrt();
        // The variance of all samples about their mean is the sum of the variances within the runs and
        // between the runs.
        let variance = weighted(&Self::variance) + scatter;
        let naive = (variance / samples as f64).sqrt();
        let growth = if naive > 0.0 { error / naive } else { 1.0 };
        let correlated = growth * growth;
        let is_long = samples as f64 / correlated.max(1.0) >= FEWEST_INDEPENDENT;
        let converged = is_long || count >= ENOUGH || !differ && runs.iter().all(Self::is_converged);
        Self::blocked(mean, error, samples, correlated, converged)
    }

    /// Returns the variance of the samples, as far as it is known.
    fn variance(&self) -> f64 {
        let naive = self.standard_error() * self.standard_error() / self.correlated_samples();
        if naive.is_finite() { naive * self.samples() as f64 } else { 0.0 }
    }
}
