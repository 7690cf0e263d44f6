//! Disks that come and go during runs: sinks and inlets.

use std::collections::{BTreeMap, BTreeSet};
use std::error::Error;
use std::time::Instant;

use granular_edmd::boundary::{Container, Part, Wall, laws};
use granular_edmd::collision::{Elastic, Frictional, LeastRebound};
use granular_edmd::glam::DVec2;
use granular_edmd::initial;
use granular_edmd::observable::{Arrivals, OfKind, SampleTimes};
#[cfg(feature = "serde")]
use granular_edmd::simulation::Checkpoint;
use granular_edmd::simulation::{BuildError, Inlet, RunError, Warning};
use granular_edmd::wall::{BiParabolic, Combined, Sinusoidal, WallMotion};
use granular_edmd::{Disk, Kind, Simulation};

use support::schedulers::{SCHEDULERS, Scheduler};

type Silo = Simulation<LeastRebound<Frictional>, Container, Scheduler>;

fn line(y: f64, width: f64) -> Part {
    Part::polyline([DVec2::new(-1.0, y), DVec2::new(width + 1.0, y)]).unwrap()
}

fn rule() -> LeastRebound<Frictional> {
    LeastRebound::new(Frictional::from_inelasticity(0.1, 0.1, 0.4).unwrap(), 0.2).unwrap()
}

/// Returns a silo with an outlet and a sink below it.
fn vessel(width: f64, outlet: f64) -> Container {
    let half = |side: f64| {
        let x = |away: f64| 0.5 * width + side * away;
        Part::polyline([DVec2::new(x(0.5 * outlet), 4.0), DVec2::new(x(0.5 * width + 1.0), 4.0)])
    };
    Container::open(width)
        .unwrap()
        .with_part("left half", half(-1.0).unwrap())
        .and_then(|vessel| vessel.with_part("right half", half(1.0)?))
        .and_then(|vessel| vessel.with_part("exit", line(1.0, width).absorbing_centers()))
        .unwrap()
}

/// Returns a silo whose grains, of three sizes and two kinds, come back above when they have left.
fn silo(width: f64, outlet: f64, rows: usize, scheduler: Scheduler) -> Silo {
    let columns = width as usize;
    let grain = |k: usize| {
        let place = DVec2::new(0.5 + (k % columns) as f64, 5.0 + (k / columns) as f64);
        let moving = DVec2::new(0.1 * libm::sin(k as f64), 0.0);
        let grain = Disk::new(place, [0.3, 0.4, 0.45][k % 3]).unwrap();
        grain.with_kind(Kind::new(u16::from(k % 3 == 2))).with_velocity(moving).unwrap()
    };
    let builder = Simulation::builder(rule(), vessel(width, outlet)).gravity(1.0).scheduler(scheduler);
    let mut silo = builder.disks((0..columns * rows).map(grain)).build().unwrap();
    let top = 8.0 + rows as f64;
    let places = [DVec2::new(1.0, top), DVec2::new(width - 1.0, top + 6.0)];
    let times = SampleTimes::every(0.25).unwrap();
    silo.add_inlet(Inlet::refill(places, DVec2::new(0.0, -2.0), times, 5).unwrap()).unwrap();
    silo
}

/// Checks that no grain is lost, doubled or in another: by numbers, masses, ids and distances.
fn check_balance(silo: &Silo, grains: usize, mass: f64) {
    let (inside, counters) = (silo.disks(), silo.counters());
    let waiting = silo.inlets()[0].waiting();
    assert_eq!(inside.len() + waiting, grains);
    assert_eq!(counters.removals - counters.insertions, waiting as u64);
    let ids: BTreeSet<u64> = inside.iter().map(Disk::id).collect();
    assert_eq!(ids.len(), inside.len(), "ids are unique");
    assert!(*ids.last().unwrap() <= grains as u64 + counters.insertions);
    if waiting == 0 {
        let now: f64 = inside.iter().map(Disk::mass).sum();
        assert!((now - mass).abs() < 1e-9 * mass, "{now} {mass}");
    }
    assert_eq!(deepest(&inside), 0.0);
}

