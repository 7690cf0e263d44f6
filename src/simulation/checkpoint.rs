//! Checkpoints: a run as data, to go on with later, bit for bit.

use std::io;
use std::path::Path;

use rand_xoshiro::Xoshiro256PlusPlus;
use thiserror::Error;

use super::bodies::{Bodies, Spin, Trajectory};
use super::cells::{Cells, GridState};
use super::engine::Simulation;
use super::event::{Counters, Exit, Slot};
use super::grid::{Grid, Place};
use super::guard::Guard;
use crate::Disk;
use crate::boundary::{Boundary, Domain};
use crate::collision::CollisionRule;
use crate::file::{Broken, Seal, write_whole};
use crate::scheduler::EventScheduler;

/// What marks a checkpoint, and the version of the format that this crate writes and reads.
const SEAL: Seal = Seal { magic: *b"GRANEDMD", version: 2 };

/// Everything that the future of a run depends on, except its rule and its walls.
///
/// A resumed run continues bit for bit, also under another scheduler. Written with a version and a checksum: a file that
/// was cut, changed or made by another version is refused, never read as data.
///
/// ```
/// use granular_edmd::boundary::Container;
/// use granular_edmd::collision::Elastic;
/// use granular_edmd::scheduler::LinearScan;
/// use granular_edmd::simulation::{Checkpoint, Simulation};
/// use granular_edmd::initial;
///
/// let container = Container::closed(20.0, 20.0)?;
/// let disks = initial::with_maxwellian_velocities(initial::lattice(&container, 50, 0.5)?, 1.0, 1)?;
/// let mut first = Simulation::builder(Elastic, container.clone()).disks(disks).build()?;
/// first.run_until(5.0, &mut ())?;
///
/// let bytes = first.checkpoint().to_bytes()?;
/// let checkpoint = Checkpoint::from_bytes(&bytes)?;
/// let mut second = Simulation::resume(&checkpoint, Elastic, container, LinearScan::default())?;
///
/// first.run_until(10.0, &mut ())?;
/// second.run_until(10.0, &mut ())?;
/// assert_eq!(first.disks(), second.disks());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Checkpoint {
    /// One for each disk, or one for all if they are alike.
    kinds: Vec<Disk>,
    gravity: f64,
    trajectories: Vec<Trajectory>,
    spins: Vec<Spin>,
    slots: Vec<Slot>,
    grid: GridState,
    domain: Domain,
    generator: Xoshiro256PlusPlus,
    origin: f64,
    now: f64,
    epoch_length: f64,
    counters: Counters,
    guard: Guard,
    tally: (u64, u64),
}

