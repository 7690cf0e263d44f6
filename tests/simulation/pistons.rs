//! Walls with a mass: exact balances, closed forms, thermodynamics of a gas under a lid.

use std::f64::consts::PI;

use granular_edmd::boundary::{Container, Wall};
use granular_edmd::collision::Elastic;
use granular_edmd::glam::DVec2;
use granular_edmd::observable::{Collision, CollisionCounts, Partner, Snapshot, on_collision};
use granular_edmd::simulation::Limits;
use granular_edmd::wall::{BiParabolic, Piston};
use granular_edmd::{Disk, Simulation, initial};

type Outcome<T = ()> = Result<T, Box<dyn std::error::Error>>;

/// Index of the lid of a closed container.
const LID: usize = 3;

/// Returns the displacement of the lid of a container of this height, and its velocity, along its normal.
fn lid(snapshot: &Snapshot<'_>, height: f64) -> (f64, f64) {
    let known = "the lid is known";
    (height - snapshot.wall_point(LID).expect(known).y, -snapshot.wall_velocity(LID).expect(known).y)
}

fn energy(snapshot: &Snapshot<'_>, piston: &Piston, height: f64) -> f64 {
    let disks: f64 = snapshot.disks().iter().map(Disk::translational_energy).sum();
    let pull = snapshot.gravity().acceleration();
    let fallen: f64 = snapshot.disks().iter().map(|disk| -disk.mass() * pull.dot(disk.position())).sum();
    let (displacement, velocity) = lid(snapshot, height);
    disks + fallen + piston.energy(displacement, velocity)
}

/// A piston on a spring over a fast disk: nothing is lost in many blows.
#[test]
fn energy_is_kept_over_many_blows() -> Outcome {
    let height = 6.0;
    let piston =
        Piston::new(7.0, [-1.0, 4.0])?.with_force(200.0)?.with_spring(3e4, 1.0)?.with_start(1.0, 0.5)?;
    let container = Container::closed(4.0, height)?.with_piston(Wall::Lid, piston)?;
    let disk = Disk::new(DVec2::new(2.0, 2.0), 0.4)?.with_velocity(DVec2::new(3.0, 60.0))?;
    let mut run = Simulation::builder(Elastic, container).disks([disk]).gravity(0.1).build()?;
    let before = energy(&run.snapshot(), &piston, height);
    let mut counts = CollisionCounts::default();
    while counts.collisions_with_wall("lid") < 200_000 {
        run.run(&Limits::collisions(200_000), &mut counts)?;
    }
    let blows = counts.collisions_with_wall("lid");
    let change = energy(&run.snapshot(), &piston, height) / before - 1.0;
    println!("{blows} blows, change of the energy {change:e}");
    assert!(change.abs() < 1e-12, "{change:e}");
    Ok(())
}

/// The momentum that a piston loses is that of its blows, and with those of the other wall, all momentum is
/// accounted for, over three million collisions.
#[test]
fn momentum_is_kept_over_a_million_blows() -> Outcome {
    let (mass, speed) = (1e12, 1e-3);
    let piston = Piston::new(mass, [-90.0, 9.6])?.with_start(0.0, speed)?;
    let container = Container::closed(10.0, 4.0)?.with_piston(Wall::Right, piston)?;
    let disk = Disk::new(DVec2::new(3.0, 2.0), 0.25)?.with_mass(1.0)?;
    let mut run = Simulation::builder(Elastic, container).disks([disk]).build()?;
    let (mut to_piston, mut from_left, mut blows) = (0.0, 0.0, 0);
    let mut sum = on_collision(|collision: &Collision| {
        if collision.partner == Partner::Wall(1) {
            from_left += collision.impulse.normal();
        } else {
            to_piston += collision.impulse.normal();
            blows += 1;
        }
    });
    run.run(&Limits::until(2e4).with_least_progress(0.0)?, &mut sum)?;
    // The piston moves to the left at first.
    let after = run.snapshot().wall_velocity(2).ok_or("it is known")?.x;
    let scale = mass * speed;
    let error = (mass * (after + speed) - to_piston) / scale;
    let carried = run.disks()[0].velocity().x;
    let all = (carried - from_left + to_piston) / scale;
    println!("{blows} blows; error of the momentum of the piston {error:e}, of all {all:e}");
    assert!(blows > 1_000_000 && error.abs() < 1e-12 && all.abs() < 1e-12);
    Ok(())
}

