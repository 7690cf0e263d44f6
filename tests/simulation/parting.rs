//! Disks that touch after a collision part. None collides again at once for a rounding of its velocity.

use granular_edmd::boundary::Container;
use granular_edmd::collision::{CollisionRule, Contact, Frictional, Impulse, Smooth, from_fn};
use granular_edmd::glam::DVec2;
use granular_edmd::simulation::RunError;
use granular_edmd::{Disk, Simulation};
use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use support::cases::few;

fn generator(seed: u64) -> Xoshiro256PlusPlus {
    Xoshiro256PlusPlus::seed_from_u64(seed)
}

/// A rule that takes all of the closing speed.
fn sticky() -> impl CollisionRule + Clone {
    Smooth::from_restitution(0.0).unwrap()
}

fn unit(random: &mut Xoshiro256PlusPlus) -> DVec2 {
    loop {
        let vector = DVec2::new(random.random_range(-1.0..1.0), random.random_range(-1.0..1.0));
        if vector.length() > 0.1 && vector.length() < 1.0 {
            return vector.normalize();
        }
    }
}

/// Returns two disks in the middle of a box of this width, which will collide obliquely and move together at
/// any velocity besides.
fn pair(random: &mut Xoshiro256PlusPlus, width: f64, masses: [f64; 2]) -> [Disk; 2] {
    let middle = DVec2::splat(0.5 * width) + unit(random) * random.random_range(0.0..0.2) * width;
    let normal = unit(random);
    let along = normal.perp() * random.random_range(-2.0..2.0);
    let together = unit(random) * random.random_range(0.0..3.0);
    let disk = |side: f64, mass: f64| {
        let disk = Disk::new(middle + side * normal * 0.7, 0.5).unwrap().with_mass(mass).unwrap();
        disk.with_velocity(together - side * (normal + along) * 0.4).unwrap()
    };
    [disk(1.0, masses[0]), disk(-1.0, masses[1])]
}

/// A smooth box: its walls are elastic for disks, so that all loss is that of the pair.
fn smooth_box(width: f64) -> Container {
    use granular_edmd::boundary::Wall;
    let walls = [Wall::Floor, Wall::Lid, Wall::Left, Wall::Right];
    let closed = Container::closed(width, width).unwrap();
    walls
        .into_iter()
        .fold(closed, |walls, wall| walls.with_rule(wall, granular_edmd::collision::Elastic).unwrap())
}

#[test]
fn two_lone_disks_without_restitution_never_stall() {
    let mut random = generator(1);
    let mut collided = 0;
    for case in 0..1000 {
        let disks = pair(&mut random, 20.0, [1.0, 1.0]);
        let mut run = Simulation::builder(sticky(), smooth_box(20.0)).disks(disks).build().unwrap();
        let end = run.run_until(200.0, &mut ());
        assert!(end.is_ok(), "case {case}: {}", end.unwrap_err());
        collided += u64::from(run.counters().disk_collisions > 0);
        assert!(run.counters().max_overlap < 1e-12, "case {case}: {:?}", run.counters());
    }
    assert!(collided > 600, "{collided}");
}

/// A light disk between a heavy one and a wall does collapse, but nothing else does.
fn is_squeezed(disks: &[Disk], width: f64) -> bool {
    let wall = |disk: &Disk| {
        let DVec2 { x, y } = disk.position();
        x.min(y).min(width - x).min(width - y) - disk.radius()
    };
    let gap = (disks[0].position() - disks[1].position()).length() - 1.0;
    gap < 1e-3 && disks.iter().map(wall).fold(f64::INFINITY, f64::min) < 1e-3
}

#[test]
fn no_pair_stalls_whatever_its_masses_and_its_box() {
    for (width, masses) in [(20.0, [1.0, 1e6]), (20.0, [1e-6, 1e6]), (1e5, [1.0, 1.0]), (1e5, [1.0, 1e6])] {
        let mut random = generator(2);
        let rule = Frictional::from_restitution(0.0, 0.0, 0.5).unwrap();
        for case in few(0..200, 5) {
            let disks = pair(&mut random, width, masses);
            let builder = Simulation::builder(rule, smooth_box(width)).disks(disks);
            let mut run = builder.build().unwrap();
            if let Err(error) = run.run_until(100.0, &mut ()) {
                assert!(is_squeezed(&run.disks(), width), "{width} {masses:?} case {case}: {error}");
            }
        }
    }
}

