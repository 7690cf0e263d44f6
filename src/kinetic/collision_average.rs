//! Averages over the collisions of a gas.

use crate::statistics::Estimate;

/// The averages over the collisions of a gas under a rule; returned by
/// [`MonteCarlo::average`](super::MonteCarlo::average).
///
/// ```
/// use granular_edmd::collision::Frictional;
/// use granular_edmd::kinetic::{Maxwellian, MonteCarlo, sticking_fraction};
/// let rule = Frictional::from_inelasticity(0.1, 0.1, 0.3)?;
/// let average = MonteCarlo::new(7).average(&rule, &Maxwellian::new(1.0)?);
/// assert!(average.energy_change().assumes_independence());
/// assert!((average.sticking_fraction() - sticking_fraction(&rule, &Maxwellian::new(1.0)?)).abs() < 2e-3);
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CollisionAverage {
    energy_change: Estimate,
    sticking_fraction: f64,
}

impl CollisionAverage {
    pub(super) const fn new(energy_change: Estimate, sticking_fraction: f64) -> Self {
        Self { energy_change, sticking_fraction }
    }

    /// Returns the mean energy change ⟨dE⟩, negative when energy is lost.
    ///
    /// Its error is the standard error of independent collisions, from the scatter within each stratum.
    pub const fn energy_change(&self) -> Estimate {
        self.energy_change
    }

    /// Returns the fraction of collisions that the rule labels
    /// [`Regime::Sticking`](crate::collision::Regime::Sticking).
    ///
    /// Its error is about `2/sqrt(samples)`.
    pub const fn sticking_fraction(&self) -> f64 {
        self.sticking_fraction
    }
}
