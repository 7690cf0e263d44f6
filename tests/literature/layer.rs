//! A layer of grains on a shaken plate, whose flights alternate above a certain acceleration.

use std::f64::consts::{PI, TAU};

use granular_edmd::boundary::{Container, Wall};
use granular_edmd::collision::{Friction, LeastRebound, SpeedDependent};
use granular_edmd::observable::{CenterOfMass, SampleTimes, Series};
use granular_edmd::wall::Sinusoidal;
use granular_edmd::{Disk, Simulation, initial};

use crate::{Outcome, agrees, measured};

/// Returns the difference of long and short flights, as the mean alternation of the height of the center of
/// mass from period to period, in amplitudes of the plate.
fn alternation(acceleration: f64) -> Result<f64, Box<dyn std::error::Error>> {
    // Gravity and frequency are 1, so that the amplitude is the acceleration.
    let floor = Sinusoidal::new(acceleration, 1.0)?;
    let container = Container::open(10.5)?.with_periodic_sides()?.with_motion(Wall::Floor, floor)?;
    let bizon =
        SpeedDependent::from_restitution(0.5, 1.0)?.with_friction(Friction::from_inelasticity(0.25, 0.5)?);
    let disks: Vec<Disk> = initial::lattice(&container, 80, 0.5)?;
    let disks = initial::with_maxwellian_velocities(disks, 0.01, 1)?;
    let rule = LeastRebound::new(bizon, 0.05)?;
    let mut simulation = Simulation::builder(rule, container).disks(disks).gravity(1.0).build()?;
    simulation.run_until(20.0 * TAU, &mut ())?;
    let mut series = Series::new(CenterOfMass, SampleTimes::every(TAU)?);
    simulation.run_until(80.5 * TAU, &mut series)?;
    let signed = |(k, center): (usize, &granular_edmd::glam::DVec2)| {
        if k % 2 == 0 { center.y } else { -center.y }
    };
    let heights = series.values();
    let sum: f64 = heights.iter().enumerate().map(signed).sum();
    Ok(sum.abs() / heights.len() as f64 / acceleration)
}

/// Flights of a body without restitution begin to alternate at Γ = √(π² + 4) = 3.72: the phase of the next
/// start then depends on that of the last one by the factor 1 − Γ sin φ = −1, while Γ cos φ = π makes a
/// flight last a period (Mehta and Luck, Phys. Rev. Lett. 65, 393 (1990)). A layer does the same.
#[test]
#[ignore = "a minute"]
fn long_flights_of_a_layer_alternate_from_the_acceleration_of_a_body_without_restitution() -> Outcome {
    let mut onset = None;
    for step in 0..16 {
        let acceleration = 3.2 + 0.1 * f64::from(step);
        let alternation = alternation(acceleration)?;
        measured(&format!("alternation at {acceleration:.1}"), alternation);
        if onset.is_none() && alternation > 0.2 {
            onset = Some(acceleration);
        }
    }
    let onset = onset.ok_or("the flights do not alternate")?;
    // Steps are 0.1 apart. Single periods scatter by some 0.1 amplitudes close to the onset.
    assert!(agrees("onset of period doubling", onset, (PI * PI + 4.0).sqrt(), 0.04));
    Ok(())
}
