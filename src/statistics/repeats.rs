//! Combination of the estimates of several runs.

use super::Estimate;
use super::plateau::FEWEST_INDEPENDENT;

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