/// The same bits from a checkpoint, and however the run is cut.
#[cfg(feature = "serde")]
#[test]
fn a_resumed_piston_goes_on_with_the_same_bits() -> Outcome {
    let piston = Piston::new(30.0, [0.0, 9.0])?.with_force(3.0)?.with_spring(0.5, 2.0)?;
    let container = Container::closed(8.0, 12.0)?.with_piston(Wall::Lid, piston)?;
    let disks = initial::with_maxwellian_velocities(initial::lattice(&container, 20, 0.4)?, 1.0, 3)?;
    let mut whole = Simulation::builder(Elastic, container.clone()).disks(disks).gravity(0.1).build()?;
    let mut cut = whole.clone();
    whole.run_until(500.0, &mut ())?;
    for piece in 1..=50 {
        cut.run_until(f64::from(piece) * 10.0, &mut ())?;
        let kept = granular_edmd::simulation::Checkpoint::from_bytes(&cut.checkpoint().to_bytes()?)?;
        cut = Simulation::resume(&kept, Elastic, container.clone()).build()?;
    }
    assert_eq!(whole.disks(), cut.disks());
    assert_eq!(lid(&whole.snapshot(), 12.0), lid(&cut.snapshot(), 12.0));
    Ok(())
}

/// A lid alone: it falls to its stop, rests there, and leaves it on a spring, as the closed forms say.
#[test]
fn a_lid_without_disks_follows_its_closed_forms() -> Outcome {
    let at = |piston: Piston, time: f64| -> Outcome<(f64, f64)> {
        let container = Container::closed(4.0, 10.0)?.with_piston(Wall::Lid, piston)?;
        let mut run = Simulation::builder(Elastic, container).build()?;
        // In pieces, so that the epoch moves.
        for piece in 1..=10 {
            run.run_until(time * f64::from(piece) / 10.0, &mut ())?;
        }
        Ok(lid(&run.snapshot(), 10.0))
    };
    let near = |(displacement, velocity): (f64, f64), expected: (f64, f64)| {
        (displacement - expected.0).abs() < 1e-12 && (velocity - expected.1).abs() < 1e-12
    };
    let falling = Piston::new(2.0, [0.0, 8.0])?.with_force(1.0)?;
    assert!(near(at(falling, 4.0)?, (4.0, 2.0)));
    assert_eq!(at(falling, 100.0)?, (8.0, 0.0), "it rests at its stop");
    // About displacement 5 with frequency 1/2: from rest at 4, it swings to 6 and back.
    let swinging = Piston::new(4.0, [0.0, 8.0])?.with_spring(1.0, 5.0)?.with_start(4.0, 0.0)?;
    assert!(near(at(swinging, 2.0 * PI)?, (6.0, 0.0)));
    assert!(near(at(swinging, PI)?, (5.0, 0.5)));
    // From rest at 0, it comes to the stop at 8, stays there without velocity, and swings back to 2.
    let stopped = swinging.with_start(0.0, 0.0)?;
    let first = (PI - (3.0_f64 / 5.0).acos()) / 0.5;
    assert!(near(at(stopped, first + 2.0 * PI)?, (2.0, 0.0)));
    Ok(())
}

