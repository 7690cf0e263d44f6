//! Ten systems with the parts that users compose, and hashes of their final states.
//!
//! The tests of the Python module run the same systems and await the same hashes, from the same file. After
//! an intended change of results, `GRANULAR_EDMD_BLESS=1` writes the file.

use std::error::Error;
use std::fs;

use granular_edmd::boundary::{Part, Thermal};
use granular_edmd::collision::{ElasticBelow, KnownRule, LeastRebound, RollingFriction, Rough, RulesByKind};
use granular_edmd::initial::Radii;
use granular_edmd::prelude::*;
use granular_edmd::simulation::{Inlet, WhiteNoise};
use granular_edmd::wall::{Combined, Piston, Sinusoidal};
use granular_edmd::{Gravity, Kind};

/// The hashes, a line for each system: name and hash.
const HASHES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../python/tests/hashes.txt");

type Result<T> = std::result::Result<T, Box<dyn Error>>;
type Run = Simulation<KnownRule>;

/// Returns a name for a state, which depends on its last bit.
fn hash(run: &Run) -> String {
    let mut hasher = blake3::Hasher::new();
    for disk in run.disks() {
        let (position, velocity) = (disk.position(), disk.velocity());
        let numbers = [position.x, position.y, velocity.x, velocity.y, disk.angle(), disk.angular_velocity()];
        for number in &numbers {
            hasher.update(&number.to_le_bytes());
        }
    }
    hasher.update(&run.time().to_le_bytes());
    hasher.finalize().to_hex()[..32].to_owned()
}

fn warm(boundary: &Container, count: usize, temperature: f64) -> Result<Vec<Disk>> {
    Ok(initial::with_maxwellian_velocities(initial::lattice(boundary, count, 0.5)?, temperature, 1)?)
}

fn run(
    rule: impl CollisionRule,
    boundary: Container,
    disks: Vec<Disk>,
    gravity: impl Into<Gravity>,
) -> Result<Run> {
    let rule = rule.known().ok_or("a rule that is not data")?;
    Ok(Simulation::builder(rule, boundary).disks(disks).gravity(gravity).seed(7).build()?)
}

fn paper_box() -> Result<Run> {
    let boundary = Container::closed(60.0, 150.0)?.with_motion(Wall::Floor, BiParabolic::new(0.1, 10.0)?)?;
    let rule = ContactDuration::new(Frictional::from_inelasticity(0.0, 0.0, 0.03)?, 1e-4)?;
    let disks = warm(&boundary, 1000, 0.5)?;
    let mut run = run(rule, boundary, disks, 0.015_625)?;
    run.run_until(60.0, &mut ())?;
    Ok(run)
}

fn cooling_gas() -> Result<Run> {
    let boundary = Container::periodic(30.0, 30.0)?;
    let disks = initial::even_lattice(&boundary, 200, 0.5)?;
    let disks = initial::without_drift(initial::with_maxwellian_velocities(disks, 1.0, 3)?)?;
    let mut run = run(Smooth::from_restitution(0.9)?, boundary, disks, 0.0)?;
    run.run_until(50.0, &mut ())?;
    Ok(run)
}

fn tilted_box() -> Result<Run> {
    let motion = Combined::new(Sinusoidal::new(0.3, 4.0)?).plus(BiParabolic::new(0.1, 9.0)?)?.scaled(1.5)?;
    let boundary = Container::closed(20.0, 40.0)?.shaken_vertically(motion)?;
    let disks = warm(&boundary, 100, 0.5)?;
    let mut run = run(Rough::from_restitution(0.9, 0.4)?, boundary, disks, DVec2::new(0.02, -0.1))?;
    run.run_until(30.0, &mut ())?;
    Ok(run)
}

fn thermal_walls() -> Result<Run> {
    let boundary = Container::closed(20.0, 20.0)?
        .with_periodic_ends()?
        .with_temperature(Wall::Left, Thermal::new(2.0)?)?
        .with_temperature(Wall::Right, Thermal::new(1.0)?.with_slip())?;
    let disks = initial::scattered(&boundary, 100, 0.5, 20.0, 5)?;
    let disks = initial::with_maxwellian_velocities(disks, 1.0, 1)?;
    let mut run = run(Smooth::from_restitution(0.95)?, boundary, disks, 0.0)?;
    run.run_until(50.0, &mut ())?;
    Ok(run)
}

fn silo() -> Result<Run> {
    let shelf = |from: f64, to: f64| Part::polyline([(from, 8.0), (to, 8.0)].map(DVec2::from));
    let exit = Part::polyline([(0.0, 2.0), (24.0, 2.0)].map(DVec2::from))?.absorbing_centers();
    let gate = Part::block([(0.0, 0.0), (24.0, 0.0), (24.0, 8.0), (0.0, 8.0)].map(DVec2::from))?;
    let silo = Container::open(24.0)?
        .with_part("left shelf", shelf(0.0, 9.0)?)?
        .with_part("right shelf", shelf(15.0, 24.0)?)?
        .with_part("exit", exit)?;
    let closed = silo.clone().with_part("gate", gate)?;
    let rule = LeastRebound::new(Frictional::from_inelasticity(0.1, 0.1, 0.4)?, 0.05)?;
    let disks = warm(&closed, 200, 0.1)?;
    let mut run = run(rule, closed, disks, 1.0)?;
    run.run_until(10.0, &mut ())?;
    run.set_boundary(silo)?;
    let places = [DVec2::new(1.0, 30.0), DVec2::new(23.0, 32.0)];
    run.add_inlet(Inlet::refill(places, DVec2::NEG_Y, SampleTimes::every(0.5)?, 1)?)?;
    run.run_until(30.0, &mut ())?;
    Ok(run)
}