/// Returns the depth of the deepest overlap, by brute force; 0 for rounding.
fn deepest(disks: &[Disk]) -> f64 {
    let depth = |a: &Disk, b: &Disk| a.radius() + b.radius() - a.position().distance(b.position());
    let all = disks.iter().enumerate();
    let deepest = all.flat_map(|(k, a)| disks[k + 1..].iter().map(move |b| depth(a, b))).fold(0.0, f64::max);
    if deepest < 1e-9 { 0.0 } else { deepest }
}

/// Runs a silo for so many removals, in looks of this duration.
fn refilled(mut silo: Silo, removals: u64, look: f64) -> Silo {
    let (grains, mass) = (silo.len(), silo.disks().iter().map(Disk::mass).sum());
    while silo.counters().removals < removals {
        silo.run_until(silo.time() + look, &mut ()).unwrap();
        check_balance(&silo, grains, mass);
    }
    silo
}

#[test]
fn a_silo_that_is_refilled_keeps_ids_numbers_and_mass() {
    let silo = refilled(silo(12.0, 4.0, 8, SCHEDULERS[0]()), 10_000, 100.0);
    assert!(silo.counters().max_overlap < 1e-9);
}

#[test]
#[ignore = "long: minutes"]
fn a_silo_of_a_thousand_is_refilled_a_million_times() {
    let started = Instant::now();
    let silo = refilled(silo(25.0, 18.0, 40, SCHEDULERS[0]()), 1_000_000, 100.0);
    println!("{:?}\n{:.0} s", silo.counters(), started.elapsed().as_secs_f64());
}

/// A shower onto a floor that takes all disks out: so many removals cost the same among few disks and many.
#[test]
#[ignore = "a measurement"]
fn removals_and_insertions_cost_the_same_among_few_disks_and_many() {
    for width in [125.0_f64, 12_500.0] {
        let container = Container::open(width).unwrap().absorbing(Wall::Floor).unwrap();
        let mut run = Simulation::builder(Elastic, container).build().unwrap();
        let drop = Disk::new(DVec2::ZERO, 0.1).unwrap().with_velocity(DVec2::NEG_Y).unwrap();
        let places = [DVec2::new(1.0, 8.0), DVec2::new(width - 1.0, 8.0)];
        let times = SampleTimes::every(1.0 / width).unwrap();
        run.add_inlet(Inlet::new(places, [drop], times, 1).unwrap()).unwrap();
        run.run_until(40.0, &mut ()).unwrap();
        let (before, started) = (*run.counters(), Instant::now());
        run.run_until(40.0 + 100_000.0 / width, &mut ()).unwrap();
        let (seconds, counters) = (started.elapsed().as_secs_f64(), run.counters().since(&before));
        println!("{} disks, {:.2} µs for each removal: {counters:?}", run.len(), 1e6 * seconds / 1e5);
    }
}

#[cfg(feature = "serde")]
#[test]
fn the_bits_are_those_of_every_scheduler_checkpoint_and_cut() {
    let mut whole = silo(12.0, 4.0, 8, SCHEDULERS[0]());
    whole.run_until(60.0, &mut ()).unwrap();
    assert!(whole.counters().removals > 200);
    for (number, scheduler) in SCHEDULERS.iter().enumerate() {
        let mut cut = silo(12.0, 4.0, 8, scheduler());
        for piece in 1..=60 {
            let end = f64::from(piece);
            if number == 0 {
                while cut.step_until(end, &mut ()).unwrap().is_some() {}
            } else {
                cut.run_until(end, &mut ()).unwrap();
            }
            if piece % 7 == 3 {
                let bytes = cut.checkpoint().to_bytes().unwrap();
                let checkpoint = Checkpoint::from_bytes(&bytes).unwrap();
                let next = SCHEDULERS[(number + piece as usize) % SCHEDULERS.len()];
                let resumed = Simulation::resume(&checkpoint, rule(), vessel(12.0, 4.0)).scheduler(next());
                cut = resumed.build().unwrap();
                assert_eq!(cut.checkpoint().to_bytes().unwrap(), bytes);
            }
        }
        assert_eq!(cut.disks(), whole.disks());
        assert_eq!(cut.counters(), whole.counters());
        assert_eq!(cut.inlets(), whole.inlets());
    }
}

