//! Moments: the beginning and the end of a run.

use crate::Gravity;
use crate::boundary::Domain;

/// A moment at which a run begins or ends, and the system that runs.
///
/// ```
/// use granular_edmd::boundary::{Boundary, Container};
/// use granular_edmd::observable::{Moment, Observer, OrderParameters, SampleTimes, Series};
///
/// let domain = Container::closed(4.0, 6.0)?.domain();
/// let mut series = Series::new(OrderParameters, SampleTimes::every(2.0)?);
/// series.on_start(&Moment::new(11.5, 100, 4, domain, 0.5));
/// assert_eq!(series.next_sample(), 12.0);
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moment {
    time: f64,
    disk_count: usize,
    wall_count: usize,
    domain: Domain,
    gravity: Gravity,
}

impl Moment {
    /// Creates a moment of a run with these numbers of disks and walls.
    ///
    /// The engine creates moments, and tests may do so.
    pub fn new(
        time: f64,
        disk_count: usize,
        wall_count: usize,
        domain: Domain,
        gravity: impl Into<Gravity>,
    ) -> Self {
        Self { time, disk_count, wall_count, domain, gravity: gravity.into() }
    }

    /// Returns the absolute time.
    pub const fn time(&self) -> f64 {
        self.time
    }

    /// Returns the number of disks.
    pub const fn disk_count(&self) -> usize {
        self.disk_count
    }

    /// Returns the number of walls.
    ///
    /// The indices of the walls are less than it.
    pub const fn wall_count(&self) -> usize {
        self.wall_count
    }

    /// Returns the rectangle that holds the centers of the disks.
    pub const fn domain(&self) -> Domain {
        self.domain
    }

    /// Returns gravity.
    pub const fn gravity(&self) -> Gravity {
        self.gravity
    }
}
