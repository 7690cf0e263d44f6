//! Checkpoints: the saved states of runs, which continue from them later, bit for bit.
//!
//! This file contains the format, and the checks of contents that are no possible state; `resumption.rs`
//! turns the others into a run.
//!
//! The seal of a file reveals accidents. The numbers behind it were written by a run, so only lengths and
//! indices are checked: a difference between the saved run and the given boundary must be an error, and must
//! not be a panic or a request for all memory. A file that was forged on purpose may continue unphysically.

mod resumption;

pub use resumption::Resumption;

use std::io;
use std::path::{Path, PathBuf};

use serde::de::DeserializeOwned;
use serde::{Deserialize, Deserializer, Serialize, Serializer, de};
use thiserror::Error;

use super::cells::{CELLS_PER_DISK, Cells, Layout, Layouts, Place, SPARE_CELLS, SPARE_DISKS};
use super::state::{Bodies, Clock, Exit, Ledger};
use super::{Counters, Inlet, Simulation};
use crate::Fingerprint;
use crate::boundary::{Boundary, Domain};
use crate::collision::CollisionRule;
use crate::file::{Damage, Seal, write_whole};
use crate::scheduler::EventScheduler;

/// The mark of a checkpoint, and the version of the format that this crate writes and reads.
const SEAL: Seal = Seal::new(*b"GRANEDMD", 11);

/// The mark of a file with a checkpoint and observers, and the version of its format.
const SEAL_WITH: Seal = Seal::new(*b"GRANWITH", 1);

/// A saved run: everything on which its future depends, except its rule and its boundary. The state of walls
/// that [react](Boundary::react) is included.
///
/// A resumed run continues bit for bit, even under another scheduler. A checkpoint is kept as bytes with a
/// version and a checksum, in its own files and inside any format of serde. Bytes that were truncated,
/// altered or written by another version are refused and never read as data. A checkpoint keeps the
/// fingerprints of its rule and its boundary, and refuses others unless the caller allows them.
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
/// let resumption = Simulation::resume(&checkpoint, Elastic, container);
/// let mut second = resumption.scheduler(LinearScan::default()).build()?;
///
/// first.run_until(10.0, &mut ())?;
/// second.run_until(10.0, &mut ())?;
/// assert_eq!(first.disks(), second.disks());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Checkpoint(Saved);

/// The contents of a checkpoint.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Saved {
    rule: Option<Fingerprint>,
    boundary: Option<Fingerprint>,
    domain: Domain,
    /// Radius, mass, inertia and kind of each disk, as disks at rest at the origin; a single disk if all are
    /// alike.
    bodies: Bodies,
    inlets: Vec<Inlet>,
    /// The state of the walls that react, as numbers.
    walls: Vec<f64>,
    layouts: Layouts,
    places: Vec<Place>,
    seed: u64,
    clock: Clock,
    counters: Counters,
    ledger: Ledger,
}

/// The error of a checkpoint that cannot be written, read or resumed.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum CheckpointError {
    /// The file cannot be read or written.
    #[error("cannot {action} the checkpoint {}", .path.display())]
    Io {
        /// The action that failed: read or write.
        action: &'static str,
        /// The file.
        path: PathBuf,
        /// The cause.
        source: io::Error,
    },
    /// The contents of a file are not a usable checkpoint.
    #[error("cannot use the checkpoint {}", .path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// The cause.
        source: Box<CheckpointError>,
    },
    /// The bytes are not a checkpoint.
    #[error("this is not a checkpoint: it does not begin like one")]
    NotACheckpoint,
    /// The checkpoint has another version of the format.
    #[error("the checkpoint has format version {found}; this crate reads version {known}")]
    Version {
        /// The version of the file.
        found: u32,
        /// The version that this crate reads.
        known: u32,
    },
    /// The file was truncated or altered.
    #[error("the checkpoint is damaged: its checksum does not match")]
    Damaged,
    /// The contents cannot be decoded or encoded.
    #[error("the checkpoint's contents cannot be decoded or encoded")]
    Contents {
        /// The cause.
        source: Box<dyn std::error::Error + Send + Sync>,
    },
    /// The contents are not a possible state.
    #[error("the checkpoint is inconsistent: {0}")]
    Inconsistent(String),
    /// The boundary has another domain than the saved run.
    #[error("the checkpoint is of a run in the domain {saved}; the boundary's is {given}")]
    Domain {
        /// The domain of the saved run.
        saved: Domain,
        /// The domain of the given boundary.
        given: Domain,
    },
    /// The rule differs from the rule of the saved run.
    #[error("the checkpoint is of a run with another rule; `with_another_rule` allows the given one")]
    AnotherRule,
    /// The boundary differs from the boundary of the saved run.
    #[error("the checkpoint is of a run with another boundary; `with_another_boundary` allows the given one")]
    AnotherBoundary,
    /// The disks do not fit into the other boundary that the caller allowed.
    #[error("the disks of the checkpoint do not fit into the boundary")]
    Boundary(#[from] super::BuildError),
}

