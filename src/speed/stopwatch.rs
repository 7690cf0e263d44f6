//! A stopwatch for processor time. Other work on the machine does not count.

use std::fs;
use std::time::{Duration, Instant};

/// A stopwatch for processor time, which starts when it is created.
///
/// On Linux, time in which other programs have the processor does not count, and readings are accurate to a
/// few microseconds. Elsewhere, the wall clock counts the seconds.
///
/// ```
/// use granular_edmd::speed::Stopwatch;
/// let watch = Stopwatch::of_thread();
/// let sum: f64 = (0..10_000).map(f64::from).sum();
/// assert!(sum > 0.0 && watch.seconds() >= 0.0);
/// ```
#[derive(Debug)]
pub struct Stopwatch {
    wall: Instant,
    start: Option<f64>,
}

impl Stopwatch {
    /// Starts a stopwatch of this thread, which must also read it.
    pub fn of_thread() -> Self {
        Self { start: seconds_of_thread(), wall: Instant::now() }
    }

    /// Returns the seconds since the start.
    pub fn seconds(&self) -> f64 {
        let wall = self.wall.elapsed().as_secs_f64();
        seconds_of_thread().zip(self.start).map_or(wall, |(now, start)| now - start)
    }
}

/// Returns the processor time of this thread, in seconds.
fn seconds_of_thread() -> Option<f64> {
    // The kernel records the time of a task when the task gives up the processor, or some milliseconds later.
    std::thread::sleep(Duration::from_nanos(1));
    let text = fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    let nanoseconds: f64 = text.split_whitespace().next()?.parse().ok()?;
    Some(1e-9 * nanoseconds)
}
