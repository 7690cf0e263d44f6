//! Disks that lie all in one place of a large box: memory and time follow their number.

use granular_edmd::boundary::Container;
use granular_edmd::collision::Elastic;
use granular_edmd::glam::DVec2;
use granular_edmd::{Disk, Simulation, initial};

/// Places this many disks of this radius on a square lattice in the lower left corner.
fn corner(count: usize, radius: f64) -> Vec<Disk> {
    let side = (count as f64).sqrt().ceil() as usize;
    let position =
        |k: usize| DVec2::new((k % side) as f64, (k / side) as f64) * (2.5 * radius) + 2.0 * radius;
    (0..count).map(|k| Disk::new(position(k), radius).unwrap()).collect()
}

/// Returns the deepest overlap of any two of some disks of one size, in radii.
fn deepest(disks: &[Disk]) -> f64 {
    let radius = disks[0].radius();
    let mut places: Vec<DVec2> = disks.iter().map(Disk::position).collect();
    places.sort_by(|a, b| a.x.total_cmp(&b.x));
    let mut nearest = f64::INFINITY;
    for (k, a) in places.iter().enumerate() {
        let near = places[k + 1..].iter().take_while(|b| b.x - a.x < 2.0 * radius);
        nearest = near.map(|b| a.distance(*b)).fold(nearest, f64::min);
    }
    2.0 - nearest / radius
}

/// A crowd in a corner once doubled the room of every cell until a few thousand disks took all memory.
#[test]
fn a_crowd_in_a_corner_takes_no_more_than_its_room() {
    for with_a_large_one in [false, true] {
        let mut disks = corner(30_001, 0.01);
        if with_a_large_one {
            disks.push(Disk::new(DVec2::new(40.0, 100.0), 5.0).unwrap());
        }
        let disks = initial::with_maxwellian_velocities(disks, 1.0, 5).unwrap();
        let container = Container::closed(60.0, 150.0).unwrap();
        let mut run = Simulation::builder(Elastic, container).disks(disks).build().unwrap();
        for _ in 0..3000 {
            run.step_until(1.0, &mut ()).unwrap();
        }
        assert!(deepest(&run.disks()[..30_001]) < 1e-9);
        assert!(run.counters().max_overlap < 1e-9, "{:?}", run.counters());
    }
}

/// All disks in one cell: a few, since each then looks at all others.
#[test]
fn a_crowd_in_one_cell_runs() {
    let disks = initial::with_maxwellian_velocities(corner(1500, 1e-4), 1.0, 5).unwrap();
    let container = Container::closed(60.0, 150.0).unwrap();
    let mut run = Simulation::builder(Elastic, container).disks(disks).build().unwrap();
    for _ in 0..3000 {
        run.step_until(1.0, &mut ()).unwrap();
    }
    assert!(deepest(&run.disks()) < 1e-9);
}
