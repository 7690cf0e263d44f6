//! Lines of equal energy loss in the plane of friction and inelasticity, and the friction of the largest
//! loss.

use super::Maxwellian;
use super::maxwellian::StickSlip;
use crate::ParameterError;
use crate::collision::Frictional;
use crate::quantity::{accept, non_negative};

/// Returns the last number at which `holds` is true, on the way from `inside`, where it is true, to
/// `outside`, where it is false.
///
/// If the condition changes more than once in between, the search finds one of the changes. It halves the
/// interval until no floating-point number is left inside. About two thousand halvings always suffice.
pub(super) fn bisected(inside: f64, outside: f64, holds: impl Fn(f64) -> bool) -> f64 {
    let (mut inside, mut outside) = (inside, outside);
    loop {
        let middle = 0.5 * (inside + outside);
        if middle == inside || middle == outside {
            return inside;
        }
        if holds(middle) { inside = middle } else { outside = middle }
    }
}

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
fn largest_loss_of_friction(mass_ratio: f64, slip_ratio: f64) -> f64 {
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
        (self.at(1.0) > 0.0).then(|| bisected(0.0, 1.0, |sine| self.at(sine) < 0.0))
    }
}

/// Consecutive points (κ, q) of a line.
pub type Piece = Vec<(f64, f64)>;

/// A line ⟨dE⟩ = const in the plane of κ = κ_s = κ_d and q = q_n = q_t (paper, Fig. 1), for the paper's rule.
///
/// With equal inelasticities the sticking probability does not depend on $`q`$, and $`\langle dE\rangle`$ is
/// a polynomial of second degree in $`q`$. Each friction therefore has at most two values of $`q`$, and none
/// is missed.
///
/// ```
/// use granular_edmd::kinetic::{IsoLine, Maxwellian};
///
/// // The transition from two rolls to collapse at the larger gravity (paper, Table I). Without inelasticity
/// // it lies at two frictions, the paper's re-entrance.
/// let line = IsoLine::new(-0.290, &Maxwellian::new(1.0)?)?;
/// assert!(line.inelasticities(0.3)?.is_empty());
/// assert!((line.inelasticities(0.0)?[0] - 0.0787).abs() < 1e-4);
///
/// let frictions: Vec<f64> = (0..=100).map(|step| f64::from(step) * 0.01).collect();
/// let pieces = line.trace(&frictions, 0.2)?;
/// assert_eq!(pieces.len(), 2);
/// assert!((pieces[0].last().unwrap().0 - 0.138).abs() < 1e-3);
/// assert!((pieces[1].first().unwrap().0 - 0.458).abs() < 1e-3);
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct IsoLine {
    /// Relative energy change ⟨dE⟩/T on the line.
    change: f64,
    mass_ratio: f64,
    slip_ratio: f64,
}

impl IsoLine {
    /// Creates the line of this mean energy change per collision.
    ///
    /// # Errors
    /// If the mean energy change is infinite, NaN or positive, since no collision gains energy.
    pub fn new(mean_energy_change: f64, gas: &Maxwellian) -> Result<Self, ParameterError> {
        let valid = mean_energy_change.is_finite() && mean_energy_change <= 0.0;
        accept(valid, "mean energy change", "finite and not positive", mean_energy_change)?;
        Ok(Self {
            change: mean_energy_change / gas.translational_temperature(),
            mass_ratio: gas.mass_ratio(),
            slip_ratio: gas.slip_ratio_squared().sqrt(),
        })
    }

    /// Returns the inelasticities in `[0, 1/2]` with this energy change at this friction: none, one or two,
    /// in ascending order.
    ///
    /// # Errors
    /// If the friction is negative or not finite.
    pub fn inelasticities(&self, friction: f64) -> Result<Vec<f64>, ParameterError> {
        non_negative("friction", friction)?;
        let [lower, upper] = self.roots(friction).map(|root| root.and_then(|root| within(root, 0.5)));
        Ok(lower.into_iter().chain(upper.filter(|_| upper != lower)).collect())
    }

