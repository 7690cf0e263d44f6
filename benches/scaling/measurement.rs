//! What is measured of one system.

use std::time::Instant;

use granular_edmd::Disk;
use granular_edmd::scheduler::EventScheduler;
use granular_edmd::simulation::Counters;

use crate::common::Outcome;
use crate::common::state::{State, oscillate};

/// One system, once.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Measurement {
    pub(crate) nanoseconds_per_collision: f64,
    pub(crate) events_per_second: f64,
    pub(crate) bytes_per_disk: f64,
    pub(crate) set_up_seconds: f64,
}

/// Builds the system and runs it for so many oscillations, after two that do not count.
pub(crate) fn measure<S: EventScheduler + Default>(
    state: &State,
    disks: impl FnOnce() -> Outcome<Vec<Disk>>,
    oscillations: u32,
) -> Outcome<Measurement> {
    let memory = resident_bytes();
    let disks = disks()?;
    let (count, boxes) = (disks.len(), disks.len() / crate::common::state::DISKS);
    let start = Instant::now();
    let mut run = state.run(disks, boxes, S::default())?;
    let set_up_seconds = start.elapsed().as_secs_f64();
    oscillate(&mut run, 2)?;
    let bytes_per_disk = (resident_bytes() - memory) / count as f64;
    let (start, before) = (Instant::now(), *run.counters());
    oscillate(&mut run, oscillations)?;
    let (seconds, after) = (start.elapsed().as_secs_f64(), run.counters());
    Ok(Measurement {
        nanoseconds_per_collision: 1e9 * seconds / (after.collisions - before.collisions) as f64,
        events_per_second: (events(after) - events(&before)) as f64 / seconds,
        bytes_per_disk,
        set_up_seconds,
    })
}

fn events(counters: &Counters) -> u64 {
    let Counters { collisions, wall_collisions, cell_crossings, repredictions, .. } = counters;
    collisions + wall_collisions + cell_crossings + repredictions
}

/// Memory of this process that is in use; NaN where Linux does not say.
fn resident_bytes() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"));
    let kilobytes = line.and_then(|text| text.trim().trim_end_matches("kB").trim().parse::<f64>().ok());
    kilobytes.map_or(f64::NAN, |kilobytes| 1024.0 * kilobytes)
}
