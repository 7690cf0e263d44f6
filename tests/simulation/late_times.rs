//! Times so late that they are coarse: such a run is refused or ended, and never frozen. Late times that are
//! allowed.

use std::time::{Duration, Instant};

use granular_edmd::boundary::{Boundary, Container, Probe, Thermal, Wall};
use granular_edmd::collision::{Elastic, Smooth};
use granular_edmd::glam::DVec2;
use granular_edmd::observable::{Collision, Observer, Snapshot};
use granular_edmd::simulation::{BuildError, RunError};
use granular_edmd::wall::{BiParabolic, Sawtooth, Sinusoidal};
use granular_edmd::{Disk, Simulation, initial};

fn pair(speed: f64) -> [Disk; 2] {
    let disk = |x: f64, velocity: DVec2| {
        Disk::new(DVec2::new(x, 5.0), 0.5).unwrap().with_velocity(velocity).unwrap()
    };
    [disk(3.0, speed * DVec2::new(0.6, 0.8)), disk(7.0, speed * DVec2::new(-0.8, 0.6))]
}

#[test]
fn times_too_far_apart_are_refused_at_once() {
    for (start, speed) in
        [(1e18, 1.0), (1e15, 700.0), (1e12, 1.1e6), (1e9, 3e9), (-1e18, 1.0), (f64::MAX, 1e-9)]
    {
        let began = Instant::now();
        let builder = Simulation::builder(Elastic, Container::closed(10.0, 10.0).unwrap()).disks(pair(speed));
        match builder.starting_at(start).build() {
            Err(BuildError::StartTime { start: named, spacing, epoch }) => {
                assert_eq!(named, start);
                assert!(64.0 * spacing > epoch);
            }
            Err(error) => panic!("{start:e} {speed:e}: {error}"),
            Ok(mut run) => {
                let end = start + 1e6 * (10.0 / speed).max(f64::EPSILON * start.abs());
                let error = run.run_until(end, &mut ()).unwrap_err();
                assert!(matches!(error, RunError::TimeTooLate { .. }), "{start:e} {speed:e}: {error}");
            }
        }
        assert!(began.elapsed() < Duration::from_secs(1), "{start:e} {speed:e}");
    }
}

/// The disks become faster on the way: the run begins well, and ends with an error when it cannot go on.
#[test]
fn disks_that_become_too_fast_for_their_time_end_the_run() {
    let hot = |temperature| {
        let walls = Container::closed(10.0, 10.0).unwrap();
        walls.with_temperature(Wall::Floor, Thermal::new(temperature).unwrap()).unwrap()
    };
    for (start, temperature) in [(1e12, 1e12), (1e9, 1e20), (1e15, 1e8), (1.0, 1e40)] {
        let began = Instant::now();
        let builder = Simulation::builder(Elastic, hot(temperature)).disks(pair(0.1)).starting_at(start);
        let Ok(mut run) = builder.build() else { continue };
        let error = loop {
            let end = run.time() + 1.0;
            match run.step_until(end, &mut ()) {
                Ok(_) => assert!(
                    began.elapsed() < Duration::from_secs(2),
                    "{start:e} {temperature:e}: {}",
                    run.time()
                ),
                Err(error) => break error,
            }
        };
        assert!(matches!(error, RunError::TimeTooLate { .. }), "{start:e} {temperature:e}: {error}");
        assert!(run.disks().iter().all(|disk| disk.position().is_finite()));
    }
}

/// Asserts that time never goes back and disks stay inside.
struct Watch {
    last: f64,
    next: f64,
    step: f64,
    walls: Container,
    deepest: f64,
}

impl Watch {
    fn see(&mut self, time: f64) {
        assert!(time >= self.last, "{time} after {}", self.last);
        self.last = time;
    }
}

impl Observer for Watch {
    fn on_collision(&mut self, collision: &Collision) {
        self.see(collision.time);
    }
    fn next_sample(&self) -> f64 {
        self.next
    }
    fn on_sample(&mut self, snapshot: &Snapshot<'_>) {
        self.see(snapshot.time());
        let domain = self.walls.domain();
        for disk in snapshot.disks() {
            let DVec2 { x, y } = disk.position();
            let out = (domain.left - x).max(x - domain.right).max(domain.bottom - y).max(y - domain.top);
            self.deepest = self.deepest.max(out + disk.radius());
        }
        self.next += self.step;
    }
}

#[test]
fn disks_stay_in_the_box_at_all_times_that_are_allowed() {
    for start in [-1e12, 0.0, 1e7, 1e11, 1e12, 3e12, 1e13] {
        for (case, gravity) in [(0, 0.0), (1, 0.5), (2, 0.5), (3, 1.0)] {
            let closed = Container::closed(12.0, 10.0).unwrap();
            let walls = match case {
                0 => closed.with_motion(Wall::Floor, Sinusoidal::new(0.1, 10.0).unwrap()),
                1 => closed.with_motion(Wall::Floor, BiParabolic::new(0.1, 10.0).unwrap()),
                2 => closed.with_temperature(Wall::Floor, Thermal::new(4.0).unwrap()),
                _ => closed.with_motion(Wall::Floor, Sawtooth::new(0.1, 3.0).unwrap()),
            };
            let walls = walls.unwrap();
            let disks = initial::lattice(&walls, 12, 0.5).unwrap();
            let disks = initial::with_maxwellian_velocities(disks, 1.0, 7).unwrap();
            let rule = Smooth::from_inelasticity(0.05).unwrap();
            let builder =
                Simulation::builder(rule, walls.clone()).disks(disks).gravity(gravity).starting_at(start);
            let mut run = match builder.build() {
                Ok(run) => run,
                Err(BuildError::StartTime { .. }) => continue,
                Err(error) => panic!("{start:e}: {error}"),
            };
            let step = 0.25;
            let mut watch = Watch { last: start, next: start, step, walls, deepest: f64::NEG_INFINITY };
            match run.run_until(start + 200.0, &mut watch) {
                Ok(_) | Err(RunError::TimeTooLate { .. } | RunError::Stalled { .. }) => {}
                Err(error) => panic!("{start:e} {case}: {error}"),
            }
            // Walls are where they are at times that are rounded. A disk misses a wall by its speed times
            // that rounding.
            let rounding = 16.0 * f64::EPSILON * start.abs() + 1e-12;
            assert!(watch.deepest < rounding, "{start:e} {case}: {:e}", watch.deepest);
            assert!(run.counters().max_wall_overlap < rounding, "{start:e} {case}: {:?}", run.counters());
            assert!(run.counters().max_overlap < 1e-11, "{start:e} {case}: {:?}", run.counters());
        }
    }
}

