//! Speed and size of each format, and what recording costs in a run.

use std::error::Error;
use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

use granular_edmd::prelude::*;

use crate::{Arguments, recorders, start};

/// Number of frames that are written for a measurement.
const FRAMES: u32 = 100;

/// Writes the last state again and again, and prints a line for each format.
pub(crate) fn print(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    let folder = arguments.out.join("measure");
    fs::create_dir(&folder)?;
    let interval = std::f64::consts::TAU / 10.0;
    let mut run = start(arguments)?;
    let began = Instant::now();
    run.run_until(100.0 * interval, &mut ())?;
    let plain = began.elapsed() / 100;
    gallery::say!("an oscillation without frames: {:.0} µs", microseconds(plain));
    for mut recorder in recorders(&folder, SampleTimes::every(interval)?)? {
        let snapshot = run.snapshot();
        let began = Instant::now();
        for frame in 0..FRAMES {
            let snapshot =
                Snapshot::new(f64::from(frame), snapshot.disks(), snapshot.domain(), snapshot.gravity());
            recorder.record(&snapshot)?;
        }
        let each = began.elapsed() / FRAMES;
        gallery::say!(
            "{recorder:?}: {:.0} µs and {:.0} frames per second",
            microseconds(each),
            1e6 / microseconds(each)
        );
    }
    for entry in fs::read_dir(&folder)? {
        let path = entry?.path();
        gallery::say!("{}: {} bytes per frame", path.display(), size(&path)? / u64::from(FRAMES));
    }
    Ok(())
}

fn microseconds(time: Duration) -> f64 {
    1e6 * time.as_secs_f64()
}

/// Returns the size of a file, or of all files in a folder.
fn size(path: &Path) -> Result<u64, Box<dyn Error>> {
    if !path.is_dir() {
        return Ok(path.metadata()?.len());
    }
    fs::read_dir(path)?.try_fold(0, |sum, entry| Ok(sum + entry?.metadata()?.len()))
}