/// Disks of very different sizes come and go through all layers of cells, where sides are periodic, too.
#[test]
fn large_and_small_disks_come_and_go() {
    for is_periodic in [false, true] {
        let container = Container::closed(40.0, 40.0).unwrap().absorbing(Wall::Floor).unwrap();
        let container = if is_periodic { container.with_periodic_sides().unwrap() } else { container };
        let model = |k: u32| {
            let radius = [0.2, 0.25, 3.0, 0.2, 1.0][k as usize % 5];
            let speed = DVec2::new(f64::from(k % 7) - 3.0, -1.0);
            Disk::new(DVec2::ZERO, radius).unwrap().with_velocity(speed).unwrap()
        };
        let mut run = Simulation::builder(Elastic, container).gravity(0.1).build().unwrap();
        for (y, interval) in [(20.0, 0.03), (36.0, 0.05)] {
            let places = [DVec2::new(3.5, y), DVec2::new(36.5, y + 0.5)];
            let times = SampleTimes::every(interval).unwrap();
            run.add_inlet(Inlet::new(places, (0..35).map(model), times, 8).unwrap()).unwrap();
        }
        for piece in 1..=30 {
            run.run_until(2.0 * f64::from(piece), &mut ()).unwrap();
            assert_eq!(deepest(&run.disks()), 0.0);
        }
        let counters = run.counters();
        assert!(counters.removals > 150 && run.len() > 50, "{} {}", counters.removals, run.len());
        assert_eq!(counters.insertions - counters.removals, run.len() as u64);
        // The inlets go, and all disks fall out.
        assert_eq!(run.remove_inlets().len(), 2);
        run.run_until(2000.0, &mut ()).unwrap();
        assert!(run.is_empty());
    }
}

/// By time t, an ideal gas at rest loses n √(T/2πm) t disks for each length of an absorbing wall.
#[test]
fn an_absorbing_wall_takes_the_flux_of_kinetic_theory() {
    const COUNT: usize = 10_000;
    let container = Container::closed(100.0, 100.0).unwrap().absorbing(Wall::Right).unwrap();
    let disks = initial::scattered(&container, COUNT, 1e-3, 100.0, 2).unwrap();
    let disks = initial::with_maxwellian_velocities(disks, 1.0, 3).unwrap();
    let mut run = Simulation::builder(Elastic, container).disks(disks).build().unwrap();
    let mut flow = Arrivals::at(["right"], SampleTimes::every(5.0).unwrap());
    run.run_until(10.0, &mut flow).unwrap();
    let lost = COUNT - run.len();
    assert_eq!(flow.counts().iter().sum::<u64>(), lost as u64);
    // Of 399 disks, the standard deviation is 20; the bound is five of them.
    let expected = COUNT as f64 / 100.0 * (1.0 / std::f64::consts::TAU).sqrt() * 10.0;
    assert!((lost as f64 - expected).abs() < 100.0, "{lost} {expected}");
}

