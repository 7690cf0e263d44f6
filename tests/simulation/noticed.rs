//! What the engine notices: walls that are not where they say, events that are lost, walls that jump. A run
//! that is wrong does not end as if it were right.

use granular_edmd::boundary::{
    Boundary, Brick, Container, Domain, FirstTouch, Overlap, Part, Probe, Region, Surface, Touch, Wall,
};
use granular_edmd::collision::{ContactDuration, Elastic, Smooth};
use granular_edmd::glam::DVec2;
use granular_edmd::observable::Partner;
use granular_edmd::scheduler::{EventScheduler, LinearScan};
use granular_edmd::simulation::{BoundaryFault, RunError, Warning};
use granular_edmd::wall::{AccelerationBounds, WallMotion, WallState};
use granular_edmd::{Disk, Flight, Simulation, initial};

fn walls() -> Container {
    Container::closed(12.0, 10.0).unwrap()
}

fn gas(container: &Container, count: usize) -> Vec<Disk> {
    let disks = initial::lattice(container, count, 0.5).unwrap();
    initial::with_maxwellian_velocities(disks, 1.0, 3).unwrap()
}

/// A container with a fault.
#[derive(Clone)]
struct Faulty {
    honest: Container,
    fault: Fault,
}

#[derive(Clone, Copy)]
enum Fault {
    /// Disks touch when they are this deep in a wall; with a negative depth, before they touch it.
    Depth(f64),
    /// Overlaps are not told.
    Blind,
    /// Disks do not touch the floor.
    NoFloor,
}

impl Boundary for Faulty {
    fn domain(&self) -> Domain {
        self.honest.domain()
    }
    fn wall_count(&self) -> usize {
        self.honest.wall_count()
    }
    fn wall(&self, wall: usize, time: f64) -> granular_edmd::boundary::WallView<'_> {
        self.honest.wall(wall, time)
    }
    fn set_time_origin(&mut self, origin: f64) {
        self.honest.set_time_origin(origin);
    }
    fn may_touch(&self, region: &Region, radius: f64) -> bool {
        self.honest.may_touch(region, 1.1 * radius)
    }
    fn first_touch(&self, flight: &Flight, until: f64) -> FirstTouch<Touch> {
        let start = flight.time();
        let (at, velocity, pull) = (flight.position(start), flight.velocity(start), flight.acceleration());
        match self.fault {
            Fault::Depth(depth) => {
                let other = Flight::new(start, at, velocity, pull, flight.radius() - depth);
                self.honest.first_touch(&other, until)
            }
            Fault::NoFloor => {
                self.honest.first_touch(flight, until).touch().filter(|touch| touch.wall != 0).into()
            }
            Fault::Blind => self.honest.first_touch(flight, until),
        }
    }
    fn surface(&self, wall: usize, position: DVec2, time: f64) -> Surface<'_> {
        self.honest.surface(wall, position, time)
    }
    fn overlap(&self, probe: &Probe) -> Option<Overlap> {
        self.honest.overlap(probe).filter(|_| !matches!(self.fault, Fault::Blind))
    }
}

/// Runs one disk that falls onto the floor of a container with a fault.
fn fall(fault: Fault, sides: Container) -> (Simulation<Elastic, Faulty>, Result<(), RunError>) {
    let disk = Disk::new(DVec2::new(6.0, 5.0), 0.5).unwrap().with_velocity(DVec2::new(0.3, 0.0)).unwrap();
    let builder = Simulation::builder(Elastic, Faulty { honest: sides, fault }).disks([disk]).gravity(1.0);
    let mut run = builder.build().unwrap();
    let end = run.run_until(100.0, &mut ()).map(|_| ());
    (run, end)
}