impl Checkpoint {
    /// Returns the absolute time at which the checkpoint was taken.
    pub fn time(&self) -> f64 {
        self.0.clock.time()
    }

    /// Returns the fingerprint of the run's rule, or `None` if the rule gives none.
    pub const fn rule(&self) -> Option<Fingerprint> {
        self.0.rule
    }

    /// Returns the fingerprint of the run's boundary, or `None` if the boundary gives none.
    pub const fn boundary(&self) -> Option<Fingerprint> {
        self.0.boundary
    }

    /// Returns the checkpoint as bytes: magic, version, checksum, contents.
    ///
    /// # Errors
    /// If the checkpoint cannot be encoded.
    pub fn to_bytes(&self) -> Result<Vec<u8>, CheckpointError> {
        Ok(SEAL.seal(&postcard::to_stdvec(&self.0).map_err(contents)?))
    }

    /// Reads a checkpoint from bytes.
    ///
    /// # Errors
    /// If the bytes are not a checkpoint, are of another version, or were truncated or altered.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, CheckpointError> {
        decoded(opened(SEAL, bytes)?).map(Self)
    }

    /// Writes the checkpoint to a file, completely or not at all.
    ///
    /// A reader never sees half of it, even if others write the same file.
    ///
    /// # Errors
    /// If the file cannot be written. An older file of that name then stays unchanged.
    pub fn write(&self, path: impl AsRef<Path>) -> Result<(), CheckpointError> {
        write_whole(path.as_ref(), &self.to_bytes()?).map_err(failed("write", path.as_ref()))
    }

    /// Reads a checkpoint from a file.
    ///
    /// # Errors
    /// If the file cannot be read, or [`Self::from_bytes`] refuses its contents. The error names the file.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, CheckpointError> {
        read(path.as_ref(), Self::from_bytes)
    }
}

/// Reads a file, and names it in each error.
fn read<T>(path: &Path, parse: impl Fn(&[u8]) -> Result<T, CheckpointError>) -> Result<T, CheckpointError> {
    let unusable = |source| CheckpointError::File { path: path.to_owned(), source: Box::new(source) };
    parse(&std::fs::read(path).map_err(failed("read", path))?).map_err(unusable)
}

/// Returns the contents after a seal.
fn opened(seal: Seal, bytes: &[u8]) -> Result<&[u8], CheckpointError> {
    seal.open(bytes).map_err(|broken| match broken {
        Damage::Foreign => CheckpointError::NotACheckpoint,
        Damage::Version(found) => CheckpointError::Version { found, known: seal.version() },
        Damage::Cut | Damage::Changed => CheckpointError::Damaged,
    })
}

fn decoded<T: de::DeserializeOwned>(bytes: &[u8]) -> Result<T, CheckpointError> {
    let (value, rest) = postcard::take_from_bytes(bytes).map_err(contents)?;
    check(rest.is_empty(), "something follows it")?;
    Ok(value)
}

fn failed(action: &'static str, path: &Path) -> impl FnOnce(io::Error) -> CheckpointError {
    let path = path.to_owned();
    move |source| CheckpointError::Io { action, path, source }
}

fn contents(source: postcard::Error) -> CheckpointError {
    CheckpointError::Contents { source: Box::new(source) }
}

/// Writes the bytes of [`Checkpoint::to_bytes`]. If the fields were written one by one, text formats would
/// lose infinities, and any format could be read without the check of the version.
impl Serialize for Checkpoint {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.to_bytes().map_err(serde::ser::Error::custom)?.serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Checkpoint {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Self::from_bytes(&Vec::<u8>::deserialize(deserializer)?).map_err(de::Error::custom)
    }
}

impl<R: CollisionRule, B: Boundary, S: EventScheduler> Simulation<R, B, S> {
    /// Takes a checkpoint of the run in its present state.
    pub fn checkpoint(&self) -> Checkpoint {
        Checkpoint(Saved {
            rule: self.parts.rule.fingerprint(),
            boundary: self.parts.boundary.fingerprint(),
            domain: self.parts.boundary.domain(),
            bodies: self.engine.bodies.clone(),
            inlets: self.engine.inlets.clone(),
            walls: self.parts.boundary.state(),
            layouts: self.engine.cells.layouts(),
            places: self.engine.cells.places.clone(),
            seed: self.engine.seed,
            // The number of events until the next check is not part of the state.
            clock: Clock { events_to_look: 0, ..self.engine.clock },
            counters: self.engine.counters,
            ledger: self.engine.ledger,
        })
    }
}

