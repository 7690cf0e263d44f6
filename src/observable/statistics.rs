//! Means and their errors, without keeping the values.

/// Mean, variance and standard error of numbers that come one by one (Welford 1962).
///
/// The standard error is that of independent numbers; for correlated ones it is too small.
///
/// ```
/// use granular_edmd::observable::RunningMean;
/// let mean: RunningMean = [1.0, 2.0, 3.0].into_iter().collect();
/// assert_eq!(mean.mean(), 2.0);
/// assert_eq!(mean.variance(), 1.0);
/// assert!((mean.standard_error() - (1.0_f64 / 3.0).sqrt()).abs() < 1e-15);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct RunningMean {
    count: u64,
    mean: f64,
    squares: f64,
}

impl RunningMean {
    /// Takes one more number.
    #[inline]
    pub fn push(&mut self, value: f64) {
        self.count += 1;
        let before = value - self.mean;
        self.mean += before / self.count as f64;
        self.squares += before * (value - self.mean);
    }

    /// How many numbers there were.
    pub const fn count(&self) -> u64 {
        self.count
    }

    /// Their mean; 0 if there were none.
    pub const fn mean(&self) -> f64 {
        self.mean
    }

    /// Their sum.
    pub fn sum(&self) -> f64 {
        self.mean * self.count as f64
    }

    /// Their unbiased variance; 0 of fewer than two.
    pub fn variance(&self) -> f64 {
        if self.count < 2 { 0.0 } else { self.squares / (self.count - 1) as f64 }
    }

    /// Their standard deviation, `$\sqrt{\mathrm{variance}}$`.
    pub fn standard_deviation(&self) -> f64 {
        self.variance().sqrt()
    }

    /// Standard error of the mean of independent numbers, `$\sqrt{\mathrm{variance}/n}$`; 0 of fewer than two.
    pub fn standard_error(&self) -> f64 {
        if self.count < 2 { 0.0 } else { (self.variance() / self.count as f64).sqrt() }
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