#[test]
fn a_collision_away_from_its_wall_ends_the_run() {
    for fault in [0.01, 1e-6, -0.01, -1e-6] {
        let (run, end) = fall(Fault::Depth(fault), walls());
        let error = end.unwrap_err();
        let RunError::FalseContact { disk: 0, partner: Partner::Wall(0), wall, depth, time } = &error else {
            panic!("{error}")
        };
        assert_eq!((wall.as_deref(), *time), (Some("floor"), run.time()));
        assert!((depth / fault - 1.0).abs() < 1e-6, "{fault:e} {depth:e}");
        let said = error.to_string();
        assert!(said.contains("boundary::laws::check") && said.contains("\"floor\""), "{said}");
        assert_eq!(run.counters().wall_collisions, 0, "the collision is not carried out");
    }
}

#[test]
fn overlaps_within_rounding_are_counted() {
    for depth in [1e-8, 3e-7] {
        let (run, end) = fall(Fault::Depth(depth), walls());
        end.unwrap();
        assert!((run.counters().max_wall_overlap - depth).abs() < 1e-13, "{:?}", run.counters());
    }
}

#[test]
fn a_boundary_that_tells_no_overlap_is_named() {
    let error = fall(Fault::Blind, walls()).1.unwrap_err();
    assert!(matches!(error, RunError::FalseContact { depth: f64::NEG_INFINITY, .. }), "{error}");
    assert!(error.to_string().contains("does `overlap` know"), "{error}");
}

#[test]
fn a_disk_that_passes_a_wall_is_noticed() {
    // Between periodic sides, there is no other wall that it could meet.
    for sides in [walls(), walls().with_periodic_sides().unwrap()] {
        let (run, end) = fall(Fault::NoFloor, sides);
        let error = end.unwrap_err();
        let is_told = match &error {
            RunError::FalseContact { wall: Some(name), .. } => name == "floor",
            RunError::Boundary { fault: BoundaryFault::Outside { y, .. }, .. } => *y < -0.5,
            _ => false,
        };
        assert!(is_told && run.time() < 20.0, "{error}");
        assert!(error.to_string().contains("boundary::laws::check"), "{error}");
    }
}

/// A floor whose motion is not what its bounds of the acceleration say.
#[test]
fn a_motion_with_false_bounds_ends_the_run() {
    struct Broken;
    impl WallMotion for Broken {
        fn state(&self, phase: f64) -> WallState {
            WallState::new(0.3 * libm::sin(10.0 * phase), 3.0 * libm::cos(10.0 * phase))
        }
        fn acceleration(&self, _: f64) -> AccelerationBounds {
            AccelerationBounds::new(f64::INFINITY, 0.0, 0.0)
        }
        fn reach(&self) -> (f64, f64) {
            (-0.3, 0.3)
        }
    }
    let container = Container::closed(20.0, 20.0).unwrap().with_motion(Wall::Floor, Broken).unwrap();
    let disks = gas(&container, 50);
    let mut run = Simulation::builder(Elastic, container).disks(disks).gravity(1.0).build().unwrap();
    let error = run.run_until(1000.0, &mut ()).unwrap_err();
    let RunError::FalseContact { wall: Some(wall), depth, .. } = &error else { panic!("{error}") };
    assert!(wall == "floor" && depth.abs() > 5e-10 && run.time() < 5.0, "{error}");
    assert!(error.to_string().contains("wall::laws::check"), "{error}");
}

/// A scheduler that loses one time. A disk that is hit before its own event is missed gets a new event.
#[test]
fn one_event_that_the_scheduler_lost_is_noticed_before_disks_overlap() {
    struct Forgetful {
        honest: LinearScan,
        sets_until_lost: u64,
    }
    impl EventScheduler for Forgetful {
        fn reset(&mut self, due: &[f64]) {
            self.honest.reset(due);
        }
        fn set(&mut self, disk: usize, due: f64) {
            self.honest.set(disk, if self.sets_until_lost == 0 { f64::INFINITY } else { due });
            self.sets_until_lost = self.sets_until_lost.wrapping_sub(1);
        }
        fn earliest(&self) -> (usize, f64) {
            self.honest.earliest()
        }
    }
    let mut errors = 0;
    for sets_until_lost in (0..1400).step_by(2) {
        let scheduler = Forgetful { honest: LinearScan::new(), sets_until_lost };
        let builder = Simulation::builder(Elastic, walls()).disks(gas(&walls(), 40)).scheduler(scheduler);
        let mut run = builder.build().unwrap();
        let mut deepest = 0.0_f64;
        let end = (1..=300).map(|step| 0.1 * f64::from(step)).try_for_each(|time| {
            run.run_until(time, &mut ())?;
            let disks = run.disks();
            let overlap = |(one, other): (&Disk, &Disk)| {
                one.radius() + other.radius() - one.position().distance(other.position())
            };
            let pairs = disks
                .iter()
                .enumerate()
                .flat_map(|(number, one)| disks[number + 1..].iter().map(move |other| (one, other)));
            deepest = pairs.map(overlap).fold(deepest, f64::max);
            Ok::<(), RunError>(())
        });
        errors += u32::from(end.is_err());
        assert!(end.is_err() || deepest < 1e-9, "{sets_until_lost}: {deepest}");
    }
    assert!(errors > 400, "{errors}");
}

