//! A mixture: light glass and heavy steel, each with its own losses, in one box.
//!
//! ```text
//! cargo run --release -p granular-edmd --example mixture
//! ```
//!
//! It takes two seconds. You learn about kinds of disks, rules for pairs of kinds, and observables for one
//! kind. In a driven granular gas, the kinds do not have the same temperature.

use granular_edmd::collision::RulesByKind;
use granular_edmd::observable::{BetweenKinds, EnergyChange, OfKind, Temperatures};
use granular_edmd::prelude::*;

const GLASS: Kind = Kind::new(0);
const STEEL: Kind = Kind::new(1);

fn main() -> anyhow::Result<()> {
    // 400 grains of radius 0.5, and 40 of radius 1 that are three times as dense.
    let glass = Disk::new(DVec2::ZERO, 0.5)?.with_kind(GLASS);
    let steel = Disk::new(DVec2::ZERO, 1.0)?.with_mass(12.0)?.with_kind(STEEL);
    let disks = [vec![glass; 400], vec![steel; 40]].concat();

    let base = Sinusoidal::new(0.1, 30.0)?;
    let container = Container::open(40.0)?.with_motion(Wall::Floor, base)?;
    let disks = initial::scattered_mix(&container, disks, 40.0, 1)?;

    // One rule for every pair that the table does not name.
    let rules = RulesByKind::new(Frictional::from_inelasticity(0.05, 0.05, 0.1)?)
        .with(STEEL, STEEL, Frictional::from_inelasticity(0.02, 0.02, 0.05)?)
        .with(STEEL, Kind::WALL, Frictional::from_inelasticity(0.02, 0.02, 0.05)?);
    let rules = ContactDuration::new(rules, 1e-3)?;
    let mut simulation = Simulation::builder(rules, container).disks(disks).gravity(1.0).build()?;
    simulation.run_until(100.0, &mut ())?;

    let of = |kind| OfKind::new(kind, (Temperatures, CenterOfMass));
    let mut series = Series::new((of(GLASS), of(STEEL)), SampleTimes::every(0.7)?);
    let mut mixed = BetweenKinds::new(GLASS, STEEL, EnergyChange::default());
    simulation.run_until(300.0, &mut (&mut series, &mut mixed))?;

    let count = series.values().len() as f64;
    for (name, kind) in [("glass", 0), ("steel", 1)] {
        let values = series.values().iter().map(|(glass, steel)| if kind == 0 { glass } else { steel });
        let (temperature, height) = values.fold((0.0, 0.0), |sum, (temperature, center)| {
            (sum.0 + temperature.translational() / count, sum.1 + center.y / count)
        });
        println!("{name}: temperature {temperature:.2}, height {height:.2}");
    }
    println!("energy lost where glass meets steel: {:.3} a collision", -mixed.inner().disks().mean());
    Ok(())
}
