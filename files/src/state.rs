//! The state in a file.

use granular_edmd::boundary::Domain;
use granular_edmd::observable::Snapshot;
use granular_edmd::{Disk, Gravity};

/// The disks of a file, with the time, gravity and the box if the file has them.
///
/// A [`Reader`](super::Reader) reads it from a file. No two disks overlap by more than the reader's
/// tolerance, and no center is outside the box.
/// [`build`](granular_edmd::simulation::SimulationBuilder::build) checks the disks against the walls.
///
/// ```
/// use granular_edmd::prelude::*;
/// use granular_edmd_files::Reader;
///
/// let state = Reader::new().read_from("x,y,radius,vx\n1.0,1.0,0.5,2.0\n3.0,1.0,0.5,0.0\n".as_bytes())?;
/// let run = Simulation::builder(Elastic, Container::open(4.0)?).disks(state.into_disks()).build()?;
/// assert_eq!(run.disks()[0].velocity(), DVec2::new(2.0, 0.0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq, Default)]
pub struct State {
    pub(super) disks: Vec<Disk>,
    pub(super) domain: Option<Domain>,
    pub(super) time: Option<f64>,
    pub(super) gravity: Option<Gravity>,
    pub(super) kind_names: Vec<String>,
    pub(super) shrunk: f64,
    /// Notes about the file, each a sentence.
    pub(super) notes: Vec<String>,
}

impl State {
    /// Creates the state of a snapshot, to write it to a file.
    pub fn of(snapshot: &Snapshot<'_>) -> Self {
        Self {
            disks: snapshot.disks().to_vec(),
            domain: Some(snapshot.domain()),
            time: Some(snapshot.time()),
            gravity: Some(snapshot.gravity()),
            ..Self::default()
        }
    }

    /// Returns a snapshot of the state, for a [`Format`](super::Format).
    ///
    /// A file without a box, time or gravity gives the rectangle around the disks, time 0 and no gravity. The
    /// snapshot has no walls, so profiles and fields divide by areas as if the whole box were free. For disks
    /// in another vessel, or under walls that move, add them by [`Snapshot::with_walls`].
    pub fn snapshot(&self) -> Snapshot<'_> {
        let domain = self.domain.unwrap_or_else(|| around(&self.disks));
        Snapshot::new(self.time.unwrap_or_default(), &self.disks, domain, self.gravity.unwrap_or_default())
    }

    /// Returns the disks, in the order of the file.
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

    /// Returns the gravity, if the file has it.
    pub const fn gravity(&self) -> Option<Gravity> {
        self.gravity
    }

    /// Returns the names of kinds that the file gives, in the order of their numbers, starting with 0. This
    /// order is alphabetical, unless the file numbers the kinds. Each frame has its own list: where a name is
    /// missing from a frame, later names have other numbers there.
    ///
    /// The list is empty if the kinds have only numbers in the file.
    pub fn kind_names(&self) -> &[String] {
        &self.kind_names
    }

    /// Returns the share of each radius by which the reader shrank the disks; 0 if it did not.
    pub const fn shrunk(&self) -> f64 {
        self.shrunk
    }

    /// Returns sentences about everything that the reader ignored or changed.
    pub fn notes(&self) -> Vec<String> {
        self.notes.clone()
    }
}

/// Returns the rectangle around these disks.
fn around(disks: &[Disk]) -> Domain {
    let end = |value: fn(&Disk) -> f64| disks.iter().map(value).fold(f64::NEG_INFINITY, f64::max);
    if disks.is_empty() {
        return Domain::new(0.0, 1.0, 0.0, 1.0);
    }
    Domain::new(
        -end(|disk| disk.radius() - disk.position().x),
        end(|disk| disk.radius() + disk.position().x),
        -end(|disk| disk.radius() - disk.position().y),
        end(|disk| disk.radius() + disk.position().y),
    )
}
