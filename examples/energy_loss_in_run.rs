//! The mean energy loss of the Maxwellian gas and of the simulated one, side by side: the paper's central
//! quantity, compared with a simulation of the paper's own system.
//!
//! ```text
//! cargo run --release --example energy_loss_in_run
//! ```

use std::error::Error;
use std::f64::consts::TAU;

use granular_edmd::kinetic::{Maxwellian, mean_energy_change};
use granular_edmd::observable::EnergyChangeProfile;
use granular_edmd::prelude::*;

/// Numbers of oscillations before measuring, and while measuring.
const OSCILLATIONS: (f64, f64) = (2000.0, 2000.0);

fn main() -> Result<(), Box<dyn Error>> {
    println!("N = 1000, 60 x 150, g = 0.015625, A = 0.1, omega = 10, q = 0");
    println!(
        "<dE>/T over disk-disk collisions: Maxwellian gas with all temperatures equal, with the rotational"
    );
    println!("temperature of the run, and the run itself, each collision over the temperature of its layer");
    println!("{:>8} {:>10} {:>10} {:>10} {:>10}", "kappa", "equal T", "T_rot", "run", "T_rot/T");
    for friction in [0.01, 0.03, 0.05, 0.07, 0.1, 0.3, 1.0] {
        let rule = Frictional::new(0.0, friction)?;
        let profile = measured(rule)?;
        let ratio = profile.rotational_ratio().unwrap_or(1.0);
        println!(
            "{friction:8} {:10.4} {:10.4} {:10.4} {ratio:10.3}",
            mean_energy_change(&rule, &Maxwellian::new(1.0)?),
            mean_energy_change(&rule, &Maxwellian::new(1.0)?.with_rotational_temperature(ratio)?),
            profile.relative_energy_change().unwrap_or(f64::NAN),
        );
    }
    Ok(())
}

/// Measures energy changes and temperatures by height in the paper's box, once it has settled.
fn measured(rule: Frictional) -> Result<EnergyChangeProfile, Box<dyn Error>> {
    let base = BiParabolic::new(0.1, 10.0)?;
    let oscillation = TAU / base.angular_frequency();
    let container = Container::closed(60.0, 150.0)?.with_motion(Wall::Floor, base)?;
    let disks = initial::with_maxwellian_velocities(initial::lattice(&container, 1000, 0.5)?, 0.5, 1)?;
    let rule = ContactDuration::new(rule, 1e-4)?;
    let mut simulation = Simulation::builder(rule, container).disks(disks).gravity(0.015_625).build()?;
    let settled = OSCILLATIONS.0 * oscillation;
    simulation.run_until(settled, &mut ())?;
    let times = SampleTimes::every(10.0 * oscillation)?.starting_at(settled)?;
    let mut profile = EnergyChangeProfile::new(0.0, 150.0, 75, times)?;
    simulation.run_until(settled + OSCILLATIONS.1 * oscillation, &mut profile)?;
    Ok(profile)
}
