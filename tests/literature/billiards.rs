//! Billiards: the digits of π, and diffusion between fixed scatterers.

use std::f64::consts::{PI, TAU};

use granular_edmd::boundary::{Container, Wall};
use granular_edmd::collision::Elastic;
use granular_edmd::glam::DVec2;
use granular_edmd::observable::{MeanSquaredDisplacement, SampleTimes};
use granular_edmd::random::{Stream, generator, uniform};
use granular_edmd::simulation::Limits;
use granular_edmd::statistics::RunningMean;
use granular_edmd::wall::Piston;
use granular_edmd::{Disk, Simulation};

use crate::{Outcome, agrees, measured};

/// Galperin's billiard: a piston of mass 100ⁿ pushes a disk of mass 1 against a wall; they collide ⌊π 10ⁿ⌋
/// times (Galperin 2003).
#[test]
fn collisions_count_the_digits_of_pi() -> Outcome {
    for digits in 0..6 {
        let piston = Piston::new(100_f64.powi(digits), [-90.0, 9.6])?.with_start(0.0, 1e-3)?;
        let container = Container::closed(10.0, 4.0)?.with_piston(Wall::Right, piston)?;
        let disk = Disk::new(DVec2::new(3.0, 2.0), 0.25)?.with_mass(1.0)?;
        let mut run = Simulation::builder(Elastic, container).disks([disk]).build()?;
        // After the last collision, the piston goes away and stops where it began.
        run.run(&Limits::until(1e5).with_least_progress(0.0)?, &mut ())?;
        let count = (PI * 10_f64.powi(digits)).floor() as u64;
        measured(&format!("collisions, {digits}"), run.counters().wall_collisions);
        assert_eq!(run.counters().wall_collisions, count, "{digits}");
    }
    Ok(())
}

/// Radius of a scatterer and of the disk that it scatters. Their sum is 1.
const RADII: [f64; 2] = [0.9, 0.1];

/// A disk of speed 1 between scatterers on a triangular lattice, `gap` apart for its center.
fn lorentz_gas(gap: f64, seed: u64) -> Result<Simulation<Elastic>, Box<dyn std::error::Error>> {
    let spacing = 2.0 + gap;
    let height = 3.0_f64.sqrt() * spacing;
    let peg = |x: f64, y: f64| Disk::new(DVec2::new(x * spacing, y * height), RADII[0]);
    let container = Container::periodic(spacing, height)?.with_pegs([peg(0.5, 0.25)?, peg(0.0, 0.75)?])?;
    let mut random = generator(seed, Stream::Custom(1), 0);
    // From the middle between three scatterers, which is free.
    let middle = DVec2::new(0.0, (0.25 - 1.0 / 6.0) * height);
    let velocity = DVec2::from_angle(TAU * uniform(&mut random));
    let disk = Disk::new(middle + DVec2::new(0.0, 0.25 * height), RADII[1])?.with_velocity(velocity)?;
    Ok(Simulation::builder(Elastic, container).disks([disk]).build()?)
}

/// The mean free time is exact, π times the free area over the free perimeter; the diffusion is that of a
/// program without common code, to 0.4 %. Neither the Boltzmann equation nor a random walk between traps
/// (Machta & Zwanzig 1983) gives it to better than 4 to 40 %.
#[test]
fn a_disk_diffuses_between_scatterers() -> Outcome {
    for (gap, diffusion) in [(0.05, 0.060_74), (0.1, 0.100_20), (0.2, 0.169_86), (0.3, 0.248_38)] {
        let spacing = 2.0 + gap;
        let free_time = 0.5 * (0.75_f64.sqrt() * spacing * spacing - PI);
        let (mut found, mut hits) = (RunningMean::default(), 0);
        // A walk between the middles of the lattice takes steps of this duration; six of them forget the
        // start.
        let step = spacing * spacing / (12.0 * diffusion);
        let (runs, duration) = (24, 600.0 * step);
        for seed in 0..runs {
            let mut run = lorentz_gas(gap, seed)?;
            run.run_until(5.0 * step, &mut ())?;
            let before = run.counters().wall_collisions;
            let mut displacement = MeanSquaredDisplacement::new(6, SampleTimes::every(step)?)?;
            run.run_until(run.time() + duration, &mut displacement)?;
            hits += run.counters().wall_collisions - before;
            found.push(displacement.diffusion_coefficient().mean());
        }
        // 4e4 free paths or more, of a chain that mixes within a few: below 0.3 %.
        let mean_time = duration * runs as f64 / hits as f64;
        assert!(agrees(&format!("free time, {gap}"), mean_time, free_time, 0.01));
        let error = found.standard_error() / diffusion;
        println!("  error {error:.4}");
        assert!(error < 0.03, "{error}");
        assert!(agrees(&format!("diffusion, {gap}"), found.mean(), diffusion, 0.012 + 4.0 * error));
    }
    Ok(())
}
