//! Periodic boxes, with periodic sides, ends or both, and unwrapped positions.

use granular_edmd::boundary::{
    Boundary, Container, Domain, FirstTouch, Overlap, Probe, Region, Surface, Touch, Wall, WallError, laws,
};
use granular_edmd::collision::{Elastic, Frictional};
use granular_edmd::glam::DVec2;
use granular_edmd::observable::Energies;
use granular_edmd::scheduler::{BucketQueue, LinearScan};
use granular_edmd::simulation::BuildError;
use granular_edmd::{Disk, Flight, Gravity, Simulation, initial};

type Outcome<T = ()> = Result<T, Box<dyn std::error::Error>>;

fn gas(container: &Container, count: usize, seed: u64) -> Outcome<Vec<Disk>> {
    let disks = initial::scattered(container, count, 0.5, container.height(), seed)?;
    Ok(initial::without_drift(initial::with_maxwellian_velocities(disks, 1.0, seed)?)?)
}

/// A disk that meets nobody flies straight, or falls, through as many periods as its time allows.
#[test]
fn a_lonely_disk_is_where_its_flight_leads() -> Outcome {
    let tilted = [0.4, -1.4].map(|angle| Gravity::tilted(0.3, angle).unwrap());
    for gravity in [0.0, 0.3, -0.3].map(Gravity::from).into_iter().chain(tilted) {
        let container = Container::periodic(7.0, 5.0)?;
        let (start, velocity) = (DVec2::new(1.0, 2.0), DVec2::new(-1.3, 0.7));
        let disk = Disk::new(start, 0.5)?.with_velocity(velocity)?;
        let mut run = Simulation::builder(Elastic, container).disks([disk]).gravity(gravity).build()?;
        for time in [0.5, 10.0, 100.0, 1000.0] {
            run.run_until(time, &mut ())?;
            let domain = run.boundary().domain();
            let disk = run.disk(0).ok_or("no disk")?;
            let there = start + velocity * time + 0.5 * time * time * gravity.acceleration();
            let error = (domain.unwrapped(&disk) - there).length();
            assert!(error < 1e-12 * (1.0 + there.length()), "{error:e} at {time}");
            assert!((0.0..=7.0).contains(&disk.position().x) && (0.0..=5.0).contains(&disk.position().y));
        }
    }
    Ok(())
}

/// Without walls, momentum is kept and the middle of all unwrapped positions moves as the momentum says.
#[test]
fn momentum_is_kept_and_the_middle_moves_along() -> Outcome {
    let container = Container::periodic(16.0, 12.0)?;
    let drift = DVec2::new(0.4, -0.7);
    let shifted = |disk: Disk| disk.with_velocity(disk.velocity() + drift);
    let disks = gas(&container, 80, 3)?.into_iter().map(shifted).collect::<Result<Vec<_>, _>>()?;
    let mut run = Simulation::builder(Frictional::from_inelasticity(0.02, 0.02, 0.3)?, container)
        .disks(disks)
        .build()?;
    let middle = |run: &Simulation<Frictional>| {
        let domain = run.boundary().domain();
        run.disks().iter().map(|disk| domain.unwrapped(disk)).sum::<DVec2>() / 80.0
    };
    let start = middle(&run);
    for time in [1.0, 10.0, 50.0] {
        run.run_until(time, &mut ())?;
        let velocity = run.disks().iter().map(Disk::velocity).sum::<DVec2>() / 80.0;
        assert!((velocity - drift).length() < 1e-13);
        assert!((middle(&run) - start - drift * time).length() < 1e-11);
    }
    assert!(run.counters().disk_collisions > 1000, "{:?}", run.counters());
    Ok(())
}

/// An elastic gas keeps its energy, and schedulers and resumed runs have the same bits, at any shape of box.
#[test]
fn boxes_of_four_rows_and_more_keep_energy_and_bits() -> Outcome {
    for (width, height, count) in [(4.1, 4.1, 4), (30.0, 4.1, 30), (4.1, 30.0, 30), (25.0, 20.0, 250)] {
        let container = Container::periodic(width, height)?;
        let disks = initial::lattice(&Container::closed(width, height)?, count, 0.5)?;
        let disks = initial::with_maxwellian_velocities(disks, 1.0, 9)?;
        let builder = || Simulation::builder(Elastic, container.clone()).disks(disks.clone());
        let (mut tree, mut scan) = (builder().build()?, builder().scheduler(LinearScan::new()).build()?);
        let mut queue = builder().scheduler(BucketQueue::new()).build()?;
        let energy = tree.measure(&Energies).total();
        for _ in 0..20 {
            let end = tree.time() + 2.0;
            tree.run_until(end, &mut ())?;
            scan.run_until(end, &mut ())?;
            queue.run_until(end, &mut ())?;
            assert_eq!(tree.disks(), scan.disks());
            assert_eq!(tree.disks(), queue.disks());
        }
        assert!((tree.measure(&Energies).total() / energy - 1.0).abs() < 1e-12);
        assert!(tree.counters().max_overlap < 1e-11, "{:?}", tree.counters());
    }
    Ok(())
}

