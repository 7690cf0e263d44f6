//! Velocity distributions and their cumulants.

use granular_edmd::collision::{Elastic, Smooth};
use granular_edmd::observable::{Observer, SampleTimes, Sampled, VelocityDistribution};

use crate::gas::{periodic_gas, run_for};
use crate::{Outcome, measured};

fn distribution() -> Result<Sampled<VelocityDistribution>, Box<dyn std::error::Error>> {
    Ok(Sampled::new(VelocityDistribution::new(3.0, 30)?.about_mean(), SampleTimes::every(1.0)?))
}

#[test]
fn a_gas_at_rest_is_maxwellian() -> Outcome {
    // Ten disks are so few that plain moments would give a_2 = -0.1 and a_3 = -0.3.
    for (count, samples) in [(10, 40_000), (1000, 400)] {
        let mut gas = periodic_gas(count, 0.05, Elastic, 1)?;
        let mut velocities = distribution()?;
        for _ in 0..samples {
            run_for(&mut gas, 2.0, &mut ())?;
            velocities.on_sample(&gas.snapshot());
        }
        let cumulants = [velocities.second_cumulant(), velocities.third_cumulant()];
        for cumulant in cumulants {
            measured(&format!("{count} disks"), cumulant);
        }
        for estimate in cumulants {
            // The error of 4e5 disks, half of them independent, is 0.002.
            assert!(estimate.standard_error() < 0.015);
            assert!(estimate.mean().abs() < 4.0 * estimate.standard_error(), "{count} disks: {estimate}");
        }
        if count == 1000 {
            let (middle, edge) = (velocities.horizontal().bins().nth(15).unwrap(), velocities.speed().bins());
            // The means over the bins from 0 to 0.2: of e^{-c^2}/√π, and of 2c e^{-c^2} up to 0.1.
            assert!((middle.density.mean() - 0.556_7).abs() < 0.01, "{middle:?}");
            assert!((edge.take(1).next().unwrap().density.mean() - 0.099_5).abs() < 0.01);
        }
    }
    Ok(())
}

/// Returns the second cumulant of smooth disks that cool, from gases of 1500.
fn cooling_cumulant(
    restitution: f64,
    gases: u64,
) -> Result<granular_edmd::statistics::Estimate, Box<dyn std::error::Error>> {
    let mut velocities = distribution()?;
    for seed in 0..gases {
        let mut gas = periodic_gas(1500, 0.008, Smooth::from_restitution(restitution)?, seed)?;
        for _ in 0..5 {
            run_for(&mut gas, 4.0, &mut ())?;
            velocities.on_sample(&gas.snapshot());
        }
    }
    Ok(velocities.second_cumulant())
}

#[test]
fn a_cooling_gas_has_the_second_cumulant_of_van_noije_and_ernst() -> Outcome {
    // Boxes are too small for vortices, N < 4π/n(1 - r²). The theory (Granular Matter 1, 57 (1998)) is linear
    // in a_2; direct simulation of the Boltzmann equation gives -0.026 and 0.033.
    for (r, gases) in [(0.8_f64, 6), (0.6, 6)] {
        let expected = 16.0 * (1.0 - r) * (1.0 - 2.0 * r * r) / (57.0 - 25.0 * r + 30.0 * r * r * (1.0 - r));
        let cumulant = cooling_cumulant(r, gases)?;
        measured("a_2", cumulant);
        // There are 45 000 disks, nearly independent after four collisions each: 0.005.
        assert!((cumulant.mean() - expected).abs() < 0.02, "{cumulant}, {expected}");
        assert!(cumulant.mean().signum() == expected.signum());
    }
    Ok(())
}
