//! Findings of the random runs, each as small as possible.

use std::cell::Cell;

use granular_edmd::boundary::{Boundary, Container, Probe, Wall};
use granular_edmd::collision::{ContactDuration, Elastic, Smooth};
use granular_edmd::glam::DVec2;
use granular_edmd::observable::{Collision, on_collision};
use granular_edmd::simulation::RunError;
use granular_edmd::wall::{
    AccelerationBounds, Approach, BiParabolic, Sawtooth, Sinusoidal, Triangular, WallMotion, WallState,
    first_touch,
};
use granular_edmd::{Disk, Simulation};

fn disk(x: f64, y: f64, velocity: DVec2) -> Disk {
    Disk::new(DVec2::new(x, y), 0.5).unwrap().with_velocity(velocity).unwrap()
}

/// Without restitution, only rounding is left to bounce with. Each event takes some 1e-15 of time, and never
/// none.
#[test]
fn a_disk_that_sticks_to_the_floor_under_a_contact_duration_stalls() {
    let still = Container::closed(9.6, 13.0).unwrap();
    let moving = still.clone().with_motion(Wall::Floor, BiParabolic::new(0.2, 10.0).unwrap()).unwrap();
    for floor in [still, moving] {
        let rule = ContactDuration::new(Smooth::from_restitution(0.0).unwrap(), 0.015).unwrap();
        let disks = [disk(2.0, 2.3, DVec2::new(0.1, -1.0))];
        let mut run = Simulation::builder(rule, floor).disks(disks).gravity(0.05).build().unwrap();
        let error = run.run_until(1e3, &mut ()).unwrap_err();
        assert!(matches!(error, RunError::Stalled { disk: 0, .. }), "{error}");
        assert!(run.counters().wall_collisions < 1_000_000, "{:?}", run.counters());
    }
}

/// The moment at which a disk enters at the other side is rounded, so the domain ends there up to rounding.
#[test]
fn a_disk_on_the_line_between_periodic_sides_is_inside_both_ways() {
    let container = Container::closed(15.5, 8.0).unwrap().with_periodic_sides().unwrap();
    for x in [-7.1e-15, -1e-30, 0.0, 15.5, 15.5_f64.next_up()] {
        let disks = [disk(x, 4.0, DVec2::new(-1.0, 0.0)), disk(7.0, 4.0, DVec2::ZERO)];
        let mut run = Simulation::builder(Elastic, container.clone()).disks(disks).build().unwrap();
        run.run_until(100.0, &mut ()).unwrap();
        // The first collision comes after a way of 7.5. The others come each time that the disks have gone
        // round the ring, less two diameters.
        assert_eq!(run.counters().disk_collisions, 7, "{x}");
        run.set_boundary(container.clone()).unwrap();
    }
}

/// A disk at rest on a steadily moving lid bounces by rounding only, and each bounce rounds its height. The
/// disk sinks, but by no more than that.
#[test]
fn a_disk_at_rest_on_a_moving_wall_sinks_by_less_than_the_rounding_of_its_bounces() {
    let lids: [Box<dyn WallMotion + Send + Sync>; 4] = [
        Box::new(Sawtooth::new(0.04, 14.7).unwrap()),
        Box::new(Triangular::new(0.1, 2.0).unwrap()),
        Box::new(BiParabolic::new(0.1, 1.0).unwrap()),
        Box::new(Sinusoidal::new(0.1, 1.0).unwrap()),
    ];
    for lid in lids {
        let container = Container::closed(9.0, 8.53).unwrap().with_motion(Wall::Lid, lid).unwrap();
        let rule = ContactDuration::new(Smooth::from_restitution(0.0).unwrap(), 0.1).unwrap();
        let disks = [disk(4.0, 7.0, DVec2::new(0.1, 0.4))];
        let mut run = Simulation::builder(rule, container).disks(disks).gravity(-0.4).build().unwrap();
        while run.counters().wall_collisions < 100_000 && run.step_until(run.time() + 1.0, &mut ()).is_ok() {}
        let mut walls = run.boundary().clone();
        walls.set_time_origin(run.time());
        let depth = walls
            .overlap(&Probe::new(run.disks()[0].position(), 0.5, 0.0))
            .map_or(0.0, |overlap| overlap.depth);
        assert!(depth < 1e5 * 8.0 * f64::EPSILON, "{depth:e}");
    }
}

