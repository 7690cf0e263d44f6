//! Histograms.

use super::Bins;
use crate::ParameterError;

/// A histogram of numbers that come one by one.
///
/// ```
/// use granular_edmd::statistics::Histogram;
/// let mut histogram = Histogram::new(0.0, 2.0, 4)?;
/// histogram.extend([0.1, 0.2, 1.7, 3.0]);
/// let first = histogram.bins().next().unwrap();
/// assert_eq!((first.low, first.high, first.count, first.density), (0.0, 0.5, 2, 1.0));
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
    /// Density: the fraction of all numbers that are in the bin, over its width; NaN without numbers.
    pub density: f64,
    /// Standard error of the density for n independent numbers: √(p(1 − p)/n)/w for the share p and the width
    /// w; NaN without numbers. It is too small for correlated numbers.
    pub standard_error: f64,
}

impl Histogram {
    /// Creates a histogram of `bins` equal bins from `low` to `high`.
    ///
    /// # Errors
    /// If an end is not finite, `high` is not above `low`, or the number of bins is not in `1..=2^20`.
    pub fn new(low: f64, high: f64, bins: usize) -> Result<Self, ParameterError> {
        let bins = Bins::new(low, high, bins)?;
        Ok(Self { bins, counts: vec![0; bins.count()], below: 0, above: 0 })
    }

    /// Takes one more number.
    ///
    /// NaN is left out.
    #[inline]
    pub fn push(&mut self, value: f64) {
        match self.bins.find(value) {
            Some(bin) => self.counts[bin] += 1,
            None if value < self.bins.edge(0) => self.below += 1,
            None => self.above += u64::from(!value.is_nan()),
        }
    }

    /// Returns the count of all numbers, inside and outside the bins.
    pub fn count(&self) -> u64 {
        self.counts.iter().sum::<u64>() + self.below + self.above
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
        let (all, width) = (self.count() as f64, self.bins.width());
        self.counts.iter().enumerate().map(move |(bin, &count)| {
            let share = count as f64 / all;
            HistogramBin {
                low: self.bins.edge(bin),
                high: self.bins.edge(bin + 1),
                count,
                density: share / width,
                standard_error: (share * (1.0 - share) / all).sqrt() / width,
            }
        })
    }

    /// Forgets all numbers so far.
    pub fn clear(&mut self) {
        self.counts.fill(0);
        (self.below, self.above) = (0, 0);
    }
}

impl Extend<f64> for Histogram {
    fn extend<T: IntoIterator<Item = f64>>(&mut self, values: T) {
        values.into_iter().for_each(|value| self.push(value));
    }
}

crate::gate::from_file! {
    Histogram { bins: Bins, counts: Vec<u64>, below: u64, above: u64 } => {
        bins.check_count(counts.len())?;
        // The sum has 128 bits, so that sums of forged counts do not wrap.
        let all: u128 = counts.iter().chain([&below, &above]).map(|&count| u128::from(count)).sum();
        let fits = all <= u128::from(u64::MAX / 2);
        crate::quantity::accept(fits, "count of a histogram", "at most 2^63 in all", all as f64)?;
        Ok(Self { bins, counts, below, above })
    }
}
