//! The measurement of one system.

use std::fmt;
use std::process::Command;
use std::time::Instant;

use granular_edmd::Disk;
use granular_edmd::scheduler::EventScheduler;
use granular_edmd::simulation::Counters;
use granular_edmd::speed::Meter;

use benches::Outcome;
use benches::state::{DISKS, State, oscillate};

/// The measured numbers of one system, from one run.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Measurement {
    pub(crate) nanoseconds_per_collision: f64,
    pub(crate) events_per_second: f64,
    pub(crate) bytes_per_disk: f64,
    pub(crate) set_up_seconds: f64,
}

/// Flag by which a new process is asked to measure one system.
const ASK: &str = "--one";

/// Returns the number of the system that this process is asked to measure.
pub(crate) fn asked_for() -> Option<usize> {
    std::env::args().skip_while(|argument| argument != ASK).nth(1)?.parse().ok()
}

impl Measurement {
    /// Measures a system, given by its number, in a new process. In this process, the system would use freed
    /// memory again, and its own memory would not be seen.
    pub(crate) fn in_new_process(number: usize) -> Outcome<Self> {
        let mut process = Command::new(std::env::current_exe()?);
        process.args(std::env::args().skip(1)).args([ASK, &number.to_string()]);
        let output = process.output()?;
        let numbers = String::from_utf8_lossy(&output.stdout);
        let numbers: Vec<f64> = numbers.split_whitespace().filter_map(|text| text.parse().ok()).collect();
        let &[nanoseconds_per_collision, events_per_second, bytes_per_disk, set_up_seconds] =
            numbers.as_slice()
        else {
            return Err(String::from_utf8_lossy(&output.stderr).trim().into());
        };
        Ok(Self { nanoseconds_per_collision, events_per_second, bytes_per_disk, set_up_seconds })
    }
}

impl fmt::Display for Measurement {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { nanoseconds_per_collision, events_per_second, bytes_per_disk, set_up_seconds } = self;
        write!(formatter, "{nanoseconds_per_collision} {events_per_second} {bytes_per_disk} {set_up_seconds}")
    }
}

/// Number of oscillations that do not count, until the epoch has moved and the neighbor cells have found
/// their size.
const WARM_UP: u32 = 30;

/// Builds the system and runs it for `oscillations` oscillations, after [`WARM_UP`].
pub(crate) fn measure<S: EventScheduler + Default>(
    state: &State,
    disks: impl FnOnce() -> Outcome<Vec<Disk>>,
    oscillations: u32,
) -> Outcome<Measurement> {
    let memory = resident_bytes();
    let disks = disks()?;
    let (count, boxes) = (disks.len(), disks.len() / DISKS);
    let start = Instant::now();
    let mut run = state.run(disks, boxes, S::default())?;
    let set_up_seconds = start.elapsed().as_secs_f64();
    oscillate(&mut run, WARM_UP)?;
    let bytes_per_disk = (resident_bytes() - memory) / count as f64;
    let meter = Meter::start(&run);
    oscillate(&mut run, oscillations)?;
    let report = meter.report(&run);
    Ok(Measurement {
        nanoseconds_per_collision: report.nanoseconds_per_collision,
        events_per_second: events(&report.counters) as f64 / report.seconds,
        bytes_per_disk,
        set_up_seconds,
    })
}

fn events(counters: &Counters) -> u64 {
    let Counters { disk_collisions, wall_collisions, cell_crossings, repredictions, .. } = counters;
    disk_collisions + wall_collisions + cell_crossings + repredictions
}

/// Returns the memory of this process that is in use; NaN if Linux does not report it.
fn resident_bytes() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"));
    let kilobytes = line.and_then(|text| text.trim().trim_end_matches("kB").trim().parse::<f64>().ok());
    kilobytes.map_or(f64::NAN, |kilobytes| 1024.0 * kilobytes)
}
