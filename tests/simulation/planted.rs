//! Rules, boundaries, schedulers and observers that break their contract: each is named, and the state is
//! whole afterwards. A run that is wrong does not end as if it were right.

use std::cell::Cell;
use std::ops::ControlFlow;
use std::rc::Rc;

use granular_edmd::boundary::{
    Boundary, Brick, Container, Domain, FirstTouch, Overlap, Part, Probe, Region, Surface, Touch, Wall,
    WallView,
};
use granular_edmd::collision::{CollisionRule, Contact, Elastic, Frictional, Impulse};
use granular_edmd::glam::DVec2;
use granular_edmd::observable::{Collision, Observer, ObserverError, Partner, Snapshot, Verdict};
use granular_edmd::scheduler::{EventScheduler, LinearScan};
use granular_edmd::simulation::{BoundaryFault, BuildError, RunError};
use granular_edmd::wall::{AccelerationBounds, WallMotion, WallState};
use granular_edmd::{Disk, Flight, Simulation, initial};
use oracles::deepest_overlap;
use support::cases::few;

fn walls() -> Container {
    Container::closed(12.0, 10.0).unwrap()
}

fn gas(container: &Container, count: usize) -> Vec<Disk> {
    let disks = initial::lattice(container, count, 0.5).unwrap();
    initial::with_maxwellian_velocities(disks, 1.0, 3).unwrap()
}

fn disks() -> Vec<Disk> {
    gas(&walls(), 20)
}

/// Asserts that all disks are at possible places after an error, and that a checkpoint is a state from which
/// a run with honest parts goes on.
fn assert_whole<R: CollisionRule, B: Boundary, S: EventScheduler>(run: &Simulation<R, B, S>) {
    let walls = walls();
    for disk in run.disks() {
        assert!(disk.position().is_finite() && disk.velocity().is_finite() && disk.angle().is_finite());
        let overlap = walls.overlap(&Probe::new(disk.position(), disk.radius(), 0.0));
        assert!(overlap.is_none_or(|overlap| overlap.depth < 1e-9), "{overlap:?} at {}", run.time());
    }
    #[cfg(feature = "serde")]
    {
        use granular_edmd::simulation::Checkpoint;
        let checkpoint = Checkpoint::from_bytes(&run.checkpoint().to_bytes().unwrap()).unwrap();
        let resumption = Simulation::resume(&checkpoint, Elastic, walls);
        let mut honest = resumption.with_another_rule().with_another_boundary().build().unwrap();
        honest.run_until(honest.time() + 5.0, &mut ()).unwrap();
    }
}

#[derive(Debug, Clone, Copy)]
enum Lie {
    None,
    Time(f64),
    Beyond,
    Wall(usize),
    Normal(DVec2),
    Velocity(DVec2),
    /// An overlap is no number.
    NoDepth,
    /// Disks touch when they are this deep in a wall; with a negative depth, before they touch it.
    Depth(f64),
    /// Overlaps are not told.
    Blind,
    /// Disks do not touch the floor.
    NoFloor,
}

/// A container that tells the truth this many times.
#[derive(Clone)]
struct Liar {
    honest: Container,
    truths: Rc<Cell<u32>>,
    lie: Lie,
}

impl Liar {
    fn lies(&self) -> bool {
        let truths = self.truths.get();
        self.truths.set(truths.saturating_sub(1));
        truths == 0
    }
}

