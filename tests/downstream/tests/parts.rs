//! Walls that react, walls for some kinds, counting lines, couples and neighbors, put together by a user.

use granular_edmd::collision::RollingFriction;
use granular_edmd::observable::{Crossings, OfKind};
use granular_edmd::prelude::*;
use granular_edmd::simulation::Warning;
use granular_edmd::wall::Piston;

type Outcome<T = ()> = Result<T, Box<dyn std::error::Error>>;

const LARGE: Kind = Kind::new(1);

/// A box that a membrane for the large disks divides in two, under a lid that a force holds down.
fn cell() -> Outcome<Container> {
    let lid = Piston::new(5.0, [-4.0, 4.0])?.with_force(-2.0)?;
    let container = Container::closed(20.0, 10.0)?.with_piston(Wall::Lid, lid)?;
    let membrane = Part::polyline([DVec2::new(10.0, 0.0), DVec2::new(10.0, 15.0)])?;
    Ok(container.with_part("membrane", membrane.only_for([LARGE]))?)
}

fn disks() -> Outcome<Vec<Disk>> {
    let place = |k: usize| DVec2::new(1.0 + 1.5 * (k % 6) as f64, 1.0 + 1.5 * (k / 6) as f64);
    let disks = (0..24).map(|k| {
        let small = k % 2 == 0;
        let disk = Disk::new(place(k), if small { 0.2 } else { 0.5 })?;
        Ok::<_, ParameterError>(if small { disk } else { disk.with_kind(LARGE) })
    });
    Ok(initial::with_maxwellian_velocities(disks.collect::<Result<Vec<_>, _>>()?, 1.0, 5)?)
}

/// Small disks go through the membrane and large ones do not; what crosses is counted by kind.
#[test]
fn a_membrane_holds_the_large_disks() -> Outcome {
    let mut run = Simulation::builder(Elastic, cell()?).disks(disks()?).build()?;
    let line = || Crossings::new([DVec2::new(10.0, 15.0), DVec2::new(10.0, 0.0)], SampleTimes::every(50.0)?);
    let mut crossings = (OfKind::new(Kind::default(), line()?), OfKind::new(LARGE, line()?));
    run.run_until(500.0, &mut crossings)?;
    let sum = |counts: &[u64]| counts.iter().sum::<u64>();
    let (forward, backward) = (sum(crossings.0.inner().forward()), sum(crossings.0.inner().backward()));
    let right = run.disks().iter().filter(|disk| disk.position().x > 10.0).count() as u64;
    assert!(forward > 20, "{forward}");
    assert_eq!(forward - backward, right);
    assert_eq!(sum(crossings.1.inner().forward()) + sum(crossings.1.inner().backward()), 0);
    assert!(
        run.disks().iter().filter(|disk| disk.kind() == LARGE).all(|disk| disk.position().x < 9.5 + 1e-9)
    );
    Ok(())
}

/// Disks and lid exchange energy, and rolling friction takes it from the spins alone.
#[test]
fn couples_damp_spins_under_a_lid() -> Outcome {
    let spinning =
        disks()?.into_iter().map(|disk| disk.with_angular_velocity(3.0)).collect::<Result<Vec<_>, _>>()?;
    let rotation = |disks: &[Disk]| disks.iter().map(Disk::rotational_energy).sum::<f64>();
    let before = rotation(&spinning);
    let rule = RollingFriction::new(Elastic, 0.05)?;
    let mut run = Simulation::builder(rule, cell()?).disks(spinning).build()?;
    run.run_until(200.0, &mut ())?;
    assert!(rotation(&run.disks()) < 0.2 * before);
    // The lid rests on its upper stop at first, which absorbs what the disks give it.
    assert!(matches!(run.warnings()[..], [Warning::WallOnStop { .. }]), "{:?}", run.warnings());
    Ok(())
}

/// Each pair is seen from both of its disks.
#[test]
fn neighbors_are_mutual() -> Outcome {
    let mut run = Simulation::builder(Elastic, cell()?).disks(disks()?).build()?;
    run.run_until(20.0, &mut ())?;
    let snapshot = run.snapshot();
    let neighbors = snapshot.neighbors(3.0)?;
    let mut pairs = 0;
    for disk in 0..snapshot.len() {
        for other in neighbors.of(disk) {
            pairs += 1;
            assert!(
                neighbors
                    .of(other.index)
                    .any(|back| back.index == disk && back.separation == -other.separation)
            );
        }
    }
    assert!(pairs > 20, "{pairs}");
    Ok(())
}
