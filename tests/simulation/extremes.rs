//! Systems of extreme numbers, and changes of everything between runs. Each gives an error that names its
//! cause, or physics.

use granular_edmd::boundary::{Boundary, Container, Thermal, Wall};
use granular_edmd::collision::{CollisionRule, Elastic, Frictional, Smooth};
use granular_edmd::glam::DVec2;
use granular_edmd::simulation::BuildError;
use granular_edmd::wall::{BiParabolic, Sinusoidal};
use granular_edmd::{Disk, Gravity, Simulation};
use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

use support::schedulers::{SCHEDULERS, Scheduler};

type Rule = std::sync::Arc<dyn CollisionRule>;
type Run = Simulation<Rule, Container, Scheduler>;

struct Random(Xoshiro256PlusPlus);

impl Random {
    fn new(seed: u64) -> Self {
        Self(Xoshiro256PlusPlus::seed_from_u64(seed))
    }

    /// A number of any of these decades.
    fn decade(&mut self, low: f64, high: f64) -> f64 {
        10_f64.powf(self.0.random_range(low..high))
    }

    fn chance(&mut self, of: u32) -> bool {
        self.0.random_range(0..of) == 0
    }

    fn rule(&mut self) -> Rule {
        match self.0.random_range(0..3) {
            0 => std::sync::Arc::new(Elastic),
            1 => std::sync::Arc::new(Smooth::from_inelasticity(self.0.random_range(0.0..=0.5)).unwrap()),
            _ => {
                let inelasticity = self.0.random_range(0.0..0.5);
                std::sync::Arc::new(Frictional::from_inelasticity(inelasticity, inelasticity, 0.3).unwrap())
            }
        }
    }

    fn walls(&mut self, size: f64) -> Container {
        let closed = if self.chance(4) { Container::open(size) } else { Container::closed(size, size) };
        let closed =
            if self.chance(4) { closed.unwrap().with_periodic_sides().unwrap() } else { closed.unwrap() };
        let wall = Wall::Floor;
        match self.0.random_range(0..4) {
            0 => {
                let motion = Sinusoidal::new(0.01 * size, self.decade(-3.0, 3.0)).unwrap();
                closed.with_motion(wall, motion).unwrap()
            }
            1 => {
                let motion = BiParabolic::new(0.01 * size, self.decade(-3.0, 3.0)).unwrap();
                closed.with_motion(wall, motion).unwrap()
            }
            2 => closed.with_temperature(wall, Thermal::new(self.decade(-30.0, 30.0)).unwrap()).unwrap(),
            _ => closed,
        }
    }

    fn disks(&mut self, size: f64) -> Vec<Disk> {
        let count = self.0.random_range(1..7);
        let (radius, speed) = (0.1 * size * self.decade(-3.0, 0.0), self.decade(-30.0, 30.0));
        let mut disk = |k: i32| {
            let place = DVec2::new(f64::from(k % 3), f64::from(k / 3)) * (0.3 * size) + 0.15 * size;
            let direction = DVec2::new(self.0.random_range(-1.0..1.0), self.0.random_range(-1.0..1.0));
            let disk = Disk::new(place, radius.clamp(1e-30, 1e30))?.with_mass(self.decade(-6.0, 6.0))?;
            let speed = if self.chance(5) { speed * self.decade(-20.0, 0.0) } else { speed };
            disk.with_velocity(speed * direction)?.with_angular_velocity(speed * direction.x)
        };
        (0..count).map(|k| disk(k).unwrap()).collect()
    }

    fn gravity(&mut self) -> Gravity {
        let strength = match self.0.random_range(0..5) {
            0 | 1 => 0.0,
            2 => self.decade(-300.0, 300.0),
            3 => -self.decade(-30.0, 30.0),
            _ => self.decade(-30.0, 30.0),
        };
        if self.chance(4) { Gravity::tilted(strength, 0.7).unwrap() } else { strength.into() }
    }
}

/// A time in which disks go some diameters.
fn short_while(run: &Run) -> f64 {
    let disks = run.disks();
    let diameter = disks.iter().map(|disk| 2.0 * disk.radius()).fold(f64::INFINITY, f64::min);
    let speed = disks.iter().map(|disk| disk.velocity().length()).fold(0.0, f64::max);
    let way = 20.0 * diameter;
    (way / (speed + (run.gravity().strength() * way).sqrt())).min(1e100)
}

