//! Means of correlated samples.

use super::{BlockedMean, Estimate};
use crate::ParameterError;
use crate::quantity::accept;

/// Largest sample: its square, summed over a series, stays finite.
const LARGEST: f64 = 1e100;

/// Returns the mean of a time series, with an error that knows of its autocorrelation (Flyvbjerg & Petersen 1989).
///
/// Neighbors are replaced by their mean again and again. The naive error of the blocked series,
///
/// ```math
/// \epsilon_B^2 = \frac{1}{n_B(n_B-1)}\sum_i (x_i^{(B)}-\bar x)^2,
/// ```
///
/// grows with the block size `$B$` until blocks are independent. The error is that of the smallest blocks with
/// `$B^3 > 2n(\epsilon_B/\epsilon_1)^4$`: shorter blocks leave a bias that is larger than the scatter of `$\epsilon_B$` itself,
/// longer ones scatter more (Lee et al. 2011, Phys. Rev. E 83, 066706). A series of less than some ten times
/// [`Estimate::correlated_samples`] has no such block: the estimate is then not converged, and its error the largest found.
///
/// # Errors
/// If there are fewer than two samples, or one is not finite or above 1e100 in size.
///
/// ```
/// use granular_edmd::statistics::block_average;
/// // An uncorrelated sequence (the logistic map), each value held for 16 samples: 16 are worth one.
/// let chaos = std::iter::successors(Some(0.3), |x| Some(4.0 * x * (1.0 - x)));
/// let series: Vec<f64> = chaos.take(512).flat_map(|x| [x; 16]).collect();
/// let average = block_average(&series)?;
/// assert!(average.is_converged());
/// assert!((average.correlated_samples() - 16.0).abs() < 6.0);
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
pub fn block_average(samples: &[f64]) -> Result<Estimate, ParameterError> {
    accept(samples.len() >= 2, "number of samples", "at least 2", samples.len() as f64)?;
    let largest = "finite and at most 1e100 in size";
    samples
        .iter()
        .try_for_each(|&sample| accept(sample.abs() <= LARGEST, "sample", largest, sample).map(|_| ()))?;
    Ok(samples.iter().copied().collect::<BlockedMean>().estimate())
}

/// Decides that blocks of this size are long enough for a series of `count` samples, if the error of the blocked series is
/// `growth` times that of the samples.
pub(super) fn is_long_enough(size: f64, count: u64, growth: f64) -> bool {
    let squared = growth * growth;
    // Products of powers of two are exact, and a cube of 2^63 is far from overflow.
    size * size * size > 2.0 * count as f64 * (squared * squared)
}
