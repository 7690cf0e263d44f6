//! The report of a run: how fast it was, and what it did. Time is processor time: other
//! work on the machine does not count.

use std::time::{Duration, Instant};
use std::{fmt, fs};

use crate::Simulation;
use crate::boundary::Boundary;
use crate::collision::CollisionRule;
use crate::scheduler::EventScheduler;
use crate::simulation::Counters;

/// A meter that is started before a run and read after it. The meter does not slow the run.
///
/// ```
/// use granular_edmd::speed::Meter;
/// # use granular_edmd::{Simulation, boundary::Container, collision::Elastic, initial};
/// # let container = Container::closed(20.0, 20.0)?;
/// # let disks = initial::with_maxwellian_velocities(initial::lattice(&container, 50, 0.5)?, 1.0, 1)?;
/// # let mut simulation = Simulation::builder(Elastic, container).disks(disks).build()?;
/// let meter = Meter::start(&simulation);
/// simulation.run_until(50.0, &mut ())?;
/// let report = meter.report(&simulation);
/// println!("{report}");
/// assert_eq!(report.counters.disk_collisions, simulation.counters().disk_collisions);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Meter {
    stopwatch: Stopwatch,
    counters: Counters,
    time: f64,
}

impl Meter {
    /// Starts a meter of the simulation, for runs in this thread.
    pub fn start<R: CollisionRule, B: Boundary, S: EventScheduler>(run: &Simulation<R, B, S>) -> Self {
        let (counters, time) = (*run.counters(), run.time());
        Self { counters, time, stopwatch: Stopwatch::of_thread() }
    }

    /// Returns the report of the simulation since the meter was started.
    pub fn report<R: CollisionRule, B: Boundary, S: EventScheduler>(
        &self,
        run: &Simulation<R, B, S>,
    ) -> RunReport {
        let seconds = self.stopwatch.seconds();
        let (counters, disks) = (run.counters().since(&self.counters), run.len());
        RunReport {
            disks,
            simulated_time: run.time() - self.time,
            seconds,
            nanoseconds_per_collision: 1e9 * seconds / counters.disk_collisions as f64,
            collisions_per_second: counters.disk_collisions as f64 / seconds,
            events_per_second: counters.events() as f64 / seconds,
            events_per_collision: counters.events() as f64 / counters.disk_collisions as f64,
            counters,
        }
    }
}

/// The report of a run, for people ([`Display`](fmt::Display)) and as data (feature `serde`).
///
/// Only collisions of two disks count as collisions here. In a run without such collisions, numbers per
/// collision are infinite or NaN.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct RunReport {
    /// Number of disks at the end.
    pub disks: usize,
    /// Simulated time.
    pub simulated_time: f64,
    /// Seconds on the processor: on Linux, time of other programs does not count; elsewhere, by the wall
    /// clock.
    pub seconds: f64,
    /// Processor time per collision, including all other events.
    pub nanoseconds_per_collision: f64,
    /// Collisions in a second.
    pub collisions_per_second: f64,
    /// Events of all kinds in a second.
    pub events_per_second: f64,
    /// Events of all kinds for each collision.
    pub events_per_collision: f64,
    /// Events by kind.
    pub counters: Counters,
}

impl fmt::Display for RunReport {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { disks, seconds, counters, .. } = self;
        let per_collision = |events: u64| events as f64 / counters.disk_collisions as f64;
        let (million, nanoseconds) = (1e-6 * self.collisions_per_second, self.nanoseconds_per_collision);
        writeln!(formatter, "{disks} disks, {:.6} units of time in {seconds:.3} s", self.simulated_time)?;
        writeln!(formatter, "{million:.3} million collisions a second, {nanoseconds:.1} ns each")?;
        write!(
            formatter,
            "{:.3} million events a second; with each collision {:.3} with walls, {:.3} passages, \
             {:.3} predicted anew, {:.3} horizons",
            1e-6 * self.events_per_second,
            per_collision(counters.wall_collisions),
            per_collision(counters.cell_crossings),
            per_collision(counters.repredictions),
            per_collision(counters.horizons),
        )
    }
}

/// A stopwatch for processor time, which starts when it is created.
///
/// On Linux, time in which other programs have the processor does not count, and readings are accurate to a
/// few microseconds. Elsewhere, the wall clock counts the seconds.
#[derive(Debug)]
struct Stopwatch {
    wall: Instant,
    start: Option<f64>,
}

impl Stopwatch {
    /// Starts a stopwatch of this thread, which must also read it.
    fn of_thread() -> Self {
        Self { start: seconds_of_thread(), wall: Instant::now() }
    }

    /// Returns the seconds since the start.
    fn seconds(&self) -> f64 {
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