#[test]
fn kinds_are_counted_apart_and_a_sink_receives_all_of_the_momentum() {
    let mut silo = silo(12.0, 4.0, 8, SCHEDULERS[0]());
    let walls = silo.boundary().walls_of("exit").unwrap();
    let count = |kind| OfKind::new(kind, Arrivals::at(["exit"], SampleTimes::every(1.0).unwrap()));
    let mut flows = (count(Kind::new(0)), count(Kind::new(1)));
    let mut received = DVec2::ZERO;
    let mut sum =
        granular_edmd::observable::on_collision(|collision: &granular_edmd::observable::Collision| {
            if collision.partner == granular_edmd::observable::Partner::Wall(walls.start) {
                received += collision.impulse.normal() * collision.normal;
            }
        });
    silo.run_until(40.0, &mut (&mut flows, &mut sum)).unwrap();
    let sums: [u64; 2] = [flows.0.inner(), flows.1.inner()].map(|flow| flow.counts().iter().sum());
    assert_eq!(sums[0] + sums[1], silo.counters().removals);
    // A third of the grains are of the second kind.
    assert!(sums[0] > sums[1] && sums[1] > 20, "{sums:?}");
    assert!(flows.0.inner().rate().unwrap().mean() > 1.0);
    // Grains fall onto the line from above, so its impulses on them point upward.
    assert!(received.y > 2.0 * silo.counters().removals as f64 * 0.1);
}

/// A part takes disks out at the touch, or when the center arrives.
#[test]
fn a_sink_takes_disks_at_the_touch_or_by_their_centers() {
    let times = [2.49, 2.51, 2.74, 2.76, 2.99, 3.01];
    let at_touch = (line(3.0, 8.0).absorbing(), [2, 1, 1, 0, 0, 0]);
    let by_centers = (line(3.0, 8.0).absorbing_centers(), [2, 2, 2, 2, 2, 0]);
    for (part, left) in [at_touch, by_centers] {
        let mut vessel = Container::closed(8.0, 20.0).unwrap().with_part("sink", part).unwrap();
        laws::check(&mut vessel, 0.25, 1.0, 3).unwrap();
        let disk = |x: f64, radius: f64| Disk::new(DVec2::new(x, 6.0), radius).unwrap();
        let disks = [disk(2.0, 0.5), disk(5.0, 0.25)].map(|disk| disk.with_velocity(DVec2::NEG_Y).unwrap());
        let mut run = Simulation::builder(Elastic, vessel).disks(disks).build().unwrap();
        let lengths = times.map(|time| run.run_until(time, &mut ()).map(|_| run.len()).unwrap());
        assert_eq!(lengths, left);
        run.run_until(1e6, &mut ()).unwrap();
    }
}

#[test]
fn what_an_inlet_cannot_do_is_an_error() {
    let container = Container::closed(8.0, 8.0).unwrap();
    let mut run = Simulation::builder(Elastic, container).build().unwrap();
    let places = |x: f64, y: f64| [DVec2::new(1.0, 1.0), DVec2::new(x, y)];
    let times = SampleTimes::every(1.0).unwrap();
    let inlet = |places| Inlet::refill(places, DVec2::ZERO, times, 0);
    assert!(inlet(places(0.5, 2.0)).is_err());
    assert!(inlet(places(f64::NAN, 2.0)).is_err());
    assert!(Inlet::new(places(2.0, 2.0), [], times, 0).is_err());
    assert!(Inlet::refill(places(2.0, 2.0), DVec2::NAN, times, 0).is_err());
    let error = run.add_inlet(inlet(places(2.0, 9.0)).unwrap()).unwrap_err();
    assert_eq!(error.to_string(), "place of an inlet must be within the ends of the domain, but is 9");
    let slow = Disk::new(DVec2::ZERO, 0.5).unwrap().with_velocity(DVec2::splat(1e-200)).unwrap();
    assert!(run.add_inlet(Inlet::new(places(2.0, 2.0), [slow], times, 0).unwrap()).is_err());
    // Where there is no room, disks wait.
    let large = Disk::new(DVec2::ZERO, 3.0).unwrap();
    run.add_inlet(Inlet::new(places(7.0, 7.0), [large], times, 0).unwrap()).unwrap();
    run.run_until(10.0, &mut ()).unwrap();
    assert_eq!((run.len(), run.inlets()[0].waiting()), (1, 9));
    // Late times are too coarse for an inlet that opens so often.
    let container = Container::closed(8.0, 8.0).unwrap();
    let mut late = Simulation::builder(Elastic, container).starting_at(1e15).build().unwrap();
    late.add_inlet(Inlet::new(places(7.0, 7.0), [large], SampleTimes::every(0.5).unwrap(), 0).unwrap())
        .unwrap();
    assert!(late.run_until(1e15 + 10.0, &mut ()).is_err());
}

