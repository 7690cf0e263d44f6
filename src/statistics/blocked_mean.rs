//! Means and errors of correlated numbers, without keeping the numbers.

use super::plateau::{BlockError, plateau};
use super::{Estimate, RunningMean};

/// The mean of correlated numbers that come one by one, with an error that accounts for their correlation.
///
/// The type keeps the scatter of blocks of 1, 2, 4, … numbers. Its memory grows with the logarithm of their
/// count, and each number costs constant time on average. [`Self::estimate`] takes the error from the
/// smallest blocks that are long enough. The result has the same bits as
/// [`block_average`](super::block_average) gives for a series in memory.
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
#[cfg_attr(feature = "serde", serde(try_from = "Vec<Level>"))]
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

impl Extend<f64> for BlockedMean {
    fn extend<T: IntoIterator<Item = f64>>(&mut self, values: T) {
        values.into_iter().for_each(|value| self.push(value));
    }
}

impl FromIterator<f64> for BlockedMean {
    fn from_iter<T: IntoIterator<Item = f64>>(values: T) -> Self {
        let mut mean = Self::default();
        mean.extend(values);
        mean
    }
}

#[cfg(feature = "serde")]
impl TryFrom<Vec<Level>> for BlockedMean {
    type Error = crate::ParameterError;

    fn try_from(levels: Vec<Level>) -> Result<Self, Self::Error> {
        use crate::quantity::{accept, finite};
        let mut expected = levels.first().map_or(0, |level| level.blocks.count());
        for Level { blocks, waiting } in &levels {
            let count = blocks.count();
            accept(
                count == expected && count > 0,
                "number of blocks",
                "half of the smaller ones",
                count as f64,
            )?;
            accept(waiting.is_some() == (count % 2 == 1), "odd block", "waiting for the next", count as f64)?;
            finite("block", waiting.unwrap_or(0.0))?;
            expected = count / 2;
        }
        accept(expected == 0, "number of blocks", "half of the smaller ones", 0.0)?;
        Ok(Self(levels))
    }
}
