//! A run in files that other programs open: OVITO, LAMMPS, ParaView, spreadsheets.
//!
//! Two kinds of disks in a vibrated box with periodic sides. Each format gets the same frames, so that the
//! files can be compared; `.ci/readers` opens them with the modules of OVITO and VTK.
//!
//! ```text
//! cargo run --release -p gallery --features files --bin export -- --out export
//! cargo run --release -p gallery --features files --bin export -- --quick --measure --out export
//! ```
//!
//! The example writes `run.xyz`, `run.dump`, `run.gsd`, `run.pvd` with its folder, `end.csv`, `end.data`,
//! `series.csv`, `run.xyz.gz` and `run.dump.gz`. Nothing is overwritten.

mod measure;

use std::error::Error;
use std::f64::consts::TAU;
use std::fs::File;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Parser;
use granular_edmd::Kind;
use granular_edmd::observable::{OfKind, Temperatures, measured_by};
use granular_edmd::prelude::*;
use granular_edmd_files::{ByEnding, RecordError, Recorder, State};
use serde_json::{Value, json};

use gallery::command_line::{self, Failure, whole};
use gallery::failure::named;
use gallery::output;
use gallery::progress::Progress;

/// A run in files that other programs open.
#[derive(Parser)]
struct Arguments {
    /// Number of frames, one every 1.1 oscillations.
    #[arg(long, default_value_t = 20, value_parser = whole::<100_000>)]
    frames: u64,
    /// Number of disks.
    #[arg(long, default_value_t = 1000, value_parser = whole::<100_000>)]
    disks: u64,
    /// Seed of the initial velocities.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Uses at most 100 disks and 4 frames.
    #[arg(long)]
    quick: bool,
    /// Also prints frames per second and bytes per frame of each format.
    #[arg(long)]
    measure: bool,
    /// Folder for the results.
    #[arg(long, value_name = "FOLDER", default_value = "out/export")]
    out: PathBuf,
    /// File for the contents of all frames as JSON, to compare them with what a reader finds; - is standard
    /// output.
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

impl Arguments {
    fn json_is_printed(&self) -> bool {
        self.json.as_ref().is_some_and(|path| path == Path::new("-"))
    }
}

/// The kind of the small disks.
const SMALL: Kind = Kind::new(7);

type Run = Simulation<ContactDuration<Frictional>>;

fn main() -> ExitCode {
    command_line::main(run)
}

fn run(arguments: &Arguments) -> Result<(), Failure> {
    command_line::make_folder(&arguments.out)?;
    if arguments.json_is_printed() {
        output::leave_to_json();
    }
    write_all(arguments)?;
    gallery::say!(
        "wrote run.xyz, run.dump, run.gsd, run.pvd, end.csv, end.data, and series.csv in {}",
        arguments.out.display()
    );
    if arguments.measure { measure::print(arguments).map_err(Failure::run) } else { Ok(()) }
}

/// Returns the run before its first oscillation: every third disk is small and light.
fn start(arguments: &Arguments) -> Result<Run, Box<dyn Error>> {
    let count = if arguments.quick { arguments.disks.min(100) } else { arguments.disks };
    let width = if arguments.quick { 20.0 } else { 60.0 };
    let base = BiParabolic::new(0.1, 10.0)?;
    let container = Container::open(width)?.with_periodic_sides()?.with_motion(Wall::Floor, base)?;
    let disks = initial::lattice(&container, count as usize, 0.5)?;
    let mut disks = initial::with_maxwellian_velocities(disks, 0.5, arguments.seed)?;
    for disk in disks.iter_mut().step_by(3) {
        *disk = Disk::new(disk.position(), 0.35)?
            .with_velocity(disk.velocity())?
            .with_mass(0.49)?
            .with_kind(SMALL);
    }
    let rule = ContactDuration::new(Frictional::from_inelasticity(0.01, 0.01, 0.1)?, 1e-4)?;
    Ok(Simulation::builder(rule, container).disks(disks).gravity(0.015_625).build()?)
}

/// Returns the time between two frames, and the time of the last one.
fn times(arguments: &Arguments) -> (f64, f64) {
    let frames = if arguments.quick { arguments.frames.min(4) } else { arguments.frames };
    let interval = 1.1 * TAU / 10.0;
    (interval, frames as f64 * interval)
}

/// Begins a file of each format.
fn recorders(folder: &Path, times: SampleTimes) -> Result<Vec<Recorder>, RecordError> {
    let names = ["run.xyz", "run.dump", "run.gsd", "run.pvd", "run.xyz.gz", "run.dump.gz"];
    names.into_iter().map(|name| Recorder::create(folder.join(name), ByEnding, times)).collect()
}

/// Creates a file, which must not exist yet.
fn new(path: &Path) -> std::io::Result<File> {
    named(path, File::create_new(path))
}

fn write_all(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    let (out, (interval, end)) = (&arguments.out, times(arguments));
    let clock = SampleTimes::every(interval)?;
    let mut run = start(arguments)?;
    let mut recorders = recorders(out, clock)?;
    let fastest =
        |s: &Snapshot<'_>| s.disks().iter().map(|disk| disk.velocity().length()).fold(0.0, f64::max);
    let fastest = measured_by(fastest).named("fastest", "length/time");
    let mut series = Series::new((CenterOfMass, OfKind::new(SMALL, Temperatures), fastest), clock);
    let mut frames = Vec::new();
    let mut expected = on_sample(clock, |snapshot: &Snapshot<'_>| frames.push(all_of(snapshot)));
    let mut progress = Progress::of("run").until(end);
    run.run_until(end, &mut ((&mut recorders, &mut progress), &mut series, &mut expected))?;
    gallery::output::warn(&run.warnings());
    let state = State::of(&run.snapshot());
    state.write_csv(new(&out.join("end.csv"))?)?;
    state.write_lammps_data(new(&out.join("end.data"))?)?;
    series.write_csv(new(&out.join("series.csv"))?)?;
    if arguments.json_is_printed() {
        output::json(&serde_json::to_string(&frames)?).map_err(|error| format!("--json -: {error}"))?;
    } else if let Some(path) = &arguments.json {
        let file = File::create_new(path).map_err(|error| format!("--json {}: {error}", path.display()))?;
        serde_json::to_writer(file, &frames)?;
    }
    Ok(())
}

/// Returns everything that a frame holds.
fn all_of(snapshot: &Snapshot<'_>) -> Value {
    let domain = snapshot.domain();
    let disk = |(index, disk): (usize, &Disk)| {
        json!({
            "id": index + 1,
            "kind": disk.kind().number(),
            "position": disk.position().to_array(),
            "unwrapped": domain.unwrapped(disk).to_array(),
            "image": disk.image(),
            "velocity": disk.velocity().to_array(),
            "angle": disk.angle(),
            "angular_velocity": disk.angular_velocity(),
            "radius": disk.radius(),
            "mass": disk.mass(),
            "inertia_factor": disk.inertia_factor(),
        })
    };
    json!({
        "time": snapshot.time(),
        "gravity": snapshot.gravity().downward(),
        "left": domain.left,
        "right": domain.right,
        "bottom": domain.bottom,
        // For an open box, it is null.
        "top": domain.top,
        "periodic": [domain.periodic_sides, domain.periodic_ends],
        "floor": snapshot.edges().bottom,
        "walls": snapshot.moving_walls().iter().map(|(wall, by, phase)| [*wall as f64, by.x, by.y, *phase]).collect::<Vec<_>>(),
        "disks": snapshot.disks().iter().enumerate().map(disk).collect::<Vec<_>>(),
    })
}
