//! The mean energy change of the paper's rule, as a formula.

use super::Maxwellian;
use super::stick_slip::StickSlip;
use crate::collision::Frictional;

/// Returns the exact mean energy change per collision of the paper's rule in a Maxwellian gas.
///
/// ```math
/// \frac{\langle dE\rangle}{T} = -4q_n p - \frac2\lambda\,q_t(1-q_t)\,w^2 s^3 - 2\kappa_d p\,w\,k^3
/// + 2\kappa_d^2p^2\lambda\,(1-s)^2(2+s)
/// ```
///
/// with $`p = 1-q_n`$, $`\lambda = \mu/\mu_t`$, $`w^2 = 1+(\lambda-1)T_r/T`$, and the sticking probability
/// $`s = \sin\alpha`$, $`k = \cos\alpha`$, $`\tan\alpha = \lambda p\kappa_s/\big((1-q_t)w\big)`$. The result
/// is an energy, in the units of the temperature. The paper computes this average by Monte Carlo only (Fig.
/// 1). At zero friction the average is the paper's Eq. (8). The derivation is in `docs/physics-kinetic.md`.
///
/// Masses enter through $`\lambda`$ alone, which is 3 for homogeneous disks of any masses. Therefore, Fig. 1
/// of the paper holds for any mixture at equal temperatures.
///
/// ```
/// use granular_edmd::collision::Frictional;
/// use granular_edmd::kinetic::{Maxwellian, mean_energy_change};
/// let gas = Maxwellian::new(1.0)?;
/// let rule = Frictional::from_inelasticity(0.0, 0.0, 0.3)?;
/// assert!((mean_energy_change(&rule, &gas) + 0.34014).abs() < 1e-5);
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
#[inline]
pub fn mean_energy_change(rule: &Frictional, gas: &Maxwellian) -> f64 {
    let (mass_ratio, slip_ratio_squared) = (gas.mass_ratio(), gas.slip_ratio_squared());
    let (normal, tangential) = (rule.normal_inelasticity(), rule.tangential_inelasticity());
    let sector = sector(rule, gas);
    // Friction can grow without bound, and the cosine of the sector then falls as the inverse of the
    // friction. Only their product stays finite.
    let friction = rule.dynamic_friction() * sector.cosine * (1.0 - normal);
    let sticking = tangential * (1.0 - tangential) * slip_ratio_squared / mass_ratio * sector.sticking_slip();
    let sliding = friction
        * (slip_ratio_squared.sqrt() * sector.cosine * sector.cosine
            - friction * mass_ratio * sector.sliding_closing());
    -gas.translational_temperature() * (4.0 * normal * (1.0 - normal) + 2.0 * (sticking + sliding))
}

/// Returns the fraction of collisions that stick, under the paper's rule in a Maxwellian gas.
///
/// The fraction is $`s = \sin\alpha`$ with $`\tan\alpha = \lambda(1-q_n)\kappa_s/\big((1-q_t)w\big)`$ (see
/// [`mean_energy_change`]).
///
/// ```
/// use granular_edmd::collision::Frictional;
/// use granular_edmd::kinetic::{Maxwellian, sticking_fraction};
/// let rule = Frictional::from_inelasticity(0.05, 0.05, 0.3)?;
/// let fraction = sticking_fraction(&rule, &Maxwellian::new(1.0)?);
/// assert!((fraction - 0.4611).abs() < 1e-4);
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
pub fn sticking_fraction(rule: &Frictional, gas: &Maxwellian) -> f64 {
    sector(rule, gas).sine
}

#[inline]
fn sector(rule: &Frictional, gas: &Maxwellian) -> StickSlip {
    let opposite = gas.mass_ratio() * (1.0 - rule.normal_inelasticity());
    let adjacent = (1.0 - rule.tangential_inelasticity()) * gas.slip_ratio_squared().sqrt();
    StickSlip::new(rule.static_friction(), opposite, adjacent)
}
