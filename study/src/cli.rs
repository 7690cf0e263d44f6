//! The command line of a study, for any experiment: `new`, `explain`, `check`, `run`, `status`, `tables`,
//! `trajectory`, `convert`, `replay`, `accept` and `bench`.
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
//! begun and waiting; the ramp and the index of each value that was not finished; whether tables of all
//! values exist; and the approximate processor seconds that the finished values took and that the other
//! values will take. Tables are CSV files whose first line has the names of the columns; `columns.csv` has
//! the units and the meanings of all columns.
//!
//! | exit code | meaning |
//! |---|---|
//! | 0 | all that was asked for is done |
//! | 1 | the command failed; standard error says why |
//! | 2 | the command line or the plan cannot be used |
//! | 3 | not finished: other processes work on it (`--no-wait`), also from `status` |
//! | 4 | from `status`: all ramps are done, but the tables are not written |
//! | 7 | from `run` and `status`: all is done, and some values stalled, failed or reached a limit |
//! | 8 | from `status`: not finished, and no process works on it |
//! | 130 | stopped by Ctrl-C or SIGTERM, with all work saved; the same command continues it |
//!
//! `replay` has nothing to save: if it is stopped, it leaves no file.

mod arguments;
mod convert;
mod plans;
mod replay;

pub use plans::example;

