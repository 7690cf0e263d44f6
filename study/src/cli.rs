//! The command line of a study, for any experiment: `new`, `explain`, `check`, `run`, `status`, `tables`,
//! `trajectory`, `convert`, `replay`, `diff`, `accept`, `bench` and `completions`.
//!
//! In a custom program, `main` is one call of [`main`]. The binary `granular-edmd` is such a program for the
//! paper's box.
//!
//! ```no_run
//! use granular_edmd_study::vibrated_box::{Base, VibratedBox};
//! use granular_edmd_study::{Plan, Protocol, cli};
//!
//! fn main() -> std::process::ExitCode {
//!     let base = Base::BiParabolic { amplitude: 0.1, angular_frequency: 10.0 };
//!     cli::main(|| Plan::new(VibratedBox::new(100, 20.0, base), Protocol::new(100, 100, 10)?, 1))
//! }
//! ```
//!
//! `status --json` prints one object: the number of ramps; the indices of the ramps that are done, running,
//! begun and waiting; the ramp and the index of each value that was not finished; whether there are tables of
//! all values; and about how many seconds of one processor the finished values took and the others will take.
//! Tables are CSV files whose first line has the names of the columns; `columns.csv` has the units and the
//! meanings of all columns.
//!
//! | exit code | meaning |
//! |---|---|
//! | 0 | all that was asked for is done |
//! | 1 | the command failed; standard error says why |
//! | 2 | the command line or the plan cannot be used |
//! | 3 | not finished: other processes work on it (`--no-wait`), also from `status` |
//! | 4 | from `status`: all ramps are done, but there are no tables of them |
//! | 6 | from `diff`: the two runs differ |
//! | 7 | from `run` and `status`: all is done, and some values stalled, failed or reached a limit |
//! | 8 | from `status`: not finished, and no process works on it |
//! | 130 | stopped by Ctrl-C or SIGTERM with all work saved; the same command goes on |
//!
//! `replay` and `diff` have nothing to save: stopped, they leave no file.

mod arguments;
mod bench;
mod convert;
mod diff;
mod explain;
mod plans;
mod replay;
mod run;
mod shape;
mod source;
mod terminal;

use std::error::Error;
use std::io::{self, Write};
use std::process::ExitCode;

use clap::Parser;

use super::errors::{PlanError, StudyError, chain};
use super::{Experiment, Plan};
use arguments::{Arguments, Command};

/// Largest number of failed values that `status` prints, and of ramps that `check` does; the JSON of `status`
/// has all.
const LISTED: usize = 8;

/// The outcome of a command, with its exit code.
#[derive(Clone, Copy)]
enum End {
    Done = 0,
    /// Values are unfinished, and other processes are working on them.
    Elsewhere = 3,
    /// All values are finished, but not the tables.
    NoTables = 4,
    /// Two runs differ.
    Different = 6,
    /// The study is complete, but some values stalled, failed or reached a limit.
    Unfinished = 7,
    /// Values are unfinished, and no process is working on them.
    Idle = 8,
    Interrupted = 130,
}

/// The reason why a command failed.
type Failure = Box<dyn Error>;

/// Runs the command line of a program, with plans of this experiment.
///
/// The command `new` writes the plan that `example` returns. `diff` copies runs, so the rule and the boundary
/// must be `Clone`.
pub fn main<E: Experiment<Rule: Clone, Boundary: Clone>>(
    example: impl FnOnce() -> Result<Plan<E>, PlanError>,
) -> ExitCode {
    let ended = match Arguments::parse().command {
        Command::New { file } => plans::new(example, file.as_deref()),
        Command::Explain { key, schema } => plans::explain::<E>(key.as_deref(), schema),
        Command::Check { plan } => plans::check::<E>(&plan),
        Command::Run { plan, out, ramp, manner } => run::run::<E>(&plan, &out, ramp, &manner),
        Command::Status { folder, json } => run::status::<E>(&folder, json),
        Command::Tables { folder, out } => run::tables::<E>(&folder, out.as_deref()),
        Command::Trajectory(wishes) => source::trajectory::<E>(&wishes),
        Command::Convert(wishes) => convert::convert(&wishes),
        Command::Replay(wishes) => replay::replay::<E>(&wishes),
        Command::Diff(wishes) => diff::diff::<E>(&wishes),
        Command::Completions { shell } => plans::completions(&shell),
        Command::Accept { folder } => run::accept::<E>(&folder),
        Command::Bench { plan: Some(plan), json, quick } => bench::plan::<E>(&plan, json, quick),
        Command::Bench { plan: None, quick, .. } => bench::table(quick),
    };
    match ended {
        Ok(end) => ExitCode::from(end as u8),
        Err(error) => report(error.as_ref()),
    }
}

/// Prints an error, and returns its exit code: 2 for an unusable plan.
fn report(error: &(dyn Error + 'static)) -> ExitCode {
    let _ = writeln!(io::stderr(), "error: {}", chain(error));
    let of_study = error.downcast_ref::<StudyError>();
    let is_of_plan = matches!(of_study, Some(StudyError::Plan(_) | StudyError::Unreadable { .. }));
    ExitCode::from(if is_of_plan || error.is::<PlanError>() { 2 } else { 1 })
}

/// Returns a time on one core as text.
fn core_time(seconds: f64) -> String {
    if seconds < 100.0 {
        format!("{seconds:.2} core seconds")
    } else {
        format!("{:.3} core hours", seconds / 3600.0)
    }
}
