//! An elastic gas of disks of given radii in a square box.

use std::f64::consts::PI;
use std::time::Instant;

use granular_edmd::boundary::Container;
use granular_edmd::collision::Elastic;
use granular_edmd::glam::DVec2;
use granular_edmd::{Disk, Simulation, initial};
use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

use crate::common::Outcome;

const AREA_FRACTION: f64 = 0.4;

/// Gap between disks at the start, relative to the distance at which they touch.
const GAP: f64 = 1e-6;

/// A gas that runs.
pub(crate) struct Gas(Simulation<Elastic>);

impl Gas {
    /// Places disks of these radii at random in a box of this side, and lets each collide so often.
    pub(crate) fn of(radii: Vec<f64>, side: f64, settle: f64) -> Outcome<Self> {
        let settle = (0.5 * settle * radii.len() as f64) as u64;
        let disks = initial::with_maxwellian_velocities(placed(radii, side)?, 1.0, 1)?;
        let container = Container::closed(side, side)?;
        let mut gas = Self(Simulation::builder(Elastic, container).disks(disks).build()?);
        gas.collide(settle)?;
        Ok(gas)
    }

    /// Returns the seconds of so many collisions.
    pub(crate) fn seconds_for(&mut self, collisions: u32) -> Outcome<f64> {
        let start = Instant::now();
        self.collide(u64::from(collisions))?;
        Ok(start.elapsed().as_secs_f64())
    }

    fn collide(&mut self, collisions: u64) -> Outcome<()> {
        let last = self.0.counters().collisions + collisions;
        while self.0.counters().collisions < last {
            self.0.step_until(self.0.time() + 1.0, &mut ())?;
        }
        Ok(())
    }

    /// Returns the passages between cells and the outdated predictions per collision.
    pub(crate) fn bookkeeping(&self) -> (f64, f64) {
        let counters = self.0.counters();
        let per_collision = |events: u64| events as f64 / counters.collisions as f64;
        (per_collision(counters.cell_crossings), per_collision(counters.repredictions))
    }
}

/// Returns the side of a box in which these disks have the area fraction of the bench.
pub(crate) fn side_for(radii: &[f64]) -> f64 {
    let area: f64 = radii.iter().map(|radius| PI * radius * radius).sum();
    let largest = radii.iter().copied().fold(0.0, f64::max);
    (area / AREA_FRACTION).sqrt().max(3.0 * largest)
}

/// Places disks one after the other at random, the largest first.
fn placed(mut radii: Vec<f64>, side: f64) -> Outcome<Vec<Disk>> {
    radii.sort_by(|a, b| b.total_cmp(a));
    let mut generator = Xoshiro256PlusPlus::seed_from_u64(7);
    let mut bins = Bins::new(side, radii[radii.len() / 2]);
    let place = |radius: f64| {
        let mut random = || radius + (side - 2.0 * radius) * generator.random::<f64>();
        let position = std::iter::repeat_with(|| DVec2::new(random(), random()));
        let free = position.take(1_000_000).find(|&position| bins.is_free(position, radius));
        let position = free.ok_or("there is no room for the disks")?;
        bins.add(position, radius);
        Ok(Disk::new(position, radius)?.with_mass(4.0 * radius * radius)?)
    };
    radii.into_iter().map(place).collect()
}

/// The disks that lie at least partly in each of some squares.
struct Bins {
    squares: Vec<Vec<(DVec2, f64)>>,
    count: usize,
    side: f64,
}

impl Bins {
    fn new(side: f64, radius: f64) -> Self {
        let count = (side / (2.0 * radius)).ceil().max(1.0);
        Self {
            squares: vec![Vec::new(); (count * count) as usize],
            count: count as usize,
            side: side / count,
        }
    }

    /// Returns the squares in which a disk lies.
    fn squares_of(&self, position: DVec2, radius: f64) -> impl Iterator<Item = usize> + use<> {
        let (count, reach) = (self.count, radius * (1.0 + GAP));
        let (side, last) = (self.side, count - 1);
        let span = move |x: f64| ((x - reach) / side) as usize..=(((x + reach) / side) as usize).min(last);
        let (columns, rows) = (span(position.x), span(position.y));
        columns.flat_map(move |column| rows.clone().map(move |row| column * count + row))
    }

    fn is_free(&self, position: DVec2, radius: f64) -> bool {
        self.squares_of(position, radius).all(|square| {
            let touches =
                |&(other, size): &(DVec2, f64)| other.distance(position) < (size + radius) * (1.0 + GAP);
            !self.squares[square].iter().any(touches)
        })
    }

    fn add(&mut self, position: DVec2, radius: f64) {
        for square in self.squares_of(position, radius) {
            self.squares[square].push((position, radius));
        }
    }
}
