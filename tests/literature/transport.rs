//! Self-diffusion of elastic disks, against Enskog's theory.

use std::f64::consts::PI;

use granular_edmd::collision::Elastic;
use granular_edmd::observable::{
    MeanSquaredDisplacement, SampleTimes, Temperatures, TimeCorrelation, Velocities,
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
    // The temperature of 1000 disks is 1 only to 3 %, so the rate is the one that was counted.
    let counted = 2.0 * (gas.counters().disk_collisions - start) as f64 / 1000.0 / 400.0;
    let thermal = gas.measure(&Temperatures).translational().sqrt();
    assert!(agrees("collisions", counted / thermal, 1.0, 0.03));
    let values: Vec<f64> = correlation.iter().map(|(_, value)| value.mean()).collect();
    // A collision takes all of the memory of a velocity on average, so C(t) = C(0) e^{-wt}, exactly at first
    // and in Enskog's first approximation later. There are 2e5 collisions, in each 0.1 mean free times 500
    // per 1000 disks with a loss that scatters by its mean: below 1 % in all. Two terms of the Sonine
    // expansion change C after two mean free times by 5 %.
    let decay = -f64::ln(values[1] / values[0]);
    assert!(agrees("decay at first", decay / (0.1 * counted), 1.0, 0.02));
    let half = values[5] / values[0] / (-0.5 * counted).exp();
    assert!(agrees("C after half of a mean free time", half, 1.0, 0.02));
    assert!(agrees("C after two mean free times", values[20] / values[0], (-2.0 * counted).exp(), 0.12));
    Ok(())
}
