//! Parts that move fast beside long flights: arms that turn, polygons that are shaken along any direction.
//!
//! The oracle is brute force. Every collision with a wall is at that wall, an elastic bounce in its frame,
//! and between collisions no disk is ever in a wall, at times as dense as the motion needs.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use granular_edmd::boundary::{Boundary, Container, Part, Probe};
use granular_edmd::collision::Elastic;
use granular_edmd::glam::DVec2;
use granular_edmd::simulation::{Event, Limits, RunEnd, RunError};
use granular_edmd::wall::{
    AccelerationBounds, BiParabolic, Combined, Sinusoidal, Tabulated, Triangular, WallMotion, WallState,
};
use granular_edmd::{Disk, Flight, Simulation};

fn point(x: f64, y: f64) -> DVec2 {
    DVec2::new(x, y)
}

fn arm(angular_velocity: f64) -> Part {
    let arm = Part::polyline([point(5.0, 5.0), point(7.0, 5.0)]).unwrap();
    arm.with_rotation(point(5.0, 5.0), angular_velocity).unwrap()
}

fn beside_an_arm(angular_velocity: f64, disk: Disk) -> Simulation<Elastic> {
    let room = Container::closed(20.0, 20.0).unwrap().with_part("arm", arm(angular_velocity)).unwrap();
    Simulation::builder(Elastic, room).disks([disk]).build().unwrap()
}

/// A disk at rest out of the reach of an arm stays there, however often the arm turns.
#[test]
fn an_arm_does_not_touch_what_it_does_not_reach() {
    for angular_velocity in [1.0, 10.0, 1e3, 1e6] {
        let disk = Disk::new(point(7.0, 7.0), 0.5).unwrap();
        let mut run = beside_an_arm(angular_velocity, disk);
        run.run_until(26_000.0, &mut ()).unwrap();
        assert_eq!(run.counters().wall_collisions, 0, "{angular_velocity}");
        assert_eq!(run.disks()[0].position(), point(7.0, 7.0));
    }
}

/// A slow disk comes to an arm that turns a million times before: it touches where it gets to the circle of
/// the arm's end, within a turn. One that passes by is never touched.
#[test]
fn an_arm_turns_a_million_times_before_it_touches() {
    let turn = std::f64::consts::TAU / 1e5;
    let coming = Disk::new(point(15.0, 5.0), 0.5).unwrap().with_velocity(point(-0.1, 0.0)).unwrap();
    let mut run = beside_an_arm(1e5, coming);
    assert!(matches!(run.step_until(100.0, &mut ()).unwrap(), Some(Event::WallCollision { .. })));
    let late = run.time() - 75.0;
    // In a turn, the disk goes 6e-6 into the ring, so the end of the arm cannot miss it.
    assert!((0.0..turn).contains(&late), "{late}");

    let passing = Disk::new(point(7.6, 1.0), 0.5).unwrap().with_velocity(point(0.0, 0.1)).unwrap();
    let mut run = beside_an_arm(1e5, passing);
    assert_eq!(run.step_until(80.0, &mut ()).unwrap(), None);
}

/// A motion that counts how often a search asks for it.
struct Counted<M>(M, Arc<AtomicU64>);

impl<M: WallMotion> WallMotion for Counted<M> {
    fn state(&self, phase: f64) -> WallState {
        self.0.state(phase)
    }
    fn acceleration(&self, phase: f64) -> AccelerationBounds {
        self.1.fetch_add(1, Ordering::Relaxed);
        self.0.acceleration(phase)
    }
    fn reach(&self) -> (f64, f64) {
        self.0.reach()
    }
    fn period(&self) -> Option<f64> {
        self.0.period()
    }
}

/// One of nine disks in a square around the origin.
fn disk(k: i32) -> Disk {
    let place = point(2.0 * f64::from(k % 3 - 1), 2.0 * f64::from(k / 3 - 1));
    let angle = 0.7 + 2.4 * f64::from(k);
    Disk::new(place, 0.5).unwrap().with_velocity(point(libm::cos(angle), libm::sin(angle))).unwrap()
}

