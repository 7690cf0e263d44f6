//! The state of all disks at one time.

use crate::Disk;
use crate::boundary::Domain;

/// The disks at one time, as copies: nothing that is done with them reaches the run.
#[derive(Debug, Clone, Copy)]
pub struct Snapshot<'a> {
    time: f64,
    disks: &'a [Disk],
    domain: Domain,
    gravity: f64,
}

impl<'a> Snapshot<'a> {
    /// A snapshot of `disks`; the engine makes them, and so may a test.
    pub const fn new(time: f64, disks: &'a [Disk], domain: Domain, gravity: f64) -> Self {
        Self { time, disks, domain, gravity }
    }

    /// When it was taken.
    pub const fn time(&self) -> f64 {
        self.time
    }

    /// The disks, in the order in which the simulation got them.
    pub const fn disks(&self) -> &'a [Disk] {
        self.disks
    }

    /// The rectangle that holds their centres.
    pub const fn domain(&self) -> Domain {
        self.domain
    }

    /// Gravity, pointing down.
    pub const fn gravity(&self) -> f64 {
        self.gravity
    }

    /// Mean of a quantity over the disks; NaN without disks.
    pub fn mean(&self, quantity: impl Fn(&Disk) -> f64) -> f64 {
        self.disks.iter().map(quantity).sum::<f64>() / self.disks.len() as f64
    }
}
