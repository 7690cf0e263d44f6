//! Means of correlated samples.

use super::{BlockedMean, Estimate, RunningMean};
use crate::ParameterError;
use crate::quantity::accept;

/// Largest sample allowed, so that a sum of squares stays finite.
const LARGEST: f64 = 1e100;

/// Smallest number of blocks with a meaningful scatter. The error of eight blocks is uncertain by a quarter.
const FEWEST_BLOCKS: u64 = 8;

/// Returns the mean of a time series, with an error that accounts for its autocorrelation (Flyvbjerg &
/// Petersen 1989).
///
/// Pairs of neighbors are replaced by their mean, again and again. The naive error of the blocked series,
///
/// ```math
/// \epsilon_B^2 = \frac{1}{n_B(n_B-1)}\sum_i (x_i^{(B)}-\bar x)^2,
/// ```
///
/// grows with the block size $`B`$ until blocks are independent. The error is that of the smallest blocks for
/// which
/// 1. $`B^3 > 2n(\epsilon_B/\epsilon_1)^4`$: shorter blocks leave a bias that is larger than the scatter of
///    $`\epsilon_B`$ itself, and longer ones scatter more (Lee et al. 2011, Phys. Rev. E 83, 066706);
/// 2. $`\epsilon_B`$ exceeds the error from blocks of half the size by at most its own uncertainty, and the
///    error from blocks of a quarter of the size by at most one and a half times its uncertainty;
/// 3. for no larger blocks does the error exceed $`\epsilon_B`$ by more than twice the uncertainty of that
///    error.
///
/// The first condition suffices for a series with one correlation time. The others detect a second, longer
/// one with a small share of the variance, such as heat that slowly comes and goes in a gas whose collisions
/// are otherwise independent. Sizes with fewer than eight blocks are not considered. So if a series is
/// shorter than some hundred times [`Estimate::correlated_samples`], no blocks meet all conditions. The
/// estimate is then not converged, and its error is the largest that was found.
///
/// # Errors
/// If there are fewer than two samples, or one is not finite or above 1e100 in size.
///
/// ```
/// use granular_edmd::statistics::block_average;
/// // An uncorrelated sequence (the logistic map), each value repeated 16 times: 16 samples are worth one.
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

/// The apparent standard error from blocks of one size.
#[derive(Debug, Clone, Copy)]
pub(super) struct BlockError {
    pub(super) error: f64,
    /// Relative uncertainty of the error itself.
    uncertainty: f64,
    blocks: u64,
}

impl BlockError {
    /// Returns the error from two or more blocks that are taken as independent.
    pub(super) fn of(blocks: &RunningMean) -> Self {
        let count = blocks.count();
        // The uncertainty is that of a standard deviation of normal numbers.
        let uncertainty = 1.0 / (2.0 * (count - 1) as f64).sqrt();
        Self { error: blocks.standard_error(), uncertainty, blocks: count }
    }
}

/// Returns the error of the smallest blocks for which it no longer grows, or `None` if there is no such size.
/// The levels are for sizes 1, 2, 4, ….
pub(super) fn plateau(levels: &[BlockError], samples: u64) -> Option<f64> {
    let known = levels.iter().take_while(|level| level.blocks >= FEWEST_BLOCKS).count();
    let levels = &levels[..known];
    // The error is compared with blocks of half and of a quarter of the size. Of two correlation times, the
    // longer one shows as a slow rise.
    let is_flat = |at: usize| {
        let here = levels[at];
        let tolerances = [1.0, 1.5].map(|factor| 1.0 + factor * here.uncertainty);
        let smaller = levels[..at].iter().rev();
        smaller.zip(tolerances).all(|(before, tolerance)| here.error <= before.error * tolerance)
    };
    let is_the_last_rise = |at: usize| {
        let least = |level: &BlockError| level.error * (1.0 - 2.0 * level.uncertainty);
        levels[at + 1..].iter().all(|larger| least(larger) <= levels[at].error)
    };
    let is_plateau = |&at: &usize| {
        let growth = levels[at].error / levels[0].error;
        is_long_enough((1_u64 << at) as f64, samples, growth) && is_flat(at) && is_the_last_rise(at)
    };
    (1..known).find(is_plateau).map(|at| levels[at].error)
}

/// Tells whether blocks of this size are long enough for a series with one correlation time. The error of
/// these blocks is `growth` times that of independent samples.
fn is_long_enough(size: f64, samples: u64, growth: f64) -> bool {
    let squared = growth * growth;
    // Products of powers of two are exact, and the cube of 2^63 is far from overflow.
    size * size * size > 2.0 * samples as f64 * (squared * squared)
}
