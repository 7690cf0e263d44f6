//! Single steps, and the events that they return.

use granular_edmd::boundary::{Container, Wall};
use granular_edmd::collision::{Elastic, Impulse, from_fn};
use granular_edmd::glam::DVec2;
use granular_edmd::simulation::{Counters, Event, RunError};
use granular_edmd::{Disk, Simulation};
use proptest::prelude::*;

use crate::setups::{config, history, setup};

proptest! {
    #![proptest_config(config(30))]

    #[test]
    fn steps_make_the_run_and_count_what_they_say(setup in setup()) {
        let end = setup.start + 2.0;
        let (expected, _) = history(setup.simulation(), end);
        let mut simulation = setup.simulation();
        let mut log = crate::setups::Log(Vec::new());
        let (mut collisions, mut wall_collisions) = (0, 0);
        while let Some(event) = simulation.step_until(end, &mut log).unwrap() {
            match event {
                Event::Collision { .. } => collisions += 1,
                Event::WallCollision { .. } => wall_collisions += 1,
                other => prop_assert!(false, "{:?}", other),
            }
            prop_assert_eq!(collisions + wall_collisions, log.0.len() as u64);
            prop_assert_eq!(simulation.time(), log.0.last().unwrap().time);
        }
        prop_assert_eq!(log.0, expected);
        let told = simulation.counters();
        prop_assert_eq!((told.disk_collisions, told.wall_collisions), (collisions, wall_collisions));
    }

    #[test]
    fn a_run_until_the_time_of_a_collision_includes_it_and_no_later_one(setup in setup()) {
        let end = setup.start + 2.0;
        let (expected, _) = history(setup.simulation(), end);
        let mut run = setup.simulation();
        let mut last = setup.start;
        for collision in &expected {
            // Any time between two collisions ends the run between them.
            let between = last.midpoint(collision.time);
            for time in [between, collision.time] {
                run.run_until(time, &mut ()).unwrap();
                let so_far = expected.partition_point(|earlier| earlier.time <= time) as u64;
                prop_assert_eq!(run.counters().collisions(), so_far, "until {:?}", time);
                prop_assert!(run.time() <= time, "{:?} is after {:?}", run.time(), time);
            }
            last = collision.time;
        }
        prop_assert_eq!(run.step_until(end, &mut ()).unwrap(), None);
    }
}

#[test]
fn a_single_disk_meets_the_walls_in_turn() {
    let disk = Disk::new(DVec2::new(1.0, 1.0), 0.5).unwrap().with_velocity(DVec2::new(1.0, 0.0)).unwrap();
    let boundary = Container::closed(4.0, 2.0).unwrap();
    let (left, right) = (boundary.index(Wall::Left).unwrap(), boundary.index(Wall::Right).unwrap());
    let mut simulation = Simulation::builder(Elastic, boundary).disks([disk]).build().unwrap();
    let mut met = Vec::new();
    while met.len() < 4 {
        if let Some(Event::WallCollision { disk: 0, wall }) = simulation.step_until(20.0, &mut ()).unwrap() {
            met.push((wall, simulation.time()));
        }
    }
    let walls: Vec<usize> = met.iter().map(|m| m.0).collect();
    assert_eq!(walls, [right, left, right, left]);
    for (k, (_, time)) in met.iter().enumerate() {
        assert!((time - (2.5 + 3.0 * k as f64)).abs() < 1e-12);
    }
}

#[test]
fn without_disks_there_is_no_event() {
    let mut simulation =
        Simulation::builder(Elastic, Container::open(4.0).unwrap()).gravity(1.0).build().unwrap();
    assert_eq!(simulation.step_until(1.0, &mut ()).unwrap(), None);
    simulation.run_until(1e9, &mut ()).unwrap();
    assert_eq!((simulation.time(), simulation.len()), (1e9, 0));
    assert_eq!(*simulation.counters(), Counters::default());
}

#[test]
fn a_rule_that_is_not_finite_ends_the_run() {
    let disk = Disk::new(DVec2::new(1.0, 1.0), 0.5).unwrap().with_velocity(DVec2::new(1.0, 0.0)).unwrap();
    for wrong in [f64::NAN, f64::INFINITY] {
        let rule = from_fn(move |_| Impulse::new(wrong, 0.0));
        let mut simulation =
            Simulation::builder(rule, Container::open(4.0).unwrap()).disks([disk]).build().unwrap();
        let error = simulation.run_until(10.0, &mut ()).unwrap_err();
        assert!(matches!(&error, RunError::NotFinite(failed) if failed.disk == 0), "{error}");
    }
}

#[test]
fn a_rule_that_does_nothing_stalls_the_run_and_does_not_hang_it() {
    let disk = Disk::new(DVec2::new(1.0, 1.0), 0.5).unwrap().with_velocity(DVec2::new(1.0, 0.0)).unwrap();
    let rule = from_fn(|_| Impulse::new(0.0, 0.0));
    let mut simulation =
        Simulation::builder(rule, Container::open(4.0).unwrap()).disks([disk]).build().unwrap();
    assert!(matches!(simulation.run_until(10.0, &mut ()), Err(RunError::Stalled { disk: 0, .. })));
}