impl Boundary for Liar {
    fn domain(&self) -> Domain {
        self.honest.domain()
    }
    fn wall_count(&self) -> usize {
        self.honest.wall_count()
    }
    fn set_time_origin(&mut self, origin: f64) {
        self.honest.set_time_origin(origin);
    }
    fn wall(&self, wall: usize, time: f64) -> WallView<'_> {
        self.honest.wall(wall, time)
    }
    fn may_touch(&self, region: &Region, radius: f64) -> bool {
        self.honest.may_touch(region, 1.1 * radius)
    }
    fn first_touch(&self, flight: &Flight, until: f64) -> FirstTouch<Touch> {
        let touch = self.honest.first_touch(flight, until);
        match self.lie {
            Lie::Depth(depth) => {
                let (start, pull) = (flight.time(), flight.acceleration());
                let (place, velocity) = (flight.position(start), flight.velocity(start));
                let other = Flight::new(start, place, velocity, pull, flight.radius() - depth);
                self.honest.first_touch(&other, until)
            }
            Lie::NoFloor => touch.touch().filter(|touch| touch.wall != 0).into(),
            Lie::Time(wait) if self.lies() => FirstTouch::At(Touch::new(flight.time() + wait, 0)),
            Lie::Beyond if self.lies() => {
                FirstTouch::At(Touch::new(if until == f64::INFINITY { until } else { until.next_up() }, 0))
            }
            Lie::Wall(wall) if self.lies() => FirstTouch::At(Touch::new(flight.time(), wall)),
            _ => touch,
        }
    }
    fn surface(&self, wall: usize, position: DVec2, time: f64) -> Surface<'_> {
        let surface = self.honest.surface(wall, position, time);
        match self.lie {
            Lie::Normal(normal) if self.lies() => Surface::new(normal, surface.velocity),
            Lie::Velocity(velocity) if self.lies() => Surface::new(surface.normal, velocity),
            _ => surface,
        }
    }
    fn overlap(&self, probe: &Probe) -> Option<Overlap> {
        match self.lie {
            Lie::NoDepth if self.lies() => Some(Overlap::new(2, f64::NAN)),
            Lie::Blind => None,
            _ => self.honest.overlap(probe),
        }
    }
}

fn run_among_liars(lie: Lie, truths: u32) -> (Simulation<Elastic, Liar>, Result<f64, RunError>) {
    let liar = Liar { honest: walls(), truths: Rc::new(Cell::new(truths)), lie };
    let mut run = Simulation::builder(Elastic, liar).disks(disks()).build().unwrap();
    let mut last = 0.0;
    let end = loop {
        match run.step_until(50.0, &mut ()) {
            Ok(Some(_)) => {}
            Ok(None) => break Ok(run.time()),
            Err(error) => break Err(error),
        }
        assert!(run.time() >= last);
        last = run.time();
    };
    (run, end)
}

#[test]
fn touches_that_cannot_be_are_named() {
    let lies = [
        Lie::Time(-1.0),
        Lie::Time(-f64::MIN_POSITIVE.sqrt().sqrt()),
        Lie::Time(f64::NAN),
        Lie::Time(f64::INFINITY),
        Lie::Time(f64::NEG_INFINITY),
        Lie::Time(-1e300),
        Lie::Beyond,
        Lie::Wall(4),
        Lie::Wall(70_000),
        Lie::Wall((1 << 16) + 1),
        Lie::Wall(usize::MAX),
    ];
    let all = lies.into_iter().flat_map(|lie| [0, 1, 57, 300].map(|truths| (lie, truths)));
    for (lie, truths) in few(all, 3) {
        let (run, end) = run_among_liars(lie, truths);
        let error = end.unwrap_err();
        let is_lost = matches!(lie, Lie::Time(wait) if wait.abs() < 1e-70);
        if is_lost && matches!(error, RunError::FalseContact { .. } | RunError::Stalled { .. }) {
            // So short a time is lost in the sum. This is a touch at once, in mid-air, or again and again.
            continue;
        }
        let RunError::Boundary { fault: BoundaryFault::Touch { wall, walls, early_by, .. }, time, .. } =
            error
        else {
            panic!("{lie:?} {truths}: {error}")
        };
        assert_eq!(walls, 4);
        assert!(time.is_finite() && time >= 0.0 && time == run.time());
        match lie {
            Lie::Wall(named) => assert_eq!(wall, named),
            Lie::Time(wait) if wait.is_finite() => assert!(early_by > 0.0, "{lie:?}: {early_by}"),
            _ => {}
        }
        assert_whole(&run);
    }
    assert!(run_among_liars(Lie::None, 0).1.is_ok());
}

