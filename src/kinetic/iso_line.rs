//! Lines of equal energy loss in the plane of friction and inelasticity.

use super::Maxwellian;
use super::bisection::boundary;
use super::largest_loss::largest_loss_of_friction;
use super::stick_slip::StickSlip;
use crate::ParameterError;
use crate::quantity::{accept, non_negative};

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
    let end = |inside, outside| point(boundary(inside, outside, |friction| line(friction).is_some()));
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