/// A rhombus with its middle at the origin, and nine disks in it.
fn rhombus(direction: DVec2, motion: impl WallMotion + Send + Sync + 'static) -> Simulation<Elastic> {
    let corners = [point(10.0, 0.0), point(0.0, 10.0), point(-10.0, 0.0), point(0.0, -10.0)];
    let rhombus = Part::polygon(corners).unwrap().with_motion(direction, motion).unwrap();
    let vessel = Container::around([("rhombus", rhombus)]).unwrap();
    Simulation::builder(Elastic, vessel).disks((0..9).map(disk)).build().unwrap()
}

/// Runs, and checks every flight by brute force, with samples `dense` apart wherever a disk is near the
/// walls. Returns the number of wall collisions.
fn checked_run(mut run: Simulation<Elastic>, end: f64, amplitude: f64, dense: f64) -> u64 {
    let mut vessel = run.boundary().clone();
    vessel.set_time_origin(0.0);
    let depth = |disk: &Disk, time: f64, more: f64| {
        vessel
            .overlap(&Probe::new(disk.position(), disk.radius() + more, time))
            .map_or(0.0, |overlap| overlap.depth)
    };
    let energy = |disk: &Disk| 0.5 * disk.mass() * disk.velocity().length_squared();
    let mut before = run.disks();
    let mut last = 0.0;
    let (start, mut work) = (before.iter().map(energy).sum::<f64>(), 0.0);
    while let Some(event) = run.step_until(end, &mut ()).unwrap() {
        let (now, after) = (run.time(), run.disks());
        for disk in &before {
            no_wall_is_missed(disk, last, now, amplitude, dense, &depth);
        }
        if let Event::WallCollision { disk, wall } = event {
            assert!(depth(&after[disk], now, 1e-9) > 0.0, "at {now}, disk {disk} is at no wall");
            let surface = vessel.surface(wall, after[disk].position(), now);
            let kick = after[disk].velocity() - before[disk].velocity();
            work += after[disk].mass() * kick.dot(surface.velocity);
            assert!(kick.perp_dot(surface.normal).abs() < 1e-9 * kick.length().max(1.0));
        }
        (before, last) = (after, now);
    }
    let gained = run.disks().iter().map(energy).sum::<f64>() - start;
    let rounding = 1e-9 * (start + work.abs());
    assert!((gained - work).abs() < rounding, "the walls did the work {work}, the disks gained {gained}");
    run.counters().wall_collisions
}

fn no_wall_is_missed(
    disk: &Disk,
    from: f64,
    to: f64,
    amplitude: f64,
    dense: f64,
    depth: &dyn Fn(&Disk, f64, f64) -> f64,
) {
    let at = |time: f64| disk.with_position(disk.position() + (time - from) * disk.velocity()).unwrap();
    let mut time = from;
    while time < to {
        let here = at(time);
        assert!(depth(&here, time, 0.0) < 1e-9, "at {time}, a disk is in a wall");
        // A disk that is far from the walls needs at least this time to get to them.
        let room = 4.0 - depth(&here, time, 4.0) - amplitude;
        time += dense.max(0.9 * room / (disk.velocity().length() + 1e-9) - dense);
    }
    assert!(depth(&at(to), to, 0.0) < 1e-9, "at {to}, a disk is in a wall");
}

