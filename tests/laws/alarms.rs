//! No check refuses a part of the library, whatever the seed.

use granular_edmd::boundary::{Boundary, Container, Part, Thermal, Wall, laws as boundary_laws};
use granular_edmd::collision::laws::{self as collision_laws, Promises};
use granular_edmd::collision::{
    CollisionRule, ContactDuration, Elastic, ElasticBelow, Friction, Frictional, LeastRebound,
    RollingFriction, Rough, RulesByKind, Smooth, SpeedDependent,
};
use granular_edmd::glam::DVec2;
use granular_edmd::wall::{
    BiParabolic, Combined, Fixed, Piston, Sawtooth, Sinusoidal, Tabulated, Triangular, WallMotion,
    laws as wall_laws,
};
use granular_edmd::{Disk, Kind};
use support::cases::few;

type Failed = Box<dyn std::error::Error>;
type Rules = Vec<(Box<dyn CollisionRule>, Promises)>;
type Motions = Vec<Box<dyn WallMotion + Send + Sync>>;
type Boundaries = Vec<(&'static str, Box<dyn Boundary>)>;

fn rules() -> Result<Rules, Failed> {
    let free = Promises::new();
    let rubbing = free.with_friction(0.4);
    let frictional = Frictional::from_inelasticity(0.05, 0.1, 0.4)?;
    let smooth = Smooth::from_inelasticity(0.1)?;
    let friction = Friction::from_inelasticity(0.1, 0.4)?;
    let table = RulesByKind::new(Smooth::from_inelasticity(0.3)?).with(Kind::new(1), Kind::new(2), smooth);
    Ok(vec![
        (Box::new(Elastic), free.with_friction(0.0).with_rolling_friction(0.0)),
        (Box::new(smooth), free.with_friction(0.0)),
        (Box::new(Rough::from_inelasticity(0.1, 0.2)?), free.with_opposed_slip()),
        (Box::new(frictional), rubbing),
        (Box::new(frictional.with_dynamic_friction(0.2)?), rubbing),
        (Box::new(SpeedDependent::from_inelasticity(0.2, 1.0)?.with_friction(friction)), rubbing),
        (Box::new(ContactDuration::new(frictional, 1e-3)?), rubbing),
        (Box::new(ElasticBelow::new(frictional, 1e-2)?), rubbing),
        (Box::new(LeastRebound::new(frictional, 1e-2)?), free.with_energy_gain()),
        (Box::new(RollingFriction::new(frictional, 0.2)?), rubbing.with_rolling_friction(0.2)),
        (Box::new(RollingFriction::new(Elastic, 1e9)?), free.with_rolling_friction(1e9)),
        (Box::new(table), free),
    ])
}

fn motions() -> Result<Motions, Failed> {
    let (amplitude, frequency) = (0.2, 5.0);
    let sine = Sinusoidal::new(amplitude, frequency)?;
    let arcs = BiParabolic::new(amplitude, frequency)?;
    Ok(vec![
        Box::new(Fixed),
        Box::new(sine),
        Box::new(arcs),
        Box::new(Triangular::new(amplitude, frequency)?),
        Box::new(Sawtooth::new(amplitude, frequency)?),
        Box::new(Combined::new(sine).delayed_until(1.3)?),
        Box::new(Combined::new(arcs).starting_at(0.7)?),
        Box::new(Combined::new(arcs).scaled(-0.5)?),
        Box::new(Combined::new(sine).plus(Sinusoidal::new(0.05, 13.0)?)?),
        Box::new(Tabulated::from_to(0.0, 0.5, 4.0)?),
    ])
}

/// A container of this number among all motions.
fn shaken(number: usize, wall: Wall) -> Result<Container, Failed> {
    let motion = motions()?.swap_remove(number % motions()?.len());
    Ok(Container::closed(9.0, 7.0)?.with_motion(wall, motion)?)
}

fn boundaries(seed: u64) -> Result<Boundaries, Failed> {
    let (middle, number) = (DVec2::new(4.5, 3.5), seed as usize);
    let container = || Container::closed(9.0, 7.0);
    let vessel = |part: Part| -> Result<Box<dyn Boundary>, Failed> {
        Ok(Box::new(container()?.with_part("part", part)?))
    };
    let bar = Part::polyline([middle - DVec2::X, middle + DVec2::X])?;
    let triangle = [DVec2::new(3.0, 2.5), DVec2::new(6.0, 2.5), DVec2::new(4.5, 4.5)];
    let outer = [DVec2::ZERO, DVec2::new(8.0, 0.0), DVec2::new(9.0, 5.0), DVec2::new(4.0, 7.0)];
    let piston = Piston::new(20.0, [-0.5, 3.0])?.with_force(-1.0)?.with_spring(5.0, 1.0)?;
    let sine = Sinusoidal::new(0.3, 3.0)?;
    Ok(vec![
        ("closed", Box::new(container()?)),
        ("open", Box::new(Container::open(9.0)?)),
        ("periodic", Box::new(Container::periodic(9.0, 7.0)?)),
        ("floor", Box::new(shaken(number, Wall::Floor)?)),
        ("lid", Box::new(shaken(number + 3, Wall::Lid)?)),
        ("side", Box::new(shaken(number + 5, Wall::Left)?)),
        ("sliding", Box::new(container()?.with_sliding(Wall::Floor, sine)?)),
        ("belt", Box::new(container()?.with_surface_speed(Wall::Lid, 0.3)?)),
        ("thermal", Box::new(container()?.with_temperature(Wall::Floor, Thermal::new(1.0)?)?)),
        ("piston", Box::new(container()?.with_piston(Wall::Lid, piston)?)),
        ("pistons", Box::new(container()?.with_piston(Wall::Lid, piston)?.with_piston(Wall::Left, piston)?)),
        ("pegs", Box::new(container()?.with_pegs([Disk::new(middle, 1.1)?])?)),
        ("peg", vessel(Part::peg(middle, 0.8)?)?),
        ("block", vessel(Part::block(triangle)?)?),
        ("bar", vessel(bar.clone())?),
        ("conveyor", vessel(bar.clone().with_surface_speed(0.4)?)?),
        ("membrane", vessel(bar.clone().only_for([Kind::new(1)]))?),
        ("pulley", vessel(Part::peg(middle, 0.8)?.with_surface_speed(0.4)?)?),
        ("sink", vessel(bar.clone().absorbing())?),
        ("exit", vessel(bar.clone().absorbing_centers())?),
        ("shaken exit", vessel(bar.clone().absorbing_centers().with_motion(DVec2::Y, sine)?)?),
        ("turning exit", vessel(bar.clone().absorbing_centers().with_rotation(middle, 0.8)?)?),
        ("turning bar", vessel(bar.with_rotation(middle, 0.8)?)?),
        ("moving block", vessel(Part::block(triangle)?.with_motion(DVec2::new(0.6, 0.8), sine)?)?),
        (
            "drum",
            Box::new(Container::around([("drum", Part::drum(middle, 4.0)?.with_rotation(middle, 0.5)?)])?),
        ),
        ("polygon", Box::new(Container::around([("outer", Part::polygon(outer)?)])?)),
    ])
}

/// Checks one rule, one motion in a random interval, and one boundary for a seed.
fn check_all(seed: u64) -> Result<(), Failed> {
    let number = seed as usize;
    let rules = rules()?;
    let (rule, promises) = &rules[number % rules.len()];
    collision_laws::check(&**rule, &promises.with_seed(seed))?;
    let motion = motions()?.swap_remove(number / 3 % motions()?.len());
    let start = (0.618 * seed as f64).rem_euclid(50.0) - 5.0;
    wall_laws::check(&*motion, start, start + 3.0)?;
    let mut boundaries = boundaries(seed)?;
    let (name, mut boundary) = boundaries.swap_remove(number % boundaries.len());
    let radius = [0.4, 0.1, 0.25][number % 3];
    let speed = [1.0, 0.3, 4.0, 1.0][number / 3 % 4];
    boundary_laws::check(&mut *boundary, radius, speed, seed)
        .map_err(|violation| format!("{name}: {violation}"))?;
    Ok(())
}

fn check_seeds(seeds: impl IntoIterator<Item = u64>) {
    let refused: Vec<_> = seeds
        .into_iter()
        .filter_map(|seed| Some(format!("seed {seed}: {}", check_all(seed).err()?)))
        .collect();
    assert!(refused.is_empty(), "{} false alarms: {}", refused.len(), refused.join("\n"));
}

#[test]
fn no_check_refuses_a_part_of_the_library() {
    check_seeds(few(0..60, 5));
    // A tip whose curvature at two steps once agreed by chance.
    check_seeds([4538]);
}

/// Some twenty minutes; it says how far it has come.
#[test]
#[ignore = "long"]
fn no_check_refuses_a_part_of_the_library_in_ten_thousand_seeds() {
    for first in (60..10_060).step_by(100) {
        check_seeds(first..first + 100);
        println!("{} seeds", first + 40);
    }
}