/// A scheduler that does not take earlier times, and one that forgets a single one.
#[test]
fn an_event_that_the_scheduler_lost_is_noticed() {
    struct Deaf {
        honest: LinearScan,
        due: Vec<f64>,
        sets: u64,
        from: u64,
    }
    impl EventScheduler for Deaf {
        fn reset(&mut self, due: &[f64]) {
            self.due = due.to_vec();
            self.honest.reset(due);
        }
        fn set(&mut self, disk: usize, due: f64) {
            self.sets += 1;
            if self.sets < self.from || due > self.due[disk] {
                self.due[disk] = due;
                self.honest.set(disk, due);
            }
        }
        fn earliest(&self) -> (usize, f64) {
            self.honest.earliest()
        }
    }
    for from in [1, 50, 500, 3000, 12_000] {
        let scheduler = Deaf { honest: LinearScan::new(), due: Vec::new(), sets: 0, from };
        let builder = Simulation::builder(Elastic, walls()).disks(gas(&walls(), 20)).scheduler(scheduler);
        let mut run = builder.build().unwrap();
        let error = run.run_until(5000.0, &mut ()).unwrap_err();
        // The disks of a lost collision may pass through each other, and meet others before the epoch ends.
        let is_told = matches!(error, RunError::Overdue { .. } | RunError::Scheduler { .. })
            || matches!(error, RunError::FalseContact { partner: Partner::Disk(_), .. });
        assert!(is_told, "{error}");
    }
}

/// A scheduler that names nothing at all has no events, so that its epoch alone shows it.
#[test]
fn a_scheduler_that_names_nothing_is_noticed() {
    struct Mute;
    impl EventScheduler for Mute {
        fn reset(&mut self, _: &[f64]) {}
        fn set(&mut self, _: usize, _: f64) {}
        fn earliest(&self) -> (usize, f64) {
            (usize::MAX, f64::INFINITY)
        }
    }
    let builder = Simulation::builder(Elastic, walls()).disks(gas(&walls(), 20)).scheduler(Mute);
    let error = builder.build().unwrap().run_until(100.0, &mut ()).unwrap_err();
    assert!(error.to_string().contains("scheduler::laws::check"), "{error}");
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

/// A disk that rolls over the open end of a bowl is behind it, and the error names the bowl, not the floor on
/// which it lands.
#[test]
fn the_wall_that_a_disk_is_in_is_named_and_not_the_one_it_touches() {
    let bowl = Part::new([Brick::arc(DVec2::new(10.0, 10.0), 8.0, 4.0, 5.0).unwrap()]).unwrap();
    let vessel = Container::closed(20.0, 20.0).unwrap().with_part("bowl", bowl).unwrap();
    let disk = Disk::new(DVec2::new(15.0, 8.0), 0.3).unwrap();
    let mut run = Simulation::builder(Elastic, vessel).disks([disk]).gravity(1.0).build().unwrap();
    let error = run.run_until(60.0, &mut ()).unwrap_err();
    assert!(matches!(&error, RunError::FalseContact { wall: Some(name), .. } if name == "bowl"), "{error}");
}
