//! The one place where means and squared deviations are accumulated.

/// The weighted mean of numbers, and the weighted sum of their squared deviations from it (Welford 1962, West
/// 1979).
///
/// The deviations are taken from the mean so far. The difference of a sum of squares and a squared sum would
/// lose the digits of a small variance about a large mean.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub(crate) struct Moments {
    pub(crate) weight: f64,
    pub(crate) mean: f64,
    pub(crate) squares: f64,
}

impl Moments {
    /// Adds a number with a positive weight.
    #[inline]
    pub(crate) fn push(&mut self, value: f64, weight: f64) {
        self.weight += weight;
        let before = value - self.mean;
        self.mean += before * weight / self.weight;
        let squares = weight * before * (value - self.mean);
        // Both factors have the same sign, except for rounding among numbers that are nearly equal.
        self.squares += if squares < 0.0 { 0.0 } else { squares };
    }
}

#[cfg(feature = "serde")]
impl Moments {
    /// Returns these moments, or an error if no set of numbers can have them.
    pub(super) fn checked(self) -> Result<Self, crate::ParameterError> {
        use crate::quantity::{accept, finite, non_negative};
        let Self { weight, mean, squares } = self;
        non_negative("weight of a mean", weight)?;
        finite("mean", mean)?;
        non_negative("sum of squared deviations", squares)?;
        accept(weight > 0.0 || mean == 0.0, "mean of no numbers", "0", mean)?;
        accept(weight > 0.0 || squares == 0.0, "sum of squared deviations of no numbers", "0", squares)?;
        Ok(self)
    }
}

crate::gate::from_file! {
    Moments { weight: f64, mean: f64, squares: f64 } => Self { weight, mean, squares }.checked()
}
