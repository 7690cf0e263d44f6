//! The command line of a study: `new`, `check`, `prepare`, `run`, `status` and `tables`, for any experiment.
//!
//! In a program of your own, `main` is one call of [`main`]. The binary `granular-edmd` is such a program for
//! the paper's box.
//!
//! ```no_run
//! use granular_edmd::study::vibrated_box::{Base, VibratedBox};
//! use granular_edmd::study::{Plan, Protocol, cli};
//!
//! fn main() -> std::process::ExitCode {
//!     let base = Base::BiParabolic { amplitude: 0.1, angular_frequency: 10.0 };
//!     cli::main(|| Plan::new(VibratedBox::new(100, 20.0, base), Protocol::new(100, 100, 10), 1))
//! }
//! ```
//!
//! `status --json` prints one object: the number of ramps, and the indices of those that are done, running,
//! begun and waiting. Tables are CSV files whose first line has the names of the columns; `columns.csv` has
//! the units of all columns.
//!
//! | exit code | meaning |
//! |---|---|
//! | 0 | all that was asked for is done |
//! | 1 | the command failed; standard error says why |
//! | 2 | the command line or the plan cannot be used |
//! | 3 | other processes do the rest (`--no-wait`); from `status`: not all ramps are done |
//! | 130 | stopped by Ctrl-C or SIGTERM with all work saved; the same command goes on |

mod template;
mod watch;
mod workflow;

use std::error::Error;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{Parser, Subcommand};

use super::{Control, Experiment, Plan, PlanError, RampStatus, Study, StudyError};
use watch::Watch;

/// Plans, runs and reads studies: many runs of one experiment, in any number of processes.
///
/// Exit codes: 0 done, 1 failed, 2 wrong command line or plan, 3 others do the rest, 130 stopped with all
/// saved.
#[derive(Debug, Parser)]
#[command(version)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Writes a commented plan to begin with.
    New {
        /// File to write; standard output if not given. An existing file is not overwritten.
        file: Option<PathBuf>,
    },
    /// Checks a plan, and prints how many ramps and values it has.
    Check {
        /// The plan, in TOML.
        plan: PathBuf,
    },
    /// Makes a study a workspace of `row`: a folder for each ramp, and `workflow.toml`. No run needs this.
    Prepare {
        /// The plan, in TOML.
        plan: PathBuf,
        /// Folder of the study: empty, or one with this plan.
        #[arg(long)]
        out: PathBuf,
    },
    /// Does the values of a plan that are not finished, alone or beside other processes that do the same.
    Run {
        /// The plan, in TOML.
        plan: PathBuf,
        /// Folder of the study: empty, or one with this plan.
        #[arg(long)]
        out: PathBuf,
        /// Index of the only ramp to do, counted from 0.
        #[arg(long)]
        ramp: Option<usize>,
        /// Number of threads; one for each processor if not given.
        #[arg(long)]
        threads: Option<usize>,
        /// Ends as soon as other processes do all that is left.
        #[arg(long)]
        no_wait: bool,
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
    },
}

/// The way in which a command ended.
enum End {
    Done,
    /// Other processes do the rest.
    Elsewhere,
    Interrupted,
}

/// The reason why a command failed.
enum Failure {
    Plan(Box<dyn Error>),
    Run(Box<dyn Error>),
}

impl From<StudyError> for Failure {
    fn from(error: StudyError) -> Self {
        match error {
            StudyError::Plan(error) => error.into(),
            error => Self::Run(error.into()),
        }
    }
}

impl From<PlanError> for Failure {
    fn from(error: PlanError) -> Self {
        Self::Plan(error.into())
    }
}

/// Runs the command line of a program, with plans of this experiment.
///
/// The command `new` writes the plan that `example` returns.
pub fn main<E: Experiment>(example: impl FnOnce() -> Result<Plan<E>, PlanError>) -> ExitCode {
    let ended = match Arguments::parse().command {
        Command::New { file } => new(example, file.as_deref()),
        Command::Check { plan } => check::<E>(&plan),
        Command::Prepare { plan, out } => prepare::<E>(&plan, &out),
        Command::Run { plan, out, ramp, threads, no_wait } => run::<E>(&plan, &out, ramp, threads, no_wait),
        Command::Status { folder, json } => status::<E>(&folder, json),
        Command::Tables { folder } => tables::<E>(&folder),
    };
    match ended {
        Ok(End::Done) => ExitCode::SUCCESS,
        Ok(End::Elsewhere) => ExitCode::from(3),
        Ok(End::Interrupted) => ExitCode::from(130),
        Err(Failure::Plan(error)) => report(error.as_ref(), 2),
        Err(Failure::Run(error)) => report(error.as_ref(), 1),
    }
}

/// Prints an error and its sources in one line.
fn report(error: &dyn Error, code: u8) -> ExitCode {
    let sources = std::iter::successors(error.source(), |&source| source.source()).map(ToString::to_string);
    let told: Vec<String> = std::iter::once(error.to_string()).chain(sources).collect();
    let _ = writeln!(std::io::stderr(), "error: {}", told.join(": "));
    ExitCode::from(code)
}

