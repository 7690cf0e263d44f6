//! The plateau of errors over block sizes, where blocks have become independent.

use super::RunningMean;

/// Smallest number of blocks with a meaningful scatter. The error of eight blocks is uncertain by a quarter.
const FEWEST_BLOCKS: u64 = 8;

/// Smallest number of independent samples from which an error can be trusted.
///
/// In one case in a thousand, blocks made from 50 independent samples look like blocks made from 120 or more.
/// If half of this number were enough, every tenth series of 30 independent samples would be called
/// converged, with an error too small by a third.
pub(super) const FEWEST_INDEPENDENT: f64 = 120.0;

/// Relative excess of a trusted error over the error from its blocks, times the number of independent
/// samples.
///
/// A series is called converged if its error is small, and some errors are small by chance. Trusted errors
/// are therefore too small on average, especially errors from few samples. With this excess, the true mean
/// lies within two errors in nine cases in ten or more, at any length. The table of
/// [`block_average`](super::block_average) shows it.
const EXCESS: f64 = 60.0;

/// Largest allowed change of the mean by the last samples, which fill no block, in units of the error from
/// the blocks. In a long series this effect is about a tenth of an error; if it exceeds this limit, the
/// blocks do not show the scatter of the whole series.
const LARGEST_REST: f64 = 1.0;

/// Rounding of means, relative to the error of independent samples.
const ROUNDING: f64 = 1e-6;

/// The apparent standard error from blocks of one size.
#[derive(Debug, Clone, Copy)]
pub(super) struct BlockError {
    pub(super) error: f64,
    mean: f64,
    /// Relative uncertainty of the error itself.
    uncertainty: f64,
    blocks: u64,
}

impl BlockError {
    /// Returns the error from two or more blocks that are assumed to be independent.
    pub(super) fn of(blocks: &RunningMean) -> Self {
        let count = blocks.count();
        // The uncertainty of a standard deviation of normal numbers.
        let uncertainty = 1.0 / (2.0 * (count - 1) as f64).sqrt();
        Self { error: blocks.standard_error(), mean: blocks.mean(), uncertainty, blocks: count }
    }
}

/// Returns the error from the smallest blocks beyond which the error no longer grows, and the same error
/// raised by the share that [`EXCESS`] gives. Returns `None` if the error cannot be trusted. The levels are
/// for sizes 1, 2, 4, ….
pub(super) fn plateau(levels: &[BlockError], samples: u64) -> Option<(f64, f64)> {
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
