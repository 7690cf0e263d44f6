//! Progress of long work: a bar on a terminal, and otherwise lines at intervals.

use std::io::IsTerminal;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use granular_edmd::observable::{Collision, Observer};
use indicatif::{ProgressBar, ProgressStyle};

use crate::output;

/// Time between two lines where there is no terminal.
const BETWEEN_LINES: Duration = Duration::from_secs(10);

/// Collisions between two readings of the clock.
const BETWEEN_LOOKS: u64 = 1 << 12;

/// Steps of the bar of a run.
const STEPS: u64 = 1000;

/// Shows on standard error how much of some work is done.
pub struct Progress {
    name: String,
    bar: Option<ProgressBar>,
    start: Instant,
    told: Mutex<Instant>,
}

impl Progress {
    /// Begins work of this name.
    pub fn of(name: impl Into<String>) -> Self {
        let style = ProgressStyle::with_template("{msg} {bar:40.cyan/blue} {percent} %, {eta} left");
        let style = style.unwrap_or_else(|_| ProgressStyle::default_bar());
        let (name, start) = (name.into(), Instant::now());
        let bar = || ProgressBar::new(0).with_style(style).with_message(name.clone());
        let bar = std::io::stderr().is_terminal().then(bar);
        Self { name, bar, start, told: Mutex::new(start) }
    }

    /// Shows the share of the work that is done.
    pub fn show(&self, done: u64, all: u64) {
        let Some(bar) = &self.bar else { return self.tell(100.0 * done as f64 / all.max(1) as f64) };
        let before = bar.position();
        bar.set_length(all);
        bar.set_position(done);
        // Work that was done before says nothing about the rate.
        if before == 0 && done > 1 {
            bar.reset_eta();
        }
    }

    fn tell(&self, percent: f64) {
        let mut told = self.told.lock().unwrap_or_else(PoisonError::into_inner);
        if told.elapsed() >= BETWEEN_LINES {
            *told = Instant::now();
            let seconds = self.start.elapsed().as_secs_f64();
            output::complain(format_args!("{}: {percent:.1} % after {seconds:.0} s", self.name));
        }
    }

    /// Returns an observer that shows the progress of a run until this time.
    pub const fn until(self, end: f64) -> Until {
        Until { progress: self, end, collisions: 0 }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

/// An observer that shows how far a run is. It counts collisions and has no sampling times, so it also shows
/// a run whose time hardly advances.
pub struct Until {
    progress: Progress,
    end: f64,
    collisions: u64,
}

impl Observer for Until {
    fn on_collision(&mut self, collision: &Collision) {
        self.collisions += 1;
        if self.collisions.is_multiple_of(BETWEEN_LOOKS) {
            self.progress.show((STEPS as f64 * collision.time / self.end) as u64, STEPS);
        }
    }
}
