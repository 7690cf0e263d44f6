//! The ends of runs: each limit ends the run, says so, and leaves the bits as they would have been.

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use granular_edmd::boundary::Container;
use granular_edmd::collision::{Frictional, Smooth};
use granular_edmd::glam::DVec2;
use granular_edmd::observable::{Collision, on_collision, stop_when};
use granular_edmd::simulation::{Limits, Remedy, RunEnd, RunError};
use granular_edmd::{Disk, Simulation};

use crate::setups::{Log, elastic_gas, shaken_and_heated};

const END: f64 = 300.0;

fn run() -> Simulation<Frictional> {
    shaken_and_heated().build().unwrap()
}

/// The collisions and the last state of a run that no limit cuts.
fn whole() -> (Vec<Collision>, Vec<Disk>) {
    let (mut run, mut log) = (run(), Log(Vec::new()));
    assert_eq!(run.run_until(END, &mut log).unwrap(), RunEnd::Time);
    (log.0, run.disks())
}

#[test]
fn a_run_cut_by_numbers_of_collisions_has_exactly_these_and_the_same_bits() {
    let (collisions, disks) = whole();
    let (mut run, mut log) = (run(), Log(Vec::new()));
    for most in [0, 1, 2, 3, 7, 50, 500].into_iter().cycle() {
        let before = log.0.len();
        let end = run.run(&Limits::until(END).with_most_collisions(most), &mut log).unwrap();
        if end == RunEnd::Time {
            break;
        }
        assert_eq!((end, log.0.len() - before), (RunEnd::Collisions, most as usize));
    }
    assert!(collisions.len() > 2000, "{}", collisions.len());
    assert_eq!((log.0, run.disks()), (collisions, disks));
}

#[test]
fn a_run_cut_by_the_clock_has_the_same_bits() {
    let (collisions, disks) = whole();
    let (mut run, mut log) = (run(), Log(Vec::new()));
    let at_once = Limits::until(END).with_wall_clock(Duration::ZERO);
    assert_eq!(run.run(&at_once, &mut log).unwrap(), RunEnd::WallClock);
    assert_eq!((run.time(), log.0.len()), (0.0, 0));
    let limits = Limits::until(END).with_wall_clock(Duration::from_millis(2));
    while run.run(&limits, &mut log).unwrap() == RunEnd::WallClock {}
    assert_eq!((log.0, run.disks()), (collisions, disks));
    assert_eq!(run.run(&Limits::until(END).with_wall_clock(Duration::MAX), &mut ()).unwrap(), RunEnd::Time);
}

/// The flag is looked at once in 1024 events.
#[test]
fn a_run_cut_by_a_flag_has_the_same_bits() {
    let (collisions, disks) = whole();
    let flag = AtomicBool::new(false);
    let limits = Limits::until(END).with_interrupt(&flag);
    let (mut run, mut all, mut cuts) = (run(), Vec::new(), 0);
    loop {
        let before = run.counters().events();
        let mut raised = 0;
        let mut watch = on_collision(|collision: &Collision| {
            all.push(*collision);
            raised += u64::from(!flag.swap(true, Ordering::Relaxed));
        });
        let end = run.run(&limits, &mut watch).unwrap();
        if end == RunEnd::Time {
            break;
        }
        assert_eq!((end, raised), (RunEnd::Interrupted, 1));
        assert!(run.counters().events() - before <= 1025);
        flag.store(false, Ordering::Relaxed);
        cuts += 1;
    }
    assert!(cuts > 2, "{cuts}");
    assert_eq!((all, run.disks()), (collisions, disks));
}

#[test]
fn another_thread_ends_a_run() {
    let flag = AtomicBool::new(false);
    let mut gas = elastic_gas(30, 20.0, 20.0, 0.0);
    let limits = Limits::until(1e9).with_interrupt(&flag);
    let end = std::thread::scope(|scope| {
        let running = scope.spawn(|| gas.run(&limits, &mut ()).unwrap());
        std::thread::sleep(Duration::from_millis(20));
        flag.store(true, Ordering::Relaxed);
        running.join().unwrap()
    });
    assert_eq!(end, RunEnd::Interrupted);
    assert_eq!(gas.run(&limits, &mut ()).unwrap(), RunEnd::Interrupted);
}