#[test]
fn surfaces_that_cannot_be_are_named() {
    let normals = [
        DVec2::ZERO,
        DVec2::NAN,
        DVec2::new(0.0, 1.1),
        DVec2::new(f64::INFINITY, 0.0),
        DVec2::new(1e-3, 0.0),
        DVec2::splat(1e200),
    ];
    let velocities = [
        DVec2::NAN,
        DVec2::new(f64::INFINITY, 0.0),
        DVec2::new(0.0, f64::NEG_INFINITY),
        DVec2::new(1e200, 0.0),
    ];
    let lies = normals.map(Lie::Normal).into_iter().chain(velocities.map(Lie::Velocity));
    for (lie, truths) in lies.flat_map(|lie| [0, 13].map(|truths| (lie, truths))) {
        let (run, end) = run_among_liars(lie, truths);
        let error = end.unwrap_err();
        assert!(
            matches!(error, RunError::Boundary { fault: BoundaryFault::Surface { .. }, .. }),
            "{lie:?}: {error}"
        );
        assert_whole(&run);
    }
}

/// It would stay the largest depth, so that no later one would be noticed.
#[test]
fn a_depth_that_is_no_number_is_named() {
    let liar = Liar { honest: walls(), truths: Rc::new(Cell::new(7)), lie: Lie::NoDepth };
    let error = Simulation::builder(Elastic, liar).disks(disks()).build().err().unwrap();
    assert!(matches!(error, BuildError::OverlapsWall { disk: 7, depth, .. } if depth.is_nan()), "{error}");
    for truths in [20, 33] {
        let (run, end) = run_among_liars(Lie::NoDepth, truths);
        let error = end.unwrap_err();
        assert!(matches!(error, RunError::FalseContact { depth, .. } if depth.is_nan()), "{error}");
        assert_whole(&run);
    }
}

#[test]
fn too_many_walls_are_refused() {
    struct Many(Container, usize);
    impl Boundary for Many {
        fn domain(&self) -> Domain {
            self.0.domain()
        }
        fn wall_count(&self) -> usize {
            self.1
        }
        fn set_time_origin(&mut self, _: f64) {}
        fn may_touch(&self, _: &Region, _: f64) -> bool {
            true
        }
        fn first_touch(&self, flight: &Flight, until: f64) -> FirstTouch<Touch> {
            self.0.first_touch(flight, until).map(|touch| Touch::new(touch.time, self.1 - 1 - touch.wall))
        }
        fn surface(&self, wall: usize, position: DVec2, time: f64) -> Surface<'_> {
            self.0.surface(self.1 - 1 - wall, position, time)
        }
        fn overlap(&self, probe: &Probe) -> Option<Overlap> {
            self.0.overlap(probe)
        }
    }
    let build = |count| Simulation::builder(Elastic, Many(walls(), count)).disks(disks()).build();
    for count in [(1 << 16) + 1, 70_000, usize::MAX] {
        let error = build(count).map(|_| ()).unwrap_err();
        let BuildError::Parameter(error) = error else { panic!("{error}") };
        assert_eq!((error.name(), error.value()), ("number of walls", count as f64));
    }
    // The last that can be numbered is named as it is.
    let mut run = build(1 << 16).unwrap();
    let mut named = Vec::new();
    let mut log = granular_edmd::observable::on_collision(|collision: &Collision| {
        if let Partner::Wall(wall) = collision.partner {
            named.push(wall);
        }
    });
    run.run_until(20.0, &mut log).unwrap();
    assert!(named.iter().all(|&wall| wall >= (1 << 16) - 4) && named.contains(&((1 << 16) - 1)));
}

/// The false answer of a scheduler, from the true one.
type Answer = fn((usize, f64)) -> (usize, f64);

/// A scheduler that is wrong from some answer on.
struct Misled {
    honest: LinearScan,
    sets: u32,
    truths: u32,
    wrong: fn((usize, f64)) -> (usize, f64),
}

