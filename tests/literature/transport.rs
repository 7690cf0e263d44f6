//! Self-diffusion, viscosities and thermal conductivity of elastic disks, against Enskog's theory.

use std::f64::consts::PI;

use granular_edmd::Simulation;
use granular_edmd::collision::{CollisionRule, Elastic};
use granular_edmd::observable::{
    MeanSquaredDisplacement, SampleTimes, Temperatures, TimeCorrelation, TransportCoefficients, Velocities,
};

use crate::gas::{collision_rate, contact_value, periodic_gas};
use crate::{Outcome, agrees};

#[test]
fn disks_diffuse_faster_than_enskog_says_by_the_known_factor() -> Outcome {
    // The factors are those of earlier runs of 1024 disks, from slopes over 20 to 40 mean free times: 1.09 to
    // 1.11 and 1.26 to 1.34, since velocities remember each other longer than in Enskog's gas.
    for (packing, factor) in [(0.1, 1.10), (0.3, 1.30)] {
        let mut gas = periodic_gas(1000, packing, Elastic, 1)?;
        let times = SampleTimes::every(1.0 / collision_rate(packing))?;
        let mut displacement = MeanSquaredDisplacement::new(40, times)?;
        gas.run_until(gas.time() + 1000.0 * times.interval(), &mut displacement)?;
        let measured = displacement.diffusion_coefficient();
        let thermal = (gas.measure(&Temperatures).translational() * 1000.0 / 999.0).sqrt();
        let enskog = thermal / (PI.sqrt() * 2.0 * (4.0 * packing / PI) * contact_value(packing));
        // Displacements of 1000 disks over 50 times 20 mean free times know D to sqrt(1/50 000), doubled by
        // their correlation: 1 %. The factors are good to 3 %.
        assert!(measured.standard_error() < 0.02 * measured.mean(), "{measured}");
        assert!(agrees(&format!("D / D_E, {packing}"), measured.mean() / enskog, factor, 0.06));
    }
    Ok(())
}

#[test]
fn velocities_forget_themselves_at_the_rate_of_collisions() -> Outcome {
    let packing = 0.05;
    let mut gas = periodic_gas(1000, packing, Elastic, 3)?;
    let rate = collision_rate(packing);
    let times = SampleTimes::every(0.1 / rate)?;
    let mut correlation = TimeCorrelation::new(Velocities, 20, times)?;
    let start = gas.counters().disk_collisions;
    gas.run_until(gas.time() + 400.0 / rate, &mut correlation)?;
    // The temperature is not quite 1, so the rate is the one that was counted.
    let counted = 2.0 * (gas.counters().disk_collisions - start) as f64 / 1000.0 / 400.0;
    assert!(agrees("collisions", counted, 1.0, 0.03));
    let values: Vec<f64> = correlation.iter().map(|(_, value)| value.mean()).collect();
    // A collision takes all of the memory of a velocity on average, so C(t) = C(0) e^{-wt}, exactly at first
    // and in Enskog's first approximation later. There are 2e5 collisions, in each 0.1 mean free times 500
    // per 1000 disks with a loss that scatters by its mean: below 1 % in all. Two terms of the Sonine
    // expansion change C after two mean free times by 5 %.
    let decay = -f64::ln(values[1] / values[0]);
    assert!(agrees("decay at first", decay, 0.1 * counted, 0.02));
    assert!(agrees("C after half of a mean free time", values[5] / values[0], (-0.5 * counted).exp(), 0.02));
    assert!(agrees("C after two mean free times", values[20] / values[0], (-2.0 * counted).exp(), 0.12));
    Ok(())
}

/// Enskog's shear viscosity, bulk viscosity and thermal conductivity for disks of unit diameter, mass and
/// temperature (Gass 1971).
fn enskog(packing: f64) -> [f64; 3] {
    let (chi, density) = (contact_value(packing), 2.0 * packing);
    let viscosity = 1.022 / (2.0 * PI.sqrt());
    let conductivity = 1.029 * 2.0 / PI.sqrt();
    [
        viscosity * (1.0 / chi + density + 0.8729 * chi * density * density),
        viscosity * 1.246 * chi * density * density,
        conductivity * (1.0 / chi + 1.5 * density + 0.8718 * chi * density * density),
    ]
}

/// A run that measures the coefficients: its disks, its packing fraction, the interval of the lags and its
/// length in mean free times. Slopes are those between 10 and 20 intervals.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Measurement {
    pub(crate) count: usize,
    pub(crate) packing: f64,
    pub(crate) interval: f64,
    pub(crate) mean_free_times: f64,
}

impl Measurement {
    pub(crate) const LAGS: usize = 20;

    /// Measures the coefficients of a gas.
    pub(crate) fn of<R: CollisionRule>(
        self,
        gas: &mut Simulation<R>,
    ) -> Result<TransportCoefficients, Box<dyn std::error::Error>> {
        let mean_free_time = 1.0 / collision_rate(self.packing);
        let times = SampleTimes::every(self.interval * mean_free_time)?;
        let mut transport = TransportCoefficients::new(Self::LAGS, times)?;
        gas.run_until(gas.time() + self.mean_free_times * mean_free_time, &mut transport)?;
        Ok(transport)
    }

    /// Tells whether the coefficients of elastic disks are those of Enskog.
    fn agrees_with_enskog(self, tolerances: [f64; 3]) -> Result<bool, Box<dyn std::error::Error>> {
        let transport = self.of(&mut periodic_gas(self.count, self.packing, Elastic, 7)?)?;
        let thermal = transport.temperature().sqrt();
        let measured = [
            ("eta / eta_E", transport.shear_viscosity()),
            ("zeta / zeta_E", transport.bulk_viscosity()),
            ("lambda / lambda_E", transport.thermal_conductivity()),
        ];
        let rows = measured.into_iter().zip(enskog(self.packing)).zip(tolerances);
        let agree = rows.map(|(((name, estimate), enskog), tolerance)| {
            let (ratio, error) =
                (estimate.mean() / (enskog * thermal), estimate.standard_error() / (enskog * thermal));
            println!("{name}, {}: {ratio:.4} ± {error:.4}", self.packing);
            agrees(&format!("{name}, {}", self.packing), ratio, 1.0, tolerance)
        });
        Ok(agree.fold(true, |all, this| all & this))
    }
}

#[test]
fn viscosities_and_conductivity_are_about_those_of_enskog() -> Outcome {
    // Two components over 400 stretches of 10 mean free times know a mean square to 5 %. The tolerances are
    // more than three times the standard errors.
    let short = Measurement { count: 500, packing: 0.05, interval: 0.5, mean_free_times: 4000.0 };
    assert!(short.agrees_with_enskog([0.2, 2.5, 0.25])?);
    Ok(())
}

#[test]
#[ignore = "ten minutes"]
fn long_viscosities_and_conductivity_are_those_of_enskog() -> Outcome {
    // The flux of heat forgets itself in two mean free times. Slopes between 5 and 10 of them would lack 3 %;
    // those between 10 and 20 lack 0.1 %. Two components over 20 000 stretches know a mean square to 0.7 %.
    let long = Measurement { count: 2000, packing: 0.05, interval: 1.0, mean_free_times: 400_000.0 };
    assert!(long.agrees_with_enskog([0.03, 0.3, 0.03])?);
    Ok(())
}
