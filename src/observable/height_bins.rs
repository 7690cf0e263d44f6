//! Equal bins of height.

use crate::ParameterError;
use crate::quantity::{accept, finite};

/// Most bins of a profile.
const MOST_BINS: usize = 1 << 20;

/// Where the bins of a profile are.
#[derive(Debug, Clone, Copy)]
pub(super) struct HeightBins {
    bottom: f64,
    height: f64,
    count: usize,
}

impl HeightBins {
    pub(super) fn new(bottom: f64, top: f64, count: usize) -> Result<Self, ParameterError> {
        finite("bottom of the profile", bottom)?;
        accept(top.is_finite() && top > bottom, "top of the profile", "finite and above its bottom", top)?;
        accept((1..=MOST_BINS).contains(&count), "number of bins", "in 1..=2^20", count as f64)?;
        let height = (top - bottom) / count as f64;
        accept(height.is_finite() && height > 0.0, "height of a bin", "finite and positive", height)?;
        Ok(Self { bottom, height, count })
    }

    pub(super) const fn count(&self) -> usize {
        self.count
    }

    /// Height of a bin.
    pub(super) const fn height(&self) -> f64 {
        self.height
    }

    /// Lower edge of a bin.
    pub(super) fn edge(&self, bin: usize) -> f64 {
        self.bottom + bin as f64 * self.height
    }

    pub(super) fn middle(&self, bin: usize) -> f64 {
        self.edge(bin) + 0.5 * self.height
    }

    /// The bin of a height: the first for what is below, `count` or more for what is above.
    pub(super) fn at_or_above(&self, height: f64) -> usize {
        // Casts saturate.
        ((height - self.bottom) / self.height) as usize
    }

    /// The bin of a height, if it is in one.
    pub(super) fn find(&self, height: f64) -> Option<usize> {
        let bin = self.at_or_above(height);
        (height >= self.bottom && bin < self.count).then_some(bin)
    }
}
