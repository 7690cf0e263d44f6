//! An elastic gas of disks of given radii in a square box.

use std::f64::consts::PI;
use std::time::Instant;

use granular_edmd::boundary::Container;
use granular_edmd::collision::Elastic;
use granular_edmd::{Disk, Simulation, initial};

use benches::Outcome;

const AREA_FRACTION: f64 = 0.4;

/// A running gas.
pub(crate) struct Gas(Simulation<Elastic>);

impl Gas {
    /// Places disks of these radii at random in a box of this side, and lets each disk collide `settle`
    /// times.
    pub(crate) fn of(radii: Vec<f64>, side: f64, settle: f64) -> Outcome<Self> {
        let settle = (0.5 * settle * radii.len() as f64) as u64;
        let disks = initial::with_maxwellian_velocities(placed(radii, side)?, 1.0, 1)?;
        let container = Container::closed(side, side)?;
        let mut gas = Self(Simulation::builder(Elastic, container).disks(disks).build()?);
        gas.collide(settle)?;
        Ok(gas)
    }

    /// Returns the seconds for `collisions` collisions.
    pub(crate) fn seconds_for(&mut self, collisions: u32) -> Outcome<f64> {
        let start = Instant::now();
        self.collide(u64::from(collisions))?;
        Ok(start.elapsed().as_secs_f64())
    }

    fn collide(&mut self, collisions: u64) -> Outcome<()> {
        let last = self.0.counters().disk_collisions + collisions;
        while self.0.counters().disk_collisions < last {
            self.0.step_until(self.0.time() + 1.0, &mut ())?;
        }
        Ok(())
    }

    /// Returns the passages between cells and the outdated predictions per collision.
    pub(crate) fn bookkeeping(&self) -> (f64, f64) {
        let counters = self.0.counters();
        let per_collision = |events: u64| events as f64 / counters.disk_collisions as f64;
        (per_collision(counters.cell_crossings), per_collision(counters.repredictions))
    }
}

/// Returns the side of a box in which these disks have the area fraction of this measurement.
pub(crate) fn side_for(radii: &[f64]) -> f64 {
    let area: f64 = radii.iter().map(|radius| PI * radius * radius).sum();
    let largest = radii.iter().copied().fold(0.0, f64::max);
    (area / AREA_FRACTION).sqrt().max(3.0 * largest)
}

/// Places disks one after the other at random, the largest first.
fn placed(mut radii: Vec<f64>, side: f64) -> Outcome<Vec<Disk>> {
    radii.sort_by(|a, b| b.total_cmp(a));
    let disks = initial::disks_from_radii(radii, 1.0)?;
    Ok(initial::scattered_mix(&Container::closed(side, side)?, disks, side, 7)?)
}