/// Returns seven disks. The first will reach the floor after going some diameters, and the others not before.
fn slow_disks(speed: f64, seed: u64) -> Vec<Disk> {
    let disk = |k: u32| {
        let shift = 1e-2 * seed as f64;
        let (place, velocity) = match k {
            0 => (DVec2::new(5.0, 2.6 + shift), DVec2::new(0.2, -1.0 - shift)),
            k => {
                (DVec2::new(1.3 * f64::from(k), 5.0 + f64::from(k % 3)), DVec2::new(0.1 * f64::from(k), 0.5))
            }
        };
        Disk::new(place, 0.5).unwrap().with_velocity(speed * velocity).unwrap()
    };
    (0..7).map(disk).collect()
}

/// A hot wall kicks a disk late in the long epoch of slow disks. The disk keeps its place.
#[test]
fn a_kick_late_in_a_long_epoch_moves_no_disk() {
    for (slow, temperature) in [(1e-9, 1.0), (1e-12, 1.0), (1e-6, 1e6), (1e-3, 1e10)] {
        for seed in 0..20 {
            let thermal = Thermal::new(temperature).unwrap().with_slip();
            let walls = Container::closed(10.0, 10.0).unwrap();
            let walls = walls.with_temperature(Wall::Floor, thermal).unwrap();
            let disks = slow_disks(slow, seed);
            let builder = Simulation::builder(Elastic, walls.clone()).disks(disks).seed(seed);
            let mut run = builder.build().unwrap();
            for _ in 0..2000 {
                let end = run.time() + 100.0 / slow;
                match run.step_until(end, &mut ()) {
                    Ok(_) => {}
                    Err(RunError::TimeTooLate { .. }) => break,
                    Err(error) => panic!("{slow:e} {temperature:e}: {error}"),
                }
                for disk in run.disks() {
                    let overlap = walls
                        .overlap(&Probe::new(disk.position(), 0.5, 0.0))
                        .map_or(0.0, |overlap| overlap.depth);
                    assert!(overlap < 1e-12, "{slow:e} {temperature:e} {seed}: {overlap:e}");
                }
            }
            let counters = run.counters();
            assert!(counters.wall_collisions > 10, "{slow:e} {temperature:e} {seed}: {counters:?}");
            assert!(counters.max_overlap < 1e-12, "{slow:e} {temperature:e} {seed}: {counters:?}");
            assert!(counters.max_wall_overlap < 1e-12, "{slow:e} {temperature:e} {seed}: {counters:?}");
        }
    }
}

/// A hot wall kicks a disk at so late a time that the disk would be elsewhere at the next number. The run
/// ends before the kick.
#[test]
fn a_kick_too_fast_for_its_time_moves_no_disk() {
    for (start, slow, temperature) in
        [(1e12, 1e-3, 1e30), (1e15, 1e-4, 1e20), (1e30, 1e-17, 1.0), (1e7, 1.0, 1e40)]
    {
        let walls = Container::closed(10.0, 10.0).unwrap();
        let walls = walls.with_temperature(Wall::Floor, Thermal::new(temperature).unwrap()).unwrap();
        let disks = slow_disks(slow, 1);
        let builder = Simulation::builder(Elastic, walls).disks(disks.clone()).starting_at(start);
        let mut run = builder.build().unwrap();
        let error = run.run_until(start + 10.0 / slow, &mut ()).unwrap_err();
        assert!(matches!(error, RunError::TimeTooLate { .. }), "{start:e}: {error}");
        assert_eq!(run.counters().wall_collisions, 0, "{start:e}");
        let flown = run.time() - start;
        for (before, after) in disks.iter().zip(run.disks()) {
            assert_eq!(before.velocity(), after.velocity());
            let expected = before.position() + flown * before.velocity();
            // Times are rounded to at least 64 numbers in an epoch, in which disks go some tens of diameters.
            assert!((after.position() - expected).length() < 2.0, "{start:e}: {after:?} {expected}");
        }
    }
}

/// Gravity is too strong for the present time if the next time after it is far below the floor for a falling
/// disk.
#[test]
fn gravity_too_strong_for_the_time_is_refused() {
    for (start, gravity) in [(1e7, 1e20), (1e12, 1e10), (1e12, -1e10), (1.0, 1e40)] {
        let builder = Simulation::builder(Elastic, Container::closed(10.0, 10.0).unwrap()).disks(pair(1.0));
        let mut run = builder.starting_at(start).build().unwrap();
        run.run_until(start + 0.3, &mut ()).unwrap();
        let before = run.disks();
        let error = run.set_gravity(gravity).unwrap_err();
        assert!(error.to_string().contains("tell times apart"), "{error}");
        assert_eq!((run.gravity(), run.disks()), (0.0.into(), before));
        run.set_gravity(1.0).unwrap();
        run.run_until(start + 5.0, &mut ()).unwrap();
    }
}
