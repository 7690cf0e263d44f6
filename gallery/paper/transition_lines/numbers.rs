//! The numbers that may govern the transitions, at each crossing, and their averages along a line.

use std::collections::BTreeMap;
use std::fmt;

use granular_edmd::ParameterError;
use granular_edmd::collision::Frictional;
use granular_edmd::kinetic::{Maxwellian, mean_energy_change, sticking_fraction};
use granular_edmd::statistics::RunningMean;

use crate::ramps::{Crossing, Ramp};

/// A mean energy change per collision, in units of the translational temperature.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Number {
    /// Closed form at equal temperatures, as in the paper.
    EqualTemperatures,
    /// The same, with the loss of sticking collisions as printed in Eq. (6).
    AsPrinted,
    /// Closed form at the ratio of the mean temperatures of the runs beside the crossing.
    MeasuredRatio,
    /// Closed form at the ratio of temperatures in the layers where disks collide.
    LocalRatio,
    /// The mean over the collisions of a run, each divided by the temperature of its layer.
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
        let rule = Frictional::from_inelasticity(q, q, crossing.friction)?;
        let gas = Maxwellian::new(1.0)?;
        let at_ratio = |ratio| Ok(mean_energy_change(&rule, &gas.with_rotational_temperature(ratio)?));
        match (self, crossing.local) {
            (Self::EqualTemperatures, _) => Ok(mean_energy_change(&rule, &gas)),
            // Without the factor 1/3, sticking collisions lose three times as much along the tangent:
            // 4q(1-q)s³ more.
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

/// An average along a line.
pub(crate) struct Average {
    /// Mean over places. A place is a crossing on a ramp; all seeds of the ramp together count once.
    pub(crate) along: RunningMean,
    /// Standard deviation between seeds at the same place; `None` with one seed.
    pub(crate) between_seeds: Option<f64>,
}

/// Averages a number over the crossings of a line.
pub(crate) fn average(number: Number, crossings: &[&(&Ramp, Crossing)]) -> Result<Average, ParameterError> {
    let mut places: BTreeMap<String, RunningMean> = BTreeMap::new();
    for (ramp, at) in crossings {
        places.entry(ramp.place(at)).or_default().push(number.at(at)?);
    }
    let several = || places.values().filter(|seeds| seeds.count() > 1);
    let freedom: u64 = several().map(|seeds| seeds.count() - 1).sum();
    let squares: f64 = several().map(|seeds| seeds.variance() * (seeds.count() - 1) as f64).sum();
    let between_seeds = (freedom > 0).then(|| (squares / freedom as f64).sqrt());
    Ok(Average { along: places.values().map(RunningMean::mean).collect(), between_seeds })
}

impl fmt::Display for Average {
    /// Writes mean, standard deviation along the line, standard error of the mean, and the scatter of seeds.
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { along, between_seeds } = self;
        let (mean, deviation, error) = (along.mean(), along.standard_deviation(), along.standard_error());
        let share = 100.0 * deviation / mean.abs();
        let places = along.count();
        if places < 2 {
            return write!(to, "{mean:.3}, one place");
        }
        write!(to, "{mean:.3} ± {deviation:.3} ({share:.0} %), error {error:.3}, {places} places")?;
        between_seeds.map_or(Ok(()), |seeds| write!(to, ", seeds ± {seeds:.3}"))
    }
}
