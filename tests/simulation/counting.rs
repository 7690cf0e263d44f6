//! Counters, events and observers agree, however long the run.

use granular_edmd::boundary::Container;
use granular_edmd::collision::{Elastic, Frictional};
use granular_edmd::glam::DVec2;
use granular_edmd::observable::{Collision, Observer, Partner};
use granular_edmd::simulation::{Counters, Event};
use granular_edmd::{Disk, Simulation, initial};
use proptest::prelude::*;

use crate::setups::{config, setup};

#[derive(Debug, Default, PartialEq)]
struct Told {
    collisions: u64,
    wall_collisions: u64,
}

impl Observer for Told {
    fn on_collision(&mut self, collision: &Collision) {
        match collision.partner {
            Partner::Disk(_) => self.collisions += 1,
            Partner::Wall(_) => self.wall_collisions += 1,
        }
    }
}

impl Told {
    fn by(counters: &Counters) -> Self {
        Self { collisions: counters.disk_collisions, wall_collisions: counters.wall_collisions }
    }
}

proptest! {
    #![proptest_config(config(12))]

    #[test]
    fn observers_steps_and_counters_agree_over_long_runs(setup in setup()) {
        let mut run = setup.simulation();
        let (mut told, mut stepped) = (Told::default(), Told::default());
        for _ in 0..5000 {
            // Disks may come to rest. The run then ends with an error, and its counts are still true.
            match run.step_until(setup.start + 300.0, &mut told).unwrap_or(None) {
                Some(Event::Collision { disk, partner }) => {
                    prop_assert!(disk < run.len() && partner < run.len() && disk != partner);
                    stepped.collisions += 1;
                }
                Some(Event::WallCollision { disk, wall }) => {
                    prop_assert!(disk < run.len() && wall < 4);
                    stepped.wall_collisions += 1;
                }
                Some(other) => prop_assert!(false, "{:?}", other),
                None => break,
            }
        }
        prop_assert_eq!(&told, &stepped);
        prop_assert_eq!(told, Told::by(run.counters()));
        let Counters { disk_collisions, wall_collisions, cell_crossings, repredictions, horizons, .. } = *run.counters();
        let sum = disk_collisions + wall_collisions + cell_crossings + repredictions + horizons;
        prop_assert_eq!(run.counters().events(), sum);
        let earlier = *run.counters();
        let mut told = Told::default();
        let _ = run.run_until(run.time() + 0.5, &mut told);
        prop_assert_eq!(told, Told::by(&run.counters().since(&earlier)));
    }
}

/// Nothing happens between walls that are far away. A search for them ends at its horizon, and only that is
/// counted.
#[test]
fn a_slow_disk_near_a_far_wall_has_horizons_and_no_collisions() {
    let disk = |x: f64, velocity: DVec2| {
        Disk::new(DVec2::new(x, 5.0), 0.5).unwrap().with_velocity(velocity).unwrap()
    };
    let slow = disk(2.0, DVec2::new(-1e-6, 0.0));
    let fast = disk(7.0, DVec2::Y);
    let builder = Simulation::builder(Elastic, Container::closed(10.0, 10.0).unwrap()).disks([slow, fast]);
    let mut run = builder.build().unwrap();
    let mut told = Told::default();
    run.run_until(4000.0, &mut told).unwrap();
    let counters = run.counters();
    assert!(counters.horizons > 10, "{counters:?}");
    assert!(counters.horizons < counters.events(), "{counters:?}");
    assert_eq!(Told::by(counters), told);
    assert_eq!(
        counters.cell_crossings
            + counters.horizons
            + counters.repredictions
            + told.collisions
            + told.wall_collisions,
        counters.events()
    );
}

#[test]
fn changes_of_the_cells_are_counted() {
    let container = Container::closed(30.0, 30.0).unwrap();
    let disks = initial::lattice(&container, 20, 0.5).unwrap();
    let disks = initial::with_maxwellian_velocities(disks, 1.0, 1).unwrap();
    let builder = Simulation::builder(Elastic, container).disks(disks);
    let mut run = builder.build().unwrap();
    assert_eq!(run.counters().cell_resizes, 0);
    run.run_until(500.0, &mut ()).unwrap();
    // A dilute gas has the largest cells: one change, since the next size is the last.
    assert_eq!(run.counters().cell_resizes, 1, "{:?}", run.counters());
    let dense = Container::closed(10.0, 10.0).unwrap();
    let disks = initial::lattice(&dense, 80, 0.5).unwrap();
    let disks = initial::with_maxwellian_velocities(disks, 1.0, 1).unwrap();
    let mut run = Simulation::builder(Frictional::from_inelasticity(0.0, 0.0, 0.1).unwrap(), dense)
        .disks(disks)
        .build()
        .unwrap();
    run.run_until(300.0, &mut ()).unwrap();
    assert!(run.counters().cell_resizes >= 1, "{:?}", run.counters());
    assert_eq!(run.counters().horizons, 0, "{:?}", run.counters());
}

/// Nothing happens if nothing moves, however late the end and however near the walls.
#[test]
fn disks_at_rest_take_no_events() {
    let disk = |x: f64| Disk::new(DVec2::new(x, 0.6), 0.5).unwrap();
    for end in [1e6, 1e12, 1e15, 1e100] {
        let builder = Simulation::builder(Elastic, Container::closed(10.0, 10.0).unwrap());
        let mut run = builder.disks([disk(0.6), disk(5.0)]).build().unwrap();
        run.run_until(end, &mut ()).unwrap();
        assert!(run.counters().events() < 10, "{:?}", run.counters());
        assert_eq!((run.time(), run.disks()[0].with_id(0).unwrap()), (end, disk(0.6)));
    }
    // A wall that begins to move finds them where they are.
    let floor = granular_edmd::wall::Sinusoidal::new(0.3, 2.0).unwrap();
    let floor =
        Container::closed(10.0, 10.0).unwrap().with_motion(granular_edmd::boundary::Wall::Floor, floor);
    let builder = Simulation::builder(Elastic, Container::closed(10.0, 10.0).unwrap());
    let mut run = builder.disks([disk(0.6), disk(5.0)]).build().unwrap();
    run.run_until(std::f64::consts::PI * 1e3, &mut ()).unwrap();
    run.set_boundary(floor.unwrap()).unwrap();
    run.run_until(4000.0, &mut ()).unwrap();
    assert!(run.counters().wall_collisions > 10, "{:?}", run.counters());
    assert!(run.counters().max_wall_overlap < 1e-10, "{:?}", run.counters());
}