/// A slow compression by a heavy piston is adiabatic: in two dimensions, the energy of a gas of points grows
/// as the inverse of the volume.
#[test]
fn a_slow_compression_heats_as_the_inverse_volume() -> Outcome {
    let piston = Piston::new(1e9, [0.0, 15.0])?.with_start(0.0, 2e-3)?;
    let container = Container::closed(20.0, 20.0)?.with_piston(Wall::Lid, piston)?;
    // Small, so that the volume is the whole one; and not too small to mix both directions.
    let disks = initial::scattered(&container, 200, 0.05, 20.0, 5)?;
    let disks = initial::with_maxwellian_velocities(disks, 1.0, 6)?;
    let mut run = Simulation::builder(Elastic, container).disks(disks).build()?;
    let kinetic = |snapshot: &Snapshot<'_>| snapshot.mean(Disk::translational_energy);
    let before = kinetic(&run.snapshot());
    run.run_until(5000.0, &mut ())?;
    let volume = |height: f64| (height - 0.1) * 19.9;
    let expected = volume(20.0) / volume(10.0);
    let ratio = kinetic(&run.snapshot()) / before;
    println!("heated by {ratio}, adiabatically by {expected}");
    // The energy of 200 disks at one time is that of the adiabat within the pressure's noise of one crossing.
    assert!((ratio / expected - 1.0).abs() < 0.02, "{ratio} {expected}");
    Ok(())
}

/// Walls with a mass must not pass through each other, in whatever order they are set, also from a file.
#[test]
fn pistons_that_could_meet_the_opposite_wall_are_refused() -> Outcome {
    let piston = |highest| Piston::new(1.0, [-1.0, highest]);
    let both = |left, right| -> Outcome<Container> {
        let container = Container::closed(12.0, 9.0)?.with_piston(Wall::Left, piston(left)?)?;
        Ok(container.with_piston(Wall::Right, piston(right)?)?)
    };
    for (left, right) in [(0.0, 12.0), (8.0, 4.0), (9.0, -0.5)] {
        both(left, right)?;
    }
    for (left, right) in [(9.0, 9.0), (8.0, 4.1)] {
        let error = both(left, right).unwrap_err().to_string();
        let expected = "highest stop of a piston must be before the nearest place of the opposite wall";
        assert!(error.starts_with(expected), "{error}");
    }
    let floor = Container::closed(12.0, 9.0)?.with_piston(Wall::Floor, piston(9.5)?).unwrap_err();
    assert!(floor.to_string().contains("highest stop"), "{floor}");
    let shaken = Container::closed(12.0, 9.0)?.with_piston(Wall::Lid, piston(9.0)?)?;
    assert!(shaken.with_motion(Wall::Floor, BiParabolic::new(0.1, 10.0)?).is_err());
    let open = Container::open(12.0)?.with_piston(Wall::Floor, piston(1e9)?)?;
    open.with_motion(Wall::Left, BiParabolic::new(0.1, 10.0)?)?;
    Ok(())
}

/// At whatever time of a run the walls are set, a piston then begins at its start.
#[test]
fn a_piston_that_is_set_during_a_run_begins_then() -> Outcome {
    let piston = Piston::new(5.0, [-30.0, 30.0])?.with_force(0.5)?.with_start(2.0, -0.75)?;
    let with_piston = Container::closed(10.0, 40.0)?.with_piston(Wall::Lid, piston)?;
    for time in [0.0, 0.3, 5.2, 1234.5] {
        let disks = [Disk::new(DVec2::new(3.0, 4.0), 0.5)?.with_velocity(DVec2::new(1.0, 0.7))?];
        let run = || Simulation::builder(Elastic, Container::closed(10.0, 40.0)?).disks(disks).build();
        let (mut first, mut second) = (run()?, run()?);
        first.run_until(time, &mut ())?;
        second.run_until(time, &mut ())?;
        let mut runs = vec![second.with_boundary(with_piston.clone())?];
        #[cfg(feature = "serde")]
        runs.push(
            Simulation::resume(&first.checkpoint(), Elastic, with_piston.clone())
                .with_another_boundary()
                .build()?,
        );
        first.set_boundary(with_piston.clone())?;
        runs.push(first);
        for run in runs {
            let (displacement, velocity) = lid(&run.snapshot(), 40.0);
            assert!((displacement - 2.0).abs() < 1e-12, "{time}: {displacement}");
            assert!((velocity + 0.75).abs() < 1e-12, "{time}: {velocity}");
            assert_eq!(run.time(), time);
        }
    }
    Ok(())
}

