//! A checkpoint and the observers of its run in one file.

use std::path::Path;

use serde::Serialize;
use serde::de::DeserializeOwned;

use super::{Checkpoint, CheckpointError, contents, decoded, failed, opened, read, validation};
use crate::file::{Seal, write_whole};

/// The mark of such a file, and the version of its format.
const SEAL: Seal = Seal::new(*b"GRANWITH", 1);

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
        validation::check(encode(&read)? == bytes, "its observers do not read back as they were written")?;
        write_whole(path.as_ref(), &SEAL.seal(&bytes)).map_err(failed("write", path.as_ref()))
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
        read(path.as_ref(), |bytes| decoded(opened(SEAL, bytes)?))
    }
}
