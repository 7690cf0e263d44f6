//! The changes of state in the plane of friction and inelasticity.

use super::state::ConvectiveRegime;
use super::transitions::{Transition, TransitionLine, transitions};
use crate::ParameterError;
use crate::quantity::positive;

/// A point of a transition line in the plane of friction and inelasticity; made by [`plane_transitions`].
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct PlaneTransition {
    /// The line that is crossed.
    pub line: TransitionLine,
    /// Friction κ in the middle between the neighbors, on a logarithmic axis.
    pub friction: f64,
    /// Inelasticity q in the middle between the neighbors.
    pub inelasticity: f64,
    /// The two neighbors, as (κ, q), between which the transition lies. They share one coordinate.
    pub between: [(f64, f64); 2],
    /// True if the regime goes up from the first neighbor to the second.
    pub rising: bool,
}

/// Finds the transitions in the plane of friction and inelasticity (paper, Fig. 5).
///
/// The observations are $`(\kappa, q)`$ and the regime of all runs on a grid, in any order. Runs of the same
/// inelasticity are compared along the friction, as on the paper's ramps. Runs of the same friction are
/// compared along the inelasticity, since only these comparisons cross a line that runs flat through the
/// plane. The middle of two frictions is the middle of their logarithms. Hysteresis is treated as in
/// [`transitions`].
///
/// The points along the friction come first, in the order of inelasticity. The points along the inelasticity
/// follow, in the order of friction.
///
/// # Errors
/// If a friction is not positive, or one of the numbers is not finite.
///
/// ```
/// use granular_edmd::analysis::ConvectiveRegime::{Conductive, OneRoll};
/// use granular_edmd::analysis::plane_transitions;
/// let smooth = [(0.01, 0.00, Conductive), (0.04, 0.00, OneRoll)];
/// let inelastic = [(0.01, 0.02, OneRoll), (0.04, 0.02, OneRoll)];
/// let found = plane_transitions(smooth.into_iter().chain(inelastic))?;
/// assert_eq!(found.len(), 2);
/// assert!((found[0].friction - 0.02).abs() < 1e-12 && found[0].inelasticity == 0.0);
/// assert!(found[1].friction == 0.01 && (found[1].inelasticity - 0.01).abs() < 1e-12);
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
pub fn plane_transitions(
    observations: impl IntoIterator<Item = (f64, f64, ConvectiveRegime)>,
) -> Result<Vec<PlaneTransition>, ParameterError> {
    let all: Vec<Observation> = observations
        .into_iter()
        .map(|(friction, q, regime)| Ok((positive("friction", friction)?, q, regime)))
        .collect::<Result<_, ParameterError>>()?;
    let along_friction = scans(&all, |&(friction, q, regime)| (q, libm::log(friction), regime));
    let along_inelasticity = scans(&all, |&observation| observation);
    let mut found = Vec::new();
    for (q, scan) in along_friction {
        found.extend(transitions(scan)?.iter().map(|at| point(at, |logarithm| (libm::exp(logarithm), q))));
    }
    for (friction, scan) in along_inelasticity {
        found.extend(transitions(scan)?.iter().map(|at| point(at, |q| (friction, q))));
    }
    Ok(found)
}

/// Two coordinates, and the regime seen there.
type Observation = (f64, f64, ConvectiveRegime);

/// Groups the observations by one coordinate, the first of the two that `turned` returns, in ascending order.
fn scans(
    all: &[Observation],
    turned: impl Fn(&Observation) -> Observation,
) -> Vec<(f64, Vec<(f64, ConvectiveRegime)>)> {
    let mut turned: Vec<Observation> = all.iter().map(turned).collect();
    turned.sort_by(|a, b| a.0.total_cmp(&b.0));
    let equal = turned.chunk_by(|a, b| a.0 == b.0);
    equal.map(|scan| (scan[0].0, scan.iter().map(|&(_, value, regime)| (value, regime)).collect())).collect()
}

fn point(at: &Transition, place: impl Fn(f64) -> (f64, f64)) -> PlaneTransition {
    let (friction, inelasticity) = place(at.value);
    let between = [place(at.value - at.error), place(at.value + at.error)];
    PlaneTransition { line: at.line, friction, inelasticity, between, rising: at.rising }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::collision::Frictional;
    use crate::kinetic::{Maxwellian, mean_energy_change};

    /// Returns the regime by the paper's hypothesis: it depends on the mean energy change alone.
    fn regime(friction: f64, inelasticity: f64) -> Result<ConvectiveRegime, ParameterError> {
        let rule = Frictional::from_inelasticity(inelasticity, inelasticity, friction)?;
        let loss = -mean_energy_change(&rule, &Maxwellian::new(1.0)?);
        Ok(match loss {
            loss if loss < 0.047 => ConvectiveRegime::Conductive,
            loss if loss < 0.137 => ConvectiveRegime::OneRoll,
            loss if loss < 0.147 => ConvectiveRegime::Coexistence,
            loss if loss < 0.290 => ConvectiveRegime::TwoRolls,
            _ => ConvectiveRegime::Collapsed,
        })
    }

    #[test]
    fn lines_of_equal_energy_loss_come_back() -> Result<(), ParameterError> {
        let frictions = (0..=60).map(|step| 0.005 * libm::exp(0.1066 * f64::from(step)));
        let grid =
            frictions.flat_map(|friction| (0..=40).map(move |step| (friction, 0.002 * f64::from(step))));
        let seen: Vec<_> = grid
            .map(|(friction, q)| Ok((friction, q, regime(friction, q)?)))
            .collect::<Result<_, ParameterError>>()?;
        let found = plane_transitions(seen)?;
        // Up to 0.3, friction alone crosses all lines. Beyond 0.3 it crosses them again on the way back: the
        // re-entrance.
        let smooth: Vec<bool> =
            found.iter().filter(|at| at.inelasticity == 0.0).map(|at| at.rising).collect();
        assert_eq!(smooth, [true, true, true, true, false, false, false, false]);
        for at in &found {
            let [first, second] = at.between.map(|(friction, q)| regime(friction, q));
            assert_eq!(first? < second?, at.rising, "{at:?}");
            assert!(at.between[0].0 < at.between[1].0 || at.between[0].1 < at.between[1].1);
        }
        Ok(())
    }
}
