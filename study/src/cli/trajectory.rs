//! The command `trajectory`: the disks of the first value of a ramp, in a file that OVITO opens.

use std::path::PathBuf;

use granular_edmd::observable::SampleTimes;
use granular_edmd::trajectory::{ByEnding, Recorder};

use super::files::Ending;
use super::source::begun;
use super::{End, Failure, Plan, PlanError, StudyError, read, refused, say};
use crate::Experiment;

#[derive(Debug, clap::Args)]
pub(super) struct Wishes {
    /// The plan, in TOML; `-` for standard input.
    plan: PathBuf,
    /// File to write, by its ending: .xyz or .extxyz, .lammpstrj or .dump, .gsd, or .pvd with its folder;
    /// .xyz.gz and .lammpstrj.gz are compressed. An existing file is not overwritten.
    #[arg(long)]
    out: PathBuf,
    /// Index of the ramp, counted from 0.
    #[arg(long, default_value_t = 0)]
    ramp: usize,
    /// Number of cycles.
    #[arg(long, default_value_t = 100)]
    cycles: u32,
    /// File from which the run starts instead: a checkpoint, or any file that `convert` reads.
    #[arg(long)]
    start: Option<PathBuf>,
}

/// Runs the first value of a ramp again, and writes a frame after each cycle.
pub(super) fn write<E: Experiment>(wishes: &Wishes) -> Result<End, Failure> {
    let Wishes { plan: path, out, ramp, cycles, start } = wishes;
    Ending::need(out, Ending::is_trajectory)?;
    let plan = Plan::<E>::from_toml(&read(path)?).map_err(refused(path))?;
    if *ramp >= plan.ramp_count() {
        let message = format!("there is no ramp {ramp}: the plan has {}, from 0 on", plan.ramp_count());
        return Err(PlanError::Toml(message).into());
    }
    let (experiment, seed) = (plan.experiment(*ramp, 0)?, plan.ramp_seed(*ramp));
    let run = match start {
        Some(file) => begun(&experiment, file, seed),
        None => experiment.build(seed),
    };
    let mut run = run.map_err(|source| StudyError::Build { ramp: *ramp, value: 0, source })?;
    let mut recorder = Recorder::create(out, ByEnding, SampleTimes::every(experiment.cycle())?)?;
    // Half a cycle more, so that rounding does not cut the last frame off.
    run.run_until(run.time() + experiment.cycle() * (f64::from(*cycles) + 0.5), &mut recorder)?;
    let (frames, disks) = (recorder.times().len(), run.len());
    say(&format!("{frames} frames of {disks} disks are in {}", out.display()))?;
    Ok(End::Done)
}