/// All shaken polygons have the collisions of brute force, at any amplitude.
#[test]
fn shaken_polygons_have_the_collisions_of_brute_force() {
    for (exponent, end) in [(1, 200.0), (2, 200.0), (3, 200.0), (4, 200.0), (5, 40.0), (6, 10.0)] {
        let amplitude = libm::pow(10.0, f64::from(-exponent));
        let dense = 0.1 * amplitude;
        for direction in [DVec2::Y, point(1.0, 0.3), point(1.0, 1.0)] {
            let motion = BiParabolic::new(amplitude, 1.0 / amplitude).unwrap();
            checked_run(rhombus(direction, motion), end, amplitude, dense);
        }
        let motion = Sinusoidal::new(amplitude, 1.0 / amplitude).unwrap();
        checked_run(rhombus(DVec2::Y, motion), end, amplitude, dense);
        let motion = Triangular::new(amplitude, 1.0 / amplitude).unwrap();
        checked_run(rhombus(DVec2::Y, motion), end, amplitude, dense);
    }
}

/// So have polygons whose motions are delayed, summed, scaled, from a table, or from one place to another.
#[test]
fn combined_motions_have_the_collisions_of_brute_force() {
    for (amplitude, end) in [(0.3, 60.0), (1e-2, 60.0), (1e-3, 20.0)] {
        let dense = 0.03 * amplitude;
        let collisions = |direction, motion: Box<dyn WallMotion + Send + Sync>| {
            checked_run(rhombus(direction, motion), end, 2.0 * amplitude, dense)
        };
        let sine = |share: f64, speed: f64| Sinusoidal::new(share * amplitude, speed / amplitude).unwrap();
        let sum =
            Combined::new(sine(0.5, 1.0)).plus(Combined::new(sine(0.25, 2.3)).scaled(-2.0).unwrap()).unwrap();
        let row = |k: u32| (0.5 * amplitude * f64::from(k), amplitude * libm::cos(f64::from(k * k)));
        let table = || Tabulated::new((0..4000).map(row)).unwrap();
        let gone = Tabulated::from_to(-amplitude, amplitude, 0.4 * end).unwrap();
        let counts = [
            collisions(DVec2::Y, Box::new(Combined::new(sine(1.0, 1.0)).delayed_until(0.3 * end).unwrap())),
            collisions(point(1.0, 0.3), Box::new(sum.clone())),
            collisions(DVec2::Y, Box::new(table())),
            collisions(point(1.0, 1.0), Box::new(Combined::new(gone).delayed_until(0.3 * end).unwrap())),
            collisions(
                DVec2::Y,
                Box::new(
                    Combined::new(Combined::new(sum).delayed_until(0.2 * end).unwrap())
                        .plus(table())
                        .unwrap(),
                ),
            ),
        ];
        assert!(counts.iter().all(|&count| count > 10), "{counts:?}");
    }
}

/// So has a polygon that turns and travels, and a drum that does: its surface turns.
#[test]
fn parts_that_turn_and_travel_have_the_collisions_of_brute_force() {
    let gone = Tabulated::from_to(-1.0, 1.5, 25.0).unwrap();
    let fast = || Sinusoidal::new(0.05, 20.0).unwrap();
    let motions: [Box<dyn Fn() -> Box<dyn WallMotion + Send + Sync>>; 3] = [
        Box::new(|| Box::new(fast())),
        Box::new(move || Box::new(Combined::new(gone.clone()).delayed_until(5.0).unwrap())),
        Box::new(|| Box::new(BiParabolic::new(0.4, 2.0).unwrap())),
    ];
    for motion in motions {
        for (angular_velocity, start) in [(0.1, 0.0), (-1.7, 3.0), (9.0, -7.5)] {
            let moves = |part: Part| {
                let part = part.with_motion(point(1.0, 0.3), motion()).unwrap();
                let part = part.with_rotation(point(0.4, -0.2), angular_velocity).unwrap();
                Container::around([("part", part.starting_at(start).unwrap())]).unwrap()
            };
            let corners = [point(10.0, 0.0), point(0.0, 10.0), point(-10.0, 0.0), point(0.0, -10.0)];
            let rhombus = moves(Part::polygon(corners).unwrap());
            let drum = moves(Part::drum(point(0.4, -0.2), 8.0).unwrap());
            for vessel in [rhombus, drum] {
                let run = Simulation::builder(Elastic, vessel).disks((0..9).map(disk)).build().unwrap();
                assert!(checked_run(run, 40.0, 1.5, 1e-3) > 10);
            }
        }
    }
}

