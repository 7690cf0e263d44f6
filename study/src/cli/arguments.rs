//! The arguments of the command line: the commands and their options.

use std::path::PathBuf;

use clap::{Parser, Subcommand};

use granular_edmd::ParameterError;

use crate::Control;

/// Largest number of threads of a run: more than any machine has processors, and few enough to start.
const MOST_THREADS: i64 = 4096;

/// Plans, runs and reads studies: many runs of one experiment, by any number of processes.
///
/// Exit codes: 0 done, 1 failed, 2 wrong command line or plan, 3 not finished and other processes work on it,
/// 4 no tables yet, 7 done but some values stalled, failed or reached a limit, 8 not
/// finished and no process works on it, 130 stopped with all saved.
#[derive(Debug, Parser)]
#[command(name = "granular-edmd", version)]
pub(super) struct Arguments {
    #[command(subcommand)]
    pub(super) command: Command,
}

#[derive(Debug, Subcommand)]
pub(super) enum Command {
    /// Writes a commented plan to begin with.
    New {
        /// File to write; standard output if not given. An existing file is not overwritten.
        file: Option<PathBuf>,
    },
    /// Explains a key of a plan or a column of the tables, or all keys and columns: meaning, unit, range and
    /// default.
    Explain {
        /// Name of the key, for example `friction`, `protocol.settle` or `protocol`.
        key: Option<String>,
    },
    /// Checks a plan, and prints how many ramps and values it has.
    Check {
        /// The plan, in TOML; `-` for standard input.
        plan: PathBuf,
    },
    /// Runs the unfinished values of a plan, alone or beside other processes.
    Run {
        /// The plan, in TOML; `-` for standard input.
        plan: PathBuf,
        /// Folder of the study: empty, or one with this plan.
        #[arg(long)]
        out: PathBuf,
        /// Index of the ramp to run, counted from 0; all ramps if not given.
        #[arg(long)]
        ramp: Option<usize>,
        #[command(flatten)]
        manner: Manner,
    },
    /// Prints the progress of a study.
    Status {
        /// Folder of the study.
        folder: PathBuf,
        /// Prints JSON, with the indices of the ramps.
        #[arg(long)]
        json: bool,
    },
    /// Writes the tables of all finished values.
    Tables {
        /// Folder of the study.
        folder: PathBuf,
        /// Folder for the tables; the study's folder if not given. Existing tables there are not overwritten.
        #[arg(long)]
        out: Option<PathBuf>,
    },
    /// Writes the disks after each cycle of a value, for OVITO, LAMMPS or ParaView. The ending of the file's
    /// name chooses the format.
    Trajectory(Trajectory),
    /// Reads disks from a file of any accepted format, and writes them to a file of another format.
    ///
    /// Columns are found by their names, in any order and case: x, y or pos, velo or vx, radius or diameter,
    /// mass, density or momenta, omega, orientation or angle, id, type, kind or species, image. Notes on
    /// standard error say what is ignored, wrapped or shrunk.
    Convert(Convert),
    /// Runs a value again, bit by bit the same and to the same end, and writes its last collisions, or its
    /// collisions in an interval of time.
    ///
    /// Columns: number of the collision in the ramp, time, id of the disk, id of the other disk or name of
    /// the wall, position of the disk, closing speed and slip speed before the collision, impulse on the
    /// disk, change of energy.
    Replay(Replay),
    /// Allows this program to continue a study that other code began. Each record keeps the mark of the code
    /// that made it.
    Accept {
        /// Folder of the study.
        folder: PathBuf,
    },
    /// Estimates the core hours of a plan from short runs without a driving.
    Bench {
        /// The plan, in TOML; `-` for standard input.
        plan: PathBuf,
        /// Prints JSON.
        #[arg(long)]
        json: bool,
        /// Measures for a tenth of the time.
        #[arg(long)]
        quick: bool,
    },
}

/// A value of a plan or a study, and the time at which its run ends.
#[derive(Debug, clap::Args)]
pub(super) struct Place {
    /// Index of the ramp, counted from 0.
    #[arg(long, default_value_t = 0)]
    pub(super) ramp: usize,
    /// Index of the value in the ramp, counted from 0. Any value after the first one starts from the end of
    /// an earlier value, and only the folder of a study has this state.
    #[arg(long, default_value_t = 0)]
    pub(super) value: usize,
    /// Absolute time at which the run ends; the end of the value if not given.
    #[arg(long, allow_negative_numbers = true)]
    pub(super) until: Option<f64>,
}

