//! The states of the paper's system at q = 0 and g = 1/64, found by running it: half a minute in release.
//!
//! ```text
//! cargo test --release --test analysis convective_states -- --ignored
//! ```

use std::error::Error;
use std::f64::consts::TAU;

use granular_edmd::boundary::{Container, Region, Wall};
use granular_edmd::collision::Frictional;
use granular_edmd::glam::DVec2;
use granular_edmd::observable::{
    ConvectionOrder, Fields, Grid, HeightProfile, OrderParameters, SampleTimes, Sampled, Series, Temperature,
    Temperatures,
};
use granular_edmd::statistics::block_average;
use granular_edmd::wall::BiParabolic;
use granular_edmd::{Simulation, initial};
use granular_edmd_study::analysis::{
    Classification, ConvectiveRegime, ConvectiveState, StateCriteria, thermal_noise,
};

use support::measured::measured;

const DISKS: usize = 1000;
const PERIOD: f64 = TAU / 10.0;

/// The measured quantities of a run, from its second half.
struct Measured {
    orders: Series<(OrderParameters, Temperatures)>,
    profile: Sampled<HeightProfile>,
    fields: Sampled<Fields>,
}

impl Measured {
    /// Runs for this many oscillations, with a sample every 20.
    fn of(friction: f64, oscillations: f64, seed: u64) -> Result<Self, Box<dyn Error>> {
        let boundary =
            Container::closed(60.0, 150.0)?.with_motion(Wall::Floor, BiParabolic::new(0.1, 10.0)?)?;
        let disks = initial::lattice(&boundary, DISKS, 0.5)?;
        let disks = initial::with_maxwellian_velocities(disks, 1.0, seed)?;
        let rule = Frictional::from_inelasticity(0.0, 0.0, friction)?;
        let mut simulation = Simulation::builder(rule, boundary).disks(disks).gravity(0.015_625).build()?;
        let times = SampleTimes::every(20.0 * PERIOD)?.starting_at(0.5 * oscillations * PERIOD)?;
        let region = Region::new(DVec2::ZERO, DVec2::new(60.0, 60.0));
        let mut measured = Self {
            orders: Series::new((OrderParameters, Temperatures), times),
            profile: Sampled::new(HeightProfile::new(0.0, 150.0, 150)?, times),
            fields: Sampled::new(Fields::new(Grid::new(region, 6, 6)?), times),
        };
        let Self { orders, profile, fields } = &mut measured;
        simulation.run_until(oscillations * PERIOD, &mut (orders, profile, fields))?;
        Ok(measured)
    }

    fn orders(&self) -> Vec<ConvectionOrder> {
        self.orders.values().iter().map(|(order, _)| *order).collect()
    }

    fn noise(&self) -> Result<f64, Box<dyn Error>> {
        let vertical = |(_, temperature): &(_, Temperature)| temperature.vertical;
        let temperatures: Vec<f64> = self.orders.values().iter().map(vertical).collect();
        Ok(thermal_noise(block_average(&temperatures)?.mean(), 1.0, DISKS)?)
    }

    fn classify(&self) -> Result<Classification, Box<dyn Error>> {
        let layer = self.profile.densest_layer();
        let found = StateCriteria::default().classify(&self.orders(), self.noise()?, layer)?;
        println!("noise {:.4}, {layer:.3?}: {}", self.noise()?, found.regime());
        for (state, cluster) in found.iter() {
            println!("  {state}: weight {:.3} at {:.4}", cluster.weight(), cluster.center());
        }
        Ok(found)
    }
}

#[test]
#[ignore = "runs the engine for half a minute in release"]
fn states_are_those_of_the_study() -> Result<(), Box<dyn Error>> {
    use ConvectiveRegime::{Collapsed, NoRoll, OneRoll, TwoRolls};
    let expected = [
        (0.005, NoRoll),
        (0.03, OneRoll),
        (0.08, TwoRolls),
        (0.12, TwoRolls),
        (0.3, Collapsed),
        (0.6, TwoRolls),
    ];
    for (friction, regime) in expected {
        for seed in 1..4 {
            let found = Measured::of(friction, 6000.0, seed)?.classify()?;
            let center = found.iter().map(|(_, cluster)| cluster.center()).next().ok_or("no cluster")?;
            measured(&format!("Ψ1, friction {friction}"), center.x.abs());
            measured(&format!("Ψ2, friction {friction}"), center.y);
            assert_eq!(found.regime(), regime, "friction {friction}, seed {seed}");
            assert_eq!(found.weight(ConvectiveState::TwoRollsDown), 0.0, "never seen");
        }
    }
    Ok(())
}

#[test]
#[ignore = "runs the engine for half a minute in release"]
fn one_roll_and_two_coexist_as_in_figure_4() -> Result<(), Box<dyn Error>> {
    let mut orders = Vec::new();
    let mut noise = 0.0;
    for seed in 1..4 {
        let measured = Measured::of(0.0605, 20_000.0, seed)?;
        measured.classify()?;
        orders.extend(measured.orders());
        noise = measured.noise()?;
    }
    let found = StateCriteria::default().classify(&orders, noise, None)?;
    assert_eq!(found.regime(), ConvectiveRegime::Coexistence);
    for (state, cluster) in found.iter() {
        let rolls = state.rolls().unwrap_or(0);
        measured(&format!("Ψ1, rolls {rolls}"), cluster.center().x.abs());
        measured(&format!("Ψ2, rolls {rolls}"), cluster.center().y);
        // The study's centers; those of runs of this length scatter by a hundredth.
        let center = DVec2::new(cluster.center().x.abs(), cluster.center().y);
        let expected =
            if state.rolls() == Some(1) { DVec2::new(0.118, 0.045) } else { DVec2::new(0.0, 0.122) };
        assert!((center - expected).length() < 0.025, "{state} at {center}");
    }
    Ok(())
}

#[test]
#[ignore = "runs the engine for some seconds in release"]
fn the_rolls_are_seen_in_the_fields() -> Result<(), Box<dyn Error>> {
    let measured = Measured::of(0.08, 6000.0, 1)?;
    let rising = |column| measured.fields.cell(column, 1).map_or(0.0, |cell| cell.velocity.y);
    println!("{:?}", (0..6).map(rising).collect::<Vec<_>>());
    assert!(rising(2) > 0.05 && rising(3) > 0.05 && rising(0) < -0.05 && rising(5) < -0.05);
    let temperature = |row| measured.fields.cell(2, row).map_or(0.0, |cell| cell.translational_temperature);
    assert!(temperature(0) > 2.0 * temperature(2), "hot below");
    Ok(())
}