    /// Traces the line at these ascending frictions, where the inelasticity is at most
    /// `largest_inelasticity`.
    ///
    /// The result contains the connected pieces of the line. If a piece ends between two of the frictions,
    /// its exact end is its last point. At such an end, the line leaves the plane, or its lower and its upper
    /// inelasticity meet. In the second case, the point belongs to both pieces. If friction alone costs more
    /// than the energy of the line, the line has a gap around the friction of the largest loss, which the
    /// trace finds. It misses a piece, or another gap, that lies entirely between two of the frictions.
    ///
    /// # Errors
    /// If a friction is negative or not finite, the frictions do not ascend, or `largest_inelasticity` is not
    /// in `[0, 1/2]`.
    pub fn trace(&self, frictions: &[f64], largest_inelasticity: f64) -> Result<Vec<Piece>, ParameterError> {
        let valid = (0.0..=0.5).contains(&largest_inelasticity);
        accept(valid, "largest inelasticity", "in [0, 0.5]", largest_inelasticity)?;
        frictions.iter().try_for_each(|&friction| non_negative("friction", friction).map(|_| ()))?;
        let descent = frictions.windows(2).find(|pair| pair[1] <= pair[0]);
        accept(descent.is_none(), "friction", "above the one before", descent.map_or(0.0, |pair| pair[1]))?;
        let on = |branch: usize| {
            move |friction| self.roots(friction)[branch].and_then(|root| within(root, largest_inelasticity))
        };
        let mut frictions = frictions.to_vec();
        let costly = largest_loss_of_friction(self.mass_ratio, self.slip_ratio);
        let next = frictions.partition_point(|&friction| friction < costly);
        if on(0)(costly).is_none() && (1..frictions.len()).contains(&next) {
            // A point without the line, so it is in no piece.
            frictions.insert(next, costly);
        }
        Ok([pieces(&frictions, on(0)), pieces(&frictions, on(1))].concat())
    }

    /// Returns both real values of q at a friction, in ascending order, including values outside the plane.
    ///
    /// The values solve $`a q^2 - b q + c = 0`$ with
    /// $`c = (\langle dE\rangle|_{q=0} - \langle dE\rangle)/T`$.
    fn roots(&self, friction: f64) -> [Option<f64>; 2] {
        let sector = StickSlip::new(friction, self.mass_ratio, self.slip_ratio);
        let squared = self.slip_ratio * self.slip_ratio / self.mass_ratio;
        let rough = 4.0 + 2.0 * squared * sector.sticking_slip();
        let sliding = friction * sector.cosine;
        let linear = 2.0 * sliding * self.slip_ratio * sector.cosine * sector.cosine;
        let quadratic = 2.0 * sliding * sliding * self.mass_ratio * sector.sliding_closing();
        roots(rough + quadratic, rough + 2.0 * quadratic - linear, quadratic - linear - self.change)
    }
}

/// Returns the real roots of a x² − b x + c with a > 0, in ascending order.
fn roots(a: f64, b: f64, c: f64) -> [Option<f64>; 2] {
    let discriminant = b * b - 4.0 * a * c;
    if discriminant < 0.0 {
        return [None; 2];
    }
    // The root of larger magnitude adds two numbers of the same sign. The other root would be their
    // difference, with few digits left, so it comes from the product of both roots, c/a, to full precision.
    let larger = 0.5 * (b + discriminant.sqrt().copysign(b));
    if larger == 0.0 {
        return [Some(0.0); 2];
    }
    let pair = [c / larger, larger / a];
    [Some(pair[0].min(pair[1])), Some(pair[0].max(pair[1]))]
}

/// Returns the inelasticity if it lies in `[0, largest]`, up to rounding.
fn within(inelasticity: f64, largest: f64) -> Option<f64> {
    let valid = (-f64::EPSILON..=largest + f64::EPSILON).contains(&inelasticity);
    valid.then(|| inelasticity.clamp(0.0, largest))
}

/// Cuts the graph of `line` into connected pieces with exact ends.
fn pieces(frictions: &[f64], line: impl Fn(f64) -> Option<f64>) -> Vec<Piece> {
    let point = |friction| line(friction).map(|inelasticity| (friction, inelasticity));
    let end = |inside, outside| point(bisected(inside, outside, |friction| line(friction).is_some()));
    let (mut pieces, mut piece, mut before) = (Vec::new(), Piece::new(), None);
    for &friction in frictions {
        if let Some(inside) = point(friction) {
            piece.extend(before.filter(|_| piece.is_empty()).and_then(|outside| end(friction, outside)));
            piece.push(inside);
        } else if let Some(&(last, _)) = piece.last() {
            piece.extend(end(last, friction));
            pieces.push(std::mem::take(&mut piece));
        }
        before = Some(friction);
    }
    pieces.extend(Some(piece).filter(|piece| !piece.is_empty()));
    pieces
}
