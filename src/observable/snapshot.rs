//! Snapshots: the state of all disks at one time.

use std::fmt;

use glam::DVec2;

use crate::boundary::{Boundary, Domain};
use crate::{Disk, Gravity};

/// The disks at one time, as copies.
///
/// The run does not see changes of these copies.
#[derive(Debug, Clone, Copy)]
pub struct Snapshot<'a> {
    time: f64,
    disks: &'a [Disk],
    domain: Domain,
    gravity: Gravity,
    walls: Option<Walls<'a>>,
}

/// The boundary of a run, and the time of a snapshot as the boundary counts it.
#[derive(Clone, Copy)]
struct Walls<'a> {
    boundary: &'a dyn Boundary,
    time: f64,
}

impl fmt::Debug for Walls<'_> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("..")
    }
}

impl<'a> Snapshot<'a> {
    /// Creates a snapshot of `disks` at an absolute time.
    ///
    /// The engine creates snapshots, and tests may do so.
    pub fn new(time: f64, disks: &'a [Disk], domain: Domain, gravity: impl Into<Gravity>) -> Self {
        Self { time, disks, domain, gravity: gravity.into(), walls: None }
    }

    /// Returns the same snapshot with the walls of a boundary, for which the snapshot is at this time after
    /// its origin.
    pub(crate) const fn with_walls(self, boundary: &'a dyn Boundary, time: f64) -> Self {
        Self { walls: Some(Walls { boundary, time }), ..self }
    }

    /// Returns the absolute time of the snapshot.
    pub const fn time(&self) -> f64 {
        self.time
    }

    /// Returns the disks, in the order in which they were given to the simulation.
    pub const fn disks(&self) -> &'a [Disk] {
        self.disks
    }

    /// Returns the rectangle that holds the centers of the disks.
    pub const fn domain(&self) -> Domain {
        self.domain
    }

    /// Returns gravity.
    pub const fn gravity(&self) -> Gravity {
        self.gravity
    }

    /// Returns the walls as lines of points, without the edges of the domain, for pictures.
    ///
    /// These are the [`wall_lines`](Boundary::wall_lines) of the boundary that the run has at this time. A
    /// snapshot that was not made by a simulation has no walls.
    ///
    /// ```
    /// use granular_edmd::prelude::*;
    ///
    /// let gate = Part::polyline([DVec2::new(1.0, 4.0), DVec2::new(7.0, 4.0)])?;
    /// let mut vessel = Vessel::new(Container::closed(8.0, 8.0)?).with("gate", gate)?;
    /// let grain = Disk::new(DVec2::new(4.0, 6.0), 0.5)?;
    /// let mut run = Simulation::builder(Elastic, vessel.clone()).disks([grain]).build()?;
    /// assert_eq!(run.snapshot().wall_lines().len(), 1);
    ///
    /// vessel.remove("gate")?;
    /// run.set_boundary(vessel)?;
    /// assert!(run.snapshot().wall_lines().is_empty());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn wall_lines(&self) -> Vec<Vec<DVec2>> {
        self.walls.map_or_else(Vec::new, |walls| walls.boundary.wall_lines(walls.time))
    }

    /// Returns a snapshot of other disks, for example of some of these, in the same domain at the same time.
    #[must_use]
    pub const fn with_disks<'b>(&self, disks: &'b [Disk]) -> Snapshot<'b>
    where
        'a: 'b,
    {
        Snapshot { disks, ..*self }
    }

    /// Returns the mean of a quantity over the disks; NaN without disks.
    pub fn mean(&self, quantity: impl Fn(&Disk) -> f64) -> f64 {
        self.disks.iter().map(quantity).sum::<f64>() / self.disks.len() as f64
    }
}