#[derive(Debug, clap::Args)]
pub(super) struct Trajectory {
    /// The plan, in TOML (`-` for standard input), or the folder of a study.
    pub(super) plan: PathBuf,
    /// File to write, by its ending: .xyz or .extxyz, .lammpstrj or .dump, .gsd, or .pvd with its folder;
    /// .xyz.gz and .lammpstrj.gz are compressed. An existing file is not overwritten.
    #[arg(long)]
    pub(super) out: PathBuf,
    #[command(flatten)]
    pub(super) place: Place,
    /// Largest number of cycles; the value may end earlier.
    #[arg(long, default_value_t = 100)]
    pub(super) cycles: u32,
}

#[derive(Debug, clap::Args)]
pub(super) struct Convert {
    /// File to read, recognized by its contents, also compressed: extended XYZ, a dump or a data file of
    /// LAMMPS, GSD, or a table with names of columns. `-` for standard input.
    pub(super) input: PathBuf,
    /// File to write, by its ending: .xyz, .extxyz, .lammpstrj, .dump, .gsd, .pvd, .csv, .data, .lmp or .vtp;
    /// .xyz.gz and .lammpstrj.gz are compressed. An existing file is not overwritten.
    pub(super) out: PathBuf,
    /// Frame to read, counted from 0, or from the end if negative; `last` for −1.
    #[arg(long, default_value = "last", allow_negative_numbers = true, value_parser = frame)]
    pub(super) frame: isize,
    /// Step of the frame to read, instead of its number: dumps, GSD files and tables number their frames by
    /// steps.
    #[arg(long, conflicts_with = "frame")]
    pub(super) step: Option<u64>,
    /// Largest overlap that is accepted, relative to the sum of the radii.
    #[arg(long, allow_negative_numbers = true)]
    pub(super) tolerance: Option<f64>,
    /// Shrinks all radii in proportion until no disks overlap. Overlaps with walls remain, since the file
    /// does not say where walls are.
    #[arg(long)]
    pub(super) shrink: bool,
    /// Mass per area of disks in a file without masses.
    #[arg(long, allow_negative_numbers = true)]
    pub(super) density: Option<f64>,
    /// Radius of disks in a file without radii.
    #[arg(long, allow_negative_numbers = true)]
    pub(super) radius: Option<f64>,
    /// Factor of all lengths in the file, such as the size of a pixel.
    #[arg(long, allow_negative_numbers = true)]
    pub(super) scale: Option<f64>,
}

/// Reads a frame number.
fn frame(text: &str) -> Result<isize, std::num::ParseIntError> {
    if text == "last" { Ok(-1) } else { text.parse() }
}

#[derive(Debug, clap::Args)]
pub(super) struct Replay {
    /// The plan, in TOML (`-` for standard input), or the folder of a study.
    pub(super) plan: PathBuf,
    #[command(flatten)]
    pub(super) place: Place,
    /// Absolute time after which all collisions are written.
    #[arg(long, allow_negative_numbers = true)]
    pub(super) from: Option<f64>,
    /// Id of a disk: only collisions of this disk are written.
    #[arg(long)]
    pub(super) disk: Option<u64>,
    /// Number of collisions to write, the last ones; 10 if there is no `--from`.
    #[arg(long)]
    pub(super) last: Option<usize>,
    /// File to write; standard output if not given. An existing file is not overwritten.
    #[arg(long)]
    pub(super) out: Option<PathBuf>,
}

#[derive(Debug, clap::Args)]
#[expect(clippy::struct_excessive_bools, reason = "flags are independent of each other")]
pub(super) struct Manner {
    /// Number of threads; one for each processor if not given.
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=MOST_THREADS))]
    pub(super) threads: Option<u16>,
    /// Folder of an earlier study to reuse. Compared with its plan, this plan may have more values on the
    /// axes and at the end of the ramp, more repeats, and more samples. Can be given several times.
    #[arg(long)]
    from: Vec<PathBuf>,
    /// Runs again the values that stalled, failed or reached a limit, and all later values of their ramps.
    /// The same code fails again.
    #[arg(long)]
    pub(super) retry: bool,
    /// Ends as soon as only work of other processes is left.
    #[arg(long)]
    no_wait: bool,
    /// Ends each value that takes more than this number of wall-clock seconds.
    #[arg(long)]
    most_seconds: Option<f64>,
    /// Writes no tables when all ramps are done; `tables` writes them later.
    #[arg(long)]
    no_tables: bool,
    /// Also reads the records of finished ramps, and runs damaged or lost ones again.
    #[arg(long)]
    verify: bool,
}

impl Manner {
    /// Returns a control with these options.
    pub(super) fn of<'a>(&'a self, control: Control<'a>) -> Result<Control<'a>, ParameterError> {
        let control = control.with_earlier_studies(&self.from);
        let control = if self.no_wait { control.without_waiting() } else { control };
        let control = if self.no_tables { control.without_tables() } else { control };
        let control = if self.verify { control.with_verification() } else { control };
        self.most_seconds.map_or(Ok(control), |most| control.with_most_seconds(most))
    }
}
