//! A stopwatch for the time on processors. Other work on the machine does not count.

use std::fs;
use std::path::Path;
use std::time::Instant;

type Clock = fn() -> Option<f64>;

/// A stopwatch, which starts when it is made.
pub struct Stopwatch {
    wall: Instant,
    clock: Clock,
    start: Option<f64>,
}

impl Stopwatch {
    /// Starts a stopwatch of this thread.
    pub fn of_thread() -> Self {
        Self::with(|| seconds_of(Path::new("/proc/thread-self")))
    }

    /// Starts a stopwatch of all threads that this process has both now and at the end.
    pub fn of_process() -> Self {
        Self::with(|| {
            let tasks = fs::read_dir("/proc/self/task").ok()?;
            tasks.map(|task| seconds_of(&task.ok()?.path())).sum()
        })
    }

    fn with(clock: Clock) -> Self {
        Self { wall: Instant::now(), clock, start: clock() }
    }

    /// Returns the seconds on processors, which are good to some milliseconds. Without such a clock of Linux,
    /// the seconds are those of the wall clock.
    pub fn seconds(&self) -> f64 {
        let passed = (self.clock)().zip(self.start).map(|(now, start)| now - start);
        passed.unwrap_or_else(|| self.wall.elapsed().as_secs_f64())
    }
}

fn seconds_of(task: &Path) -> Option<f64> {
    let text = fs::read_to_string(task.join("schedstat")).ok()?;
    let nanoseconds: f64 = text.split_whitespace().next()?.parse().ok()?;
    Some(1e-9 * nanoseconds)
}
