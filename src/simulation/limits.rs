//! The limits of a run: its end time, and reasons to stop earlier.

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use super::state::least_progress;
use super::{Counters, RunEnd};
use crate::ParameterError;
use crate::quantity::non_negative;

/// Number of events between two checks of the wall clock and of the flag that interrupts the run. The number
/// is large enough that the checks cost next to nothing, and small enough that a limit is noticed
/// immediately, even if each event takes all the steps that a search for a moving wall may take.
const EVENTS_BETWEEN_LOOKS: u64 = 256;

/// Relative rounding error of times that are computed from the same decimal numbers in different ways.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// End of a run without an end time. The search for a wall that a disk at rest never meets may be due later.
pub(super) const NEVER: f64 = 1e300;

/// The end of a run, and the limits that may end it earlier: a number of collisions, a wall-clock time, a
/// flag that another thread sets.
///
/// [`Simulation::run`](crate::Simulation::run) returns which of them ended the run. In each case, the next
/// run continues with the bits that the run would have had without the limit. Observers end runs by their
/// [verdict](crate::observable::Observer::verdict).
///
/// ```
/// use std::time::Duration;
/// use granular_edmd::simulation::{Limits, RunEnd};
/// # use granular_edmd::{Simulation, boundary::Container, collision::Elastic, initial};
/// # let container = Container::closed(20.0, 20.0)?;
/// # let disks = initial::with_maxwellian_velocities(initial::lattice(&container, 50, 0.5)?, 1.0, 1)?;
/// # let mut simulation = Simulation::builder(Elastic, container).disks(disks).build()?;
/// let limits = Limits::until(1e3).with_most_collisions(500).with_wall_clock(Duration::from_secs(60));
/// assert_eq!(simulation.run(&limits, &mut ())?, RunEnd::Collisions);
/// let counters = simulation.counters();
/// assert_eq!(counters.disk_collisions + counters.wall_collisions, 500);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy)]
pub struct Limits<'a> {
    end: f64,
    most_collisions: u64,
    wall_clock: Option<Duration>,
    interrupt: Option<&'a AtomicBool>,
    least_progress: Option<f64>,
}

impl<'a> Limits<'a> {
    /// Creates the limits of a run that ends at the absolute time `end`, with no other limit.
    pub const fn until(end: f64) -> Self {
        Self { end, most_collisions: u64::MAX, wall_clock: None, interrupt: None, least_progress: None }
    }

    /// Creates the limits of a run of `count` collisions, of disks with disks or walls, without an end time.
    ///
    /// If nothing can happen any more, the run ends earlier, with [`RunEnd::Time`].
    pub const fn collisions(count: u64) -> Self {
        Self { most_collisions: count, ..Self::until(NEVER) }
    }

    /// Returns the same limits, with at most `most_collisions` collisions in the run, of disks with disks or
    /// walls.
    pub fn with_most_collisions(self, most_collisions: u64) -> Self {
        Self { most_collisions, ..self }
    }

    /// Returns the same limits, with at most this wall-clock time.
    ///
    /// The clock is read every 256 events and at each sample, so the run takes a little longer.
    pub fn with_wall_clock(self, wall_clock: Duration) -> Self {
        Self { wall_clock: Some(wall_clock), ..self }
    }

