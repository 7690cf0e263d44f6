//! Running means and moments, and the errors of correlated data by blocks.

use super::Estimate;
use super::estimate::FEWEST_INDEPENDENT;
use crate::ParameterError;
use crate::quantity::accept;

/// The mean, variance and standard error of numbers that come one by one (Welford 1962).
///
/// The standard error assumes independent numbers. It is too small for correlated numbers, such as the
/// samples or collisions of one run; see [`BlockedMean`].
///
/// ```
/// use granular_edmd::statistics::RunningMean;
/// let mean: RunningMean = [1.0, 2.0, 3.0].into_iter().collect();
/// assert_eq!(mean.mean(), 2.0);
/// assert_eq!(mean.variance(), 1.0);
/// assert!((mean.standard_error() - (1.0_f64 / 3.0).sqrt()).abs() < 1e-15);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct RunningMean {
    pub(crate) weight: f64,
    pub(crate) mean: f64,
    /// Weighted sum of the squared deviations from the mean. They are taken from the mean so far: the
    /// difference of a sum of squares and a squared sum would lose the digits of a small variance about a
    /// large mean.
    pub(crate) squares: f64,
}

impl RunningMean {
    /// Adds a number.
    #[inline]
    pub fn push(&mut self, value: f64) {
        self.push_weighted(value, 1.0);
    }

    /// Adds a number with a weight (West 1979).
    #[inline]
    pub(crate) fn push_weighted(&mut self, value: f64, weight: f64) {
        self.weight += weight;
        let before = value - self.mean;
        self.mean += before * weight / self.weight;
        let squares = weight * before * (value - self.mean);
        // Both factors have the same sign, except for rounding among numbers that are nearly equal.
        self.squares += if squares < 0.0 { 0.0 } else { squares };
    }

    /// Returns the count of the numbers.
    pub const fn count(&self) -> u64 {
        self.weight as u64
    }

    /// Returns the mean of the numbers, or NaN without numbers.
    pub const fn mean(&self) -> f64 {
        if self.weight > 0.0 { self.mean } else { f64::NAN }
    }

    /// Returns the sum of the numbers.
    pub fn sum(&self) -> f64 {
        self.mean * self.weight
    }

    /// Returns the unbiased variance of the numbers; NaN for fewer than two.
    pub fn variance(&self) -> f64 {
        if self.weight < 2.0 { f64::NAN } else { self.squares / (self.weight - 1.0) }
    }

    /// Returns the standard deviation of the numbers, the square root of the variance.
    pub fn standard_deviation(&self) -> f64 {
        self.variance().sqrt()
    }

    /// Returns the standard error of the mean of n independent numbers, √(variance/n); NaN for fewer than
    /// two.
    pub fn standard_error(&self) -> f64 {
        (self.variance() / self.weight).sqrt()
    }

    /// Returns the mean with the error of independent numbers.
    pub fn estimate(&self) -> Estimate {
        Estimate::independent(self.mean(), self.standard_error(), self.count())
    }
}

/// Implements `Extend` and `FromIterator` for means of numbers that come one by one.
macro_rules! collect_numbers {
    ($($mean:ident),+) => {
        $(impl Extend<f64> for $mean {
            fn extend<T: IntoIterator<Item = f64>>(&mut self, values: T) {
                values.into_iter().for_each(|value| self.push(value));
            }
        }

        impl FromIterator<f64> for $mean {
            fn from_iter<T: IntoIterator<Item = f64>>(values: T) -> Self {
                let mut mean = Self::default();
                mean.extend(values);
                mean
            }
        })+
    };
}

collect_numbers! { RunningMean, BlockedMean }

/// Largest allowed magnitude of a sample, so that a sum of squares stays finite.
const LARGEST: f64 = 1e100;

