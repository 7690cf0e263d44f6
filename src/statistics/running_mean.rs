//! Means and central moments that are updated number by number.

use super::Estimate;

/// The weighted mean of numbers, and the weighted sum of their squared deviations from it (Welford 1962, West
/// 1979).
///
/// The deviations are taken from the mean so far. The difference of a sum of squares and a squared sum would
/// lose the digits of a small variance about a large mean.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
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

/// The mean, variance and standard error of numbers that come one by one (Welford 1962).
///
/// The standard error assumes independent numbers. It is too small for correlated numbers, such as the
/// samples or collisions of one run; see [`BlockedMean`](super::BlockedMean).
///
/// ```
/// use granular_edmd::statistics::RunningMean;
/// let mean: RunningMean = [1.0, 2.0, 3.0].into_iter().collect();
/// assert_eq!(mean.mean(), 2.0);
/// assert_eq!(mean.variance(), 1.0);
/// assert!((mean.standard_error() - (1.0_f64 / 3.0).sqrt()).abs() < 1e-15);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(from = "RawRunningMean", into = "RawRunningMean"))]
pub struct RunningMean(Moments);

impl RunningMean {
    /// Adds a number.
    #[inline]
    pub fn push(&mut self, value: f64) {
        self.0.push(value, 1.0);
    }

    /// Returns the count of the numbers.
    pub const fn count(&self) -> u64 {
        self.0.weight as u64
    }

    /// Returns the mean of the numbers, or NaN without numbers.
    pub const fn mean(&self) -> f64 {
        if self.0.weight > 0.0 { self.0.mean } else { f64::NAN }
    }

    /// Returns the sum of the numbers.
    pub fn sum(&self) -> f64 {
        self.0.mean * self.0.weight
    }

    /// Returns the unbiased variance of the numbers; NaN for fewer than two.
    pub fn variance(&self) -> f64 {
        if self.0.weight < 2.0 { f64::NAN } else { self.0.squares / (self.0.weight - 1.0) }
    }

    /// Returns the standard deviation of the numbers, the square root of the variance.
    pub fn standard_deviation(&self) -> f64 {
        self.variance().sqrt()
    }

    /// Returns the standard error of the mean of n independent numbers, √(variance/n); NaN for fewer than
    /// two.
    pub fn standard_error(&self) -> f64 {
        (self.variance() / self.0.weight).sqrt()
    }

    /// Returns the mean with the error of independent numbers.
    pub fn estimate(&self) -> Estimate {
        Estimate::independent(self.mean(), self.standard_error(), self.count())
    }
}

impl Extend<f64> for RunningMean {
    fn extend<T: IntoIterator<Item = f64>>(&mut self, values: T) {
        values.into_iter().for_each(|value| self.push(value));
    }
}

impl FromIterator<f64> for RunningMean {
    fn from_iter<T: IntoIterator<Item = f64>>(values: T) -> Self {
        let mut mean = Self::default();
        mean.extend(values);
        mean
    }
}

/// The form of the mean in files.
#[cfg(feature = "serde")]
#[derive(serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields, rename = "RunningMean")]
struct RawRunningMean {
    count: u64,
    mean: f64,
    squares: f64,
}

#[cfg(feature = "serde")]
impl From<RunningMean> for RawRunningMean {
    fn from(running: RunningMean) -> Self {
        Self { count: running.count(), mean: running.0.mean, squares: running.0.squares }
    }
}

#[cfg(feature = "serde")]
impl From<RawRunningMean> for RunningMean {
    fn from(RawRunningMean { count, mean, squares }: RawRunningMean) -> Self {
        Self(Moments { weight: count as f64, mean, squares })
    }
}