/// In a pipe, gravity drives the disks until the rough walls brake them as much.
#[test]
fn a_pipe_has_walls_on_its_sides_only() -> Outcome {
    let pipe = Container::closed(10.0, 20.0)?.with_periodic_ends()?;
    assert_eq!((pipe.wall_count(), pipe.index(Wall::Left), pipe.index(Wall::Floor)), (2, Some(0), None));
    assert_eq!(laws::check(&mut pipe.clone(), 0.5, 1.0, 7), Ok(()));
    let disks = gas(&pipe, 60, 5)?;
    let mut run = Simulation::builder(Frictional::from_inelasticity(0.01, 0.01, 0.5)?, pipe)
        .disks(disks)
        .gravity(0.05)
        .build()?;
    run.run_until(400.0, &mut ())?;
    let flow =
        |run: &Simulation<Frictional>| run.disks().iter().map(|disk| disk.velocity().y).sum::<f64>() / 60.0;
    let early = flow(&run);
    run.run_until(1200.0, &mut ())?;
    // Free fall would have reached 60.
    assert!(early < -0.5 && flow(&run) > -20.0, "{early} {}", flow(&run));
    assert!(run.disks().iter().any(|disk| disk.image()[1] < -10 && disk.image()[0] == 0));
    Ok(())
}

#[test]
fn what_cannot_be_periodic_is_refused() -> Outcome {
    let open = Container::open(10.0)?.with_periodic_ends();
    assert_eq!(open.unwrap_err(), WallError::Missing { wall: Wall::Lid });
    for (width, height) in [(3.9, 20.0), (20.0, 3.9)] {
        let disk = Disk::new(DVec2::new(2.0, 2.0), 0.5)?;
        let run = Simulation::builder(Elastic, Container::periodic(width, height)?).disks([disk]).build();
        let error = run.err().ok_or("the box is too small")?;
        assert_eq!(error, BuildError::DomainTooSmall { width, height, diameter: 1.0 });
    }
    // A disk across the upper end overlaps one across the lower end.
    let disks = [Disk::new(DVec2::new(2.0, 0.1), 0.5)?, Disk::new(DVec2::new(2.0, 7.9), 0.5)?];
    let run = Simulation::builder(Elastic, Container::periodic(8.0, 8.0)?).disks(disks).build();
    assert!(matches!(run, Err(BuildError::Overlap { first: 0, second: 1, .. })));
    Ok(())
}

/// Images are kept by checkpoints and by disks that begin another run.
#[cfg(feature = "serde")]
#[test]
fn images_outlast_a_resume_and_a_new_run() -> Outcome {
    let container = Container::periodic(9.0, 8.0)?;
    let disks = gas(&container, 20, 1)?;
    let mut first = Simulation::builder(Elastic, container.clone()).disks(disks).build()?;
    first.run_until(50.0, &mut ())?;
    assert!(first.disks().iter().any(|disk| disk.image()[0] != 0 && disk.image()[1] != 0));
    let checkpoint = first.checkpoint();
    let mut second = Simulation::resume(&checkpoint, Elastic, container.clone()).build()?;
    let mut third = Simulation::builder(Elastic, container).disks(first.disks()).build()?;
    for run in [&mut first, &mut second] {
        run.run_until(90.0, &mut ())?;
    }
    assert_eq!(first.disks(), second.disks());
    third.run_until(1e-9, &mut ())?;
    assert!(
        third.disks().iter().zip(checkpoint_images(&checkpoint)?).all(|(disk, image)| disk.image() == image)
    );
    Ok(())
}

#[cfg(feature = "serde")]
fn checkpoint_images(checkpoint: &granular_edmd::simulation::Checkpoint) -> Outcome<Vec<[i32; 2]>> {
    let run = Simulation::resume(checkpoint, Elastic, Container::periodic(9.0, 8.0)?).build()?;
    Ok(run.disks().iter().map(Disk::image).collect())
}

/// A user's boundary, whose ends are periodic although it has no upper end.
struct Endless;

impl Boundary for Endless {
    fn domain(&self) -> Domain {
        Domain::new(0.0, 10.0, 0.0, f64::INFINITY).with_periodic_sides().with_periodic_ends()
    }
    fn wall_count(&self) -> usize {
        0
    }
    fn set_time_origin(&mut self, _: f64) {}
    fn may_touch(&self, _: &Region, _: f64) -> bool {
        false
    }
    fn first_touch(&self, _: &Flight, _: f64) -> FirstTouch<Touch> {
        FirstTouch::NONE
    }
    fn surface(&self, _: usize, _: DVec2, _: f64) -> Surface<'_> {
        Surface::new(DVec2::Y, DVec2::ZERO)
    }
    fn overlap(&self, _: &Probe) -> Option<Overlap> {
        None
    }
}

#[test]
fn ends_that_are_nowhere_are_refused() -> Outcome {
    let disk = Disk::new(DVec2::new(5.0, 5.0), 0.5)?;
    let run = Simulation::builder(Elastic, Endless).disks([disk]).build();
    assert!(matches!(run, Err(BuildError::Domain { .. })));
    Ok(())
}
