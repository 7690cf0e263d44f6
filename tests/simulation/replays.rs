//! Runs played back: any collision is made again, and differences of two runs are found where they are.

use granular_edmd::boundary::{Container, Wall};
use granular_edmd::collision::{Elastic, Smooth};
use granular_edmd::glam::DVec2;
use granular_edmd::observable::{Collision, SampleTimes, on_collision};
use granular_edmd::replay::{Replay, Replayed};
use granular_edmd::scheduler::{BySize, LinearScan};
use granular_edmd::simulation::{Inlet, RunError};
use granular_edmd::{Disk, Simulation, initial};

type Gas = Simulation<Elastic, Container, BySize>;

/// Returns a gas whose disks leave through one side and come back at the other.
fn gas() -> Gas {
    let container = Container::closed(15.0, 15.0).unwrap().absorbing(Wall::Right).unwrap();
    let disks = initial::lattice(&container, 60, 0.4).unwrap();
    let disks = initial::with_maxwellian_velocities(disks, 1.0, 4).unwrap();
    let mut gas = Simulation::builder(Elastic, container).disks(disks).build().unwrap();
    let (places, times) = ([DVec2::splat(1.0), DVec2::new(2.0, 14.0)], SampleTimes::every(0.5).unwrap());
    gas.add_inlet(Inlet::refill(places, DVec2::X, times, 9).unwrap()).unwrap();
    gas
}

/// Returns all collisions of a run until a time, as an observer sees them.
fn observed(mut run: Gas, end: f64) -> Vec<Collision> {
    let mut all = Vec::new();
    run.run_until(end, &mut on_collision(|collision: &Collision| all.push(*collision))).unwrap();
    all
}

#[test]
fn any_collision_is_made_again() {
    let all = observed(gas(), 20.0);
    assert!(all.len() > 500);
    // The shorter interval gives more states than are kept.
    for interval in [0.1, 0.7] {
        let mut replay = Replay::new(gas(), interval).unwrap();
        replay.run_until(11.0).unwrap();
        replay.run_until(20.0).unwrap();
        assert!(replay.present().counters().removals > 20);
        let played = replay.collisions(f64::NEG_INFINITY, 20.0).unwrap();
        assert!(played.iter().map(|replayed| replayed.collision).eq(all.iter().copied()));
        assert!(played.iter().map(|replayed| replayed.number).eq(1..=all.len() as u64));
        let window = replay.collisions(5.0, 9.0).unwrap();
        assert!(replay.collisions(9.0, 5.0).unwrap().is_empty());
        let within = |replayed: &&Replayed| (5.0..=9.0).contains(&replayed.collision.time);
        assert!(window.iter().eq(played.iter().filter(within)));
        for number in [1, 2, 77, 400, all.len() as u64] {
            let mut before = replay.before_collision(number).unwrap().unwrap();
            let mut next = None;
            before
                .step_until(20.0, &mut on_collision(|collision: &Collision| next = Some(*collision)))
                .unwrap();
            assert_eq!(next, Some(all[number as usize - 1]));
        }
        assert!(replay.before_collision(all.len() as u64 + 1).unwrap().is_none());
        assert!(replay.at(20.5).unwrap().is_none() && replay.at(-1.0).unwrap().is_none());
        assert_eq!(replay.at(20.0).unwrap().unwrap().disks(), replay.present().disks());
        // One that came in during the run, and may have had several indices.
        for id in [3, 65] {
            let own = |replayed: &&Replayed| replayed.id == id || replayed.partner_id == Some(id);
            let own: Vec<Replayed> = played.iter().filter(own).cloned().collect();
            assert!(own.len() > 4, "{id} {}", own.len());
            assert_eq!(replay.last_collisions_of(id, 20.0, 3).unwrap(), own[own.len() - 3..]);
            assert_eq!(replay.last_collisions_of(id, 20.0, 10_000).unwrap(), own);
        }
    }
}

#[test]
fn the_time_of_a_collision_is_a_time_up_to_which_it_is_played() {
    for start in [-7.3, 0.0, 2.7, 1e4] {
        let container = Container::closed(15.0, 15.0).unwrap();
        let disks = initial::lattice(&container, 60, 0.4).unwrap();
        let disks = initial::with_maxwellian_velocities(disks, 1.0, 4).unwrap();
        let run = Simulation::builder(Elastic, container).disks(disks).starting_at(start).build().unwrap();
        let mut replay = Replay::new(run, 1.7).unwrap();
        replay.run_until(start + 20.0).unwrap();
        let all = replay.collisions(f64::NEG_INFINITY, start + 20.0).unwrap();
        // Disks that touch two walls at the start have two collisions at the same time.
        let until = |time| &all[..all.partition_point(|replayed| replayed.collision.time <= time)];
        for (number, replayed) in all.iter().enumerate() {
            let (id, time) = (replayed.id, replayed.collision.time);
            let last = until(time).iter().rfind(|last| last.id == id || last.partner_id == Some(id));
            assert_eq!(replay.last_collisions_of(id, time, 1).unwrap(), [last.unwrap().clone()]);
            let state = replay.at(time).unwrap().unwrap();
            assert_eq!(state.counters().collisions(), until(time).len() as u64, "{time:?}");
            let to = all[(number + 3).min(all.len() - 1)].collision.time;
            assert_eq!(replay.collisions(time, to).unwrap(), until(to)[until(time).len()..], "{time:?}");
        }
    }
}

