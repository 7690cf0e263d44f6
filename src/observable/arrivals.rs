//! The arrivals of disks at walls.

use super::by_wall::ByWall;
use super::stretch::Stretch;
use super::table::Table;
use super::{Collision, Heading, Observer, ObserverError, Partner, SampleTimes, Snapshot};
use crate::ParameterError;
use crate::statistics::{Estimate, block_average};

/// An observer that counts the disks that arrive at some walls, over intervals of time: the flow into a sink.
///
/// The rate of an interval of length $`\Delta t`$ with $`n`$ arrivals is $`n/\Delta t`$. An interval counts
/// only if it was watched from its start to its end. At a wall that is not a sink, each bounce is an arrival.
/// In an [`OfKind`](super::OfKind), only disks of one kind count.
///
/// ```
/// use granular_edmd::prelude::*;
/// use granular_edmd::observable::Arrivals;
///
/// let exit = Part::polyline([(-1.0, 1.0), (5.0, 1.0)].map(DVec2::from))?.absorbing_centers();
/// let silo = Container::open(4.0)?.with_part("exit", exit)?;
/// // The centers come to the line every 1/4.
/// let grain = |k: f64| Disk::new(DVec2::new(2.0, 1.5 + k), 0.4)?.with_velocity(DVec2::new(0.0, -4.0));
/// let grains = (0..40).map(|k| grain(f64::from(k))).collect::<Result<Vec<_>, _>>()?;
/// let mut flow = Arrivals::at(["exit"], SampleTimes::every(1.0)?);
/// Simulation::builder(Elastic, silo).disks(grains).build()?.run_until(10.0, &mut flow)?;
/// assert_eq!(flow.counts(), [4; 10]);
/// assert_eq!(flow.rate()?.mean(), 4.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct Arrivals {
    walls: ByWall<()>,
    stretch: Stretch,
    present: u64,
    times: Vec<f64>,
    counts: Vec<u64>,
}

impl Arrivals {
    /// Creates an observer of arrivals at the walls and parts of these names, counted over the intervals
    /// between these times.
    ///
    /// A run ends with an error if its boundary has no wall and no part of one of these names.
    pub fn at<N: Into<String>>(names: impl IntoIterator<Item = N>, times: SampleTimes) -> Self {
        let (mut walls, stretch) = (ByWall::NONE, Stretch::new(times));
        names.into_iter().for_each(|name| walls.insert(name.into(), ()));
        Self { walls, stretch, present: 0, times: Vec::new(), counts: Vec::new() }
    }

    /// Returns the ends of the intervals.
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// Returns the number of arrivals in each interval.
    pub fn counts(&self) -> &[u64] {
        &self.counts
    }

    /// Returns the mean number of arrivals per unit of time, with its error.
    ///
    /// Arrivals that are fed at regular times make up for each other from one interval to the next, and the
    /// error is then too large, up to tenfold: run several seeds for the true scatter.
    ///
    /// # Errors
    /// If no interval is complete yet.
    pub fn rate(&self) -> Result<Estimate, ParameterError> {
        block_average(&self.rates().collect::<Vec<_>>())
    }

    /// Forgets all arrivals.
    pub fn clear(&mut self) {
        self.stretch.forget();
        self.times.clear();
        self.counts.clear();
        self.present = 0;
    }

    fn rates(&self) -> impl Iterator<Item = f64> {
        self.counts.iter().map(|&count| count as f64 / self.stretch.sample_times.interval())
    }
}

impl Observer for Arrivals {
    fn on_start(&mut self, start: &Snapshot<'_>) -> Result<(), ObserverError> {
        self.walls.find(start)?;
        if self.stretch.begin(start)? {
            self.present = 0;
        }
        Ok(())
    }

    #[inline]
    fn on_collision(&mut self, collision: &Collision) {
        let Partner::Wall(wall) = collision.partner else { return };
        self.present += u64::from(self.walls.at(wall).is_some());
    }

    fn next_sample(&self) -> f64 {
        self.stretch.sample_times.upcoming()
    }

    fn on_sample(&mut self, snapshot: &Snapshot<'_>) {
        let count = std::mem::take(&mut self.present);
        if self.stretch.finish(snapshot.time()).is_some() {
            self.times.push(snapshot.time());
            self.counts.push(count);
        }
    }

    fn on_end(&mut self, end: &Snapshot<'_>) {
        self.stretch.pause(end.time());
    }
}

/// The columns are the end of each interval, the number of arrivals in it, and their rate.
impl Table for Arrivals {
    fn headings(&self) -> Vec<Heading> {
        [("time", "time"), ("arrivals", "1"), ("rate", "1/time")].map(Heading::from).into()
    }

    fn rows(&self) -> Box<dyn Iterator<Item = Vec<f64>> + '_> {
        let counts = self.counts.iter().map(|&count| count as f64);
        let rows = self.times.iter().zip(counts).zip(self.rates());
        Box::new(rows.map(|((&time, count), rate)| vec![time, count, rate]))
    }
}
