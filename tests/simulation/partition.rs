//! Parts with a mass, which slide along a line: a free partition between two gases, and a peg on a rail.

use granular_edmd::boundary::{Boundary, Container, Part, WallError, laws};
use granular_edmd::collision::{Elastic, Rough, Smooth};
use granular_edmd::glam::DVec2;
use granular_edmd::observable::{
    Collision, FreeWall, Partner, SampleTimes, Series, WallStress, on_collision,
};
use granular_edmd::wall::Piston;
use granular_edmd::{Disk, Simulation, initial};
use support::cases::few;

type Outcome<T = ()> = Result<T, Box<dyn std::error::Error>>;

const MASS: f64 = 20.0;
const WIDTH: f64 = 24.0;

/// A partition in the middle of a box.
fn partition(piston: Piston) -> Outcome<Container> {
    let wall = Part::polyline([(0.5 * WIDTH, 0.0), (0.5 * WIDTH, 8.0)].map(DVec2::from))?;
    Ok(Container::closed(WIDTH, 8.0)?.with_part("partition", wall.with_piston(DVec2::X, piston)?)?)
}

/// A round peg without friction that slides up a rail at a slant.
fn peg() -> Outcome<Container> {
    let peg = Part::peg(DVec2::new(12.0, 4.0), 1.0)?.with_rule(Smooth::from_inelasticity(0.0)?);
    let peg =
        peg.with_piston(DVec2::new(3.0, 1.0), Piston::new(MASS, [-6.0, 6.0])?.with_spring(2.0, 0.0)?)?;
    Ok(Container::closed(WIDTH, 8.0)?.with_part("peg", peg)?)
}

fn gas<B: Boundary + Clone>(walls: &B, count: usize) -> Outcome<Vec<Disk>> {
    let disks = initial::scattered(walls, count, 0.4, 8.0, 1)?;
    Ok(initial::with_maxwellian_velocities(disks, 1.0, 2)?)
}

fn energy(disks: &[Disk]) -> f64 {
    disks.iter().map(|disk| disk.translational_energy() + disk.rotational_energy()).sum()
}

#[test]
fn parts_with_a_mass_keep_the_contract() -> Outcome {
    let loaded = Piston::new(MASS, [-8.0, 8.0])?.with_force(0.3)?.with_spring(5.0, 1.0)?;
    for mut walls in [partition(Piston::new(MASS, [-11.0, 11.0])?)?, partition(loaded)?, peg()?] {
        for seed in few(0..3, 3) {
            assert_eq!(laws::check(&mut walls, 0.4, 1.0, seed), Ok(()));
        }
    }
    Ok(())
}

/// Rough disks push a partition from both sides. Energy is kept, and the walls of the box take all of the
/// momentum.
#[test]
fn a_partition_keeps_energy_and_momentum() -> Outcome {
    let walls = partition(Piston::new(MASS, [-11.0, 11.0])?)?;
    let disks = gas(&walls, 24)?;
    let mut run = Simulation::builder(Rough::from_restitution(1.0, 1.0)?, walls).disks(disks).build()?;
    let free = FreeWall::named("partition");
    let before = energy(&run.disks());
    let momentum = |disks: &[Disk], speed: f64| {
        disks.iter().map(|disk| disk.mass() * disk.velocity().x).sum::<f64>() + MASS * speed
    };
    let (start, mut taken, mut hits) = (momentum(&run.disks(), 0.0), 0.0, 0);
    let mut seen = on_collision(|collision: &Collision| match collision.partner {
        Partner::Wall(0..4) => {
            let (normal, impulse) = (collision.normal, collision.impulse);
            taken += impulse.normal() * normal.x + impulse.tangential() * normal.perp().x;
        }
        Partner::Wall(_) => hits += 1,
        Partner::Disk(_) => (),
    });
    run.run_until(2000.0, &mut seen)?;
    let (moving, disks) = (run.measure(&free), run.disks());
    let (kept, balance) =
        (energy(&disks) + moving.energy, momentum(&disks, moving.velocity.x) - start - taken);
    println!("{hits} hits: energy {:e}, momentum {balance:e}", kept / before - 1.0);
    assert!(hits > 1000 && (kept / before - 1.0).abs() < 1e-12 && balance.abs() < 1e-9);
    Ok(())
}

