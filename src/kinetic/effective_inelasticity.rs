//! The effective inelasticity: one coefficient for the whole energy loss of a collision.

use crate::ParameterError;
use crate::collision::Smooth;
use crate::quantity::{accept, positive};

/// Returns the effective normal inelasticity: the inelasticity of smooth disks that lose the same energy per
/// collision.
///
/// The effective inelasticity is the paper's Eq. (9),
///
/// ```math
/// q_\text{eff} = \tfrac12\left(1 - \sqrt{1 + \langle dE\rangle/T}\right),
/// ```
///
/// in `[0, 1/2]`, for a mean energy change in $`[-T, 0]`$, with $`T`$ the translational temperature. No gas
/// of smooth disks is outside that range: with restitution zero they lose exactly $`T`$, and they never gain
/// energy. Disks with friction can lose more, and a Monte Carlo mean can exceed zero within its error. The
/// function refuses such values instead of clipping them.
///
/// # Errors
/// If the temperature is not positive, or the mean energy change is not in $`[-T, 0]`$.
///
/// ```
/// use granular_edmd::kinetic::effective_inelasticity;
/// assert!((effective_inelasticity(-0.290, 1.0)? - 0.079).abs() < 5e-4); // paper, Table I
/// let error = effective_inelasticity(-1.02, 1.0).unwrap_err();
/// assert_eq!(error.to_string(), "mean energy change per temperature must be in [-1, 0], but is -1.02");
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
pub fn effective_inelasticity(mean_energy_change: f64, temperature: f64) -> Result<f64, ParameterError> {
    let change = mean_energy_change / positive("temperature", temperature)?;
    accept((-1.0..=0.0).contains(&change), "mean energy change per temperature", "in [-1, 0]", change)?;
    // This is (1 - root)/2, with numerator and denominator multiplied by (1 + root). At small losses the root
    // is close to 1, and the difference would keep few digits.
    Ok(0.5 * change.abs() / (1.0 + (1.0 + change).sqrt()))
}

/// Returns the mean energy change per collision without friction, the inverse of [`effective_inelasticity`].
///
/// The energy change is $`\langle dE\rangle = -4q_n(1-q_n)T`$ (paper, Eq. (8)).
///
/// # Errors
/// If the inelasticity is not in `[0, 1/2]`, or the temperature is not positive.
///
/// ```
/// use granular_edmd::kinetic::{effective_inelasticity, frictionless_energy_change};
/// let change = frictionless_energy_change(0.1, 2.0)?;
/// assert!((change + 0.72).abs() < 1e-15);
/// assert!((effective_inelasticity(change, 2.0)? - 0.1).abs() < 1e-15);
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
pub fn frictionless_energy_change(inelasticity: f64, temperature: f64) -> Result<f64, ParameterError> {
    let inelasticity = Smooth::from_inelasticity(inelasticity)?.normal_inelasticity();
    Ok(-4.0 * inelasticity * (1.0 - inelasticity) * positive("temperature", temperature)?)
}
