//! The friction of the largest energy loss.

use super::Maxwellian;
use super::bisection::boundary;
use crate::collision::Frictional;

/// Returns the static friction at which the mean energy loss is largest, with the inelasticities of `rule`.
///
/// The ratio $`\rho = \kappa_d/\kappa_s`$ is kept, too (1 if the rule has no friction). At a stationary point
/// the sticking probability $`s`$ depends on $`\rho`$ and $`q_t`$ alone; for $`\rho = 1`$
///
/// ```math
/// s = \sqrt{\frac{2(1-q_t)}{1-2q_t}} - 1,\qquad
/// \kappa = \frac{(1-q_t)\,w}{\lambda(1-q_n)}\,\frac{s}{\sqrt{1-s^2}},
/// ```
///
/// which exists for $`q_t < 1/3`$. The notation is as in [`mean_energy_change`](super::mean_energy_change);
/// the derivation is in `docs/physics-kinetic.md`. At $`q_n = q_t = 0`$, where only
/// sliding loses energy, the loss is largest at $`\kappa = 0.2627`$; the paper gives $`\kappa\approx0.3`$.
///
/// The result is `None` if the loss has no maximum at a finite friction. If sticking itself loses much
/// ($`q_t\ge1/3`$ for $`\rho=1`$), the loss grows with friction all the way to rough disks. There is no
/// maximum for $`\rho = 0`$ either, because sliding friction then loses nothing.
///
/// ```
/// use granular_edmd::collision::Frictional;
/// use granular_edmd::kinetic::{Maxwellian, friction_of_largest_loss};
/// let gas = Maxwellian::new(1.0)?;
/// let friction = friction_of_largest_loss(&Frictional::from_inelasticity(0.1, 0.1, 0.0)?, &gas);
/// assert!((friction.unwrap() - 1.0 / 3.0).abs() < 1e-12);
/// assert!(friction_of_largest_loss(&Frictional::from_inelasticity(0.1, 0.4, 0.0)?, &gas).is_none());
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
pub fn friction_of_largest_loss(rule: &Frictional, gas: &Maxwellian) -> Option<f64> {
    let ratio = friction_ratio(rule);
    let tangential = rule.tangential_inelasticity();
    let sine = Slope::new(ratio, tangential).root()?;
    let slip_ratio = gas.slip_ratio_squared().sqrt();
    let opposite = gas.mass_ratio() * (1.0 - rule.normal_inelasticity());
    Some(friction_at(sine, (1.0 - tangential) * slip_ratio, opposite))
}

/// Returns the friction with the largest loss of disks without inelasticity; 0 if there is none.
pub(super) fn largest_loss_of_friction(mass_ratio: f64, slip_ratio: f64) -> f64 {
    friction_at(Slope::new(1.0, 0.0).root().unwrap_or(0.0), slip_ratio, mass_ratio)
}

/// Returns the friction with this sticking probability, from the ratio of the impulses that stop the slip and
/// the closing.
fn friction_at(sine: f64, slip: f64, closing: f64) -> f64 {
    let cosine = ((1.0 - sine) * (1.0 + sine)).sqrt();
    slip * sine / (closing * cosine)
}

fn friction_ratio(rule: &Frictional) -> f64 {
    if rule.static_friction() == 0.0 { 1.0 } else { rule.dynamic_friction() / rule.static_friction() }
}

/// A function of the sticking probability s that has the sign of the derivative of ⟨dE⟩ with respect to
/// friction.
///
/// The function is $`-\rho + 3Gs^2 + 2H\,(1-(1+s)^{-2})`$ with $`H = \rho^2(1-q_t)`$, $`G = \rho - q_t - H`$.
/// It starts negative: the loss grows with friction. For $`G<0`$ it stays negative. Otherwise it rises, so it
/// has at most one root, which is the only minimum of $`\langle dE\rangle`$.
struct Slope {
    ratio: f64,
    quadratic: f64,
    saturating: f64,
}

impl Slope {
    fn new(ratio: f64, tangential: f64) -> Self {
        let saturating = ratio * ratio * (1.0 - tangential);
        Self { ratio, quadratic: ratio - tangential - saturating, saturating }
    }

    fn at(&self, sine: f64) -> f64 {
        let above = 1.0 + sine;
        // This form of 1 - 1/(1+s)² has a common denominator. At small s the difference would keep few
        // digits.
        let saturated = sine * (1.0 + above) / (above * above);
        -self.ratio + 3.0 * self.quadratic * sine * sine + 2.0 * self.saturating * saturated
    }

    fn root(&self) -> Option<f64> {
        (self.at(1.0) > 0.0).then(|| boundary(0.0, 1.0, |sine| self.at(sine) < 0.0))
    }
}
