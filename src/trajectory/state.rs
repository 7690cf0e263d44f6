//! The state that a file holds.

use crate::boundary::Domain;
use crate::observable::Snapshot;
use crate::{Disk, Gravity};

/// The disks of a file, with the time, gravity and the box if the file has them.
///
/// No two disks overlap, and none has its center outside the box.
/// [`build`](crate::simulation::SimulationBuilder::build) checks them against the walls.
///
/// ```
/// use granular_edmd::prelude::*;
/// use granular_edmd::trajectory::State;
///
/// let state = State::from_csv("x,y,radius,vx\n1.0,1.0,0.5,2.0\n3.0,1.0,0.5,0.0\n".as_bytes())?;
/// let run = Simulation::builder(Elastic, Container::open(4.0)?).disks(state.into_disks()).build()?;
/// assert_eq!(run.disks()[0].velocity(), DVec2::new(2.0, 0.0));
///
/// let error = State::from_csv("x,y,radius\n1.0,1.0,0.5\n1.5,1.0,0.5\n".as_bytes()).unwrap_err();
/// assert_eq!(error.to_string(), "line 3: the disk overlaps that of line 2 by 0.5");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct State {
    pub(super) disks: Vec<Disk>,
    pub(super) domain: Option<Domain>,
    pub(super) time: Option<f64>,
    pub(super) gravity: Option<Gravity>,
}

impl State {
    /// Creates the state of a snapshot, to write it to a file.
    pub fn of(snapshot: &Snapshot<'_>) -> Self {
        Self {
            disks: snapshot.disks().to_vec(),
            domain: Some(snapshot.domain()),
            time: Some(snapshot.time()),
            gravity: Some(snapshot.gravity()),
        }
    }

    /// Returns the disks, in the order of their numbers if the file numbers them.
    pub fn disks(&self) -> &[Disk] {
        &self.disks
    }

    /// Returns the disks without the rest of the state.
    pub fn into_disks(self) -> Vec<Disk> {
        self.disks
    }

    /// Returns the box, if the file has one.
    pub const fn domain(&self) -> Option<Domain> {
        self.domain
    }

    /// Returns the time, if the file has one.
    pub const fn time(&self) -> Option<f64> {
        self.time
    }

    /// Returns gravity, if the file has it.
    pub const fn gravity(&self) -> Option<Gravity> {
        self.gravity
    }
}
