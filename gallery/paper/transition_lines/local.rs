//! The collisions of a run at a crossing, each with the temperature of its layer.

use std::error::Error;

use granular_edmd::observable::{EnergyChangeProfile, SampleTimes, Sampled};
use granular_edmd_study::Experiment;

use crate::ramps::{Crossing, Local, Ramp};

/// Runs the box of a ramp at one of its crossings, from a lattice, and measures it by layers two diameters
/// high. The run settles for `oscillations` oscillations, and is measured for the same number.
///
/// The temperature of a layer comes from the vertical and horizontal motion in the frame of the box, over the
/// whole width. The flow therefore counts as heat, and hot and cold regions at the same height are averaged.
pub(crate) fn measure(ramp: &Ramp, at: &Crossing, oscillations: u32) -> Result<Local, Box<dyn Error>> {
    let experiment = ramp.experiment.clone().with_friction(at.friction).with_inelasticity(at.inelasticity);
    let settled = f64::from(oscillations) * experiment.cycle();
    // Samples are a hundredth less than 10 oscillations apart, so that they see all phases of the base.
    let times = SampleTimes::every(9.99 * experiment.cycle())?.starting_at(settled)?;
    let mut profile = Sampled::new(EnergyChangeProfile::new(0.0, 150.0, 75)?, times);
    let mut simulation = experiment.build(1)?;
    simulation.run_until(settled, &mut ())?;
    simulation.run_until(2.0 * settled, &mut profile)?;
    let (Some(energy_change), Some(temperature_ratio)) =
        (profile.relative_energy_change(), profile.rotational_ratio())
    else {
        return Err("no collisions at a crossing".into());
    };
    Ok(Local { energy_change, temperature_ratio })
}
