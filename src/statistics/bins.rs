//! Bins of equal width.

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
