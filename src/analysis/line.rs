//! Averages along a line of transitions.

use crate::ParameterError;
use crate::collision::Frictional;
use crate::kinetic::{Maxwellian, effective_inelasticity, mean_energy_change};
use crate::quantity::accept;
use crate::statistics::RunningMean;

/// A row of the paper's Table I; made by [`line_average`].
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct LineAverage {
    energy_change: RunningMean,
    effective_inelasticity: RunningMean,
}

impl LineAverage {
    /// Returns ⟨dE⟩ over the points of the line: the mean, and the standard deviation as the table's error.
    pub const fn energy_change(&self) -> &RunningMean {
        &self.energy_change
    }

    /// Returns the effective inelasticity over the points of the line.
    pub const fn effective_inelasticity(&self) -> &RunningMean {
        &self.effective_inelasticity
    }
}

/// Averages the energy change per collision and the effective inelasticity along a line of transitions.
///
/// Each point is the rule at which a transition was seen. Its $`\langle dE\rangle`$ is the [closed
/// form](mean_energy_change) in a Maxwellian `gas`, and its $`q_\text{eff}`$ follows by the paper's Eq. (9).
/// Both are averaged over the points, as in the paper's Table I. The table's "±" is their [standard
/// deviation](RunningMean::standard_deviation), not the error of the mean, because the scatter along the line
/// tests the paper's hypothesis.
///
/// # Errors
/// If there is no point, or one loses more than smooth disks can (see [`effective_inelasticity`]).
///
/// ```
/// use granular_edmd::analysis::line_average;
/// use granular_edmd::collision::Frictional;
/// use granular_edmd::kinetic::Maxwellian;
/// // Points on the axes of the first line at the larger gravity, for the paper's energy change.
/// let ends = [(0.0119, 0.0), (0.0, 0.0143), (0.0, 1.792)];
/// let [first, second, third] = ends.map(|(q, friction)| Frictional::from_inelasticity(q, q, friction));
/// let line = [first?, second?, third?];
/// let average = line_average(&line, &Maxwellian::new(1.0)?)?;
/// assert!((average.energy_change().mean() + 0.047).abs() < 5e-4);
/// assert!((average.effective_inelasticity().mean() - 0.012).abs() < 5e-4);
/// assert!(average.energy_change().standard_deviation() < 5e-4);
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
pub fn line_average(line: &[Frictional], gas: &Maxwellian) -> Result<LineAverage, ParameterError> {
    accept(!line.is_empty(), "number of points of a line", "at least 1", 0.0)?;
    let changes: Vec<f64> = line.iter().map(|rule| mean_energy_change(rule, gas)).collect();
    let effective = |&change: &f64| effective_inelasticity(change, gas.translational_temperature());
    Ok(LineAverage {
        energy_change: changes.iter().copied().collect(),
        effective_inelasticity: changes.iter().map(effective).collect::<Result<RunningMean, _>>()?,
    })
}
