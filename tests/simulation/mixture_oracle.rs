//! Mixtures of any sizes against brute force: between two events all pairs are looked at, and none may have
//! met.

use granular_edmd::boundary::{Boundary, Container, Wall};
use granular_edmd::collision::Elastic;
use granular_edmd::glam::DVec2;
use granular_edmd::simulation::Event;
use granular_edmd::wall::BiParabolic;
use granular_edmd::{Disk, Simulation, initial};
use oracles::{meeting, rounding};
use rand::{Rng, RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use support::cases::few;

#[derive(Debug, Clone, Copy)]
enum Sides {
    Closed,
    Open,
    /// Periodic sides, ends, or both.
    Periodic(bool, bool),
}

/// The parts of a system.
#[derive(Debug)]
struct Mixture {
    sides: Sides,
    radii: Vec<f64>,
    /// Width in diameters of the largest disk, if that is not too narrow.
    width: f64,
    filling: f64,
    gravity: f64,
    seed: u64,
}

impl Mixture {
    fn random(seed: u64) -> Self {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
        let ratio = 1000.0_f64.powf(random.random());
        let count = random.random_range(2..70);
        let law = random.random_range(0..4);
        let sides = match random.random_range(0..6) {
            0 => Sides::Closed,
            1 => Sides::Open,
            2 | 3 => Sides::Periodic(true, false),
            4 => Sides::Periodic(false, true),
            _ => Sides::Periodic(true, true),
        };
        let gravity = [0.0, 0.05, 0.0, -0.02][random.random_range(0..4)];
        Self {
            sides,
            radii: (0..count).map(|k| 0.5 * size(law, ratio, k, &mut random)).collect(),
            width: 4.05 * 5.0_f64.powf(random.random()),
            filling: random.random_range(0.02..0.5),
            gravity: match sides {
                // Disks that fly out of an open container must fall back.
                Sides::Open => 0.05,
                // Disks that fall forever, without friction, lose the digits of their places.
                Sides::Periodic(_, true) => 0.0,
                _ => gravity,
            },
            seed,
        }
    }

    fn build(&self) -> Simulation<Elastic> {
        let area: f64 = self.radii.iter().map(|radius| std::f64::consts::PI * radius * radius).sum();
        let largest = self.radii.iter().copied().fold(0.0, f64::max);
        let width = self.width * 2.0 * largest;
        let lowest = if matches!(self.sides, Sides::Periodic(_, true)) { 8.1 } else { 2.1 };
        let mut height = (area / self.filling / width).max(lowest * largest);
        loop {
            let container = self.container(width, height);
            if let Ok(disks) = initial::scattered_mix(&container, self.disks(), height, self.seed) {
                let disks = initial::with_maxwellian_velocities(disks, 1.0, self.seed).unwrap();
                let builder = Simulation::builder(Elastic, container).disks(disks);
                return builder.gravity(self.gravity).build().unwrap();
            }
            height *= 1.2;
        }
    }

    fn disks(&self) -> Vec<Disk> {
        let mut radii = self.radii.clone();
        radii.sort_by(|a, b| b.total_cmp(a));
        let disk = |radius: f64| Disk::new(DVec2::ZERO, radius).unwrap().with_mass(4.0 * radius * radius);
        radii.into_iter().map(|radius| disk(radius).unwrap()).collect()
    }

    fn container(&self, width: f64, height: f64) -> Container {
        let base = BiParabolic::new(0.1, 10.0).unwrap();
        let closed = Container::closed(width, height).unwrap();
        match self.sides {
            Sides::Closed => closed,
            Sides::Open => Container::open(width).unwrap().with_motion(Wall::Floor, base).unwrap(),
            Sides::Periodic(true, true) => Container::periodic(width, height).unwrap(),
            Sides::Periodic(true, false) => closed.with_periodic_sides().unwrap(),
            Sides::Periodic(false, ends) => {
                assert!(ends);
                closed.with_periodic_ends().unwrap()
            }
        }
    }
}

/// Returns a size from 1 to `ratio`: two sizes, one intruder, a power law, or all alike.
fn size(law: u32, ratio: f64, k: usize, random: &mut impl Rng) -> f64 {
    match law {
        0 if random.random::<f64>() < 0.1 => ratio,
        1 if k == 0 => ratio,
        2 => (1.0 - random.random::<f64>() * (1.0 - ratio.powi(-2))).powf(-0.5),
        3 => ratio.powf(random.random()),
        _ => 1.0,
    }
}

/// Runs a random mixture for this many events, and looks at all pairs at each event.
fn check(seed: u64, events: u32) {
    let mixture = Mixture::random(seed);
    let mut run = mixture.build();
    let domain = run.boundary().domain();
    for _ in 0..events {
        let (before, since) = (run.disks(), run.time());
        let event = run.step_until(since + 1e3, &mut ()).unwrap();
        let passed = run.time() - since;
        let met = meeting(&domain, &before, passed);
        assert!(met.is_none(), "{met:?} {mixture:?}");
        match event {
            Some(Event::Collision { disk, partner }) => {
                let (a, b) = (run.disk(disk).unwrap(), run.disk(partner).unwrap());
                let gap = domain.separation(a.position(), b.position()).length() - a.radius() - b.radius();
                let allowed = rounding(&before)(a.radius() + b.radius());
                assert!(gap.abs() < allowed, "no touch: {gap:e} {mixture:?}");
            }
            Some(_) => {}
            None => return,
        }
    }
}

#[test]
fn no_pair_meets_unseen() {
    for seed in few(0..200, 10) {
        check(seed, 300);
    }
}

/// The same for thousands of mixtures. `MIXTURES` says how many, `MIXTURE_SEED` which is the first.
#[test]
#[ignore = "takes minutes"]
fn no_pair_meets_unseen_in_thousands_of_mixtures() {
    let number = |name| std::env::var(name).ok().and_then(|text| text.parse::<u64>().ok());
    let first = number("MIXTURE_SEED").unwrap_or(1000);
    for seed in first..first + number("MIXTURES").unwrap_or(4000) {
        check(seed, 4000);
    }
}
