//! The command `trajectory`: the disks of a value, in a file that OVITO opens.

use std::path::PathBuf;

use granular_edmd::observable::SampleTimes;
use granular_edmd::trajectory::{ByEnding, Recorder};

use super::files::Ending;
use super::source::{Place, Source};
use super::{End, Failure, say};
use crate::Experiment;

#[derive(Debug, clap::Args)]
pub(super) struct Wishes {
    /// The plan, in TOML (`-` for standard input), or the folder of a study.
    plan: PathBuf,
    /// File to write, by its ending: .xyz or .extxyz, .lammpstrj or .dump, .gsd, or .pvd with its folder;
    /// .xyz.gz and .lammpstrj.gz are compressed. An existing file is not overwritten.
    #[arg(long)]
    out: PathBuf,
    #[command(flatten)]
    place: Place,
    /// Number of cycles, which may go beyond the end of the value.
    #[arg(long, default_value_t = 100)]
    cycles: u32,
}

/// Runs a value again, and writes a frame after each cycle.
pub(super) fn write<E: Experiment>(wishes: &Wishes) -> Result<End, Failure> {
    let Wishes { plan, out, place, cycles } = wishes;
    Ending::need(out, Ending::is_trajectory)?;
    let Source { mut run, cycle, .. } = Source::<E>::open(plan, place, place.start.as_deref())?;
    let mut recorder = Recorder::create(out, ByEnding, SampleTimes::every(cycle)?)?;
    // Half a cycle more, so that rounding does not cut the last frame off.
    let end = run.time() + cycle * (f64::from(*cycles) + 0.5);
    run.run_until(place.until.map_or(end, |until| end.min(until)), &mut recorder)?;
    let (frames, disks) = (recorder.times().len(), run.len());
    say(&format!("{frames} frames of {disks} disks are in {}", out.display()))?;
    Ok(End::Done)
}
