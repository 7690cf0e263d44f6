//! The command `trajectory`: the disks of the first value of a ramp, in a file that OVITO opens.

use std::path::Path;

use granular_edmd::observable::SampleTimes;
use granular_edmd::trajectory::{ByEnding, Recorder};

use super::{End, Failure, Plan, PlanError, StudyError, read, refused, say};
use crate::Experiment;

/// Runs the first value of a ramp again, and writes a frame after each cycle.
pub(super) fn write<E: Experiment>(
    plan: &Path,
    ramp: usize,
    cycles: u32,
    out: &Path,
) -> Result<End, Failure> {
    let path = plan;
    let plan = Plan::<E>::from_toml(&read(path)?).map_err(refused(path))?;
    if ramp >= plan.ramp_count() {
        let message = format!("there is no ramp {ramp}: the plan has {}, from 0 on", plan.ramp_count());
        return Err(PlanError::Toml(message).into());
    }
    let experiment = plan.experiment(ramp, 0)?;
    let cannot = |source| StudyError::Build { ramp, value: 0, source };
    let mut run = experiment.build(plan.ramp_seed(ramp)).map_err(cannot)?;
    let times = SampleTimes::every(experiment.cycle())?;
    let mut recorder = Recorder::create(out, ByEnding, times)?;
    // Half a cycle more, so that rounding does not cut the last frame off.
    run.run_until(experiment.cycle() * (f64::from(cycles) + 0.5), &mut recorder)?;
    let (frames, disks) = (recorder.times().len(), run.len());
    say(&format!("{frames} frames of {disks} disks are in {}", out.display()))?;
    Ok(End::Done)
}
