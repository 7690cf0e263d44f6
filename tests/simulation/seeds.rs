//! Random numbers of a run: they follow from the seed and from when they are drawn, and from nothing else.

use granular_edmd::boundary::Thermal;
use granular_edmd::prelude::*;
use granular_edmd::simulation::{Inlet, WhiteNoise};

type Outcome<T = ()> = Result<T, Box<dyn std::error::Error>>;

/// A gas between thermal walls, whose disks have the ids from 1 on.
fn hot_walls() -> Outcome<Container> {
    let container = Container::closed(20.0, 20.0)?.with_temperature(Wall::Floor, Thermal::new(1.0)?)?;
    Ok(container.with_temperature(Wall::Lid, Thermal::new(1.0)?)?)
}

/// A noise that is made anew for each piece of a run continues, and a second one with another stream differs.
#[test]
fn a_noise_made_anew_goes_on() -> Outcome {
    let container = Container::periodic(20.0, 20.0)?;
    let disks = initial::lattice(&container, 60, 0.5)?;
    let run = Simulation::builder(Elastic, container).disks(disks).build()?;
    let noise = |stream: Option<u64>| -> Outcome<WhiteNoise> {
        let noise = WhiteNoise::new(0.1, SampleTimes::every(0.1)?, 7)?;
        Ok(stream.map_or(noise.clone(), |number| noise.with_stream(number)))
    };
    let end = |pieces: u32, stream| -> Outcome<Vec<Disk>> {
        let mut run = run.clone();
        for piece in 1..=pieces {
            let end = 8.0 * f64::from(piece) / f64::from(pieces);
            run.run_driven(&Limits::until(end), &mut noise(stream)?, &mut ())?;
        }
        Ok(run.disks())
    };
    assert_eq!(end(4, None)?, end(1, None)?);
    assert_ne!(end(1, Some(1))?, end(1, None)?);
    assert_ne!(end(1, Some(1))?, end(1, Some(2))?);
    Ok(())
}

/// Where disks entered on the left and on the right, relative to their inlet.
#[derive(Default)]
struct Seen([Vec<DVec2>; 2]);
impl Observer for Seen {
    fn on_insert(&mut self, disk: &Disk, _: f64) {
        let right = disk.position().x > 40.0;
        self.0[usize::from(right)].push(disk.position() - DVec2::new(if right { 60.0 } else { 10.0 }, 0.0));
    }
}

/// Two inlets of one run may have one seed.
#[test]
fn inlets_with_one_seed_differ() -> Outcome {
    let container = Container::open(100.0)?.absorbing(Wall::Floor)?;
    let mut run = Simulation::builder(Elastic, container).gravity(1.0).build()?;
    let grain = Disk::new(DVec2::ZERO, 0.1)?.with_velocity(DVec2::new(0.0, -20.0))?;
    for x in [10.0, 60.0] {
        let places = [DVec2::new(x, 8.0), DVec2::new(x + 10.0, 9.0)];
        run.add_inlet(Inlet::new(places, [grain], SampleTimes::every(0.5)?, 7)?)?;
    }
    let mut seen = Seen::default();
    run.run_until(500.0, &mut seen)?;
    assert_eq!(seen.0.each_ref().map(Vec::len), [1000; 2]);
    assert!(seen.0[0].iter().zip(&seen.0[1]).all(|(left, right)| left.distance(*right) > 1e-9));
    Ok(())
}

/// What a disk draws at a wall depends neither on its index nor on what other disks draw.
#[test]
fn walls_draw_by_disk() -> Outcome {
    let flying = |id: u64, x: f64, speed: f64| {
        let disk = Disk::new(DVec2::new(x, 10.0), 0.5)?.with_velocity(DVec2::new(0.0, speed))?;
        disk.with_id(id)
    };
    let (one, other) = (flying(1, 3.0, -3.0)?, flying(2, 16.0, 5.0)?);
    let after_first_touch = |disks: Vec<Disk>| -> Outcome<Disk> {
        let mut run = Simulation::builder(Elastic, hot_walls()?).disks(disks).seed(5).build()?;
        run.run_until(3.4, &mut ())?;
        Ok(run.disk(run.index_of(1).ok_or("gone")?).ok_or("gone")?)
    };
    let alone = after_first_touch(vec![one])?;
    assert!(alone.velocity().y > 0.0);
    assert_eq!(after_first_touch(vec![one, other])?, alone);
    assert_eq!(after_first_touch(vec![other, one])?, alone);
    Ok(())
}

/// From one prepared state, each seed gives another future, at walls and at inlets, and the same one again.
#[test]
fn branches_have_their_own_seeds() -> Outcome {
    let grain = Disk::new(DVec2::ZERO, 0.4)?.with_velocity(DVec2::NEG_Y)?;
    let places = [DVec2::new(1.0, 12.0), DVec2::new(19.0, 19.0)];
    for (container, inlets) in [(hot_walls()?, 0), (Container::closed(20.0, 20.0)?, 1)] {
        let disks = initial::with_maxwellian_velocities(initial::lattice(&container, 20, 0.5)?, 1.0, 1)?;
        let mut run = Simulation::builder(Elastic, container.clone()).disks(disks).seed(2).build()?;
        for _ in 0..inlets {
            run.add_inlet(Inlet::new(places, [grain], SampleTimes::every(2.0)?, 2)?)?;
        }
        run.run_until(5.0, &mut ())?;
        let prepared = run.checkpoint();
        let branch = |seed: Option<u64>| -> Outcome<Vec<Disk>> {
            let resumption = Simulation::resume(&prepared, Elastic, container.clone());
            let mut run = seed.map_or(resumption.clone(), |seed| resumption.seed(seed)).build()?;
            run.run_until(30.0, &mut ())?;
            Ok(run.disks())
        };
        assert_eq!(branch(Some(3))?, branch(Some(3))?);
        assert_ne!(branch(Some(3))?, branch(Some(4))?);
        assert_eq!(branch(None)?, branch(Some(2))?);
    }
    Ok(())
}
