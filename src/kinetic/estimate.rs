//! The result of a Monte Carlo average.

/// A mean energy change per collision with its standard error; made by [`MonteCarlo`](super::MonteCarlo).
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Estimate {
    mean: f64,
    standard_error: f64,
    samples: u64,
    sticking_fraction: f64,
}

impl Estimate {
    pub(super) const fn new(mean: f64, standard_error: f64, samples: u64, sticking_fraction: f64) -> Self {
        Self { mean, standard_error, samples, sticking_fraction }
    }

    /// Returns `$\langle dE\rangle$`, negative when energy is lost.
    pub const fn mean(&self) -> f64 {
        self.mean
    }

    /// Returns the standard error of the mean, from the scatter of the samples within each stratum.
    pub const fn standard_error(&self) -> f64 {
        self.standard_error
    }

    /// Returns the number of collisions sampled.
    pub const fn samples(&self) -> u64 {
        self.samples
    }

    /// Returns the fraction of collisions that the rule labels
    /// [`Regime::Sticking`](crate::collision::Regime::Sticking). Its error is about `2/sqrt(samples)`.
    pub const fn sticking_fraction(&self) -> f64 {
        self.sticking_fraction
    }
}
