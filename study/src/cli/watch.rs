//! The display of progress, as a bar on a terminal or else in lines, and the signals that stop a study.

use std::io::{IsTerminal, Write};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

use crate::Progress;

/// True once Ctrl-C or SIGTERM was received.
static STOP: AtomicBool = AtomicBool::new(false);

/// Time between two lines if there is no terminal.
const BETWEEN_LINES: Duration = Duration::from_secs(10);

pub(super) const fn stop() -> &'static AtomicBool {
    &STOP
}

pub(super) fn is_stopped() -> bool {
    STOP.load(Ordering::Relaxed)
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

/// Makes Ctrl-C and SIGTERM end a process that has nothing to save.
pub(super) fn end_at_once() -> Result<(), ctrlc::Error> {
    ctrlc::set_handler(|| std::process::exit(130))
}

/// Display of a running study.
pub(super) struct Watch {
    /// The bar, if there is a terminal.
    bar: Option<ProgressBar>,
    told: Mutex<Instant>,
}

impl Watch {
    /// Creates the display.
    pub(super) fn new() -> Self {
        let style =
            ProgressStyle::with_template("{elapsed_precise} {wide_bar} {percent}% {per_sec}, {eta} left");
        // The template is valid.
        let style = style.unwrap_or_else(|_| ProgressStyle::default_bar());
        let bar = std::io::stderr().is_terminal().then(|| ProgressBar::new(0).with_style(style));
        Self { bar, told: Mutex::new(Instant::now()) }
    }

    pub(super) fn show(&self, progress: &Progress) {
        let Some(bar) = &self.bar else { return self.tell(progress) };
        let before = bar.position();
        bar.set_length(progress.total);
        bar.set_position(progress.done);
        // Values that were finished earlier do not count for the rate.
        if progress.done > before + 1 {
            bar.reset_eta();
        }
    }

    fn tell(&self, progress: &Progress) {
        let mut told = self.told.lock().unwrap_or_else(PoisonError::into_inner);
        if told.elapsed() < BETWEEN_LINES {
            return;
        }
        *told = Instant::now();
        let percent = 100.0 * progress.done as f64 / progress.total.max(1) as f64;
        let line = format!("{percent:.1} % ({} of {} steps)", progress.done, progress.total);
        let _ = writeln!(std::io::stderr(), "{line}");
    }

    pub(super) fn end(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}
