//! Very long runs: no drift of the energy, no overlap beyond rounding, and late times as good as early ones.
//!
//! ```text
//! COLLISIONS=10000000 cargo test --release --test simulation -- --ignored --nocapture billion_collisions
//! ```

use granular_edmd::boundary::{Boundary, Container, Probe, Wall};
use granular_edmd::collision::{Contact, Elastic, Impulse, from_fn};
use granular_edmd::glam::DVec2;
use granular_edmd::observable::Energies;
use granular_edmd::{Disk, Simulation};

use crate::setups::elastic_gas_at;

/// A gas of packing fraction 0.31 under a gravity that makes the density vary by a tenth.
fn gas(start: f64) -> Simulation<Elastic> {
    elastic_gas_at(start, 1000, 50.0, 50.0, 0.002)
}

/// Returns the number of disk–disk collisions of a long run: 10⁹, or the value of the variable `COLLISIONS`.
fn wanted() -> u64 {
    std::env::var("COLLISIONS").map_or(1_000_000_000, |text| text.parse().unwrap())
}

/// Rounding of a distance. Positions at the epoch stay below 512, far flights of the fastest disks included,
/// and have a last digit of 2⁻⁴⁴. A distance comes from four of them.
const ROUNDING: f64 = 4.0 / (1_u64 << 44) as f64;

/// Runs until this many collisions, and asserts energy and overlap at each hundredth of the way.
fn run(mut simulation: Simulation<Elastic>, collisions: u64) {
    let (start, before) = (simulation.time(), simulation.measure(&Energies).total());
    let mut told = 0;
    while simulation.counters().disk_collisions < collisions {
        let end = simulation.time() + 64.0;
        simulation.run_until(end, &mut ()).unwrap();
        let counters = *simulation.counters();
        let drift = simulation.measure(&Energies).total() / before - 1.0;
        if counters.disk_collisions >= told {
            let time = simulation.time() - start;
            let overlap = counters.max_overlap;
            println!(
                "{:.2e} collisions, {time:.0} after {start:e}: drift {drift:.1e}, overlap {overlap:.1e}",
                counters.disk_collisions as f64
            );
            told += collisions.div_ceil(100);
        }
        assert!(drift.abs() < 1e-9, "{drift:e}");
        assert!(counters.max_overlap < ROUNDING, "{:e}", counters.max_overlap);
    }
}

#[test]
fn a_long_run_keeps_energy_and_distance() {
    run(gas(0.0), 20_000);
}

#[test]
#[ignore = "a billion collisions: the better part of an hour in release"]
fn elastic_disks_keep_energy_and_distance_for_a_billion_collisions() {
    run(gas(0.0), wanted());
}

#[test]
#[ignore = "a billion collisions: the better part of an hour in release"]
fn late_elastic_disks_keep_energy_and_distance_for_a_billion_collisions() {
    run(gas(1e7), wanted());
}

#[test]
fn a_run_at_ten_million_has_the_digits_of_one_at_zero() {
    // Nothing depends on the time between fixed walls: the bits are the same, although times have 23 binary
    // digits fewer.
    let after = |start: f64| {
        let mut simulation = gas(start);
        simulation.run_until(start + 64.0, &mut ()).unwrap();
        (simulation.disks(), *simulation.counters())
    };
    let (early, late) = (after(0.0), after(1e7));
    assert!(early.1.disk_collisions > 20_000, "{:?}", early.1);
    assert_eq!(early.0, late.0);
    assert_eq!(early.1, late.1);
}

#[test]
fn disks_that_a_collision_makes_fast_keep_their_digits() {
    // The disks creep toward each other for a million units of time, and their rule has them part at a speed
    // of 123.4.
    let burst = from_fn(|contact: &Contact| {
        Impulse::new(contact.normal_mass() * (contact.closing_speed() + 123.4), 0.0)
    });
    let walls = [Wall::Floor, Wall::Lid, Wall::Left, Wall::Right];
    let closed = Container::closed(10.0, 10.0).unwrap();
    let walls = walls.into_iter().fold(closed, |walls, wall| walls.with_rule(wall, Elastic).unwrap());
    let disk = |x: f64, velocity: f64| {
        let disk = Disk::new(DVec2::new(x, 5.0), 0.5).unwrap();
        disk.with_velocity(DVec2::new(velocity, 1e-7)).unwrap()
    };
    let disks = [disk(3.1, 1e-6), disk(7.3, -1.3e-6)];
    let mut simulation = Simulation::builder(burst, walls.clone()).disks(disks).build().unwrap();
    while simulation.counters().wall_collisions < 1000 {
        simulation.step_until(simulation.time() + 1.0, &mut ()).unwrap();
        for disk in simulation.disks() {
            let overlap = walls.overlap(&Probe::new(disk.position(), 0.5, simulation.time()));
            assert!(
                overlap.is_none_or(|overlap| overlap.depth < 1e-12),
                "{overlap:?} at {}",
                simulation.time()
            );
        }
    }
}