impl EventScheduler for Misled {
    fn reset(&mut self, due: &[f64]) {
        self.honest.reset(due);
    }
    fn set(&mut self, disk: usize, due: f64) {
        self.sets += 1;
        self.honest.set(disk, due);
    }
    fn earliest(&self) -> (usize, f64) {
        let honest = self.honest.earliest();
        if self.sets >= self.truths { (self.wrong)(honest) } else { honest }
    }
    fn upcoming(&mut self, disks: &mut Vec<usize>) {
        disks.extend([usize::MAX, 1 << 40, 20]);
    }
}

#[test]
fn schedulers_that_name_what_is_not_so_are_named() {
    let lies: [Answer; 8] = [
        |(_, due)| (20, due),
        |(_, due)| (usize::MAX, due),
        |(disk, _)| (disk, f64::NAN),
        |(disk, due)| (disk, due - 1.0),
        |(disk, due)| (disk, due.next_down()),
        |(disk, _)| (disk, f64::NEG_INFINITY),
        |(disk, due)| ((disk + 1) % 20, due),
        |(disk, _)| (disk, -1e300),
    ];
    for (number, wrong) in lies.into_iter().enumerate() {
        for truths in [0, 1, 100, 999] {
            let scheduler = Misled { honest: LinearScan::new(), sets: 0, truths, wrong };
            let builder = Simulation::builder(Elastic, walls()).disks(disks()).scheduler(scheduler);
            let mut run = builder.build().unwrap();
            let error = run.run_until(50.0, &mut ()).unwrap_err();
            assert!(matches!(error, RunError::Scheduler { .. }), "{number} {truths}: {error}");
            assert!(run.time().is_finite() && run.time() >= 0.0);
            assert_whole(&run);
        }
    }
}

