//! Means of correlated samples.

use crate::ParameterError;
use crate::observable::RunningMean;
use crate::quantity::accept;

/// Largest sample: its square, summed over a series, stays finite.
const LARGEST: f64 = 1e100;

/// Mean of a correlated series with its standard error; made by [`block_average`].
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct BlockAverage {
    mean: f64,
    error: f64,
    correlated_samples: f64,
    converged: bool,
}

impl BlockAverage {
    /// The mean of all samples.
    pub const fn mean(&self) -> f64 {
        self.mean
    }

    /// Its standard error, with the correlation of the samples in it.
    pub const fn standard_error(&self) -> f64 {
        self.error
    }

    /// How many consecutive samples tell as much as one independent sample, `$1 + 2\sum_k\rho_k$` for
    /// autocorrelations `$\rho_k$`; 1 if the samples are independent or all equal.
    pub const fn correlated_samples(&self) -> f64 {
        self.correlated_samples
    }

    /// Whether the series was long enough: if not, the error is a lower bound.
    pub const fn is_converged(&self) -> bool {
        self.converged
    }
}

/// Mean of a time series, with an error that knows of its autocorrelation (Flyvbjerg & Petersen 1989).
///
/// Neighbours are replaced by their mean again and again. The naive error of the blocked series,
///
/// ```math
/// \epsilon_B^2 = \frac{1}{n_B(n_B-1)}\sum_i (x_i^{(B)}-\bar x)^2,
/// ```
///
/// grows with the block size `$B$` until blocks are independent. The smallest block is taken with
/// `$B^3 > 2n(\epsilon_B/\epsilon_1)^4$`, where the bias left and the scatter of `$\epsilon_B$` itself are about equal
/// (Lee et al. 2011, Phys. Rev. E 83, 066706). A series for which there is none is too short to tell, as one below some
/// ten of [`BlockAverage::correlated_samples`] is: the largest error found is then returned as not converged.
///
/// # Errors
/// If there are fewer than two samples, or one is not finite or above 1e100 in size.
///
/// ```
/// use granular_edmd::analysis::block_average;
/// // An uncorrelated sequence (the logistic map), each value held for 16 samples: 16 are worth one.
/// let chaos = std::iter::successors(Some(0.3), |x| Some(4.0 * x * (1.0 - x)));
/// let series: Vec<f64> = chaos.take(512).flat_map(|x| [x; 16]).collect();
/// let average = block_average(&series)?;
/// assert!(average.is_converged());
/// assert!((average.correlated_samples() - 16.0).abs() < 6.0);
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
pub fn block_average(samples: &[f64]) -> Result<BlockAverage, ParameterError> {
    check(samples)?;
    let whole: RunningMean = samples.iter().copied().collect();
    let naive = whole.standard_error();
    let plateau = plateau(samples, naive);
    let error = plateau.unwrap_or_else(|| levels(samples).map(|(_, error)| error).fold(naive, f64::max));
    let correlated_samples = if naive > 0.0 { (error / naive).powi(2) } else { 1.0 };
    Ok(BlockAverage { mean: whole.mean(), error, correlated_samples, converged: plateau.is_some() })
}

fn check(samples: &[f64]) -> Result<(), ParameterError> {
    accept(samples.len() >= 2, "number of samples", "at least 2", samples.len() as f64)?;
    samples.iter().try_for_each(|&sample| {
        accept(sample.abs() <= LARGEST, "sample", "finite and at most 1e100 in size", sample).map(|_| ())
    })
}

/// The error at the smallest block that is long enough.
fn plateau(samples: &[f64], naive: f64) -> Option<f64> {
    let enough = |block: f64, error: f64| {
        let growth = if naive > 0.0 { error / naive } else { 0.0 };
        block.powi(3) > 2.0 * samples.len() as f64 * growth.powi(4)
    };
    levels(samples).find(|&(block, error)| enough(block, error)).map(|(_, error)| error)
}

/// Block sizes and naive errors, as long as there are two blocks; a last odd block is left out.
fn levels(samples: &[f64]) -> impl Iterator<Item = (f64, f64)> {
    let halve =
        |blocks: &Vec<f64>| Some(blocks.chunks_exact(2).map(|pair| 0.5 * (pair[0] + pair[1])).collect());
    let blocked = std::iter::successors(Some(samples.to_vec()), halve).take_while(|blocks| blocks.len() >= 2);
    blocked.enumerate().map(|(level, blocks)| {
        let mean: RunningMean = blocks.into_iter().collect();
        ((1_u64 << level) as f64, mean.standard_error())
    })
}