#[test]
fn a_disk_that_sticks_to_walls_slides_along_them() {
    let mut random = generator(3);
    for case in 0..1000 {
        let disk = Disk::new(DVec2::splat(10.0) + 8.0 * unit(&mut random), 0.5).unwrap();
        let disk = disk.with_velocity(unit(&mut random) * random.random_range(0.1..10.0)).unwrap();
        let container = Container::closed(20.0, 20.0).unwrap();
        let mut run = Simulation::builder(sticky(), container).disks([disk]).build().unwrap();
        let end = run.run_until(300.0, &mut ());
        assert!(end.is_ok(), "case {case}: {}", end.unwrap_err());
        assert!(run.counters().max_wall_overlap < 1e-12, "case {case}: {:?}", run.counters());
    }
}

/// Three disks may collapse by physics, at restitutions below 0.07. They do not at 0.3, however often they
/// collide.
#[test]
fn three_disks_above_the_restitution_of_collapse_never_stall() {
    let mut random = generator(4);
    for case in 0..300 {
        let [first, second] = pair(&mut random, 20.0, [1.0, 1.0]);
        let at = first.position() + 1.3 * (first.position() - second.position()).normalize();
        let third = Disk::new(at, 0.5).unwrap().with_velocity(second.velocity() * 0.5).unwrap();
        let rule = Smooth::from_restitution(0.3).unwrap();
        let builder = Simulation::builder(rule, smooth_box(20.0)).disks([first, second, third]);
        let Ok(mut run) = builder.build() else { continue };
        let end = run.run_until(100.0, &mut ());
        assert!(end.is_ok(), "case {case}: {}", end.unwrap_err());
    }
}

/// Sum of momenta and of kinetic energies.
fn balance(disks: &[Disk]) -> (DVec2, f64) {
    let momentum = disks.iter().map(|disk| disk.mass() * disk.velocity()).sum();
    (momentum, disks.iter().map(Disk::translational_energy).sum())
}

#[test]
fn what_makes_disks_part_changes_neither_momentum_nor_energy() {
    let mut random = generator(5);
    for case in 0..2000 {
        let masses = [[1.0, 1.0], [1.0, 1e6], [3.0, 0.2]][case % 3];
        let disks = pair(&mut random, 1e3, masses);
        let mut run = Simulation::builder(sticky(), smooth_box(1e3)).disks(disks).build().unwrap();
        let (before, _) = balance(&disks);
        while run.counters().disk_collisions + run.counters().wall_collisions == 0 {
            run.step_until(run.time() + 10.0, &mut ()).unwrap();
        }
        if run.counters().wall_collisions > 0 {
            continue;
        }
        let after = run.disks();
        // The closing speed is gone, and everything else stays.
        let normal = (after[0].position() - after[1].position()).normalize();
        let reduced = masses[0] * masses[1] / (masses[0] + masses[1]);
        let closing = (disks[1].velocity() - disks[0].velocity()).dot(normal);
        let expected = balance(&disks).1 - 0.5 * reduced * closing * closing;
        let (momentum, energy) = balance(&after);
        let scale: f64 = after.iter().map(|disk| disk.mass() * disk.velocity().length()).sum();
        assert!(
            (momentum - before).length() <= 8.0 * f64::EPSILON * scale,
            "case {case}: {momentum} {before}"
        );
        assert!((energy / expected - 1.0).abs() < 1e-12, "case {case}: {energy:e} {expected:e}");
    }
}

/// A rule that lets disks pass through each other wants them to close on. The engine does not overrule it.
#[test]
fn a_rule_without_an_impulse_is_left_alone() {
    let ghost = from_fn(|_: &Contact| Impulse::new(0.0, 0.0));
    let mut random = generator(6);
    for case in few(0..50, 5) {
        let disks = pair(&mut random, 20.0, [1.0, 1.0]);
        let mut run = Simulation::builder(ghost, smooth_box(20.0)).disks(disks).build().unwrap();
        if let Err(error) = run.run_until(2.0, &mut ()) {
            assert!(matches!(error, RunError::Stalled { .. }), "case {case}: {error}");
        }
        if run.counters().wall_collisions > 0 {
            continue;
        }
        for (before, after) in disks.iter().zip(run.disks()) {
            assert_eq!(before.velocity(), after.velocity(), "case {case}");
        }
    }
}