/// The walls of a finished run, in a run that starts where the finished one started.
#[test]
fn a_new_run_begins_with_the_initial_state_of_used_walls() -> Outcome {
    let piston = Piston::new(2.0, [0.0, 10.0])?.with_force(0.5)?;
    let container = Container::closed(10.0, 20.0)?.with_piston(Wall::Lid, piston)?;
    let disks = initial::with_maxwellian_velocities(initial::lattice(&container, 20, 0.5)?, 1.0, 1)?;
    // Before the first impact, after some, and after the epoch has moved.
    for end in [1.0, 5.0, 9.0, 20.0, 40.0, 400.0] {
        let mut first = Simulation::builder(Elastic, container.clone()).disks(disks.clone()).build()?;
        first.run_until(end, &mut ())?;
        let used = first.boundary().clone();
        let mut second = Simulation::builder(Elastic, used).disks(disks.clone()).build()?;
        assert_eq!(lid(&second.snapshot(), 20.0), (0.0, 0.0), "{end}");
        second.run_until(end, &mut ())?;
        assert_eq!(
            (second.disks(), lid(&second.snapshot(), 20.0)),
            (first.disks(), lid(&first.snapshot(), 20.0))
        );
    }
    Ok(())
}

/// A light lid that takes disks out moves on with them, and gains no energy.
#[test]
fn a_light_sink_gains_no_energy() -> Outcome {
    for mass in [0.04, 1.0, 25.0] {
        let piston = Piston::new(mass, [-30.0, 5.0])?;
        let container =
            Container::closed(10.0, 20.0)?.with_piston(Wall::Lid, piston)?.absorbing(Wall::Lid)?;
        let disk =
            Disk::new(DVec2::new(5.0, 10.0), 0.5)?.with_mass(1.0)?.with_velocity(DVec2::new(0.3, 1.0))?;
        let mut run = Simulation::builder(Elastic, container).disks([disk]).build()?;
        run.run_until(12.0, &mut ())?;
        let (_, velocity) = lid(&run.snapshot(), 20.0);
        assert!((velocity + 1.0 / (1.0 + mass)).abs() < 1e-12, "{mass}: {velocity}");
        assert!(run.disks().is_empty());
    }
    Ok(())
}

/// A checkpoint keeps the piston, also for a caller who would allow other walls.
#[cfg(feature = "serde")]
#[test]
fn the_same_walls_are_not_other_walls() -> Outcome {
    let lid_of = |run: &Simulation<Elastic, Container>| lid(&run.snapshot(), 16.0);
    let piston =
        Piston::new(6.0, [-12.0, 9.0])?.with_force(1.5)?.with_spring(1.6, 1.0)?.with_start(2.0, 0.5)?;
    let container = Container::closed(14.0, 16.0)?.with_piston(Wall::Lid, piston)?;
    let disks = initial::lattice(&Container::closed(14.0, 10.0)?, 40, 0.4)?;
    let disks = initial::with_maxwellian_velocities(disks, 1.0, 3)?;
    let mut run = Simulation::builder(Elastic, container.clone()).disks(disks).gravity(0.1).build()?;
    run.run_until(3.0, &mut ())?;
    let mut resumed =
        Simulation::resume(&run.checkpoint(), Elastic, container).with_another_boundary().build()?;
    assert_eq!(lid_of(&resumed), lid_of(&run));
    for run in [&mut run, &mut resumed] {
        run.run_until(20.0, &mut ())?;
    }
    assert_eq!((resumed.disks(), lid_of(&resumed)), (run.disks(), lid_of(&run)));
    Ok(())
}

/// A piston and a motion of the same wall would replace each other.
#[test]
fn a_motion_does_not_replace_a_piston() -> Outcome {
    let (piston, base) = (Piston::new(5.0, [-1.0, 3.0])?, BiParabolic::new(0.1, 10.0)?);
    let container = Container::closed(10.0, 10.0)?;
    let refused = container.clone().with_piston(Wall::Lid, piston)?.with_motion(Wall::Lid, base).unwrap_err();
    assert!(refused.to_string().contains("would be lost"), "{refused}");
    assert!(container.clone().with_motion(Wall::Lid, base)?.with_piston(Wall::Lid, piston).is_err());
    container.with_piston(Wall::Lid, piston)?.with_piston(Wall::Lid, piston)?;
    Ok(())
}