#[test]
fn an_inlet_that_could_never_let_in_is_refused() {
    let times = SampleTimes::every(1.0).unwrap();
    let room = |size: f64| Container::closed(size, size).unwrap();
    let box_of_ten = || Simulation::builder(Elastic, room(10.0)).build().unwrap();
    let places = [DVec2::splat(2.0), DVec2::splat(8.0)];
    let giant = Disk::new(DVec2::ZERO, 1e30).unwrap();
    let error = box_of_ten().add_inlet(Inlet::new(places, [giant], times, 1).unwrap()).unwrap_err();
    assert!(matches!(error, BuildError::DomainTooSmall { .. }), "{error}");
    let slow = Inlet::refill(places, DVec2::new(1e-120, 0.0), times, 1).unwrap();
    let error = box_of_ten().add_inlet(slow).unwrap_err().to_string();
    assert!(error.contains("1e-120"), "{error}");

    let mut run = box_of_ten();
    let small = Disk::new(DVec2::ZERO, 0.1).unwrap();
    run.add_inlet(Inlet::new(places, [small], times, 1).unwrap()).unwrap();
    let error = run.set_boundary(room(5.0)).unwrap_err().to_string();
    assert!(error.contains("place of an inlet must be within the sides of the domain, but is 8"), "{error}");
    assert!(run.clone().with_boundary(room(5.0)).is_err());
    // A domain that holds the places may be too small for the models.
    let mut large = box_of_ten();
    let model = Disk::new(DVec2::ZERO, 0.9).unwrap();
    large.add_inlet(Inlet::new([DVec2::splat(1.0); 2], [model], times, 1).unwrap()).unwrap();
    let narrow = Container::closed(3.0, 10.0).unwrap().with_periodic_sides().unwrap();
    let error = large.set_boundary(narrow).unwrap_err();
    assert!(matches!(error, BuildError::DomainTooSmall { .. }), "{error}");
    run.run_until(3.5, &mut ()).unwrap();
    assert_eq!(run.len(), 3);
}

/// The inlet lies inside of a block.
#[test]
fn disks_that_wait_at_an_inlet_are_warned_of() {
    let corners = [(2.0, 2.0), (8.0, 2.0), (8.0, 8.0), (2.0, 8.0)];
    let block = Part::block(corners.map(|(x, y)| DVec2::new(x, y))).unwrap();
    let walls = Container::closed(10.0, 10.0).unwrap().with_part("block", block).unwrap();
    let mut run = Simulation::builder(Elastic, walls).build().unwrap();
    let (places, small) = ([DVec2::splat(4.0), DVec2::splat(6.0)], Disk::new(DVec2::ZERO, 0.1).unwrap());
    run.add_inlet(Inlet::new(places, [small], SampleTimes::every(1.0).unwrap(), 1).unwrap()).unwrap();
    run.run_until(999.0, &mut ()).unwrap();
    assert_eq!(run.warnings(), []);
    run.run_until(1000.0, &mut ()).unwrap();
    assert_eq!(run.warnings(), [Warning::DisksWait { inlet: 0, waiting: 1000 }]);
}

#[test]
fn an_inlet_without_ids_or_times_ends_the_run() {
    let places = [DVec2::splat(2.0), DVec2::splat(8.0)];
    let small = Disk::new(DVec2::ZERO, 0.1).unwrap();
    let walls = || Container::closed(10.0, 10.0).unwrap();
    let cause = |error: RunError| format!("{error}: {}", error.source().unwrap());

    let last = small.with_id(1 << 53).unwrap().with_position(DVec2::splat(9.0)).unwrap();
    let mut run = Simulation::builder(Elastic, walls()).disks([last]).build().unwrap();
    let times = SampleTimes::every(1.0).unwrap();
    run.add_inlet(Inlet::new(places, [small], times, 1).unwrap()).unwrap();
    let error = cause(run.run_until(5.0, &mut ()).unwrap_err());
    assert!(error.contains("an inlet failed at time 1: largest id so far"), "{error}");

    let mut late = Simulation::builder(Elastic, walls()).starting_at(1e9).build().unwrap();
    let times = SampleTimes::every(1e-8).unwrap();
    late.add_inlet(Inlet::new(places, [small], times, 1).unwrap()).unwrap();
    let error = cause(late.run_until(2e9, &mut ()).unwrap_err());
    assert!(error.contains("time of the next opening"), "{error}");
}