/// A peg that hardly turns and travels far meets a disk that waits on its way, however long the flight.
#[test]
fn a_part_that_turns_travels_to_a_waiting_disk() {
    let travel = Tabulated::from_to(0.0, 12.0, 20.0).unwrap();
    let peg = Part::peg(point(3.0, 10.0), 0.5).unwrap().with_rotation(point(3.0, 11.0), 1e-9).unwrap();
    let peg = peg.with_motion(DVec2::X, travel.clone()).unwrap();
    let room = Container::closed(20.0, 20.0).unwrap().with_part("peg", peg).unwrap();
    let disk = Disk::new(point(12.0, 10.0), 0.5).unwrap();
    let flight = Flight::new(0.0, disk.position(), DVec2::ZERO, DVec2::ZERO, disk.radius());
    let touch = room.first_touch(&flight, 1e3).touch().unwrap().time;
    let displacement = travel.state(touch).displacement;
    assert!((displacement - 8.0).abs() < 1e-6, "{touch}: {displacement}");
    let mut run = Simulation::builder(Elastic, room).disks([disk]).build().unwrap();
    assert!(matches!(run.step_until(100.0, &mut ()).unwrap(), Some(Event::WallCollision { .. })));
    assert!((travel.state(run.time()).displacement - 8.0).abs() < 0.05, "{}", run.time());
}

/// A wall that begins to move meets the disks that are near it then.
#[test]
fn delayed_motions_are_met_at_their_start() {
    for start in 1..40 {
        let start = f64::from(start);
        let motion = Combined::new(Sinusoidal::new(1.0, 3.0).unwrap()).delayed_until(start).unwrap();
        checked_run(rhombus(DVec2::Y, motion), start + 1.0, 1.0, 0.01);
        let motion = Combined::new(Tabulated::from_to(0.0, 1.0, 0.3).unwrap()).delayed_until(start).unwrap();
        checked_run(rhombus(point(-1.0, 0.5), motion), start + 1.0, 1.0, 0.01);
    }
}

/// A fast motion of a small amplitude takes hardly more steps for a collision than a slow one.
#[test]
fn fast_motions_are_as_cheap_as_slow_ones() {
    let cost = |amplitude: f64| {
        let asked = Arc::new(AtomicU64::new(0));
        let motion = Sinusoidal::new(amplitude, 1.0 / amplitude).unwrap();
        let mut run = rhombus(DVec2::Y, Counted(motion, Arc::clone(&asked)));
        asked.store(0, Ordering::Relaxed);
        run.run_until(200.0, &mut ()).unwrap();
        asked.load(Ordering::Relaxed) as f64 / run.counters().wall_collisions as f64
    };
    let slow = cost(0.1);
    for amplitude in [1e-2, 1e-3, 1e-4, 1e-5, 1e-6] {
        let fast = cost(amplitude);
        assert!(fast < 3.0 * slow, "{amplitude}: {fast} steps for a collision, and {slow} at 0.1");
    }
}

/// A motion that never comes near most of its reach, so that no search comes to an end.
struct Lazy;

impl WallMotion for Lazy {
    fn state(&self, _: f64) -> WallState {
        WallState::new(-1.0, 0.0)
    }
    fn acceleration(&self, phase: f64) -> AccelerationBounds {
        AccelerationBounds::new(phase + 1e-9, 0.0, 0.0)
    }
    fn reach(&self) -> (f64, f64) {
        (-1.0, 1.0)
    }
}