impl Checkpoint {
    /// Writes the checkpoint and the observers of its run to one file, completely or not at all.
    ///
    /// All numbers keep their bits, even infinities and NaN. The state and the observers in one file always
    /// belong to the same time. The observers can be anything that serde writes and reads: a [`Series`], a
    /// [`Sampled`] accumulator, a tuple of several, or a custom type. A field that serde skips is not
    /// written, and begins anew when the file is read: no state may stand in it.
    ///
    /// [`Series`]: crate::observable::Series
    /// [`Sampled`]: crate::observable::Sampled
    ///
    /// ```
    /// use granular_edmd::prelude::*;
    /// use granular_edmd::simulation::Checkpoint;
    ///
    /// # let file = std::env::temp_dir().join(format!("granular-edmd-with-{}", std::process::id()));
    /// let container = Container::closed(20.0, 20.0)?;
    /// let disks = initial::with_maxwellian_velocities(initial::lattice(&container, 50, 0.5)?, 1.0, 1)?;
    /// let mut run = Simulation::builder(Elastic, container.clone()).disks(disks).build()?;
    /// let mut series = Series::new(CenterOfMass, SampleTimes::every(0.5)?);
    /// run.run_until(5.0, &mut series)?;
    /// run.checkpoint().write_with(&series, &file)?;
    ///
    /// let (checkpoint, mut resumed) = Checkpoint::read_with::<Series<CenterOfMass>>(&file)?;
    /// Simulation::resume(&checkpoint, Elastic, container).build()?.run_until(10.0, &mut resumed)?;
    /// run.run_until(10.0, &mut series)?;
    /// assert_eq!(resumed.values(), series.values());
    /// # std::fs::remove_file(&file)?;
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If the observers do not read back as they were written, as types with `#[serde(untagged)]`, `flatten`
    /// or `skip_serializing_if` may not, or if the file cannot be written. An older file of that name then
    /// stays unchanged.
    pub fn write_with<O: Serialize + DeserializeOwned>(
        &self,
        observers: &O,
        path: impl AsRef<Path>,
    ) -> Result<(), CheckpointError> {
        let encode = |observers: &O| postcard::to_stdvec(&(self, observers)).map_err(contents);
        let bytes = encode(observers)?;
        // An unreadable file must be noticed now, not when the run is gone and its observers are needed.
        let (_, read): (Self, O) = decoded(&bytes)?;
        check(encode(&read)? == bytes, "its observers do not read back as they were written")?;
        write_whole(path.as_ref(), &SEAL_WITH.seal(&bytes)).map_err(failed("write", path.as_ref()))
    }

    /// Reads a checkpoint and the observers of its run from a file that [`write_with`](Self::write_with)
    /// wrote.
    ///
    /// # Errors
    /// If the file cannot be read, is not such a file, is of another version, was truncated or altered, or
    /// has observers of another layout. The error names the file. Files hold no names: observers whose
    /// numbers are laid out in the same way, such as two series of two columns, are not told apart. Read the
    /// types that were written, in the same order.
    pub fn read_with<O: DeserializeOwned>(path: impl AsRef<Path>) -> Result<(Self, O), CheckpointError> {
        read(path.as_ref(), |bytes| decoded(opened(SEAL_WITH, bytes)?))
    }
}

fn check(valid: bool, what: &'static str) -> Result<(), CheckpointError> {
    if valid { Ok(()) } else { Err(CheckpointError::Inconsistent(what.to_owned())) }
}

/// Checks everything that does not depend on the cells.
fn check_lengths(saved: &Saved, walls: usize) -> Result<(), CheckpointError> {
    let bodies = &saved.bodies;
    check(bodies.are_whole() && bodies.len() == saved.places.len(), "its parts differ in length")?;
    let times = [saved.clock.origin, saved.clock.now, saved.clock.epoch_length];
    check(times.iter().all(|time| time.is_finite()) && times[2] > 0.0, "a time is not finite")?;
    let mut forecasts = bodies.particles.iter().map(|particle| particle.forecast);
    let are_walls = forecasts.all(|event| event.exit != Exit::Wall || usize::from(event.wall) < walls);
    check(are_walls, "an event names no wall")
}

/// Checks that the grids have a class for each disk, and no more cells than the disks need.
fn check_layouts(saved: &Saved, mut diameters: impl Iterator<Item = f64>) -> Result<(), CheckpointError> {
    let Layouts { smallest, larger, classes } = &saved.layouts;
    let disks = 2 * saved.places.len() + SPARE_DISKS;
    let most = 2.0 * (CELLS_PER_DISK * disks as f64 + SPARE_CELLS);
    let suits = |Layout { columns, rows, .. }: Layout| {
        columns.min(rows) > 0 && f64::from(columns) * f64::from(rows) <= most
    };
    let suits_all = suits(*smallest) && larger.iter().all(|layer| layer.homes().is_some_and(suits));
    let largest = classes.last().map_or(0.0, |class| class.largest);
    let have_a_class = classes.len() == larger.len() + 1 && diameters.all(|diameter| diameter <= largest);
    check(suits_all && have_a_class, "its neighbor cells do not fit the disks")
}

/// Checks that each disk is in a cell of its grid.
fn check_places(saved: &Saved, cells: &Cells) -> Result<(), CheckpointError> {
    let are_cells = saved.places.iter().enumerate().all(|(disk, place)| {
        let Layout { columns, rows, .. } = cells.grid_of(disk).layout;
        (1..=columns).contains(&place.column) && (1..=rows).contains(&place.row)
    });
    check(are_cells, "a disk is outside the neighbor cells")
}