/// Returns the mean of a time series, with an error that accounts for its autocorrelation (Flyvbjerg &
/// Petersen 1989).
///
/// Pairs of neighbors are replaced by their mean, repeatedly. The naive error of the blocked series,
///
/// ```math
/// \epsilon_B^2 = \frac{1}{n_B(n_B-1)}\sum_i (x_i^{(B)}-\bar x)^2,
/// ```
///
/// grows with the block size $`B`$ until blocks are independent. The error is taken from the smallest blocks
/// for which
/// 1. $`B^3 > 2n(\epsilon_B/\epsilon_1)^4`$: shorter blocks leave a bias that is larger than the scatter of
///    $`\epsilon_B`$ itself, and longer ones scatter more (Lee et al. 2011, Phys. Rev. E 83, 066706);
/// 2. $`\epsilon_B`$ exceeds the error from blocks of half the size by at most its own uncertainty, and the
///    error from blocks of a quarter of the size by at most one and a half times its uncertainty;
/// 3. no error from larger blocks exceeds $`\epsilon_B`$ by more than twice the uncertainty of that error;
/// 4. the samples at the end that fill no block change the mean by at most $`\epsilon_B`$.
///
/// The first condition suffices for a series with one correlation time. The other conditions detect a second,
/// longer correlation time with a small share of the variance, such as heat that slowly comes and goes in a
/// gas whose collisions are otherwise independent. They do not consider sizes with fewer than eight blocks.
///
/// An error is [converged](Estimate::is_converged) if there are such blocks, and if the largest error from
/// eight or more blocks leaves at least 120 independent samples, $`n_i`$. The error is then multiplied by
/// $`1 + 60/n_i`$, because errors that are small by chance pass this test more often than others. An error
/// that is not converged is the largest that was found, even from two blocks.
///
/// The method was tried on 4000 Gaussian series of $`n`$ samples with one correlation time ($`\tau`$ samples
/// are worth one), and on series with two times (70 % and 30 % of the variance, the second time $`\tau_2`$ 30
/// times longer):
///
/// | $`n/\tau`$ or $`n/\tau_2`$ | 30 | 50 | 75 | 100 | 150 | 300 | 1000 |
/// |---|---|---|---|---|---|---|---|
/// | one time: converged | 0 | 0.1 % | 4 % | 21 % | 77 % | 97 % | 99.5 % |
/// | of these, true mean within two errors | | | 92 % | 96 % | 98 % | 97 % | 95 % |
/// | two times: converged | 40 % | 69 % | 81 % | 92 % | 93 % | 98 % | 99.7 % |
/// | of these, true mean within two errors | 94 % | 96 % | 96 % | 96 % | 95 % | 95 % | 95 % |
///
/// If all samples are equal, the error is 0 and not converged: the series does not show whether the quantity
/// is constant, or has not changed yet.
///
/// # Errors
/// If there are fewer than two samples, or one of them is not finite or above 1e100 in magnitude.
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
    let largest = "finite and at most 1e100 in magnitude";
    samples
        .iter()
        .try_for_each(|&sample| accept(sample.abs() <= LARGEST, "sample", largest, sample).map(|_| ()))?;
    Ok(samples.iter().copied().collect::<BlockedMean>().estimate())
}

/// Smallest number of blocks with a meaningful scatter. The error of eight blocks is uncertain by a quarter.
const FEWEST_BLOCKS: u64 = 8;

/// Relative excess of a trusted error over the error from its blocks, times the number of independent
/// samples.
///
/// A series is called converged if its error is small, and some errors are small by chance. Trusted errors
/// are therefore too small on average, especially errors from few samples. With this excess, the true mean
/// lies within two errors in nine cases in ten or more, at any length. The table of
/// [`block_average`] shows it.
const EXCESS: f64 = 60.0;

/// Largest allowed change of the mean by the last samples, which fill no block, in units of the error from
/// the blocks. In a long series this effect is about a tenth of an error; if it exceeds this limit, the
/// blocks do not show the scatter of the whole series.
const LARGEST_REST: f64 = 1.0;

/// Rounding of means, relative to the error of independent samples.
const ROUNDING: f64 = 1e-6;

/// The apparent standard error from blocks of one size.
#[derive(Debug, Clone, Copy)]
struct BlockError {
    error: f64,
    mean: f64,
    /// Relative uncertainty of the error itself.
    uncertainty: f64,
    blocks: u64,
}

impl BlockError {
    /// Returns the error from two or more blocks that are assumed to be independent.
    fn of(blocks: &RunningMean) -> Self {
        let count = blocks.count();
        // The uncertainty of a standard deviation of normal numbers.
        let uncertainty = 1.0 / (2.0 * (count - 1) as f64).sqrt();
        Self { error: blocks.standard_error(), mean: blocks.mean(), uncertainty, blocks: count }
    }
}

