//! Equal bins of height.

use crate::ParameterError;
use crate::quantity::{accept, finite, positive};

/// Largest number of bins of a profile.
const MOST_BINS: usize = 1 << 20;

/// Equal bins between two heights.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "RawHeightBins"))]
pub(super) struct HeightBins {
    bottom: f64,
    height: f64,
    count: usize,
}

impl HeightBins {
    pub(super) fn new(bottom: f64, top: f64, count: usize) -> Result<Self, ParameterError> {
        finite("bottom of the profile", bottom)?;
        accept(top.is_finite() && top > bottom, "top of the profile", "finite and above its bottom", top)?;
        Self { bottom, height: (top - bottom) / count as f64, count }.checked()
    }

    fn checked(self) -> Result<Self, ParameterError> {
        let Self { bottom, height, count } = self;
        finite("bottom of the profile", bottom)?;
        accept((1..=MOST_BINS).contains(&count), "number of bins", "in 1..=2^20", count as f64)?;
        positive("height of a bin", height)?;
        finite("top of the profile", self.edge(count))?;
        Ok(self)
    }

    /// Checks that there are as many entries as bins.
    #[cfg(feature = "serde")]
    pub(super) fn check_count(&self, count: usize) -> Result<(), ParameterError> {
        accept(count == self.count, "number of values", "that of the bins", count as f64).map(|_| ())
    }

    pub(super) const fn count(&self) -> usize {
        self.count
    }

    /// Returns the height of a bin.
    pub(super) const fn height(&self) -> f64 {
        self.height
    }

    /// Returns the lower edge of a bin.
    pub(super) fn edge(&self, bin: usize) -> f64 {
        self.bottom + bin as f64 * self.height
    }

    pub(super) fn middle(&self, bin: usize) -> f64 {
        self.edge(bin) + 0.5 * self.height
    }

    /// Returns the bin of a height. All heights below the first bin count for it; heights above the last bin
    /// give `count` or more.
    pub(super) fn at_or_above(&self, height: f64) -> usize {
        // The cast saturates: a negative number becomes 0.
        ((height - self.bottom) / self.height) as usize
    }

    /// Returns the bin of a height, if there is one.
    pub(super) fn find(&self, height: f64) -> Option<usize> {
        let bin = self.at_or_above(height);
        (height >= self.bottom && bin < self.count).then_some(bin)
    }
}

#[cfg(feature = "serde")]
#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields, rename = "HeightBins")]
struct RawHeightBins {
    bottom: f64,
    height: f64,
    count: usize,
}

#[cfg(feature = "serde")]
impl TryFrom<RawHeightBins> for HeightBins {
    type Error = ParameterError;

    fn try_from(RawHeightBins { bottom, height, count }: RawHeightBins) -> Result<Self, ParameterError> {
        Self { bottom, height, count }.checked()
    }
}
