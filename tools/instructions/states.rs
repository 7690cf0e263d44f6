//! Settled elastic gases of a thousand disks, with the same bits in every program.

use std::f64::consts::PI;

use benches::Outcome;
use granular_edmd::boundary::{Boundary, Container};
use granular_edmd::collision::Elastic;
use granular_edmd::glam::DVec2;
use granular_edmd::initial::{disks_from_radii, even_lattice, scattered_mix, with_maxwellian_velocities};
use granular_edmd::simulation::Limits;
use granular_edmd::{Disk, Simulation};

const DISKS: usize = 1000;
/// Number of collisions of each disk after which a gas has forgotten its lattice.
const COLLISIONS: u64 = 100;

/// Returns equal disks at this area fraction, at most 0.766, periodic on all sides.
pub(crate) fn gas(area_fraction: f64) -> Outcome<Simulation<Elastic>> {
    let side = side(DISKS as f64, area_fraction);
    let container = Container::periodic(side, side)?;
    let disks = even_lattice(&container, DISKS, 0.5)?;
    settled(container, disks)
}

/// Returns disks of two sizes, in the ratio 1 to 10, each with about half of the disks' area, at the area
/// fraction 0.4, periodic on all sides.
pub(crate) fn mixture() -> Outcome<Simulation<Elastic>> {
    let large = DISKS / 101;
    let small = DISKS - large;
    let side = side(small as f64 + 100.0 * large as f64, 0.4);
    let container = Container::periodic(side, side)?;
    let radii = std::iter::repeat_n(5.0, large).chain(std::iter::repeat_n(0.5, small));
    let disks = scattered_mix(&container, disks_from_radii(radii, 1.0)?, side, 7)?;
    settled(container, disks)
}

/// Returns equal disks in a square vessel with 36 round pegs, at the area fraction 0.4.
pub(crate) fn vessel() -> Outcome<Simulation<Elastic>> {
    let side = side(DISKS as f64, 0.4);
    let peg = |peg: u32| {
        let place = DVec2::new(f64::from(peg % 6) + 0.5, f64::from(peg / 6) + 0.5);
        Disk::new(side / 6.0 * place, 0.25)
    };
    let pegs = (0..36).map(peg).collect::<Result<Vec<_>, _>>()?;
    let container = Container::closed(side, side)?.with_pegs(pegs)?;
    let disks = even_lattice(&container, DISKS, 0.5)?;
    settled(container, disks)
}

/// Returns the side of a square in which `disks` disks of diameter 1 have this area fraction.
fn side(disks: f64, area_fraction: f64) -> f64 {
    (0.25 * PI * disks / area_fraction).sqrt()
}

fn settled<B: Boundary>(boundary: B, disks: Vec<Disk>) -> Outcome<Simulation<Elastic, B>> {
    let disks = with_maxwellian_velocities(disks, 1.0, 1)?;
    let collisions = COLLISIONS * disks.len() as u64 / 2;
    let mut run = Simulation::builder(Elastic, boundary).disks(disks).build()?;
    run.run(&Limits::until(f64::MAX).with_most_collisions(collisions), &mut ())?;
    Ok(run)
}
