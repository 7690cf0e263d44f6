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
use granular_edmd::statistics::BlockedMean;

/// Numbers of oscillations before measuring, and while measuring.
const OSCILLATIONS: (f64, f64) = (2000.0, 2000.0);

/// Parts of the measured time, whose scatter tells the errors.
const PARTS: u32 = 80;

/// Energy changes and temperatures by height.
struct Measured {
    profile: EnergyChangeProfile,
    /// Relative energy change and ratio of temperatures in each part.
    parts: [BlockedMean; 2],
}

impl Measured {
    /// Returns a number of the whole run with its error, and a star if that is only a lower bound.
    fn with_error(whole: Option<f64>, parts: &BlockedMean) -> String {
        let error = parts.estimate();
        let mark = if error.is_converged() { ' ' } else { '*' };
        format!("{:.4} ± {:.4}{mark}", whole.unwrap_or(f64::NAN), error.standard_error())
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    println!("N = 1000, 60 x 150, g = 0.015625, A = 0.1, omega = 10, q = 0");
    println!(
        "<dE>/T over disk-disk collisions: Maxwellian gas with all temperatures equal, with the rotational"
    );
    println!("temperature of the run, and the run itself, each collision over the temperature of its layer;");
    println!("± is the standard error from blocks of the run, * a lower bound of it");
    println!("{:>8} {:>10} {:>10} {:>18} {:>18}", "kappa", "equal T", "T_rot", "run", "T_rot/T");
    for friction in [0.01, 0.03, 0.05, 0.07, 0.1, 0.3, 1.0] {
        let rule = Frictional::new(0.0, friction)?;
        let Measured { profile, parts: [changes, ratios] } = measured(rule)?;
        let ratio = profile.rotational_ratio();
        println!(
            "{friction:8} {:10.4} {:10.4} {:>18} {:>18}",
            mean_energy_change(&rule, &Maxwellian::new(1.0)?),
            mean_energy_change(
                &rule,
                &Maxwellian::new(1.0)?.with_rotational_temperature(ratio.unwrap_or(1.0))?
            ),
            Measured::with_error(profile.relative_energy_change(), &changes),
            Measured::with_error(ratio, &ratios),
        );
    }
    Ok(())
}

/// Measures the paper's box, once it has settled: the whole time, and its parts.
fn measured(rule: Frictional) -> Result<Measured, Box<dyn Error>> {
    let base = BiParabolic::new(0.1, 10.0)?;
    let oscillation = TAU / base.angular_frequency();
    let container = Container::closed(60.0, 150.0)?.with_motion(Wall::Floor, base)?;
    let disks = initial::with_maxwellian_velocities(initial::lattice(&container, 1000, 0.5)?, 0.5, 1)?;
    let rule = ContactDuration::new(rule, 1e-4)?;
    let mut simulation = Simulation::builder(rule, container).disks(disks).gravity(0.015_625).build()?;
    let settled = OSCILLATIONS.0 * oscillation;
    simulation.run_until(settled, &mut ())?;
    let from = |start, every: f64| {
        let times = SampleTimes::every(every * oscillation)?.starting_at(start)?;
        EnergyChangeProfile::new(0.0, 150.0, 75, times)
    };
    let mut measured = Measured { profile: from(settled, 10.0)?, parts: Default::default() };
    for part in 0..PARTS {
        let at = |part: u32| settled + OSCILLATIONS.1 * oscillation * f64::from(part) / f64::from(PARTS);
        let mut profile = from(at(part), 1.0)?;
        simulation.run_until(at(part + 1), &mut (&mut measured.profile, &mut profile))?;
        measured.parts[0].extend(profile.relative_energy_change());
        measured.parts[1].extend(profile.rotational_ratio());
    }
    Ok(measured)
}
