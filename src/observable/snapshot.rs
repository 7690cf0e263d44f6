//! Snapshots: the state of all disks at one time.

use crate::Disk;
use crate::boundary::Domain;

/// The disks at one time, as copies.
///
/// The run does not see changes of these copies.
#[derive(Debug, Clone, Copy)]
pub struct Snapshot<'a> {
    time: f64,
    disks: &'a [Disk],
    domain: Domain,
    gravity: f64,
}

impl<'a> Snapshot<'a> {
    /// Creates a snapshot of `disks` at an absolute time.
    ///
    /// The engine creates snapshots, and tests may do so.
    pub const fn new(time: f64, disks: &'a [Disk], domain: Domain, gravity: f64) -> Self {
        Self { time, disks, domain, gravity }
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

    /// Returns gravity, which points down.
    pub const fn gravity(&self) -> f64 {
        self.gravity
    }

    /// Returns a snapshot of other disks, for example of some of these, in the same domain at the same time.
    #[must_use]
    pub const fn with_disks<'b>(&self, disks: &'b [Disk]) -> Snapshot<'b> {
        Snapshot { time: self.time, disks, domain: self.domain, gravity: self.gravity }
    }

    /// Returns the mean of a quantity over the disks; NaN without disks.
    pub fn mean(&self, quantity: impl Fn(&Disk) -> f64) -> f64 {
        self.disks.iter().map(quantity).sum::<f64>() / self.disks.len() as f64
    }
}
