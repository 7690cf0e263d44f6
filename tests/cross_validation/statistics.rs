//! Two sets of independent runs, compared.

use std::fmt;

use granular_edmd::statistics::RunningMean;

use crate::means::Means;

/// A quantity in both programs.
///
/// The error comes from the scatter between independent runs, so that no correlation time has to be known,
/// however slow the flow is.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Comparison {
    ours: RunningMean,
    theirs: RunningMean,
}

impl Comparison {
    /// Compares a quantity in as many runs of one program as of the other.
    pub(crate) fn of(ours: &[Means], theirs: &[Means], quantity: fn(&Means) -> f64) -> Self {
        assert_eq!(ours.len(), theirs.len());
        Self { ours: ours.iter().map(quantity).collect(), theirs: theirs.iter().map(quantity).collect() }
    }

    /// Standard error of the difference.
    fn error(&self) -> f64 {
        self.ours.standard_error().hypot(self.theirs.standard_error())
    }

    /// Returns the difference in standard errors, which is Student's t. It is `None` for what never changes,
    /// such as spins without friction.
    pub(crate) fn deviation(&self) -> Option<f64> {
        (self.error() > 0.0).then(|| (self.ours.mean() - self.theirs.mean()) / self.error())
    }
}

/// Shows our mean, the standard error of the difference, and the difference in standard errors.
impl fmt::Display for Comparison {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let digits = (1.0 - self.error().log10().floor()).clamp(0.0, 6.0) as usize;
        let (mean, error) = (self.ours.mean(), self.error());
        match self.deviation() {
            None => write!(formatter, "–"),
            Some(deviation) => write!(formatter, "{mean:.digits$} ± {error:.digits$}: {deviation:+.1}"),
        }
    }
}

/// Returns the mean and standard deviation of the sum of `points` squares of Student's t with `freedom`
/// degrees of freedom. The square t² has the F distribution with 1 and `freedom`.
pub(crate) fn expected_sum(points: usize, freedom: u64) -> (f64, f64) {
    let (count, freedom) = (points as f64, freedom as f64);
    let mean = freedom / (freedom - 2.0);
    let variance = 2.0 * mean * mean * (freedom - 1.0) / (freedom - 4.0);
    (count * mean, (count * variance).sqrt())
}

#[test]
fn the_sum_of_squares_tends_to_chi_square() {
    let (mean, scatter) = expected_sum(22, 1_000_000);
    assert!((mean - 22.0).abs() < 1e-3 && (scatter - 44.0_f64.sqrt()).abs() < 1e-3);
}