/// Returns how many disks pass a line for centers, and how many it takes out. The function returns the height
/// of a place above the line at a time.
fn passed(part: Part, height: impl Fn(DVec2, f64) -> f64, speed: f64) -> Result<[usize; 2], Box<dyn Error>> {
    let container = Container::closed(20.0, 20.0)?;
    let disks =
        initial::with_maxwellian_velocities(initial::scattered(&container, 40, 0.4, 20.0, 2)?, 1.0, 2)?;
    let slowed = disks.into_iter().map(|disk| disk.with_velocity(speed * disk.velocity()));
    let disks = slowed.collect::<Result<Vec<_>, _>>()?;
    let vessel = container.with_part("line", part.absorbing_centers())?;
    laws::check(&mut vessel.clone(), 0.4, 1.0, 5)?;
    let gravity = speed * DVec2::new(0.1, -0.3);
    let mut run = Simulation::builder(Elastic, vessel).disks(disks).gravity(gravity).build()?;
    let signs = |run: &Simulation<_, _>| -> BTreeMap<u64, bool> {
        let side = |disk: &Disk| (disk.id(), height(disk.position(), run.time()) > 0.0);
        run.disks().iter().map(side).collect()
    };
    let (mut before, mut passed) = (signs(&run), 0);
    for step in 1..=1500 {
        run.run_until(0.01 * f64::from(step), &mut ())?;
        let now = signs(&run);
        passed += now.iter().filter(|(id, side)| before[id] != **side).count();
        before = now;
    }
    Ok([passed, 40 - run.len()])
}

/// No center passes a line for centers: not a line at rest, where all events are predicted anew just as one
/// of these disks arrives, and not a line that shakes or turns, among disks in motion or at rest.
#[test]
fn no_center_passes_a_line_for_centers() -> Result<(), Box<dyn Error>> {
    let line = || Part::polyline([(-30.0, 10.0), (50.0, 10.0)].map(DVec2::from));
    let (sine, parabolas, late) = (
        Sinusoidal::new(0.6, 2.0)?,
        BiParabolic::new(0.6, 2.0)?,
        Combined::new(Sinusoidal::new(2.0, 0.7)?).delayed_until(5.0)?,
    );
    let (turn, middle) = (0.1, DVec2::splat(10.0));
    for speed in [0.0, 1.0] {
        let shaken = |motion: &dyn WallMotion, part: Part| {
            let phase = |time: f64| motion.period().map_or(time, |period| time.rem_euclid(period));
            let way = |time| motion.state(phase(time)).displacement;
            passed(part, |place, time| place.y - 10.0 - way(time), speed)
        };
        let turned = |place: DVec2, time: f64| DVec2::from_angle(-turn * time).rotate(place - middle).y;
        let outcomes = [
            passed(line()?, |place, _| place.y - 10.0, speed)?,
            shaken(&sine, line()?.with_motion(DVec2::Y, sine)?)?,
            shaken(&parabolas, line()?.with_motion(DVec2::Y, parabolas)?)?,
            shaken(&late, line()?.with_motion(DVec2::Y, late.clone())?)?,
            passed(line()?.with_rotation(middle, turn)?, turned, speed)?,
        ];
        assert_eq!(outcomes.map(|[passed, _]| passed), [0; 5], "{outcomes:?}");
        assert!(outcomes[usize::from(speed == 0.0)..].iter().all(|&[_, taken]| taken > 0), "{outcomes:?}");
    }
    Ok(())
}