/// Prints a line. A reader that is gone is no error.
fn say(line: &str) {
    let _ = writeln!(std::io::stdout(), "{line}");
}

fn new<E: Experiment>(
    example: impl FnOnce() -> Result<Plan<E>, PlanError>,
    file: Option<&Path>,
) -> Result<End, Failure> {
    let text = template::commented(&example()?)?;
    let Some(path) = file else {
        say(text.trim_end());
        return Ok(End::Done);
    };
    let written = fs::File::create_new(path).and_then(|mut file| file.write_all(text.as_bytes()));
    written.map_err(StudyError::io("write", path))?;
    Ok(End::Done)
}

fn read(path: &Path) -> Result<String, Failure> {
    Ok(fs::read_to_string(path).map_err(StudyError::io("read", path))?)
}

/// Returns the error of a plan in a file, which names the file.
fn refused(path: &Path) -> impl Fn(PlanError) -> Failure {
    move |source| Failure::Plan(StudyError::Unreadable { path: path.to_owned(), source }.into())
}

/// Opens or creates the study of a plan in a folder.
fn study<E: Experiment>(path: &Path, folder: &Path) -> Result<Study<E>, Failure> {
    let plan = Plan::from_toml_unproven(&read(path)?).map_err(refused(path))?;
    Study::open_or_create_unproven(folder, plan).map_err(|error| match error {
        StudyError::Plan(source) => refused(path)(source),
        error => error.into(),
    })
}

fn check<E: Experiment>(path: &Path) -> Result<End, Failure> {
    let plan = Plan::<E>::from_toml(&read(path)?).map_err(refused(path))?;
    let (ramps, values, cycles) = (plan.ramp_count(), plan.value_count(), plan.protocol().cycles());
    let repeats = match plan.repeats() {
        1 => String::new(),
        repeats => format!(", {repeats} repeats among them"),
    };
    say(&format!("{ramps} ramps of {values} values of {cycles} cycles{repeats}"));
    Ok(End::Done)
}

fn prepare<E: Experiment>(path: &Path, out: &Path) -> Result<End, Failure> {
    let study = study::<E>(path, out)?;
    study.prepare()?;
    workflow::write(out)?;
    say(&format!("{} ramps are prepared in {}", study.plan().ramp_count(), out.display()));
    Ok(End::Done)
}

fn run<E: Experiment>(
    path: &Path,
    out: &Path,
    ramp: Option<usize>,
    threads: Option<usize>,
    no_wait: bool,
) -> Result<End, Failure> {
    let study = study::<E>(path, out)?;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads.unwrap_or(0)).build();
    let pool = pool.map_err(|error| Failure::Run(error.into()))?;
    let watch = Watch::new().map_err(Failure::Run)?;
    let show = |progress: &super::Progress| watch.show(progress);
    let control = Control::default().with_progress(&show).with_interrupt(watch::stop());
    let control = if no_wait { control.without_waiting() } else { control };
    let summary = pool.install(|| match ramp {
        Some(ramp) => study.run_ramp(ramp, &control),
        None => study.run(&control),
    })?;
    watch.end();
    for file in &summary.redone {
        say(&format!("{} was damaged and has been done again", file.display()));
    }
    say(&format!("{} of {} values are finished in {}", summary.finished, summary.total, out.display()));
    if summary.failed > 0 {
        let log = out.join("log.jsonl");
        say(&format!("{} of them stalled or failed; {} says why", summary.failed, log.display()));
    }
    Ok(match (summary.is_complete(), summary.elsewhere.is_empty()) {
        (true, _) => End::Done,
        (false, false) if !watch::is_stopped() => End::Elsewhere,
        _ => End::Interrupted,
    })
}

fn status<E: Experiment>(folder: &Path, json: bool) -> Result<End, Failure> {
    let study = Study::<E>::open(folder)?;
    let ramps = study.plan().ramp_count();
    let all: Vec<RampStatus> = (0..ramps).map(|ramp| study.status(ramp)).collect::<Result<_, _>>()?;
    let of = |wanted| (0..ramps).filter(|&ramp| all[ramp] == wanted).collect::<Vec<usize>>();
    let found = [
        ("done", of(RampStatus::Done)),
        ("running", of(RampStatus::Running)),
        ("begun", of(RampStatus::Begun)),
        ("waiting", of(RampStatus::Waiting)),
    ];
    if json {
        let lists = found.each_ref().map(|(name, ramps)| format!(r#""{name}":{ramps:?}"#));
        say(&format!(r#"{{"ramps":{ramps},{}}}"#, lists.join(",")));
    } else {
        let counts = found.each_ref().map(|(name, ramps)| format!("{} {name}", ramps.len()));
        say(&format!("{ramps} ramps: {}", counts.join(", ")));
    }
    Ok(if found[0].1.len() == ramps { End::Done } else { End::Elsewhere })
}

fn tables<E: Experiment>(folder: &Path) -> Result<End, Failure> {
    let study = Study::<E>::open(folder)?;
    let finished = study.write_tables()?;
    say(&format!("tables of {finished} values are in {}", folder.display()));
    Ok(End::Done)
}
