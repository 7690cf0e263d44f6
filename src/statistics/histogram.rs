//! Histograms, and their bins.

use super::{BlockedMean, Estimate};
use crate::ParameterError;
use crate::quantity::{accept, finite, positive};

/// Largest number of bins.
const MOST_BINS: usize = 1 << 20;

/// Equal bins between two numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub(crate) struct Bins {
    low: f64,
    high: f64,
    #[cfg_attr(feature = "serde", serde(skip))]
    width: f64,
    count: usize,
}

impl Bins {
    pub(crate) fn new(low: f64, high: f64, count: usize) -> Result<Self, ParameterError> {
        finite("lower end of the bins", low)?;
        accept(
            high.is_finite() && high > low,
            "upper end of the bins",
            "finite and above the lower one",
            high,
        )?;
        accept((1..=MOST_BINS).contains(&count), "number of bins", "in 1..=2^20", count as f64)?;
        let width = positive("width of a bin", (high - low) / count as f64)?;
        let bins = Self { low, high, width, count };
        let is_resolved = bins.edge(1) > low && high > bins.edge(count - 1);
        let is_usable = is_resolved && (1.0 / width).is_finite();
        accept(is_usable, "width of a bin", "above the rounding of its edges", width)?;
        Ok(bins)
    }

    /// Checks that there is one entry for each bin.
    #[cfg(feature = "serde")]
    pub(crate) fn check_count(&self, count: usize) -> Result<(), ParameterError> {
        accept(count == self.count, "number of values", "the number of bins", count as f64).map(|_| ())
    }

    pub(crate) const fn count(&self) -> usize {
        self.count
    }

    /// Returns the width of a bin.
    pub(crate) const fn width(&self) -> f64 {
        self.width
    }

    /// Returns the lower edge of a bin.
    pub(crate) fn edge(&self, bin: usize) -> f64 {
        // The product is rounded, but the last edge must be exactly the number that the user gave.
        if bin == self.count { self.high } else { self.low + bin as f64 * self.width }
    }

    pub(crate) fn middle(&self, bin: usize) -> f64 {
        self.edge(bin) + 0.5 * self.width
    }

    /// Returns the bin of a number. Numbers below the first bin give the first bin; numbers above the last
    /// bin give `count` or more.
    pub(crate) fn at_or_above(&self, value: f64) -> usize {
        // The cast saturates: a negative number becomes 0.
        let bin = ((value - self.low) / self.width) as usize;
        // The quotient and the edges round differently, so a number on an edge may be one bin off.
        match bin {
            _ if bin > self.count => bin,
            1.. if value < self.edge(bin) => bin - 1,
            _ if value >= self.edge(bin + 1) => bin + 1,
            _ => bin,
        }
    }

    /// Returns the index of the bin that contains a number, or `None` if the number is outside all bins.
    pub(crate) fn find(&self, value: f64) -> Option<usize> {
        let bin = self.at_or_above(value);
        (value >= self.low && bin < self.count).then_some(bin)
    }
}

crate::gate::from_file! {
    Bins { low: f64, high: f64, count: usize } => Self::new(low, high, count)
}

/// A histogram of numbers that come one by one.
///
/// The numbers may be correlated: the errors come from the scatter between blocks of consecutive numbers, by
/// the method of [`BlockedMean`]. The size of the smallest blocks is the number of bins, and at least 64.
///
/// ```
/// use granular_edmd::statistics::Histogram;
/// let mut histogram = Histogram::new(0.0, 2.0, 4)?;
/// histogram.extend([0.1, 0.2, 1.7, 3.0]);
/// let first = histogram.bins().next().unwrap();
/// assert_eq!((first.low, first.high, first.count, first.density.mean()), (0.0, 0.5, 2, 1.0));
/// assert!(!first.density.is_converged());
/// assert_eq!((histogram.count(), histogram.below(), histogram.above()), (4, 0, 1));
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Histogram {
    bins: Bins,
    counts: Vec<u64>,
    below: u64,
    above: u64,
    /// Count of all numbers, inside and outside the bins.
    count: u64,
    /// The counts at the end of the last block.
    before: Vec<u64>,
    /// Shares of the numbers of a block, for each bin.
    shares: Vec<BlockedMean>,
}