/// A motion that counts how often it is asked for its acceleration.
struct Counting<M>(M, Cell<u32>);

impl<M: WallMotion> WallMotion for Counting<M> {
    fn state(&self, time: f64) -> WallState {
        self.0.state(time)
    }
    fn acceleration(&self, time: f64) -> AccelerationBounds {
        self.1.set(self.1.get() + 1);
        self.0.acceleration(time)
    }
    fn reach(&self) -> (f64, f64) {
        self.0.reach()
    }
}

/// A disk that bounces off a fast wall is out of its reach for a million periods. The search looks at none of
/// these.
#[test]
fn a_search_takes_some_periods_of_a_wall_however_fast_it_is() {
    for frequency in [1e3, 1e6, 1e9] {
        let wall = Counting(Sinusoidal::new(1.0 / frequency, frequency).unwrap(), Cell::new(0));
        for step in 0..100 {
            let start = f64::from(step) * 0.063 / frequency;
            let place = wall.state(start).displacement;
            wall.1.set(0);
            let touch = first_touch(&wall, &Approach::new(start, place, 2.0, -1.0), 10.0).touch().unwrap();
            assert!(touch > 3.9 && wall.1.get() < 200, "{frequency:e}: {} looks", wall.1.get());
        }
    }
}

/// A disk that moves with a wall parts from it at the turn. If rounding lets it approach in the boundary's
/// arithmetic, the engine pushes it, and the collision reports this push, too.
#[test]
fn a_push_away_from_a_wall_is_part_of_the_collision() {
    let mut pushed = 0;
    for seed in 0..200 {
        let shake = |wall: u32| {
            let size = f64::from(seed * 4 + wall);
            Triangular::new(0.05 + 0.1 * size.sin().abs(), 4.0 + (1.7 * size).cos().abs() * 10.0).unwrap()
        };
        let walls = [Wall::Floor, Wall::Lid, Wall::Left, Wall::Right].into_iter().zip(0..);
        let container = walls.fold(Container::closed(6.0, 5.0).unwrap(), |container, (wall, index)| {
            container.with_motion(wall, shake(index)).unwrap()
        });
        let rule = Smooth::from_restitution(0.0).unwrap();
        let disks = [disk(2.0, 2.0, DVec2::new(0.3, 1.0 + 0.01 * f64::from(seed)))];
        let mut run = Simulation::builder(rule, container).disks(disks).build().unwrap();
        let told = Cell::new(None);
        for _ in 0..200 {
            let before = run.disks()[0];
            told.set(None);
            let mut hear = on_collision(|collision: &Collision| told.set(Some(*collision)));
            if run.step_until(run.time() + 10.0, &mut hear).is_err() {
                break;
            }
            let Some(collision) = told.take() else { continue };
            let after = run.disks()[0];
            let change = after.translational_energy() - before.translational_energy();
            let (rounding, told) = (1e-14 * after.translational_energy(), collision.energy_change);
            assert!((change - told).abs() <= rounding, "{change:e}, not {told:e}: {collision:?}");
            let impulse = (after.velocity() - before.velocity()).dot(collision.normal) * after.mass();
            assert!((impulse - collision.impulse.normal()).abs() <= 1e-14, "{impulse:e}: {collision:?}");
            pushed += u32::from(collision.contact.closing_speed() <= 0.0 && change != 0.0);
        }
    }
    assert!(pushed > 0);
}

/// The acceleration 8A/H² of a motion whose squared period vanishes is no number, though Aω² is one.
#[test]
fn motions_whose_squared_periods_vanish_are_refused() {
    assert!(BiParabolic::new(1e-320, 1e300).is_err());
    assert!(Sinusoidal::new(1e-320, 1e300).is_err());
    assert!(BiParabolic::new(1e-300, 1e150).is_ok());
}
