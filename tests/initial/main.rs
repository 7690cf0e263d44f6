//! Initial states: what is placed is inside, apart, in order, and the same for the same seed.

mod even;
mod packed;
mod radii;
mod rows;
mod scattered;
mod streams;
mod velocities;

use granular_edmd::boundary::{Boundary, Probe};
use granular_edmd::glam::DVec2;
use granular_edmd::{Disk, Simulation, collision::Elastic, initial};

/// Returns disks of these radii at the origin.
fn disks(radii: impl IntoIterator<Item = f64>) -> Vec<Disk> {
    radii.into_iter().map(|radius| Disk::new(DVec2::ZERO, radius).unwrap()).collect()
}

/// Checks by all pairs that no disks overlap, that none overlaps a wall, and that the engine takes them.
fn assert_apart<B: Boundary>(boundary: B, disks: &[Disk]) {
    let domain = boundary.domain();
    for (index, disk) in disks.iter().enumerate() {
        assert_eq!(boundary.overlap(&Probe::new(disk.position(), disk.radius(), 0.0)), None, "{disk:?}");
        for other in &disks[..index] {
            let distance = domain.separation(disk.position(), other.position()).length();
            assert!(distance > disk.radius() + other.radius(), "{disk:?} overlaps {other:?}");
        }
    }
    Simulation::builder(Elastic, boundary).disks(disks.iter().copied()).build().unwrap();
}

/// Checks that only places differ.
fn assert_same_disks(placed: &[Disk], given: &[Disk]) {
    assert_eq!(placed.len(), given.len());
    for (placed, given) in placed.iter().zip(given) {
        assert_eq!(placed.with_position(DVec2::ZERO), given.with_position(DVec2::ZERO));
    }
}

/// A change of these bits changes trajectories. It must be announced under "Results" in the changelog.
#[test]
fn normal_velocities_keep_their_bits() {
    let velocity = initial::with_maxwellian_velocities(disks([0.5]), 1.0, 1).unwrap()[0].velocity();
    assert_eq!(
        velocity.to_array().map(f64::to_bits),
        [4_600_639_643_466_980_704, 4_603_145_546_403_400_218],
        "{velocity}"
    );
}