#[test]
fn sample_times_that_cannot_be_are_named() {
    struct Clock(fn(f64) -> f64, f64);
    impl Observer for Clock {
        fn next_sample(&self) -> f64 {
            self.1
        }
        fn on_sample(&mut self, _: &Snapshot<'_>) {
            self.1 = (self.0)(self.1);
        }
    }
    let clocks: [fn(f64) -> f64; 5] =
        [|_| f64::NAN, |time| time, |time| time - 1.0, |time| time.next_down(), |_| f64::NEG_INFINITY];
    for clock in clocks {
        let mut run = Simulation::builder(Elastic, walls()).disks(disks()).build().unwrap();
        let error = run.run_until(5.0, &mut Clock(clock, 1.0)).unwrap_err();
        assert!(matches!(error, RunError::SampleTime { time: 1.0, .. }), "{error}");
        assert_whole(&run);
        run.run_until(6.0, &mut ()).unwrap();
    }
    let mut run = Simulation::builder(Elastic, walls()).disks(disks()).build().unwrap();
    let error = run.run_until(5.0, &mut Clock(|time| time, f64::NAN)).unwrap_err();
    assert!(matches!(error, RunError::SampleTime { next, time: 0.0, .. } if next.is_nan()), "{error}");
    // A clock that is behind catches up, and one that never beats is left alone.
    run.run_until(5.0, &mut Clock(|time| time + 1.0, -3.0)).unwrap();
    run.run_until(6.0, &mut Clock(|time| time, f64::INFINITY)).unwrap();
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Stage {
    Start,
    Collision,
    Sample,
    End,
}

/// An observer that fails at one of its calls, and counts the others.
#[derive(Default)]
struct Failing {
    at: Option<Stage>,
    due: bool,
    starts: u32,
    ends: u32,
    collisions_after: u32,
    sampled: bool,
}

impl Failing {
    fn reach(&mut self, stage: Stage) {
        self.due |= self.at == Some(stage);
    }
}

impl Observer for Failing {
    fn on_start(&mut self, _: &Snapshot<'_>) -> Result<(), ObserverError> {
        self.starts += 1;
        self.reach(Stage::Start);
        Ok(())
    }
    fn on_collision(&mut self, _: &Collision) {
        self.collisions_after += u32::from(self.due);
        self.reach(Stage::Collision);
    }
    fn next_sample(&self) -> f64 {
        if self.sampled { f64::INFINITY } else { 1.0 }
    }
    fn on_sample(&mut self, _: &Snapshot<'_>) {
        self.sampled = true;
        self.reach(Stage::Sample);
    }
    fn on_end(&mut self, _: &Snapshot<'_>) {
        self.ends += 1;
        self.reach(Stage::End);
    }
    fn verdict(&mut self) -> Verdict {
        if self.due { Err("the disk is full".into()) } else { Ok(ControlFlow::Continue(())) }
    }
}

#[test]
fn an_observer_that_fails_ends_the_run_there() {
    for stage in [Stage::Start, Stage::Collision, Stage::Sample, Stage::End] {
        let mut run = Simulation::builder(Elastic, walls()).disks(disks()).build().unwrap();
        let mut failing = Failing { at: Some(stage), ..Failing::default() };
        let error = run.run_until(5.0, &mut failing).unwrap_err();
        let RunError::Observer { time, source } = &error else { panic!("{stage:?}: {error}") };
        assert_eq!(source.to_string(), "the disk is full");
        assert!(!error.to_string().contains("full"), "the source is told once: {error}");
        assert_eq!(*time, run.time());
        match stage {
            Stage::Start => assert_eq!(*time, 0.0),
            Stage::Collision => {
                assert_eq!(run.counters().disk_collisions + run.counters().wall_collisions, 1);
            }
            Stage::Sample => assert_eq!(*time, 1.0),
            Stage::End => assert_eq!(*time, 5.0),
        }
        assert_eq!((failing.starts, failing.ends, failing.collisions_after), (1, 1, 0), "{stage:?}");
        assert_whole(&run);
        // Nothing is lost: the run goes on with the bits that it would have had.
        run.run_until(9.0, &mut ()).unwrap();
        let mut plain = Simulation::builder(Elastic, walls()).disks(disks()).build().unwrap();
        plain.run_until(9.0, &mut ()).unwrap();
        assert_eq!(run.disks(), plain.disks(), "{stage:?}");
    }
}

#[test]
fn an_end_before_the_present_tells_no_observer() {
    let mut run = Simulation::builder(Elastic, walls()).disks(disks()).starting_at(3.0).build().unwrap();
    let mut failing = Failing::default();
    assert!(matches!(run.run_until(2.0, &mut failing), Err(RunError::End { .. })));
    assert_eq!((failing.starts, failing.ends), (0, 0));
}

/// A rule that fails with this impulse after this many contacts.
struct Failed {
    truths: Cell<u32>,
    impulse: fn(&Contact) -> Impulse,
}

impl CollisionRule for Failed {
    fn impulse(&self, contact: &Contact) -> Impulse {
        if self.truths.get() == 0 {
            return (self.impulse)(contact);
        }
        self.truths.set(self.truths.get() - 1);
        Elastic.impulse(contact)
    }
}

#[test]
fn an_outcome_that_is_no_motion_names_both_partners_and_the_contact() {
    let impulses: [fn(&Contact) -> Impulse; 7] = [
        |_| Impulse::new(f64::NAN, 0.0),
        |_| Impulse::new(0.0, f64::NAN),
        |_| Impulse::new(f64::INFINITY, 0.0),
        |_| Impulse::new(1.0, f64::NEG_INFINITY),
        |_| Impulse::new(f64::MAX, 0.0),
        |_| Impulse::new(1e61, 0.0),
        |_| Impulse::new(0.5, 1e61),
    ];
    let (mut pairs, mut walls_named) = (0, 0);
    for impulse in impulses {
        for truths in [0, 1, 2, 3, 10, 50, 51, 52, 53, 200] {
            let rule = Failed { truths: Cell::new(truths), impulse };
            let mut run = Simulation::builder(rule, walls()).disks(disks()).build().unwrap();
            let error = run.run_until(50.0, &mut ()).unwrap_err();
            let said = error.to_string();
            let RunError::NotFinite(failed) = error else { panic!("{error}") };
            assert!(failed.disk < 20 && failed.time == run.time());
            let closing = failed.contact.closing_speed();
            assert!(closing >= 0.0 && closing.is_finite());
            let asked = impulse(&failed.contact);
            let same = |a: f64, b: f64| a.to_bits() == b.to_bits();
            assert!(
                same(failed.impulse.normal(), asked.normal())
                    && same(failed.impulse.tangential(), asked.tangential())
            );
            let names = match failed.partner {
                Partner::Disk(partner) => {
                    pairs += 1;
                    format!("disks {} and {partner}", failed.disk)
                }
                Partner::Wall(wall) => {
                    walls_named += 1;
                    let name = run.boundary().wall(wall, 0.0).to_string();
                    let names = format!("disk {} with the wall {name:?}", failed.disk);
                    assert_eq!(failed.wall, Some(name));
                    names
                }
            };
            assert!(
                said.contains(&names) && said.contains(" leads to no finite motion: closing at "),
                "{said}"
            );
            assert_whole(&run);
            // An infinite velocity does not stay. With the rule repaired, the run goes on.
            run.set_rule(Failed { truths: Cell::new(u32::MAX), impulse });
            run.run_until(50.0, &mut ()).unwrap();
            assert_whole(&run);
        }
    }
    assert!(pairs > 10 && walls_named > 10, "{pairs} {walls_named}");
}

/// The changes are finite each, and together lead beyond all bounds.
#[test]
fn velocities_that_grow_beyond_all_bounds_end_the_run() {
    let growing = granular_edmd::collision::from_fn(|contact: &Contact| {
        Impulse::new(contact.normal_mass() * contact.closing_speed() * 1e9, 0.0)
    });
    let mut run = Simulation::builder(growing, walls()).disks(disks()).build().unwrap();
    let error = loop {
        if let Err(error) = run.step_until(run.time() + 1.0, &mut ()) {
            break error;
        }
    };
    assert!(matches!(error, RunError::NotFinite(_) | RunError::TimeTooLate { .. }), "{error}");
    assert!(run.disks().iter().all(|disk| disk.velocity().abs().max_element() <= 1e60));
    let error = loop {
        if let Err(error) = run.step_until(run.time() + 1.0, &mut ()) {
            break error;
        }
    };
    assert!(matches!(error, RunError::NotFinite(_) | RunError::TimeTooLate { .. }), "{error}");
}

/// A rule under which every contact is asserted to be one.
struct Strict<R>(R);

impl<R: CollisionRule> CollisionRule for Strict<R> {
    fn impulse(&self, contact: &Contact) -> Impulse {
        let closing = contact.closing_speed();
        assert!(closing >= 0.0 && closing.is_finite() && closing.is_sign_positive(), "{contact}");
        assert!(contact.slip_speed().is_finite(), "{contact}");
        assert!(contact.normal_mass() > 0.0 && contact.tangential_mass() > 0.0, "{contact}");
        assert!(contact.tangential_mass() <= contact.normal_mass(), "{contact}");
        assert!(contact.time_since_last_collision() >= 0.0, "{contact}");
        self.0.impulse(contact)
    }
}

/// Does this many collisions, or all if there are fewer, since disks at rest on a wall collide without end.
fn take_steps<R: CollisionRule, B: Boundary>(run: &mut Simulation<R, B>, steps: usize) {
    for _ in 0..steps {
        if !matches!(run.step_until(200.0, &mut ()), Ok(Some(_))) {
            break;
        }
    }
}

#[test]
fn no_rule_is_given_a_closing_speed_below_zero() {
    use granular_edmd::boundary::Thermal;
    use granular_edmd::wall::{BiParabolic, Sawtooth, Sinusoidal, Triangular};
    let rules = || {
        [
            Frictional::from_inelasticity(0.0, 0.0, 0.2),
            Frictional::from_inelasticity(0.1, 0.1, 0.0),
            Frictional::from_inelasticity(0.3, 0.3, 0.5),
            Frictional::from_inelasticity(0.5, 0.5, 0.1),
        ]
        .map(Result::unwrap)
    };
    let containers = [
        Ok(walls()),
        walls().with_motion(Wall::Floor, Sinusoidal::new(0.1, 50.0).unwrap()),
        walls().with_motion(Wall::Lid, BiParabolic::new(0.1, 10.0).unwrap()),
        walls().with_motion(Wall::Left, Sawtooth::new(0.1, 10.0).unwrap()),
        walls().with_motion(Wall::Right, Triangular::new(0.1, 10.0).unwrap()),
        walls().with_temperature(Wall::Floor, Thermal::new(2.0).unwrap()),
        Ok(walls().with_periodic_sides().unwrap()),
    ];
    for (container, rule) in
        containers.into_iter().map(Result::unwrap).flat_map(|c| rules().map(|r| (c.clone(), r)))
    {
        for gravity in [0.0, 0.3] {
            let builder =
                Simulation::builder(Strict(rule), container.clone()).disks(disks()).gravity(gravity);
            let mut run = builder.build().unwrap();
            take_steps(&mut run, 5000);
        }
    }
    for (speed, rule) in [0.0, 0.3, -7.0].into_iter().flat_map(|speed| rules().map(|rule| (speed, rule))) {
        let rim = Part::drum(DVec2::ZERO, 4.0).unwrap().with_surface_speed(speed).unwrap();
        let drum = Container::around([("rim", rim)]).unwrap();
        let places =
            (-2..=2).flat_map(|x| (-2..=2).map(move |y| 1.1 * DVec2::new(f64::from(x), f64::from(y))));
        let disks = places.map(|place| Disk::new(place, 0.45).unwrap()).collect();
        let disks = initial::with_maxwellian_velocities(disks, 1.0, 9).unwrap();
        for gravity in [0.0, 0.5] {
            let builder =
                Simulation::builder(Strict(rule), drum.clone()).disks(disks.clone()).gravity(gravity);
            let mut run = builder.build().unwrap();
            take_steps(&mut run, 5000);
            assert!(run.counters().wall_collisions > 20, "{speed} {rule:?}: {:?}", run.counters());
            assert!(run.counters().max_wall_overlap < 1e-9, "{speed} {rule:?}: {:?}", run.counters());
        }
    }
}

/// Runs one disk that falls onto the floor of a container with a fault.
fn fall(lie: Lie, honest: Container) -> (Simulation<Elastic, Liar>, Result<(), RunError>) {
    let disk = Disk::new(DVec2::new(6.0, 5.0), 0.5).unwrap().with_velocity(DVec2::new(0.3, 0.0)).unwrap();
    let builder =
        Simulation::builder(Elastic, Liar { honest, truths: Rc::default(), lie }).disks([disk]).gravity(1.0);
    let mut run = builder.build().unwrap();
    let end = run.run_until(100.0, &mut ()).map(|_| ());
    (run, end)
}

#[test]
fn a_collision_away_from_its_wall_ends_the_run() {
    for fault in [0.01, 1e-6, -0.01, -1e-6] {
        let (run, end) = fall(Lie::Depth(fault), walls());
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
        let (run, end) = fall(Lie::Depth(depth), walls());
        end.unwrap();
        assert!((run.counters().max_wall_overlap - depth).abs() < 1e-13, "{:?}", run.counters());
    }
}

#[test]
fn a_boundary_that_tells_no_overlap_is_named() {
    let error = fall(Lie::Blind, walls()).1.unwrap_err();
    assert!(matches!(error, RunError::FalseContact { depth: f64::NEG_INFINITY, .. }), "{error}");
    assert!(error.to_string().contains("does `overlap` know"), "{error}");
}

#[test]
fn a_disk_that_passes_a_wall_is_noticed() {
    // Between periodic sides, there is no other wall that it could meet.
    for sides in [walls(), walls().with_periodic_sides().unwrap()] {
        let (run, end) = fall(Lie::NoFloor, sides);
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
            deepest = deepest.max(deepest_overlap(&run.boundary().domain(), &run.disks()));
            Ok::<(), RunError>(())
        });
        errors += u32::from(end.is_err());
        assert!(end.is_err() || deepest < 1e-9, "{sets_until_lost}: {deepest}");
    }
    assert!(errors > 400, "{errors}");
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
