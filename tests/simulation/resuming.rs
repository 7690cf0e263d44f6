//! Checkpoints in files and inside other formats, and runs that go on with other parts.

use std::path::PathBuf;

use granular_edmd::boundary::{Container, Thermal, Wall};
use granular_edmd::collision::{CollisionRule, Contact, Elastic, Frictional, Impulse, from_fn};
use granular_edmd::glam::DVec2;
use granular_edmd::simulation::{Checkpoint, CheckpointError};
use granular_edmd::wall::Sinusoidal;
use granular_edmd::{Disk, Simulation, initial};
use serde::{Deserialize, Serialize};

fn walls() -> Container {
    let walls = Container::closed(12.0, 10.0).unwrap();
    walls.with_temperature(Wall::Floor, Thermal::new(2.0).unwrap()).unwrap()
}

fn rule() -> Frictional {
    Frictional::from_inelasticity(0.05, 0.05, 0.2).unwrap()
}

fn run<R: CollisionRule>(rule: R) -> Simulation<R> {
    let disks = initial::lattice(&walls(), 20, 0.5).unwrap();
    let disks = initial::with_maxwellian_velocities(disks, 1.0, 3).unwrap();
    let mut run = Simulation::builder(rule, walls()).disks(disks).gravity(0.05).seed(2).build().unwrap();
    run.run_until(4.0, &mut ()).unwrap();
    run
}

/// A user's own file, with a checkpoint inside.
#[derive(Serialize, Deserialize)]
struct Experiment {
    name: String,
    states: Vec<Checkpoint>,
    last: Option<Inner>,
}

#[derive(Serialize, Deserialize)]
struct Inner {
    state: Checkpoint,
}

fn experiment() -> (Experiment, Checkpoint) {
    let state = run(rule()).checkpoint();
    let last = Some(Inner { state: state.clone() });
    (Experiment { name: "gas".into(), states: vec![state.clone(), state.clone()], last }, state)
}

fn assert_same(read: &Experiment, state: &Checkpoint) {
    assert_eq!(read.name, "gas");
    let states = read.states.iter().chain(read.last.iter().map(|inner| &inner.state));
    for read in states {
        assert_eq!(read, state);
        let mut resumed = Simulation::resume(read, rule(), walls()).build().unwrap();
        let mut whole = run(rule());
        whole.run_until(9.0, &mut ()).unwrap();
        resumed.run_until(9.0, &mut ()).unwrap();
        assert_eq!(resumed.disks(), whole.disks());
        assert_eq!(resumed.counters(), whole.counters());
    }
}

#[test]
fn a_checkpoint_within_other_formats_is_exact() {
    let (experiment, state) = experiment();
    let json = serde_json::to_string_pretty(&experiment).unwrap();
    assert_same(&serde_json::from_str(&json).unwrap(), &state);
    let value = serde_json::to_value(&experiment).unwrap();
    assert_same(&serde_json::from_value(value).unwrap(), &state);
    let bytes = postcard::to_stdvec(&experiment).unwrap();
    assert_same(&postcard::from_bytes(&bytes).unwrap(), &state);
}

#[test]
fn damage_within_other_formats_is_told() {
    let state = run(rule()).checkpoint();
    let bytes: Vec<u8> = serde_json::from_value(serde_json::to_value(&state).unwrap()).unwrap();
    let refused = |change: &dyn Fn(&mut Vec<u8>)| {
        let mut bytes = bytes.clone();
        change(&mut bytes);
        serde_json::from_value::<Checkpoint>(serde_json::to_value(bytes).unwrap()).unwrap_err().to_string()
    };
    assert!(refused(&|bytes| bytes[0] ^= 1).contains("not a checkpoint"));
    assert!(refused(&|bytes| bytes[8] = 77).contains("version 77"));
    assert!(refused(&|bytes| bytes[100] ^= 1).contains("damaged"));
    assert!(refused(&|bytes| bytes.truncate(200)).contains("damaged"));
    assert!(refused(&Vec::clear).contains("not a checkpoint"));
    for json in ["[256]", "[-1]", "[1.5]", "\"text\"", "{}", "null", "[[1]]"] {
        assert!(serde_json::from_str::<Checkpoint>(json).is_err(), "{json}");
    }
}

#[test]
fn another_rule_or_boundary_is_taken_on_purpose_only() {
    let state = run(rule()).checkpoint();
    let other = || Frictional::from_inelasticity(0.05, 0.05, 0.21).unwrap();
    let error = Simulation::resume(&state, other(), walls()).build().map(|_| ()).unwrap_err();
    assert!(matches!(error, CheckpointError::AnotherRule), "{error}");
    let error =
        Simulation::resume(&state, Elastic, walls()).with_another_boundary().build().map(|_| ()).unwrap_err();
    assert!(matches!(error, CheckpointError::AnotherRule), "{error}");
    Simulation::resume(&state, other(), walls())
        .with_another_rule()
        .build()
        .unwrap()
        .run_until(9.0, &mut ())
        .unwrap();

    let hotter = || {
        Container::closed(12.0, 10.0)
            .unwrap()
            .with_temperature(Wall::Floor, Thermal::new(2.5).unwrap())
            .unwrap()
    };
    let wider = || Container::closed(14.0, 10.0).unwrap();
    let vibrated = || walls().with_motion(Wall::Lid, Sinusoidal::new(0.05, 3.0).unwrap()).unwrap();
    for (number, other) in
        [hotter(), wider(), vibrated(), walls().with_periodic_sides().unwrap()].into_iter().enumerate()
    {
        let error = Simulation::resume(&state, rule(), other.clone()).build().map(|_| ()).unwrap_err();
        assert!(matches!(error, CheckpointError::AnotherBoundary), "{number}: {error}");
        let error = Simulation::resume(&state, rule(), other.clone())
            .with_another_rule()
            .build()
            .map(|_| ())
            .unwrap_err();
        assert!(matches!(error, CheckpointError::AnotherBoundary), "{number}: {error}");
        match Simulation::resume(&state, rule(), other).with_another_boundary().build() {
            Ok(mut run) => {
                run.run_until(9.0, &mut ()).unwrap();
                assert!(run.counters().max_wall_overlap < 1e-9 && run.counters().max_overlap < 1e-9);
            }
            Err(error) => assert!(matches!(error, CheckpointError::Boundary(_)), "{number}: {error}"),
        }
    }
    let small = Container::closed(4.0, 4.0).unwrap();
    let error =
        Simulation::resume(&state, rule(), small).with_another_boundary().build().map(|_| ()).unwrap_err();
    assert!(matches!(error, CheckpointError::Boundary(_)), "{error}");
}

