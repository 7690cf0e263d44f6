//! Disks in single file: hard rods, and channels so narrow that no disk passes another.

use std::f64::consts::PI;

use granular_edmd::boundary::{Boundary, Container};
use granular_edmd::collision::Elastic;
use granular_edmd::glam::DVec2;
use granular_edmd::initial;
use granular_edmd::observable::{MeanSquaredDisplacement, SampleTimes, Stress, Temperatures};
use granular_edmd::random::{Stream, generator, normal, uniform};
use granular_edmd::statistics::RunningMean;
use granular_edmd::{Disk, Simulation};

use crate::{Outcome, agrees};

/// Rods of length 1 on a ring, at rest as a whole and at temperature 1, at random positions.
fn rods(count: usize, length: f64, seed: u64) -> Result<Simulation<Elastic>, Box<dyn std::error::Error>> {
    let mut random = generator(seed, Stream::Custom(2), 0);
    let free = length - count as f64;
    let mut places: Vec<f64> = (0..count).map(|_| free * uniform(&mut random)).collect();
    places.sort_by(f64::total_cmp);
    let speeds: Vec<f64> = (0..count).map(|_| normal(&mut random)).collect();
    let drift = speeds.iter().sum::<f64>() / count as f64;
    let square = speeds.iter().map(|speed| (speed - drift).powi(2)).sum::<f64>() / count as f64;
    let disk = |(number, (place, speed)): (usize, (&f64, &f64))| {
        let position = DVec2::new(place + number as f64 + 0.5, 2.0);
        Disk::new(position, 0.5 * (1.0 - 1e-9))?.with_velocity((speed - drift) / square.sqrt() * DVec2::X)
    };
    let disks = places.iter().zip(&speeds).enumerate().map(disk).collect::<Result<Vec<_>, _>>()?;
    let ring = Container::closed(length, 4.0)?.with_periodic_sides()?;
    Ok(Simulation::builder(Elastic, ring).disks(disks).build()?)
}

/// Equal rods exchange their velocities, so a rod diffuses although no velocity ever relaxes:
/// ⟨x²⟩ = 2 D t with D = (1/ρ - 1) √(T/2πm) (Jepsen 1965; rods have the spacing of points plus their length).
#[test]
fn rods_in_single_file_diffuse_as_jepsen_says() -> Outcome {
    let (count, density, mut found) = (500, 0.5, RunningMean::default());
    for seed in 0..40 {
        let mut run = rods(count, count as f64 / density, seed)?;
        let mut displacement = MeanSquaredDisplacement::new(6, SampleTimes::every(1.0)?)?;
        run.run_until(60.0, &mut displacement)?;
        // The coefficient is that of two dimensions, of which one is idle.
        found.push(2.0 * displacement.diffusion_coefficient().mean());
    }
    let expected = (1.0 / density - 1.0) / (2.0 * PI).sqrt();
    let error = found.standard_error() / expected;
    println!("  error {error:.4}");
    assert!(error < 0.02, "{error}");
    assert!(agrees("diffusion in single file", found.mean(), expected, 4.0 * error));
    Ok(())
}

/// The pressure of five rods on a ring, P L/NT = 1 + (N - 1)/N ρ/(1 - ρ) (Tonks 1936, for a ring of N rods):
/// its collisional part belongs to the temperature of the N - 1 degrees of freedom that momentum leaves.
#[test]
fn few_rods_on_a_ring_have_the_pressure_of_their_degrees_of_freedom() -> Outcome {
    let (count, density, mut found) = (5.0, 0.5, RunningMean::default());
    for seed in 0..400 {
        let mut run = rods(5, count / density, seed)?;
        let mut stress = Stress::new(SampleTimes::every(10.0)?);
        run.run_until(100.0, &mut stress)?;
        let area = run.boundary().domain().width() * run.boundary().domain().height();
        let free = count / (count - 1.0);
        found.push(1.0 + stress.collisional().xx.mean() * area / (count * free));
    }
    let expected = 1.0 + (count - 1.0) / count * density / (1.0 - density);
    let error = found.standard_error() / expected;
    assert!(error < 0.005, "{error}");
    assert!(agrees("Z of five rods on a ring", found.mean(), expected, 4.0 * error));
    Ok(())
}

/// Returns the mean spacing of disks of diameter 1 along a channel that leaves their centers this width,
/// under a force along it over the temperature: by the largest eigenvalue of exp(-f d(y - y')), where d is
/// the distance along the channel at which two disks touch (Barker 1962; Kofke & Post 1993). Exact up to a
/// width of √3/2, beyond which a disk touches its second neighbor.
fn spacing(width: f64, force: f64) -> f64 {
    const POINTS: usize = 64;
    let touching = |a: usize, b: usize| {
        let aside = width * (a as f64 - b as f64) / POINTS as f64;
        (1.0 - aside * aside).sqrt()
    };
    let weight = |a, b| (-force * touching(a, b)).exp();
    let mut vector = [1.0; POINTS];
    let mut mean = 1.0;
    for _ in 0..30 {
        let next: [f64; POINTS] =
            std::array::from_fn(|a| (0..POINTS).map(|b| weight(a, b) * vector[b]).sum());
        let (mut sum, mut distances) = (0.0, 0.0);
        for a in 0..POINTS {
            for b in 0..POINTS {
                let share = vector[a] * weight(a, b) * vector[b];
                sum += share;
                distances += share * touching(a, b);
            }
        }
        mean = distances / sum;
        let norm = next.iter().fold(0.0_f64, |largest, value| largest.max(*value));
        vector = next.map(|value| value / norm);
    }
    mean + 1.0 / force
}

/// The force along a channel in which disks cannot pass each other, at two widths, against the exact one.
#[test]
fn a_channel_in_single_file_has_its_exact_pressure() -> Outcome {
    let (count, distance) = (200, 1.25);
    for width in [0.5, 0.8] {
        let (length, height) = (f64::from(count) * distance, 1.0 + width);
        let channel = Container::closed(length, height)?.with_periodic_sides()?;
        let disks = (0..count)
            .map(|number| Disk::new(DVec2::new((f64::from(number) + 0.5) * distance, 0.5 * height), 0.5));
        let disks = initial::with_maxwellian_velocities(disks.collect::<Result<Vec<_>, _>>()?, 1.0, 1)?;
        let disks = initial::without_drift(disks)?;
        let mut run = Simulation::builder(Elastic, channel).disks(disks).build()?;
        run.run_until(100.0, &mut ())?;
        let mut stress = Stress::new(SampleTimes::every(1.0)?);
        run.run_until(1000.0, &mut stress)?;
        // Energy and the momentum along the channel are conserved.
        let count = f64::from(count);
        let temperature = run.measure(&Temperatures).translational() * 2.0 * count / (2.0 * count - 1.0);
        let xx = stress.tensor().xx;
        println!("  {xx}");
        let force = xx.mean() * height / temperature;
        let (mut low, mut high) = (0.1, 100.0);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if spacing(width, middle) > distance { low = middle } else { high = middle }
        }
        // N disks leave 1/N. Without their width, it would be 1/(distance - 1) = 4.
        let tolerance = 0.005 + 4.0 * xx.standard_error() / xx.mean();
        assert!(tolerance < 0.03);
        assert!(agrees(&format!("force along a channel, {width}"), force, low, tolerance));
    }
    Ok(())
}