    /// Returns the same limits, with a flag that ends the run when it is set, by another thread or by the
    /// handler of a signal.
    ///
    /// ```
    /// use std::sync::atomic::{AtomicBool, Ordering};
    /// use granular_edmd::simulation::{Limits, RunEnd};
    /// # use granular_edmd::{Simulation, boundary::Container, collision::Elastic};
    /// # let mut simulation = Simulation::builder(Elastic, Container::open(4.0)?).build()?;
    /// let flag = AtomicBool::new(false);
    /// let limits = Limits::until(1e3).with_interrupt(&flag);
    /// // Another thread asks the run to end.
    /// flag.store(true, Ordering::Relaxed);
    /// assert_eq!(simulation.run(&limits, &mut ())?, RunEnd::Interrupted);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn with_interrupt(self, flag: &'a AtomicBool) -> Self {
        Self { interrupt: Some(flag), ..self }
    }

    /// Returns the same limits, with this simulated time per event as the least progress of the run; 0 for a
    /// run that may stand still.
    ///
    /// Progress is judged over windows of 200 000 events plus 20 for each disk. A search for a wall looks
    /// ahead for a limited time; if it ends there without a touch, it counts as 256 events. A run with less
    /// progress is [stalled](crate::simulation::RunError::Stalled). Without this limit, $`N`$ disks may have
    /// about $`1.3\times10^8 + 4\times10^6 N`$ events in the time in which a typical disk moves or falls tens
    /// of diameters.
    ///
    /// # Errors
    /// If the time is negative or not finite.
    pub fn with_least_progress(self, time_per_event: f64) -> Result<Self, ParameterError> {
        Ok(Self { least_progress: Some(non_negative("least progress", time_per_event)?), ..self })
    }

    /// Returns the remaining limits after these collisions and this wall-clock time.
    pub(super) fn rest(&self, collisions: u64, spent: Duration) -> Self {
        let most_collisions = self.most_collisions.saturating_sub(collisions);
        let wall_clock = self.wall_clock.map(|time| time.saturating_sub(spent));
        Self { most_collisions, wall_clock, ..*self }
    }

    /// Returns the same limits with another end.
    pub(super) fn ending_at(self, end: f64) -> Self {
        Self { end, ..self }
    }

    /// Returns the absolute time at which the run ends; 1e300 without an end time.
    pub const fn end(&self) -> f64 {
        self.end
    }
}

/// Returns the end of a run, or the time of the next sample, kick or opening if only rounding puts it later.
pub(super) fn rounded_up(end: f64, next: f64) -> f64 {
    let is_same = next > end && next - end <= ROUNDING * end.abs();
    if is_same { next } else { end }
}

/// The limits of a run that is under way.
#[derive(Debug)]
pub(super) struct Watch<'a> {
    limits: &'a Limits<'a>,
    /// The count of all collisions at which the run ends.
    last_collision: u64,
    deadline: Option<Instant>,
}

impl<'a> Watch<'a> {
    /// Begins to watch a run that starts with these counts.
    pub(super) fn new(limits: &'a Limits<'a>, counters: &Counters) -> Self {
        Self {
            limits,
            last_collision: counters.collisions().saturating_add(limits.most_collisions),
            // A time so late that no clock can show it does not limit the run.
            deadline: limits.wall_clock.and_then(|time| Instant::now().checked_add(time)),
        }
    }

    /// Returns the absolute time at which the run ends.
    #[inline]
    pub(super) const fn end(&self) -> f64 {
        self.limits.end
    }

    /// Returns the limit that the run has reached, or `None`.
    pub(super) fn reached(&self, counters: &Counters) -> Option<RunEnd> {
        if counters.collisions() >= self.last_collision {
            return Some(RunEnd::Collisions);
        }
        if self.limits.interrupt.is_some_and(|flag| flag.load(Ordering::Relaxed)) {
            return Some(RunEnd::Interrupted);
        }
        self.deadline.is_some_and(|deadline| Instant::now() >= deadline).then_some(RunEnd::WallClock)
    }

    /// Returns the number of events until the next check of the limits.
    ///
    /// The result is at most the number of collisions left, so the run ends exactly at the last collision.
    pub(super) fn events_to_look(&self, counters: &Counters) -> u64 {
        let is_timed = self.deadline.is_some() || self.limits.interrupt.is_some();
        let most = if is_timed { EVENTS_BETWEEN_LOOKS } else { u64::MAX };
        most.min(self.last_collision - counters.collisions())
    }

    /// Returns the least simulated time per event.
    pub(super) fn least_progress(&self, epoch_length: f64, disks: usize) -> f64 {
        self.limits.least_progress.unwrap_or_else(|| least_progress(epoch_length, disks))
    }
}