/// A checkpoint cannot be written, read or resumed.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum CheckpointError {
    /// The file cannot be read or written.
    #[error("the checkpoint file: {0}")]
    Io(#[from] io::Error),
    /// The file is something else.
    #[error("this is not a checkpoint: it does not begin as one")]
    NotACheckpoint,
    /// Another version of the format.
    #[error("the checkpoint has format version {found}; this crate reads version {known}")]
    Version {
        /// The version of the file.
        found: u32,
        /// The version that this crate reads.
        known: u32,
    },
    /// The file was cut or changed.
    #[error("the checkpoint is damaged: its checksum does not match")]
    Damaged,
    /// The contents cannot be decoded or encoded.
    #[error("the checkpoint's contents: {0}")]
    Contents(#[from] postcard::Error),
    /// The contents do not make a state.
    #[error("the checkpoint is inconsistent: {0}")]
    Inconsistent(&'static str),
    /// The walls are not those of the run that was saved.
    #[error("the checkpoint is of a run in the domain {saved:?}; the boundary's is {given:?}")]
    Domain {
        /// The domain of the run that was saved.
        saved: Domain,
        /// The domain of the boundary given.
        given: Domain,
    },
}

impl Checkpoint {
    /// The time at which it was taken.
    pub fn time(&self) -> f64 {
        self.origin + self.now
    }

    /// The checkpoint as bytes: magic, version, checksum, contents.
    ///
    /// # Errors
    /// If it cannot be encoded.
    pub fn to_bytes(&self) -> Result<Vec<u8>, CheckpointError> {
        Ok(SEAL.seal(&postcard::to_stdvec(self)?))
    }

    /// A checkpoint from bytes.
    ///
    /// # Errors
    /// If they are not a checkpoint, of another version, cut, or changed.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, CheckpointError> {
        let contents = SEAL.open(bytes).map_err(|broken| match broken {
            Broken::Foreign => CheckpointError::NotACheckpoint,
            Broken::Version(found) => CheckpointError::Version { found, known: SEAL.version },
            Broken::Cut | Broken::Changed => CheckpointError::Damaged,
        })?;
        let (checkpoint, rest) = postcard::take_from_bytes(contents)?;
        check(rest.is_empty(), "something follows it")?;
        Ok(checkpoint)
    }

    /// Writes the checkpoint to a file, whole or not at all: a reader never sees half of it.
    ///
    /// # Errors
    /// If the file cannot be written; a file of that name is then as it was.
    pub fn write(&self, path: impl AsRef<Path>) -> Result<(), CheckpointError> {
        Ok(write_whole(path.as_ref(), &self.to_bytes()?)?)
    }

    /// Reads a checkpoint from a file.
    ///
    /// # Errors
    /// If the file cannot be read, or as [`Self::from_bytes`].
    pub fn read(path: impl AsRef<Path>) -> Result<Self, CheckpointError> {
        Self::from_bytes(&std::fs::read(path)?)
    }

    /// That the numbers make a state which the engine can go on with, but for the places of the disks.
    fn check(&self, walls: usize) -> Result<(), CheckpointError> {
        let count = self.trajectories.len();
        let lengths = [self.spins.len(), self.slots.len(), self.grid.len()];
        check(lengths.iter().all(|&length| length == count), "its parts differ in length")?;
        check([1, count].contains(&self.kinds.len()), "its disks are of too many kinds, or of none")?;
        check(self.times().iter().all(|time| time.is_finite()), "a time is not finite")?;
        check(self.epoch_length > 0.0 && self.now >= 0.0, "its epoch is out of order")?;
        check(self.trajectories.iter().all(Trajectory::is_finite), "a trajectory is not finite")?;
        check(self.spins.iter().all(Spin::is_valid), "a rotation is not finite")?;
        check(self.are_slots_valid(walls), "an event is of nobody, or in the past")?;
        check(self.counters.are_valid() && self.guard.is_valid(), "its counters are beyond all counting")?;
        let Counters { cell_crossings, collisions, .. } = self.counters;
        check(self.tally.0 <= cell_crossings && self.tally.1 <= collisions, "its counters run backwards")
    }

    fn are_slots_valid(&self, walls: usize) -> bool {
        let partner = |disk: usize, slot: &Slot| {
            let partner = slot.partner as usize;
            slot.collision_due == f64::INFINITY || (partner < self.slots.len() && partner != disk)
        };
        self.slots.iter().enumerate().all(|(disk, slot)| {
            let wall = slot.exit != Exit::Wall || usize::from(slot.wall) < walls;
            partner(disk, slot) && wall && slot.collision_due >= self.now && slot.exit_due >= self.now
        })
    }

    /// That the grid is one of this boundary, and all disks are in it where they belong, and have where to go.
    fn check_places(&self, grid: &Grid, domain: &Domain, bodies: &Bodies) -> Result<(), CheckpointError> {
        let places = self.grid.places();
        let inside = |(disk, &place): (usize, &Place)| grid.holds(place, bodies.position(disk, self.now));
        check(places.iter().enumerate().all(inside), "a disk is outside its neighbour cell")?;
        let radii = (0..self.slots.len()).map(|disk| bodies.material(disk).radius);
        check(grid.has_room(domain, places.iter().copied().zip(radii)), "the disks of a cell overlap")?;
        let leads = |(slot, &place): (&Slot, &Place)| {
            slot.exit_due == f64::INFINITY || grid.contains(grid.neighbour(place, slot.exit.direction()).0)
        };
        check(self.slots.iter().zip(places).all(leads), "a disk leaves the neighbour cells")
    }

    fn times(&self) -> [f64; 4] {
        [self.origin, self.now, self.epoch_length, self.gravity]
    }
}

fn check(valid: bool, what: &'static str) -> Result<(), CheckpointError> {
    if valid { Ok(()) } else { Err(CheckpointError::Inconsistent(what)) }
}

impl<R: CollisionRule, B: Boundary, S: EventScheduler> Simulation<R, B, S> {
    /// The run as data.
    pub fn checkpoint(&self) -> Checkpoint {
        Checkpoint {
            kinds: self.bodies.kinds(),
            gravity: self.bodies.gravity,
            trajectories: self.bodies.particles.iter().map(|particle| particle.trajectory).collect(),
            spins: self.bodies.spins.clone(),
            slots: self.bodies.particles.iter().map(|particle| particle.slot).collect(),
            grid: self.cells.state(),
            domain: self.boundary.domain(),
            generator: self.generator.clone(),
            origin: self.origin,
            now: self.now,
            epoch_length: self.epoch_length,
            counters: self.counters,
            guard: self.guard,
            tally: self.tally,
        }
    }

    /// A run that goes on where the checkpoint was taken, with its gravity, generator and counters.
    ///
    /// The rule and the boundary are not in it: give the same ones for the same future, or a new rule for a ramp. A boundary
    /// with other walls that move otherwise is not noticed; use [`Self::set_boundary`] after resuming to change walls.
    ///
    /// # Errors
    /// If the checkpoint is inconsistent, or its domain is not the boundary's.
    pub fn resume(
        checkpoint: &Checkpoint,
        rule: R,
        boundary: B,
        scheduler: S,
    ) -> Result<Self, CheckpointError> {
        checkpoint.check(boundary.wall_count())?;
        let (saved, given) = (checkpoint.domain, boundary.domain());
        if saved != given {
            return Err(CheckpointError::Domain { saved, given });
        }
        let Checkpoint { kinds, gravity, trajectories, slots, spins, .. } = checkpoint;
        let bodies = Bodies::restored(kinds, *gravity, trajectories, slots, spins.clone());
        let radius = bodies.largest_radius();
        let suits = checkpoint.grid.suits(&given, 2.0 * radius);
        check(suits, "its neighbour cells are not those of the domain")?;
        let grid = Grid::new(&given, checkpoint.grid.layout(), 2.0 * radius);
        checkpoint.check_places(&grid, &given, &bodies)?;
        let cells = Cells::restored(&boundary, radius, grid, checkpoint.grid.places());
        Ok(Self::restored(rule, boundary, scheduler, bodies, cells, checkpoint))
    }

    fn restored(
        rule: R,
        boundary: B,
        scheduler: S,
        bodies: Bodies,
        cells: Cells,
        saved: &Checkpoint,
    ) -> Self {
        let mut run =
            Self::idle(rule, boundary, scheduler, bodies, cells, saved.generator.clone(), saved.origin);
        run.now = saved.now;
        run.epoch_length = saved.epoch_length;
        run.counters = saved.counters;
        run.guard = saved.guard;
        run.tally = saved.tally;
        run.shift_epoch(0.0);
        run
    }
}