/// In equilibrium, the pressures on both sides are equal, and the partition has half a temperature.
#[test]
fn a_partition_comes_to_equilibrium_between_two_gases() -> Outcome {
    let walls = partition(Piston::new(MASS, [-11.0, 11.0])?)?;
    let mut run = Simulation::builder(Elastic, walls.clone()).disks(gas(&walls, 40)?).build()?;
    run.run_until(2000.0, &mut ())?;
    let times = SampleTimes::every(500.0)?;
    let mut pressure = WallStress::new(times).with_wall("left", 8.0)?.with_wall("right", 8.0)?;
    let mut moving = Series::new(FreeWall::named("partition"), SampleTimes::every(2.0)?);
    run.run_until(42_000.0, &mut (&mut pressure, &mut moving))?;
    let [left, right] = ["left", "right"].map(|side| pressure.pressure(side).map_or(f64::NAN, |p| p.mean()));
    let heat = moving.mean(|wall| 2.0 * wall.energy)?.mean();
    let temperature = energy(&run.disks()) / 40.0;
    println!("pressures {left} and {right}, temperatures {temperature} and {heat}");
    assert!((left / right - 1.0).abs() < 0.01 && (heat / temperature - 1.0).abs() < 0.1);
    Ok(())
}

#[test]
fn a_peg_on_a_rail_keeps_energy_and_goes_on_with_the_same_bits() -> Outcome {
    for walls in [peg()?, partition(Piston::new(MASS, [-11.0, 11.0])?)?] {
        let build = || -> Outcome<_> {
            Ok(Simulation::builder(Elastic, walls.clone()).disks(gas(&walls, 20)?).build()?)
        };
        let name = walls.part_names().next().ok_or("a part")?.to_owned();
        let (mut whole, mut first) = (build()?, build()?);
        let total =
            |run: &Simulation<Elastic>| energy(&run.disks()) + run.measure(&FreeWall::named(&name)).energy;
        let before = total(&whole);
        whole.run_until(3000.0, &mut ())?;
        assert!((total(&whole) / before - 1.0).abs() < 1e-12, "{name}: {}", total(&whole) / before - 1.0);
        first.run_until(1234.5, &mut ())?;
        let mut resumed = Simulation::resume(&first.checkpoint(), Elastic, walls.clone()).build()?;
        resumed.run_until(3000.0, &mut ())?;
        assert_eq!(resumed.disks(), whole.disks());
        assert_eq!(resumed.boundary().state(), whole.boundary().state());
    }
    Ok(())
}

/// Friction along the rail would need more than a mass along the normal.
#[test]
fn a_part_that_disks_would_rub_along_its_rail_is_refused() -> Outcome {
    let piston = Piston::new(MASS, [-2.0, 2.0])?;
    let refused = |part: Part| {
        let error = Container::closed(WIDTH, 8.0)
            .map_err(WallError::from)
            .and_then(|walls| walls.with_part("x", part));
        matches!(error, Err(WallError::Guide { .. }))
    };
    let rough_peg = Part::peg(DVec2::new(12.0, 4.0), 1.0)?;
    let tip = Part::polyline([(12.0, 0.0), (12.0, 5.0)].map(DVec2::from))?;
    let slanted = Part::polyline([(11.0, 0.0), (12.0, 8.0)].map(DVec2::from))?;
    for part in [rough_peg, tip, slanted] {
        assert!(refused(part.clone().with_piston(DVec2::X, piston)?));
        let smooth = part.with_rule(Smooth::from_inelasticity(0.1)?);
        assert!(!refused(smooth.with_piston(DVec2::X, piston)?));
    }
    let turning = Part::drum(DVec2::ZERO, 2.0)?.with_rotation(DVec2::ONE, 0.3)?;
    assert!(turning.with_piston(DVec2::X, piston).is_err());
    let walls = partition(piston)?;
    let written = serde_json::to_string(&walls)?;
    assert_eq!(serde_json::from_str::<Container>(&written)?.fingerprint(), walls.fingerprint());
    Ok(())
}