/// A bin of a [`Histogram`].
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct HistogramBin {
    /// Lower edge, which belongs to the bin.
    pub low: f64,
    /// Upper edge, which belongs to the next bin.
    pub high: f64,
    /// Count of the numbers in the bin.
    pub count: u64,
    /// Density: the fraction of all numbers that are in the bin, divided by its width; NaN without numbers.
    ///
    /// Before there are two blocks, its error assumes independent numbers: √(p(1 − p)/n)/w for the share p
    /// and the width w. Such an error is reported as a lower bound.
    pub density: Estimate,
}

impl Histogram {
    /// Creates a histogram of `bins` equal bins from `low` to `high`.
    ///
    /// # Errors
    /// If an end is not finite, `high` is not above `low`, or the number of bins is not in `1..=2^20`.
    pub fn new(low: f64, high: f64, bins: usize) -> Result<Self, ParameterError> {
        let bins = Bins::new(low, high, bins)?;
        let (counts, shares) = (vec![0; bins.count()], vec![BlockedMean::new(); bins.count()]);
        Ok(Self { bins, before: counts.clone(), counts, below: 0, above: 0, count: 0, shares })
    }

    /// Adds a number.
    ///
    /// NaN is left out.
    #[inline]
    pub fn push(&mut self, value: f64) {
        match self.bins.find(value) {
            Some(bin) => self.counts[bin] += 1,
            None if value < self.bins.edge(0) => self.below += 1,
            None if value.is_nan() => return,
            None => self.above += 1,
        }
        self.count += 1;
        if self.count.is_multiple_of(block(&self.bins)) {
            self.end_block();
        }
    }

    fn end_block(&mut self) {
        let size = block(&self.bins) as f64;
        for ((share, count), before) in self.shares.iter_mut().zip(&self.counts).zip(&mut self.before) {
            share.push(count.saturating_sub(*before) as f64 / size);
            *before = *count;
        }
    }

    /// Returns the count of all numbers, inside and outside the bins.
    pub const fn count(&self) -> u64 {
        self.count
    }

    /// Returns the count of the numbers below the first bin.
    pub const fn below(&self) -> u64 {
        self.below
    }

    /// Returns the count of the numbers above the last bin.
    pub const fn above(&self) -> u64 {
        self.above
    }

    /// Iterates over the bins, from the lowest up.
    pub fn bins(&self) -> impl ExactSizeIterator<Item = HistogramBin> {
        let all = self.count as f64;
        self.counts.iter().zip(&self.shares).enumerate().map(move |(bin, (&count, shares))| {
            let share = count as f64 / all;
            let density = if shares.count() < 2 {
                Estimate::blocked(share, (share * (1.0 - share) / all).sqrt(), self.count, 1.0, false)
            } else {
                // The mean also includes the numbers after the last complete block.
                shares.estimate().about(share)
            };
            let [low, high] = [bin, bin + 1].map(|edge| self.bins.edge(edge));
            HistogramBin { low, high, count, density: density.scaled(1.0 / self.bins.width()) }
        })
    }
}

/// Returns the size of the smallest blocks. A number then costs constant time, however many bins there are.
const fn block(bins: &Bins) -> u64 {
    let bins = bins.count() as u64;
    if bins > 64 { bins } else { 64 }
}

impl Extend<f64> for Histogram {
    fn extend<T: IntoIterator<Item = f64>>(&mut self, values: T) {
        values.into_iter().for_each(|value| self.push(value));
    }
}

crate::gate::from_file! {
    Histogram {
        bins: Bins, counts: Vec<u64>, below: u64, above: u64, count: u64, before: Vec<u64>, shares: Vec<BlockedMean>
    } => {
        use crate::quantity::accept;
        for given in [counts.len(), before.len(), shares.len()] {
            bins.check_count(given)?;
        }
        // The sum has 128 bits, so that sums of forged counts do not wrap.
        let all: u128 = counts.iter().chain([&below, &above]).map(|&count| u128::from(count)).sum();
        let fits = all == u128::from(count) && count <= u64::MAX / 2;
        accept(fits, "count of a histogram", "the sum of its bins, and at most 2^63", count as f64)?;
        Ok(Self { bins, counts, below, above, count, before, shares })
    }
}
