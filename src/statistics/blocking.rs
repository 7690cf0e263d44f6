//! Means of correlated samples.

use super::{BlockedMean, Estimate, RunningMean};
use crate::ParameterError;
use crate::quantity::accept;

/// Largest sample allowed, so that a sum of squares stays finite.
const LARGEST: f64 = 1e100;

/// Smallest number of blocks with a meaningful scatter. The error of eight blocks is uncertain by a quarter.
const FEWEST_BLOCKS: u64 = 8;

/// Smallest number of independent samples of an error that can be trusted.
///
/// Blocks of a series of 50 independent samples look like those of 120 or more in one case of a thousand.
/// With half of this number, every tenth series of 30 would be called converged, with an error too small by a
/// third.
const FEWEST_INDEPENDENT: f64 = 120.0;

/// Excess of a trusted error over that of its blocks, times the number of independent samples.
///
/// A series is called converged if its error is small, and some errors are small by chance: the errors that
/// are trusted are too small on average, the more so the fewer samples they have. With this excess, two
/// errors hold the true mean in nine cases of ten or more at any length. The table of [`block_average`] shows
/// it.
const EXCESS: f64 = 60.0;

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
/// are otherwise independent. Sizes with fewer than eight blocks are not considered.
///
/// An error is [converged](Estimate::is_converged) if there are such blocks, and if the largest error of any
/// blocks leaves at least 120 independent samples, $`n_i`$. The error is then raised by the share $`60/n_i`$,
/// because errors that are small by chance pass this test more often than others. If an error is not
/// converged, it is the largest that was found.
///
/// Of 4000 Gaussian series of $`n`$ samples and one correlation time, of which $`\tau`$ are worth one, and of
/// series with two times (of 70 % and 30 % of the variance, the second one 30 times longer and measured by
/// $`n/\tau_2`$):
///
/// | $`n/\tau`$ or $`n/\tau_2`$ | 30 | 50 | 75 | 100 | 150 | 300 | 1000 |
/// |---|---|---|---|---|---|---|---|
/// | one time: converged | 0 | 0.1 % | 4 % | 21 % | 77 % | 97 % | 99.5 % |
/// | of these, true mean within two errors | | | 92 % | 96 % | 98 % | 97 % | 95 % |
/// | two times: converged | 40 % | 69 % | 81 % | 92 % | 93 % | 98 % | 99.7 % |
/// | of these, true mean within two errors | 94 % | 96 % | 96 % | 96 % | 95 % | 95 % | 95 % |
///
/// If all samples are equal, the error is 0, and it is not converged: the series does not show whether the
/// quantity is constant, or has not changed yet.
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

/// Returns the error of the smallest blocks for which it no longer grows, and that error raised as
/// [`EXCESS`] says, or `None` if the error cannot be trusted. The levels are for sizes 1, 2, 4, ….
pub(super) fn plateau(levels: &[BlockError], samples: u64) -> Option<(f64, f64)> {
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
    let growth = |error: f64| error / levels[0].error;
    let is_plateau = |&at: &usize| {
        let size = (1_u64 << at) as f64;
        is_long_enough(size, samples, growth(levels[at].error)) && is_flat(at) && is_the_last_rise(at)
    };
    let error = (1..known).find(is_plateau).map(|at| levels[at].error)?;
    // The largest error, not that of the plateau: what counts here is how long the correlation may be.
    let largest = levels.iter().map(|level| level.error).fold(levels[0].error, f64::max);
    let growth = growth(largest);
    let independent = samples as f64 / (growth * growth);
    (independent >= FEWEST_INDEPENDENT).then(|| (error, error * (1.0 + EXCESS / independent)))
}

/// Tells whether blocks of this size are long enough for a series with one correlation time. The error of
/// these blocks is `growth` times that of independent samples.
fn is_long_enough(size: f64, samples: u64, growth: f64) -> bool {
    let squared = growth * growth;
    // Products of powers of two are exact, and the cube of 2^63 is far from overflow.
    size * size * size > 2.0 * samples as f64 * (squared * squared)
}
