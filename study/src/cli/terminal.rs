//! Input and output of the commands; the display of progress, which is a bar on a terminal and otherwise
//! lines; and the signals that stop a command.

use std::fs;
use std::io::{self, IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressFinish, ProgressStyle};

use super::Failure;
use crate::{Progress, StudyError};

/// True once Ctrl-C or SIGTERM was received.
pub(super) static STOP: AtomicBool = AtomicBool::new(false);

/// Time between two lines of progress if there is no terminal.
const BETWEEN_LINES: Duration = Duration::from_secs(10);

/// Prints a line.
pub(super) fn say(line: &str) -> Result<(), Failure> {
    let mut out = io::stdout();
    wrote(writeln!(out, "{line}").and_then(|()| out.flush()), Path::new("standard output")).map(drop)
}

/// Prints notes for the reader of a result, on standard error.
pub(super) fn tell(note: &str) {
    let _ = writeln!(io::stderr(), "note: {note}");
}

/// Evaluates the result of writing output. If the reader has closed a pipe, the result is false, and not an
/// error: the reader has seen enough. A full disk is an error.
pub(super) fn wrote(written: io::Result<()>, path: &Path) -> Result<bool, Failure> {
    match written {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(false),
        written => Ok(written.map(|()| true).map_err(StudyError::io("write", path))?),
    }
}

/// Reads a file, or standard input for the name `-`.
pub(super) fn read(path: &Path) -> Result<String, Failure> {
    let text =
        if path == Path::new("-") { io::read_to_string(io::stdin()) } else { fs::read_to_string(path) };
    Ok(text.map_err(StudyError::io("read", path))?)
}

/// Writes a new file. An existing file is not overwritten.
pub(super) fn write_new(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    let written = fs::File::create_new(path).and_then(|mut file| file.write_all(bytes));
    Ok(written.map_err(StudyError::io("write", path))?)
}

/// Makes Ctrl-C and SIGTERM stop a study. A second signal ends the process immediately; only saved work is
/// kept.
pub(super) fn listen() -> Result<(), ctrlc::Error> {
    ctrlc::set_handler(|| {
        if STOP.swap(true, Ordering::Relaxed) {
            std::process::exit(130);
        }
    })
}

/// Makes Ctrl-C and SIGTERM end a process that has nothing to save, and remove its incomplete file.
pub(super) fn end_at_once(file: Option<PathBuf>) -> Result<(), ctrlc::Error> {
    ctrlc::set_handler(move || {
        let _ = file.as_ref().map(fs::remove_file);
        std::process::exit(130)
    })
}

/// Display of a running study. It is cleared when it is dropped.
pub(super) struct Watch {
    /// The bar, if there is a terminal.
    bar: Option<ProgressBar>,
    shown: Mutex<Instant>,
}

impl Watch {
    /// Creates the display.
    pub(super) fn new() -> Self {
        let style =
            ProgressStyle::with_template("{elapsed_precise} {wide_bar} {percent}% {per_sec}, {eta} left");
        // The template is valid.
        let style = style.unwrap_or_else(|_| ProgressStyle::default_bar());
        let bar = || ProgressBar::new(0).with_style(style).with_finish(ProgressFinish::AndClear);
        let bar = io::stderr().is_terminal().then(bar);
        Self { bar, shown: Mutex::new(Instant::now()) }
    }

    pub(super) fn show(&self, progress: &Progress) {
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