/// Returns the error from the smallest blocks beyond which the error no longer grows, and the same error
/// raised by the share that [`EXCESS`] gives. Returns `None` if the error cannot be trusted. The levels are
/// for sizes 1, 2, 4, ….
fn plateau(levels: &[BlockError], samples: u64) -> Option<(f64, f64)> {
    let known = levels.iter().take_while(|level| level.blocks >= FEWEST_BLOCKS).count();
    let levels = &levels[..known];
    // The error is compared with the errors from blocks half and a quarter as large. The longer of two
    // correlation times shows as a slow rise.
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
    let rest = |at: usize| (levels[at].mean - levels[0].mean).abs();
    let is_plateau = |&at: &usize| {
        let size = (1_u64 << at) as f64;
        let shows_all = rest(at) <= LARGEST_REST * levels[at].error + ROUNDING * levels[0].error;
        is_long_enough(size, samples, growth(levels[at].error))
            && is_flat(at)
            && is_the_last_rise(at)
            && shows_all
    };
    let error = (1..known).find(is_plateau).map(|at| levels[at].error)?;
    // The largest error counts here, not the error of the plateau, since it matters how long the correlation
    // may be.
    let largest = levels.iter().map(|level| level.error).fold(levels[0].error, f64::max);
    let growth = growth(largest);
    let independent = samples as f64 / (growth * growth);
    (independent >= FEWEST_INDEPENDENT).then(|| (error, error * (1.0 + EXCESS / independent)))
}

/// Returns whether blocks of this size are long enough for a series with one correlation time. The error of
/// these blocks is `growth` times the error of independent samples.
fn is_long_enough(size: f64, samples: u64, growth: f64) -> bool {
    let squared = growth * growth;
    // Products of powers of two are exact, and the cube of 2^63 is far from overflow.
    size * size * size > 2.0 * samples as f64 * (squared * squared)
}

/// The mean of correlated numbers that come one by one, with an error that accounts for their correlation.
///
/// The type keeps the scatter of blocks of 1, 2, 4, … numbers. Its memory grows with the logarithm of their
/// count, and each number costs constant time on average. [`Self::estimate`] takes the error from the
/// smallest blocks that are long enough. The result has the same bits as
/// [`block_average`] gives for a series in memory.
///
/// ```
/// use granular_edmd::statistics::{BlockedMean, block_average};
/// let series: Vec<f64> = (0..1000).map(|k| f64::from(k / 10 % 7)).collect();
/// let mean: BlockedMean = series.iter().copied().collect();
/// assert_eq!(mean.estimate(), block_average(&series)?);
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
// Blocks of one number, of two, of four, …, for all sizes of which there is at least one block.
pub struct BlockedMean(Vec<Level>);

/// Blocks of one size.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
struct Level {
    blocks: RunningMean,
    /// The last block, until it forms a larger block with the next.
    waiting: Option<f64>,
}

impl BlockedMean {
    /// Creates a mean of no numbers.
    pub const fn new() -> Self {
        Self(Vec::new())
    }

    /// Creates a mean of no numbers with room for all numbers that a run can have, so that a collision never
    /// allocates.
    pub(crate) fn with_room() -> Self {
        Self(Vec::with_capacity(u64::BITS as usize))
    }

    /// Adds a number.
    #[inline]
    pub fn push(&mut self, value: f64) {
        let mut block = value;
        for level in &mut self.0 {
            level.blocks.push(block);
            let Some(before) = level.waiting.take() else {
                level.waiting = Some(block);
                return;
            };
            block = 0.5 * (before + block);
        }
        self.0.push(Level { blocks: RunningMean::from_iter([block]), waiting: Some(block) });
    }

    /// Returns the count of the numbers.
    pub fn count(&self) -> u64 {
        self.ungrouped().count()
    }

    /// Returns the mean of the numbers, or NaN without numbers.
    pub fn mean(&self) -> f64 {
        self.ungrouped().mean()
    }

    /// Returns the sum of the numbers.
    pub fn sum(&self) -> f64 {
        self.ungrouped().sum()
    }

    /// Returns the mean and the variance of the single numbers, regardless of their correlation.
    pub fn ungrouped(&self) -> RunningMean {
        self.0.first().map_or_else(RunningMean::default, |level| level.blocks)
    }

    /// Returns the mean with an error from blocks, for numbers of at most 1e100 in magnitude.
    pub fn estimate(&self) -> Estimate {
        let whole = self.ungrouped();
        let naive = whole.standard_error();
        if whole.count() < 2 {
            return Estimate::blocked(whole.mean(), naive, whole.count(), 1.0, false);
        }
        if naive == 0.0 {
            // Equal samples carry no more information than one of them.
            return Estimate::blocked(whole.mean(), 0.0, whole.count(), whole.count() as f64, false);
        }
        let several = self.0.iter().map(|level| level.blocks).take_while(|blocks| blocks.count() >= 2);
        let errors: Vec<BlockError> = several.map(|blocks| BlockError::of(&blocks)).collect();
        let plateau = plateau(&errors, whole.count());
        let (error, raised) = plateau.unwrap_or_else(|| {
            let largest = errors.iter().map(|level| level.error).fold(naive, f64::max);
            (largest, largest)
        });
        let growth = error / naive;
        Estimate::blocked(whole.mean(), raised, whole.count(), growth * growth, plateau.is_some())
    }
}