/// A change of the boundary during a run, and at a resumption, are the same.
#[test]
fn another_boundary_at_a_resumption_is_as_one_that_is_set() {
    let other = || {
        Container::closed(15.0, 11.0)
            .unwrap()
            .with_motion(Wall::Lid, Sinusoidal::new(0.05, 3.0).unwrap())
            .unwrap()
    };
    let mut set = run(rule());
    let state = set.checkpoint();
    set.set_boundary(other()).unwrap();
    let mut resumed = Simulation::resume(&state, rule(), other()).with_another_boundary().build().unwrap();
    set.run_until(20.0, &mut ()).unwrap();
    resumed.run_until(20.0, &mut ()).unwrap();
    assert_eq!(set.disks(), resumed.disks());
    assert_eq!(set.counters(), resumed.counters());
}

#[test]
fn only_two_parts_that_cannot_say_who_they_are_pass_for_each_other() {
    let closure =
        |loss: f64| from_fn(move |contact: &Contact| Impulse::new(contact.normal_impulse(1.0 - loss), 0.0));
    let refused = |state: &Checkpoint, rule: &dyn CollisionRule, walls: Container| {
        Simulation::resume(state, rule, walls).build().map(|_| ()).unwrap_err()
    };
    let unknown = run(closure(0.1)).checkpoint();
    Simulation::resume(&unknown, closure(0.2), walls()).build().unwrap();
    assert!(matches!(refused(&unknown, &rule(), walls()), CheckpointError::AnotherRule));
    let known = run(rule()).checkpoint();
    assert!(matches!(refused(&known, &closure(0.2), walls()), CheckpointError::AnotherRule));
    Simulation::resume(&known, closure(0.2), walls()).with_another_rule().build().unwrap();
    let unnamed = || walls().with_rule(Wall::Left, closure(0.1)).unwrap();
    assert!(matches!(refused(&known, &rule(), unnamed()), CheckpointError::AnotherBoundary));
    // The domain of two unknown boundaries is compared in any case.
    let builder = Simulation::builder(rule(), unnamed()).disks([]);
    let unnamed = builder.build().unwrap().checkpoint();
    let wider = Container::closed(13.0, 10.0).unwrap().with_rule(Wall::Left, closure(0.1)).unwrap();
    let error = refused(&unnamed, &rule(), wider);
    assert!(matches!(error, CheckpointError::Domain { .. }), "{error}");
}

#[test]
fn several_threads_may_write_one_file() {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("threads-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join("state");
    let mut longer = run(rule());
    let states = [longer.checkpoint(), {
        longer.run_until(6.0, &mut ()).unwrap();
        longer.checkpoint()
    }];
    states[0].write(&path).unwrap();
    std::thread::scope(|scope| {
        for state in states.iter().cycle().take(4) {
            let path = &path;
            scope.spawn(move || (0..100).for_each(|_| state.write(path).unwrap()));
        }
        for _ in 0..2 {
            scope
                .spawn(|| (0..300).for_each(|_| assert!(states.contains(&Checkpoint::read(&path).unwrap()))));
        }
    });
    assert_eq!(std::fs::read_dir(&folder).unwrap().count(), 1, "no temporary is left");
    std::fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn a_disk_that_has_turned_often_reads_back() {
    let spun = Disk::new(DVec2::splat(5.0), 0.5).unwrap().with_angular_velocity(1e60).unwrap();
    let mut run = Simulation::builder(Elastic, walls()).disks([spun]).build().unwrap();
    run.run_until(1e6, &mut ()).unwrap();
    let disks = run.disks();
    assert!(disks[0].angle() > 1e60);
    let json = serde_json::to_string(&disks).unwrap();
    let read: Vec<Disk> = serde_json::from_str(&json).unwrap();
    assert!((read[0].angle() / disks[0].angle() - 1.0).abs() < 1e-15);
    let bytes = postcard::to_stdvec(&disks).unwrap();
    assert_eq!(postcard::from_bytes::<Vec<Disk>>(&bytes).unwrap(), disks);
    let state = Checkpoint::from_bytes(&run.checkpoint().to_bytes().unwrap()).unwrap();
    assert_eq!(Simulation::resume(&state, Elastic, walls()).build().unwrap().disks(), disks);
}
