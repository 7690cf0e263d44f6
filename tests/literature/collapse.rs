//! Inelastic collapse of disks on a line.

use granular_edmd::boundary::{Container, Wall};
use granular_edmd::collision::{Elastic, Smooth};
use granular_edmd::glam::DVec2;
use granular_edmd::{Disk, Simulation};
use rand_xoshiro::Xoshiro256PlusPlus;
use rand_xoshiro::rand_core::{Rng, SeedableRng};

use crate::Outcome;

fn uniform(generator: &mut Xoshiro256PlusPlus) -> f64 {
    (generator.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
}

/// Returns the number of collisions of disks in a vertical row without gravity that approach each other. The
/// row is far from all walls, or on its way to a floor of the same restitution.
fn collisions(
    count: usize,
    restitution: f64,
    free: bool,
    seed: u64,
) -> Result<u64, Box<dyn std::error::Error>> {
    let mut generator = Xoshiro256PlusPlus::seed_from_u64(seed);
    let rule = Smooth::from_restitution(restitution)?;
    let container = Container::closed(4.0, 2000.0)?.with_rule(Wall::Lid, Elastic)?;
    let mut height = if free { 1000.0 } else { 0.5 };
    let mut velocity = if free { 1.0 } else { 0.0 };
    let mut disks = Vec::new();
    for _ in 0..count {
        height += 1.0 + uniform(&mut generator);
        velocity -= uniform(&mut generator);
        disks.push(Disk::new(DVec2::new(2.0, height), 0.5)?.with_velocity(DVec2::new(0.0, velocity))?);
    }
    let mut simulation = Simulation::builder(rule, container).disks(disks).build()?;
    // A collapse ends the run with an error, or disappears in rounding.
    let _ = simulation.run_until(300.0, &mut ());
    Ok(simulation.counters().disk_collisions + simulation.counters().wall_collisions)
}

/// Cases of collapse: the number of disks, whether they are free, the restitution below which they collapse,
/// and a number of collisions between those 3 % above and those 3 % below. The restitution is
/// $`\tan^2(\pi/12)`$ for three free disks (McNamara & Young 1992), and $`\tan^2[(\pi/4)(1-1/n)]`$ for n
/// disks at a wall (Bernu & Mazighi 1990).
const CASES: [(usize, bool, f64, u64); 3] =
    [(3, true, 0.071_796_77, 25), (2, false, 0.171_572_88, 100), (3, false, 1.0 / 3.0, 120)];

#[test]
fn rows_collapse_below_the_threshold() -> Outcome {
    // Above the threshold, a row has a finite number of collisions, which grows toward the threshold. Below
    // it, collisions go on until speeds differ by rounding only (free disks: some 35) or the guard ends the
    // run (at a wall).
    for (count, free, threshold, between) in CASES {
        for seed in 0..60 {
            let (above, below) = (
                collisions(count, 1.03 * threshold, free, seed)?,
                collisions(count, 0.97 * threshold, free, seed)?,
            );
            assert!(above < between && below > between, "{count} {free} {seed}: {above}, {below}");
        }
    }
    Ok(())
}
