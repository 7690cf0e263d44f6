//! The numbers that may govern the transitions, at each crossing, and their averages along a line.

use granular_edmd::ParameterError;
use granular_edmd::collision::Frictional;
use granular_edmd::kinetic::{Maxwellian, mean_energy_change, sticking_fraction};
use granular_edmd::statistics::RunningMean;

use crate::ramps::Crossing;

/// A mean energy change per collision, in units of the translational temperature.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Number {
    /// Closed form at equal temperatures, as in the paper.
    EqualTemperatures,
    /// The same, if sticking collisions lost what is printed as Eq. (6).
    AsPrinted,
    /// Closed form at the ratio of the mean temperatures of the runs beside the crossing.
    MeasuredRatio,
    /// Closed form at the ratio of temperatures in the layers where disks collide.
    LocalRatio,
    /// The mean over the collisions of a run, each over the temperature of its layer.
    InTheRun,
}

impl Number {
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::EqualTemperatures => "closed form, equal temperatures",
            Self::AsPrinted => "closed form, Eq. (6) as printed",
            Self::MeasuredRatio => "closed form, measured T_rot/T",
            Self::LocalRatio => "closed form, T_rot/T of layers",
            Self::InTheRun => "measured, over T of layers",
        }
    }

    /// Returns the number at a crossing; NaN for what is measured in layers, if it was not measured.
    pub(crate) fn at(self, crossing: &Crossing) -> Result<f64, ParameterError> {
        let q = crossing.inelasticity;
        let rule =
            Frictional::from_inelasticity(q, q)?.with_friction(crossing.friction, crossing.friction)?;
        let gas = Maxwellian::new(1.0)?;
        let at_ratio = |ratio| Ok(mean_energy_change(&rule, &gas.with_rotational_temperature(ratio)?));
        match (self, crossing.local) {
            (Self::EqualTemperatures, _) => Ok(mean_energy_change(&rule, &gas)),
            // Without the third, sticking loses three times as much in the tangent: 4q(1-q)s³ more.
            (Self::AsPrinted, _) => {
                let sticking = sticking_fraction(&rule, &gas).powi(3);
                Ok(mean_energy_change(&rule, &gas) - 4.0 * q * (1.0 - q) * sticking)
            }
            (Self::MeasuredRatio, _) => at_ratio(crossing.temperature_ratio),
            (Self::LocalRatio, Some(local)) => at_ratio(local.temperature_ratio),
            (Self::InTheRun, Some(local)) => Ok(local.energy_change),
            (Self::LocalRatio | Self::InTheRun, None) => Ok(f64::NAN),
        }
    }
}

/// Averages a number over the crossings of a line; each crossing counts alike.
pub(crate) fn average(number: Number, crossings: &[&Crossing]) -> Result<RunningMean, ParameterError> {
    crossings.iter().map(|crossing| number.at(crossing)).collect()
}

/// Formats mean, standard deviation along the line and standard error of the mean.
pub(crate) fn formatted(average: &RunningMean) -> String {
    if average.count() == 0 {
        return "-".to_owned();
    }
    let (mean, deviation, error) = (average.mean(), average.standard_deviation(), average.standard_error());
    let relative = 100.0 * deviation / mean.abs();
    format!("{mean:.3} ± {deviation:.3} ({relative:.0} %), error {error:.3}, {} points", average.count())
}