#[test]
fn the_first_limit_ends_the_run() {
    let limits = Limits::until(5.0).with_most_collisions(u64::MAX).with_wall_clock(Duration::from_secs(3600));
    assert_eq!(limits.end(), 5.0);
    let (mut run, mut count) = (run(), 0);
    assert_eq!(run.run(&limits, &mut ()).unwrap(), RunEnd::Time);
    let mut third = stop_when(|_: &Collision| {
        count += 1;
        count == 3
    });
    let limits = Limits::until(END).with_most_collisions(4);
    assert_eq!(run.run(&limits, &mut third).unwrap(), RunEnd::Observer);
    let error = run.run(&Limits::until(f64::INFINITY), &mut ()).unwrap_err();
    assert!(matches!(error, RunError::End { .. }), "{error}");
}

/// Limits are asked at each sample, too: a run without events ends.
#[test]
fn samples_without_events_end_at_a_limit() {
    let disk = Disk::new(DVec2::splat(2.0), 0.5).unwrap();
    let container = Container::open(4.0).unwrap();
    let mut run = Simulation::builder(Smooth::from_inelasticity(0.1).unwrap(), container)
        .disks([disk])
        .build()
        .unwrap();
    let times = granular_edmd::observable::SampleTimes::every(1e-6).unwrap();
    let mut samples = granular_edmd::observable::on_sample(times, |_: &_| ());
    let limits = Limits::until(1e6).with_wall_clock(Duration::from_millis(5));
    assert_eq!(run.run(&limits, &mut samples).unwrap(), RunEnd::WallClock);
}

#[test]
fn the_least_progress_is_the_callers() {
    let error = Limits::until(1.0).with_least_progress(-1.0).unwrap_err();
    assert!(error.to_string().contains("least progress") && error.to_string().contains("-1"), "{error}");
    assert!(Limits::until(1.0).with_least_progress(f64::NAN).is_err());

    let mut gas = elastic_gas(30, 20.0, 20.0, 0.0);
    let impatient = Limits::until(1e9).with_least_progress(1.0).unwrap();
    let error = gas.run(&impatient, &mut ()).unwrap_err();
    let RunError::Stalled { events, elapsed, remedy, .. } = error else { panic!("{error}") };
    assert_eq!((events, remedy), (200_600, Remedy::LessProgress));
    assert!(elapsed > 0.0 && elapsed < 200_600.0, "{elapsed}");
    gas.run_until(gas.time() + 10.0, &mut ()).unwrap();
}

/// A ball that comes to rest.
fn ball() -> Simulation<Smooth> {
    let disk = Disk::new(DVec2::new(2.0, 1.5), 0.5).unwrap();
    let rule = Smooth::from_restitution(0.5).unwrap();
    Simulation::builder(rule, Container::open(4.0).unwrap()).disks([disk]).gravity(1.0).build().unwrap()
}

#[test]
fn a_run_stalls_at_the_same_event_however_it_is_cut() {
    let mut plain = ball();
    let error = plain.run_until(10.0, &mut ()).unwrap_err();
    let expected = (error.to_string(), plain.counters().events(), plain.disks());

    let mut cut = ball();
    let limits = Limits::until(10.0).with_most_collisions(777).with_wall_clock(Duration::from_secs(60));
    let error = loop {
        match cut.run(&limits, &mut ()) {
            Ok(end) => assert_eq!(end, RunEnd::Collisions),
            Err(error) => break error,
        }
    };
    assert_eq!((error.to_string(), cut.counters().events(), cut.disks()), expected);

    let mut stepped = ball();
    let error = loop {
        if let Err(error) = stepped.step_until(10.0, &mut ()) {
            break error;
        }
    };
    assert_eq!((error.to_string(), stepped.counters().events(), stepped.disks()), expected);
}

/// Without a least progress, only the other limits end a run that stands still.
#[test]
fn a_run_may_stand_still_if_its_caller_says_so() {
    let limits = Limits::until(10.0).with_least_progress(0.0).unwrap().with_most_collisions(1_000_000);
    let mut still = ball();
    assert_eq!(still.run(&limits, &mut ()).unwrap(), RunEnd::Collisions);
    assert!(still.time() < 4.3, "{}", still.time());
}
