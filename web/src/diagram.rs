//! The paper's lines in the plane of friction and inelasticity.

use granular_edmd::ParameterError;
use granular_edmd::kinetic::{IsoLine, Maxwellian};

/// Frictions at the edges of the diagram.
const FRICTIONS: (f64, f64) = (0.004, 4.0);

/// Mean energy changes on the transition lines 0–1, 1–2 (a), 1–2 (b), 2–collapse (paper, Table I).
const LARGER_GRAVITY: [f64; 4] = [-0.047, -0.137, -0.147, -0.290];
const SMALLER_GRAVITY: [f64; 4] = [-0.090, -0.351, -0.377, -0.614];

/// Returns the lines as triples of line, friction and inelasticity. A piece ends with a triple of NaN.
pub(crate) fn lines(larger_gravity: bool, largest_inelasticity: f64) -> Result<Vec<f32>, ParameterError> {
    let (low, high) = FRICTIONS;
    let step = (high / low).ln() / 200.0;
    let frictions: Vec<f64> = (0..=200).map(|number| low * (f64::from(number) * step).exp()).collect();
    let changes = if larger_gravity { LARGER_GRAVITY } else { SMALLER_GRAVITY };
    let mut points = Vec::new();
    for (line, change) in changes.into_iter().enumerate() {
        let pieces = IsoLine::new(change, &Maxwellian::new(1.0)?)?.trace(&frictions, largest_inelasticity)?;
        for piece in pieces {
            points.extend(piece.iter().flat_map(|&(friction, q)| [line as f32, friction as f32, q as f32]));
            points.extend([f32::NAN; 3]);
        }
    }
    Ok(points)
}
