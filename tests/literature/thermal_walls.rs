//! A single disk between two thermal walls: a gas so dilute that disks never meet.

use std::f64::consts::FRAC_2_PI;

use granular_edmd::boundary::{Container, Thermal, Wall};
use granular_edmd::collision::Elastic;
use granular_edmd::glam::DVec2;
use granular_edmd::observable::{Collision, on_collision};
use granular_edmd::{Disk, Simulation};

use crate::{Outcome, agrees};

#[test]
fn a_knudsen_gas_conducts_heat_as_computed() -> Outcome {
    let (cold, hot, gap) = (0.25_f64, 1.0_f64, 4.0);
    let container = Container::closed(8.0, gap + 1.0)?
        .with_periodic_sides()?
        .with_temperature(Wall::Floor, Thermal::new(hot)?)?
        .with_temperature(Wall::Lid, Thermal::new(cold)?)?;
    let disk = Disk::new(DVec2::new(2.0, 2.0), 0.5)?.with_velocity(DVec2::Y)?;
    let mut simulation = Simulation::builder(Elastic, container).disks([disk]).seed(3).build()?;
    let (mut last, mut square, mut heat, mut touches) = (0.0, 0.0, 0.0, 0_u32);
    let mut watch = on_collision(|c: &Collision| {
        square += gap * gap / (c.time - last);
        last = c.time;
        touches += 1;
        heat += if c.normal.y > 0.0 { c.energy_change } else { 0.0 };
    });
    while simulation.counters().wall_collisions < 200_000 {
        simulation.step_until(simulation.time() + 1.0, &mut watch)?;
    }
    let time = simulation.time();
    // There are 1e5 round trips, whose times scatter by about their mean (their variance diverges, but only
    // as a logarithm): 0.5 %. The heat per round trip is 1.5 ± 2.2: 0.5 %.
    let trips = FRAC_2_PI.sqrt() / (gap * (hot.powf(-0.5) + cold.powf(-0.5)));
    assert!(agrees("v_y^2", square / time, (hot * cold).sqrt(), 0.025));
    assert!(agrees("round trips", 0.5 * f64::from(touches) / time, trips, 0.025));
    // Normal motion carries T. Tangential motion and spin carry T/2 each.
    assert!(agrees("heat flux", heat / time, trips * 2.0 * (hot - cold), 0.03));
    Ok(())
}
