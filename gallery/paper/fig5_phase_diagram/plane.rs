//! The changes of state in the plane of friction and inelasticity.

use granular_edmd::ParameterError;
use granular_edmd::quantity::positive;
use granular_edmd_study::analysis::{ConvectiveRegime, Transition, TransitionLine, transitions};

/// A point of a transition line in the plane of friction and inelasticity; made by [`plane_transitions`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct PlaneTransition {
    /// The line that is crossed.
    pub(crate) line: TransitionLine,
    /// Friction κ in the middle between the neighbors, on a logarithmic axis.
    pub(crate) friction: f64,
    /// Inelasticity q in the middle between the neighbors.
    pub(crate) inelasticity: f64,
    /// The two neighbors, as (κ, q), between which the transition lies. They share one coordinate.
    pub(crate) between: [(f64, f64); 2],
    /// True if the regime goes up from the first neighbor to the second.
    pub(crate) rising: bool,
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
pub(crate) fn plane_transitions(
    observations: impl IntoIterator<Item = (f64, f64, ConvectiveRegime)>,
) -> Result<Vec<PlaneTransition>, ParameterError> {
    let all: Vec<Observation> = observations
        .into_iter()
        .map(|(friction, q, regime)| Ok((positive("friction", friction)?, q, regime)))
        .collect::<Result<_, ParameterError>>()?;
    let along_friction = scans(&all, |&(friction, q, regime)| (q, friction.ln(), regime));
    let along_inelasticity = scans(&all, |&observation| observation);
    let mut found = Vec::new();
    for (q, scan) in along_friction {
        found.extend(transitions(scan)?.iter().map(|at| point(at, |logarithm| (logarithm.exp(), q))));
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