/// Returns the depth by which disks are beyond the domain, in terms of their size, less what the rounding of
/// the time allows. A moving wall is where it is at a rounded time, and a disk goes some way in the rounding.
fn deepest(run: &Run) -> f64 {
    let domain = run.boundary().domain();
    let rounding = 2.0 * f64::EPSILON * run.time().abs();
    let depth = |disk: &Disk| {
        let DVec2 { x, y } = disk.position();
        let out = (domain.left - x).max(x - domain.right).max(domain.bottom - y).max(y - domain.top);
        (out - rounding * disk.velocity().length()) / disk.radius()
    };
    run.disks().iter().map(depth).fold(f64::NEG_INFINITY, f64::max)
}

fn assert_sound(run: &Run, case: u64) {
    for disk in run.disks() {
        let numbers =
            [disk.position().x, disk.position().y, disk.velocity().x, disk.velocity().y, disk.angle()];
        assert!(numbers.iter().all(|number| number.is_finite()), "{case}: {disk:?}");
    }
    assert!(run.time().is_finite());
    assert!(deepest(run) < 1e-6, "{case}: {:e} {:?} {:?}", deepest(run), run.counters(), run.disks());
}

/// Does some events, with a change now and then. All errors must be clear ones.
fn live(random: &mut Random, run: &mut Run, size: f64, case: u64) {
    for _ in 0..30 {
        for _ in 0..20 {
            let before = run.time();
            let end = run.time() + short_while(run);
            if run.step_until(end, &mut ()).is_err() {
                assert_sound(run, case);
                return;
            }
            // An epoch that begins for a kick, at a time that is twice its origin, may round the time down.
            assert!(run.time() >= before.next_down(), "{case}");
            assert_sound(run, case);
        }
        match random.0.random_range(0..8) {
            0 => run.set_rule(random.rule()),
            1 => drop(run.set_gravity(random.gravity())),
            2 => drop(run.set_boundary(random.walls(size))),
            _ => {}
        }
        assert_sound(run, case);
    }
}

fn try_systems(cases: std::ops::Range<u64>) -> usize {
    let mut built = 0;
    for case in cases {
        let mut random = Random::new(case);
        let size = random.decade(-20.0, 20.0);
        let start = if random.chance(3) { random.decade(-10.0, 15.0) } else { 0.0 };
        let scheduler = SCHEDULERS[case as usize % SCHEDULERS.len()]();
        let builder = Simulation::builder(random.rule(), random.walls(size)).disks(random.disks(size));
        match builder.gravity(random.gravity()).starting_at(start).scheduler(scheduler).build() {
            Ok(mut run) => {
                built += 1;
                live(&mut random, &mut run, size, case);
            }
            Err(
                BuildError::StartTime { .. }
                | BuildError::OverlapsWall { .. }
                | BuildError::Parameter(_)
                | BuildError::DomainTooSmall { .. },
            ) => {}
            Err(error) => panic!("{case}: {error}"),
        }
    }
    built
}

#[test]
fn extreme_systems_are_refused_or_run() {
    assert!(try_systems(0..300) > 100);
}

#[test]
#[ignore = "minutes: many more of them"]
fn many_extreme_systems_are_refused_or_run() {
    assert!(try_systems(1000..20_000) > 5000);
}

/// Far from the origin, positions have no digits for small disks.
#[test]
fn positions_that_are_too_coarse_are_refused() {
    let at = |far: f64| {
        let container = Container::closed(1e-4, 1e-4).unwrap().shifted(DVec2::splat(far)).unwrap();
        let disk = Disk::new(DVec2::splat(far + 5e-5), 1e-6).unwrap();
        Simulation::builder(Elastic, container).disks([disk]).build().map(drop)
    };
    assert!(at(1e3).is_ok());
    let refused = at(1e8).unwrap_err().to_string();
    assert!(refused.contains("spacing of positions"), "{refused}");
}

/// Dust beside a giant needs no epochs as short as the dust is fine: places in that box have no such digits.
#[test]
fn dust_beside_a_giant_costs_no_more_than_other_disks() {
    let place = |k: i32| DVec2::new(0.5 + f64::from(k % 5), 0.5 + f64::from(k / 5));
    let dust = (0..20).map(|k| {
        let way = DVec2::from_angle(f64::from(k));
        Disk::new(place(k), 1e-9).and_then(|disk| disk.with_velocity(way)).unwrap()
    });
    let giant = Disk::new(DVec2::new(7.0, 7.0), 2.0).unwrap().with_mass(1e6).unwrap();
    let container = Container::closed(10.0, 10.0).unwrap();
    let disks = std::iter::once(giant).chain(dust);
    let mut run = Simulation::builder(Elastic, container).disks(disks).build().unwrap();
    run.run_until(10.0, &mut ()).unwrap();
    assert!(run.counters().wall_collisions > 20, "{:?}", run.counters());
    assert!(run.counters().events() < 100_000, "{:?}", run.counters());
}
