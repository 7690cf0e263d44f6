//! Extreme and odd settings: no disks, no speed, no sign, and contact durations that are too long.

use granular_edmd::boundary::Container;
use granular_edmd::collision::{ContactDuration, Elastic, Smooth};
use granular_edmd::glam::DVec2;
use granular_edmd::simulation::Warning;
use granular_edmd::{Disk, Simulation, initial};

fn walls() -> Container {
    Container::closed(12.0, 10.0).unwrap()
}

fn gas(container: &Container, count: usize) -> Vec<Disk> {
    let disks = initial::lattice(container, count, 0.5).unwrap();
    initial::with_maxwellian_velocities(disks, 1.0, 3).unwrap()
}

/// Without disks, cells of any size will do, if the domain has room for them.
#[test]
fn boxes_without_disks_run_whatever_their_shape() {
    for (width, height) in [(20.0, 5.0), (5.0, 20.0), (1e3, 1e-3)] {
        let container = Container::periodic(width, height).unwrap();
        let mut run = Simulation::builder(Elastic, container).build().unwrap();
        run.run_until(3.0, &mut ()).unwrap();
        let disk = Disk::new(DVec2::new(0.5 * width, 0.5 * height), 0.1 * height.min(width)).unwrap();
        assert_eq!(run.insert([disk]).unwrap(), 0..1);
        assert_eq!(run.remove(|_, _| true).unwrap().len(), 1);
        run.run_until(6.0, &mut ()).unwrap();
        assert!(run.is_empty() && run.time() == 6.0);
    }
}

/// The slower the disks, the longer the epoch: there are never many.
#[test]
fn the_slowest_disks_take_few_events_to_the_last_times() {
    for (speed, end) in [(0.0, 1e278), (0.0, 1.7e308), (1e-100, 2.9e100), (1e-100, 1e103)] {
        let disk = |x: f64| Disk::new(DVec2::new(x, 5.0), 0.5).unwrap();
        let disks = [disk(2.0).with_velocity(DVec2::new(speed, 0.0)).unwrap(), disk(6.0)];
        let mut run = Simulation::builder(Elastic, walls()).disks(disks).build().unwrap();
        run.run_until(end, &mut ()).unwrap();
        let counters = run.counters();
        assert!(counters.events() < 5000 && counters.max_overlap < 1e-12, "{speed:e}: {counters:?}");
        let way = speed * end;
        if way < 3.0 {
            assert!(
                (run.disks()[0].position().x - 2.0 - way).abs() < 1e-12,
                "{speed:e} {:?}",
                run.disks()[0]
            );
        }
    }
}

#[test]
fn a_contact_duration_beyond_the_time_between_collisions_is_a_warning() {
    let warnings = |duration: f64| {
        let rule = ContactDuration::new(Smooth::from_restitution(0.9).unwrap(), duration).unwrap();
        let container = Container::closed(20.0, 20.0).unwrap();
        let disks = gas(&container, 100);
        let mut run = Simulation::builder(rule, container).disks(disks).build().unwrap();
        run.run_until(100.0, &mut ()).unwrap();
        run.warnings()
    };
    assert_eq!(warnings(1e-4), []);
    let long = warnings(1000.0);
    assert!(
        matches!(long[..], [Warning::LongContactDuration { elastic, collisions, .. }] if elastic < collisions)
    );
    assert!(long[0].to_string().contains("times the time between two collisions"), "{}", long[0]);
}

/// Only one disk takes part in a collision with a wall.
#[test]
fn collisions_with_walls_count_once_for_a_contact_duration() {
    let share = |duration: f64| {
        let rule = ContactDuration::new(Smooth::from_restitution(0.99999).unwrap(), duration).unwrap();
        let disk = Disk::new(DVec2::splat(2.0), 0.5).unwrap().with_velocity(DVec2::new(1.0, 0.7)).unwrap();
        let container = Container::closed(4.0, 4.0).unwrap();
        let mut run = Simulation::builder(rule, container).disks([disk]).build().unwrap();
        run.run_until(1e4, &mut ()).unwrap();
        let rate = run.counters().wall_collisions as f64 / 1e4;
        let warnings = run.warnings();
        let reported = warnings.iter().find_map(|warning| match warning {
            Warning::LongContactDuration { share_of_time, .. } => Some(*share_of_time),
            _ => None,
        });
        (reported, duration * rate)
    };
    let (reported, expected) = share(0.15);
    assert!(
        reported.is_some_and(|share| (0.7..1.0).contains(&(share / expected))),
        "{reported:?} {expected}"
    );
    let (reported, expected) = share(0.08);
    assert!(reported.is_none() && expected < 0.05, "{reported:?} {expected}");
}

/// A gravity of −0 is a gravity of 0, however it is set.
#[test]
fn gravity_has_no_sign_where_there_is_none() {
    let gas = gas(&walls(), 40);
    let end = |gravity: f64| {
        let mut run =
            Simulation::builder(Elastic, walls()).disks(gas.clone()).gravity(gravity).build().unwrap();
        run.run_until(60.0, &mut ()).unwrap();
        run.set_gravity(gravity).unwrap();
        run.run_until(120.0, &mut ()).unwrap();
        (run.disks(), *run.counters())
    };
    assert_eq!(end(-0.0), end(0.0));
}