/// A limit of the wall clock holds during searches that never end, and the guard ends such a run in time. A
/// search of 256 steps counts as so many events.
#[test]
fn searches_count_as_events() {
    let floor = Part::block([point(2.0, 2.0), point(8.0, 2.0), point(8.0, 3.0), point(2.0, 3.0)]).unwrap();
    let room = Container::closed(10.0, 10.0).unwrap();
    let room = room.with_part("slab", floor.with_motion(DVec2::Y, Lazy).unwrap()).unwrap();
    let disk = Disk::new(point(5.0, 4.0), 0.5).unwrap();
    let mut run = Simulation::builder(Elastic, room).disks([disk]).build().unwrap();
    let start = Instant::now();
    let limits =
        Limits::until(1e3).with_wall_clock(Duration::from_millis(20)).with_least_progress(0.0).unwrap();
    assert_eq!(run.run(&limits, &mut ()).unwrap(), RunEnd::WallClock);
    // The limit is kept within 0.1 s; a busy machine may be asleep for longer than that.
    assert!(start.elapsed() < Duration::from_secs(5));
    let events = run.counters().events();
    let error = run.run_until(1e3, &mut ()).unwrap_err();
    assert!(matches!(error, RunError::Stalled { .. }), "{error}");
    assert!(run.counters().events() - events < 2_000, "so few searches fill a window of 200 000 events");
}

/// How far runs go beyond a limit of the wall clock, with parts of which each search takes all its steps.
/// `cargo test --release --all-features --test boundary -- --ignored overshoot --nocapture`
#[test]
#[ignore = "a measurement of times"]
fn overshoot_of_the_wall_clock() {
    let limits = |now: f64| {
        let limits = Limits::until(now + 1e9).with_wall_clock(Duration::from_millis(20));
        limits.with_least_progress(0.0).unwrap()
    };
    for frequency in [1e2, 1e4, 1e6] {
        let disk = Disk::new(point(9.0, 5.0), 0.5).unwrap().with_velocity(point(-0.3, 0.01)).unwrap();
        let mut run = beside_an_arm(frequency, disk);
        let over = |_| {
            let start = Instant::now();
            run.run(&limits(run.time()), &mut ()).unwrap();
            start.elapsed().as_secs_f64() - 0.02
        };
        let mut over: Vec<f64> = (0..50).map(over).collect();
        over.sort_by(f64::total_cmp);
        println!(
            "arm at {frequency:e}: beyond the limit by {:.4} s in the median, {:.4} s at most",
            over[25], over[49]
        );
        assert!(over[25] < 0.1);
    }
}

/// A part that is too fast for the times of a run is an error that says so, if a disk comes into its reach.
#[test]
fn a_part_too_fast_for_all_times_is_named() {
    let coming = Disk::new(point(9.0, 5.0), 0.5).unwrap().with_velocity(point(-1.0, 0.0)).unwrap();
    let mut run = beside_an_arm(1e30, coming);
    let error = run.run_until(100.0, &mut ()).unwrap_err().to_string();
    assert!(error.contains("a wall moves too fast"), "{error}");
    assert!((run.time() - 1.5).abs() < 1e-9, "it flies freely up to the reach: {}", run.time());
    let resting = Disk::new(point(7.0, 7.0), 0.5).unwrap();
    beside_an_arm(1e30, resting).run_until(1e3, &mut ()).unwrap();
}

/// A stroke that is lost in the rounding of coordinates is refused.
#[test]
fn a_stroke_below_rounding_is_refused() {
    let part = |amplitude: f64| {
        let peg = Part::peg(point(5.0, 5.0), 1.0).unwrap();
        let motion = BiParabolic::new(amplitude, 1.0 / amplitude).unwrap();
        Container::closed(10.0, 10.0).unwrap().with_part("peg", peg.with_motion(DVec2::X, motion).unwrap())
    };
    assert!(part(1e-9).is_ok());
    let error = part(1e-15).unwrap_err().to_string();
    assert!(error.starts_with("stroke of the part \"peg\" must be 0 or at least "), "{error}");
}