use std::error::Error;
use std::ffi::OsString;
use std::fs;
use std::io::{self, IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use arguments::{Arguments, Command, Manner};
use clap::Parser;
use indicatif::{ProgressBar, ProgressFinish, ProgressStyle};
use serde_json::json;

use super::errors::{PlanError, StudyError, chain};
use super::{Control, Experiment, Plan, Progress, RampStatus, Record, Study};

/// Largest number of failed values that `status` prints, and of ramps that `check` prints; the JSON of
/// `status` contains all.
const LISTED: usize = 8;

/// The outcome of a command, with its exit code.
#[derive(Clone, Copy)]
enum End {
    Done = 0,
    /// Values are unfinished, and other processes are working on them.
    Elsewhere = 3,
    /// All values are finished, but the tables are not.
    NoTables = 4,
    /// The study is complete, but some values stalled, failed or reached a limit.
    Unfinished = 7,
    /// Values are unfinished, and no process is working on them.
    Idle = 8,
    Interrupted = 130,
}

/// The reason why a command failed.
type Failure = Box<dyn Error>;

/// Runs the command line of a program for studies of this experiment.
///
/// The command `new` writes the plan that `example` returns.
pub fn main<E: Experiment>(example: impl FnOnce() -> Result<Plan<E>, PlanError>) -> ExitCode {
    ExitCode::from(main_from(std::env::args_os(), example))
}

/// Runs the command line with these arguments, of which the first is the name of the program, and returns the
/// exit code.
///
/// A program in another language that calls this library uses it in place of [`main`]. A command line that
/// cannot be read, and a request for help, end the process.
pub fn main_from<E: Experiment>(
    arguments: impl IntoIterator<Item = OsString>,
    example: impl FnOnce() -> Result<Plan<E>, PlanError>,
) -> u8 {
    let done = |()| End::Done;
    let ended = match Arguments::parse_from(arguments).command {
        Command::New { file } => plans::new(example, file.as_deref()).map(done),
        Command::Explain { key } => plans::explain::<E>(key.as_deref()).map(done),
        Command::Check { plan } => plans::check::<E>(&plan).map(done),
        Command::Run { plan, out, ramp, manner } => run::<E>(&plan, &out, ramp, &manner),
        Command::Status { folder, json } => status::<E>(&folder, json),
        Command::Tables { folder, out } => tables::<E>(&folder, out.as_deref()).map(done),
        Command::Trajectory(wishes) => replay::trajectory::<E>(&wishes).map(done),
        Command::Convert(wishes) => convert::convert(&wishes).map(done),
        Command::Replay(wishes) => replay::replay::<E>(&wishes).map(done),
        Command::Accept { folder } => accept::<E>(&folder).map(done),
        Command::Bench { plan, json, quick } => plans::bench::<E>(&plan, json, quick).map(done),
    };
    match ended {
        Ok(end) => end as u8,
        Err(error) => report(error.as_ref()),
    }
}

/// Prints an error, and returns its exit code: 2 if the plan is at fault, and otherwise 1.
fn report(error: &(dyn Error + 'static)) -> u8 {
    let _ = writeln!(io::stderr(), "error: {}", chain(error));
    let of_study = error.downcast_ref::<StudyError>();
    let is_of_plan = matches!(of_study, Some(StudyError::Plan(_) | StudyError::Unreadable { .. }));
    if is_of_plan || error.is::<PlanError>() { 2 } else { 1 }
}

/// Opens or creates the study of a plan in a folder.
fn study<E: Experiment>(path: &Path, folder: &Path) -> Result<Study<E>, Failure> {
    let plan = Plan::from_toml_unproven(&read(path)?).map_err(StudyError::unreadable(path))?;
    Ok(Study::open_or_put(folder, plan, false).map_err(|error| match error {
        StudyError::Plan(source) => StudyError::unreadable(path)(source),
        error => error,
    })?)
}

fn run<E: Experiment>(path: &Path, out: &Path, ramp: Option<usize>, manner: &Manner) -> Result<End, Failure> {
    let study = study::<E>(path, out)?;
    if manner.retry {
        for [failed, _] in study.failed()? {
            if ramp.is_none_or(|ramp| ramp == failed) {
                study.forget_failed(failed)?;
            }
        }
    }
    let pool = rayon::ThreadPoolBuilder::new().num_threads(manner.threads.map_or(0, usize::from)).build()?;
    listen()?;
    let watch = Watch::new();
    let show = |progress: &Progress| watch.show(progress);
    let control = manner.of(Control::default().with_progress(&show).with_interrupt(&STOP))?;
    let summary = pool.install(|| match ramp {
        Some(ramp) => study.run_ramp(ramp, &control),
        None => study.run(&control),
    })?;
    drop(watch);
    for file in &summary.redone {
        say(&format!("{} was damaged and has been done again", file.display()))?;
    }
    if STOP.load(Ordering::Relaxed) && !summary.is_complete() {
        say("stopped; all work is saved, also on unfinished values: the same command continues")?;
    }
    say(&format!("{} of {} values have ended in {}", summary.finished, summary.total, out.display()))?;
    for (count, fate) in
        [(summary.failed, "stalled, failed or reached a limit"), (summary.warned, "have warnings")]
    {
        if count > 0 {
            say(&format!("{count} of them {fate}: `status {}` says why", out.display()))?;
        }
    }
    Ok(match (summary.is_complete(), summary.elsewhere.is_empty()) {
        (true, _) if summary.failed > 0 => End::Unfinished,
        (true, _) => End::Done,
        (false, false) if !STOP.load(Ordering::Relaxed) => End::Elsewhere,
        _ => End::Interrupted,
    })
}

fn status<E: Experiment>(folder: &Path, json: bool) -> Result<End, Failure> {
    let study = Study::<E>::open(folder)?;
    let (all, has_tables) = (study.all_status()?, study.has_tables());
    let ramps = all.len();
    let of = |wanted| (0..ramps).filter(|&ramp| all[ramp] == wanted).collect::<Vec<usize>>();
    let [done, running, begun, waiting] =
        [RampStatus::Done, RampStatus::Running, RampStatus::Begun, RampStatus::Waiting].map(of);
    let (are_done, are_run) = (done.len() == ramps, !running.is_empty());
    let failed = study.failed()?;
    let (spent, left) = study.seconds()?;
    if json {
        let object = json!({
            "ramps": ramps, "done": done, "running": running, "begun": begun, "waiting": waiting,
            "failed": failed, "tables": has_tables, "seconds": spent, "seconds_left": left,
        });
        say(&object.to_string())?;
    } else {
        let [done, running, begun, waiting] = [done, running, begun, waiting].map(|ramps| ramps.len());
        let counts = format!("{done} done, {running} running, {begun} begun, {waiting} waiting");
        let not = if has_tables { "" } else { "do not " };
        say(&format!("{ramps} ramps: {counts}; the tables {not}have all values"))?;
        if left.is_finite() {
            say(&format!("about {} are done, {} are left", core_time(spent), core_time(left)))?;
        }
        let reason = |record: &Record<E>| record.outcome().reason().unwrap_or_default().to_owned();
        list(&study, "stalled, failed or reached a limit", &failed, reason)?;
        list(&study, "have warnings", &study.warned()?, |record| record.warnings().join("; "))?;
    }
    Ok(match (are_done, has_tables) {
        (true, true) if failed.is_empty() => End::Done,
        (true, true) => End::Unfinished,
        (true, false) => End::NoTables,
        (false, _) if are_run => End::Elsewhere,
        (false, _) => End::Idle,
    })
}

/// Prints the first values that have a fate, each with the reason.
fn list<E: Experiment>(
    study: &Study<E>,
    fate: &str,
    values: &[[usize; 2]],
    reason: impl Fn(&Record<E>) -> String,
) -> Result<(), Failure> {
    if values.is_empty() {
        return Ok(());
    }
    say(&format!("{} values {fate}:", values.len()))?;
    for &[ramp, value] in values.iter().take(LISTED) {
        let reason = match study.record(ramp, value) {
            Ok(record) => record.as_ref().map_or_else(String::new, &reason),
            Err(error) => chain(&error),
        };
        say(&format!("  ramp {ramp}, value {value}: {reason}"))?;
    }
    if values.len() > LISTED { say("  …") } else { Ok(()) }
}

fn tables<E: Experiment>(folder: &Path, out: Option<&Path>) -> Result<(), Failure> {
    let study = Study::<E>::open(folder)?;
    let finished = out.map_or_else(|| study.write_tables(), |out| study.write_tables_to(out))?;
    say(&format!("tables of {finished} values are in {}", out.unwrap_or(folder).display()))
}

fn accept<E: Experiment>(folder: &Path) -> Result<(), Failure> {
    let differences = Study::<E>::accept_changes(folder)?;
    for difference in &differences {
        say(&difference.to_string())?;
    }
    say(if differences.is_empty() {
        "the study is of this code: there is nothing to accept"
    } else {
        "from here on, records are of this code: the column made_by of values.csv tells them from those before"
    })
}

/// Returns a time on one core as text.
fn core_time(seconds: f64) -> String {
    if seconds < 100.0 {
        format!("{seconds:.2} core seconds")
    } else {
        format!("{:.3} core hours", seconds / 3600.0)
    }
}

/// True once Ctrl-C or SIGTERM was received.
static STOP: AtomicBool = AtomicBool::new(false);

/// Time between two lines of progress if there is no terminal.
const BETWEEN_LINES: Duration = Duration::from_secs(10);

/// Prints a line.
fn say(line: &str) -> Result<(), Failure> {
    let mut out = io::stdout();
    wrote(writeln!(out, "{line}").and_then(|()| out.flush()), Path::new("standard output")).map(drop)
}

/// Prints notes for the reader of a result, on standard error.
fn tell(note: &str) {
    let _ = writeln!(io::stderr(), "note: {note}");
}

/// Evaluates the result of writing output. If the reader has closed a pipe, the result is false, and not an
/// error: the reader has seen enough. A full disk is an error.
fn wrote(written: io::Result<()>, path: &Path) -> Result<bool, Failure> {
    match written {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(false),
        written => Ok(written.map(|()| true).map_err(StudyError::io("write", path))?),
    }
}

/// Reads a file, or standard input for the name `-`.
fn read(path: &Path) -> Result<String, Failure> {
    let text =
        if path == Path::new("-") { io::read_to_string(io::stdin()) } else { fs::read_to_string(path) };
    Ok(text.map_err(StudyError::io("read", path))?)
}

/// Writes a new file. An existing file is not overwritten.
fn write_new(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    let written = fs::File::create_new(path).and_then(|mut file| file.write_all(bytes));
    Ok(written.map_err(StudyError::io("write", path))?)
}

/// Makes Ctrl-C and SIGTERM stop a study. A second signal ends the process immediately; only saved work is
/// kept.
fn listen() -> Result<(), ctrlc::Error> {
    ctrlc::set_handler(|| {
        if STOP.swap(true, Ordering::Relaxed) {
            std::process::exit(130);
        }
    })
}

/// Makes Ctrl-C and SIGTERM end a process that has nothing to save, and remove its incomplete file.
fn end_at_once(file: Option<PathBuf>) -> Result<(), ctrlc::Error> {
    ctrlc::set_handler(move || {
        let _ = file.as_ref().map(fs::remove_file);
        std::process::exit(130)
    })
}

/// Display of a running study. It is cleared when it is dropped.
struct Watch {
    /// The bar, if there is a terminal.
    bar: Option<ProgressBar>,
    shown: Mutex<Instant>,
}

impl Watch {
    /// Creates the display.
    fn new() -> Self {
        let style =
            ProgressStyle::with_template("{elapsed_precise} {wide_bar} {percent}% {per_sec}, {eta} left");
        // The template is valid.
        let style = style.unwrap_or_else(|_| ProgressStyle::default_bar());
        let bar = || ProgressBar::new(0).with_style(style).with_finish(ProgressFinish::AndClear);
        let bar = io::stderr().is_terminal().then(bar);
        Self { bar, shown: Mutex::new(Instant::now()) }
    }

    fn show(&self, progress: &Progress) {
        let Some(bar) = &self.bar else { return self.tell(progress) };
        let before = bar.position();
        bar.set_length(progress.total);
        bar.set_position(progress.done);
        // A jump of several steps comes from values that were finished earlier, and these do not count for
        // the rate.
        if progress.done > before + 1 {
            bar.reset_eta();
        }
    }

    fn tell(&self, progress: &Progress) {
        let mut shown = self.shown.lock().unwrap_or_else(PoisonError::into_inner);
        if shown.elapsed() < BETWEEN_LINES {
            return;
        }
        *shown = Instant::now();
        let percent = 100.0 * progress.done as f64 / progress.total.max(1) as f64;
        let line = format!("{percent:.1} % ({} of {} steps)", progress.done, progress.total);
        let _ = writeln!(io::stderr(), "{line}");
    }
}