#[test]
fn runs_that_are_the_same_have_no_differences_and_others_have_them_where_they_are() {
    let replay = |run: Gas| {
        let mut replay = Replay::new(run, 0.5).unwrap();
        replay.run_until(60.0).unwrap();
        replay
    };
    let first = replay(gas());
    let none = first.differences(&replay(gas().with_scheduler(BySize::new())), 0.0).unwrap().unwrap();
    assert_eq!((none.partners, none.apart), (None, None));
    // A disk that is pushed at time 7 is apart from itself right after it.
    let mut pushed = gas();
    pushed.run_until(7.0, &mut ()).unwrap();
    let chosen = pushed.disks()[5];
    pushed.remove(|_, disk| disk.id() == chosen.id()).unwrap();
    let velocity = chosen.velocity() + DVec2::new(0.0, 1e-6);
    pushed.insert([chosen.with_velocity(velocity).unwrap()]).unwrap();
    let other = replay(pushed);
    let mut start = gas();
    start.run_until(7.0, &mut ()).unwrap();
    let found = replay(start).differences(&other, 1e-7).unwrap().unwrap();
    let apart = found.apart.unwrap();
    assert_eq!(apart.id, chosen.id());
    assert!((7.0999..7.1001).contains(&apart.time), "{apart:?}");
    let partners = found.partners.unwrap();
    let time = partners.collisions[0].collision.time;
    assert!(time > apart.time && time < 60.0, "{partners:?}");
    let [one, two] = &partners.collisions;
    assert!([one, two].iter().all(|seen| seen.id == partners.id || seen.partner_id == Some(partners.id)));
    assert!(first.differences(&replay_of_another_time(), 0.1).unwrap().is_none());
}

fn replay_of_another_time() -> Replay<Elastic, Container, BySize> {
    let container = Container::closed(15.0, 15.0).unwrap();
    let late = Simulation::builder(Elastic, container).starting_at(0.1).build().unwrap();
    Replay::new(late, 0.5).unwrap()
}

#[test]
fn the_collisions_before_an_error_can_be_played_back() {
    let disk = Disk::new(DVec2::new(2.0, 3.0), 0.5).unwrap();
    let rule = Smooth::from_restitution(0.5).unwrap();
    let container = Container::open(4.0).unwrap();
    let ball = Simulation::builder(rule, container).disks([disk]).gravity(1.0).build().unwrap();
    let mut replay = Replay::new(ball.clone().with_scheduler(LinearScan::default()), 1.0).unwrap();
    assert!(matches!(replay.run_until(100.0), Err(RunError::Stalled { .. })));
    // The bounces come ever faster until the time 3 √5.
    let last = replay.last_collisions_of(1, f64::INFINITY, 3).unwrap();
    let collapse = 3.0 * 5.0_f64.sqrt();
    assert!(last.iter().all(|replayed| (replayed.collision.time - collapse).abs() < 1e-6), "{last:?}");
    let before = replay.before_collision(5).unwrap().unwrap();
    assert_eq!(before.counters().wall_collisions, 4);
    // The state in which it ended is there, too, and times without an end are refused.
    let present = replay.present();
    assert_eq!(replay.at(present.time()).unwrap().unwrap().disks(), present.disks());
    assert!(matches!(replay.clone().run_until(f64::NAN), Err(RunError::End { .. })));
    // The other ball goes on, and is compared until the first one ends. Their last common states lie far
    // before the difference.
    let mut first = Replay::new(ball.clone(), 1.0).unwrap();
    assert!(first.run_until(100.0).is_err());
    let mut other = Replay::new(ball.with_rule(Smooth::from_restitution(0.501).unwrap()), 1.0).unwrap();
    assert!(other.run_until(100.0).is_err());
    for (one, two) in [(&first, &other), (&other, &first)] {
        let found = one.differences(two, 1e-3).unwrap().unwrap();
        assert!(found.partners.is_none());
        // The first bounce, at √5, is the same; afterwards, the speeds differ by 0.001 √5.
        let time = found.apart.unwrap().time - 5.0_f64.sqrt();
        assert!((time - 1e-3 / (1e-3 * 5.0_f64.sqrt())).abs() < 1e-6, "{time}");
    }
}

/// An end before the present is refused, and says nothing about the run.
#[test]
fn an_end_in_the_past_is_refused() {
    let mut replay = Replay::new(gas(), 1.0).unwrap();
    replay.run_until(2.0).unwrap();
    assert!(matches!(replay.run_until(1.0), Err(RunError::End { .. })));
    assert!(replay.run_until(3.0).is_ok());
}