fn drum() -> Result<Run> {
    let drum = Part::drum(DVec2::ZERO, 8.0)?.with_rotation(DVec2::ZERO, 0.3)?;
    let boundary = Container::around([("drum", drum)])?;
    let radii = Radii::two_sizes(0.4, 0.6, 0.5)?.draw(60, 2);
    let disks = initial::scattered_mix(&boundary, initial::disks_from_radii(radii, 1.0)?, 3.0, 1)?;
    let rule = LeastRebound::new(Frictional::from_inelasticity(0.1, 0.1, 0.5)?, 0.05)?;
    let mut run = run(rule, boundary, disks, 1.0)?;
    run.run_until(20.0, &mut ())?;
    Ok(run)
}

fn mixture() -> Result<Run> {
    let floor = Sinusoidal::new(0.5, 3.0)?;
    let boundary = Container::open(20.0)?.with_motion(Wall::Floor, floor)?.with_periodic_sides()?;
    let radii = Radii::log_normal(0.5, 0.3, 0.3, 0.9)?.draw(80, 4);
    let disks = initial::disks_from_radii(radii, 1.0)?.into_iter().enumerate();
    let disks = disks.map(|(index, disk)| disk.with_kind(Kind::new((index % 2) as u16))).collect();
    let disks = initial::with_maxwellian_velocities(initial::packed_mix(&boundary, disks, 12.0, 1)?, 0.2, 1)?;
    let rolling = RollingFriction::new(Frictional::from_inelasticity(0.05, 0.1, 0.3)?, 0.01)?;
    let rules = RulesByKind::new(Frictional::from_inelasticity(0.05, 0.05, 0.3)?.into())
        .with(Kind::new(0), Kind::new(1), rolling.known().ok_or("a rule that is not data")?)
        .with(Kind::new(1), Kind::WALL, KnownRule::from(Elastic));
    let rules = ContactDuration::new(rules.known().ok_or("a rule that is not data")?, 1e-3)?;
    let mut run = run(rules, boundary, disks, 0.5)?;
    run.run_until(30.0, &mut ())?;
    Ok(run)
}

fn piston() -> Result<Run> {
    let lid = Piston::new(50.0, [-30.0, 30.0])?.with_force(1.0)?;
    let boundary = Container::closed(20.0, 40.0)?.with_piston(Wall::Lid, lid)?;
    let disks = warm(&boundary, 100, 1.0)?;
    let mut run = run(Elastic, boundary, disks, 0.0)?;
    run.run_until(50.0, &mut ())?;
    Ok(run)
}

fn white_noise() -> Result<Run> {
    let boundary = Container::periodic(20.0, 20.0)?;
    let disks = initial::even_lattice(&boundary, 100, 0.5)?;
    let mut run = run(Smooth::from_restitution(0.8)?, boundary, disks, 0.0)?;
    let mut noise = WhiteNoise::new(0.3, SampleTimes::every(0.2)?, 7)?.with_rotational_noise(0.1)?;
    run.run_driven(&Limits::until(50.0), &mut noise, &mut ())?;
    Ok(run)
}

fn pegs() -> Result<Run> {
    let peg = |x: f64| Disk::new(DVec2::new(x, 5.0), 1.0);
    let boundary = Container::closed(20.0, 30.0)?
        .with_surface_speed(Wall::Floor, 0.5)?
        .with_rule(Wall::Left, Smooth::from_inelasticity(0.3)?)?
        .with_pegs([peg(5.0)?, peg(15.0)?])?;
    let rule = ElasticBelow::new(Frictional::from_inelasticity(0.02, 0.1, 0.2)?, 0.01)?;
    let disks = warm(&boundary, 80, 1.0)?;
    let mut run = run(rule, boundary, disks, 0.05)?;
    run.run_until(50.0, &mut ())?;
    Ok(run)
}

#[test]
fn final_states_are_the_known_ones() -> Result<()> {
    type System = fn() -> Result<Run>;
    let systems: [(&str, System); 10] = [
        ("paper_box", paper_box),
        ("cooling_gas", cooling_gas),
        ("tilted_box", tilted_box),
        ("thermal_walls", thermal_walls),
        ("silo", silo),
        ("drum", drum),
        ("mixture", mixture),
        ("piston", piston),
        ("white_noise", white_noise),
        ("pegs", pegs),
    ];
    let lines = systems.map(|(name, system)| system().map(|run| format!("{name} {}\n", hash(&run))));
    let found = lines.into_iter().collect::<Result<String>>()?;
    if std::env::var_os("GRANULAR_EDMD_BLESS").is_some() {
        fs::write(HASHES, &found)?;
    }
    assert_eq!(found, fs::read_to_string(HASHES)?);
    Ok(())
}
