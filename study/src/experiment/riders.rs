//! The parts of a value's run besides its observer: a driving, which is saved with the value, and a
//! companion, which is not.

use std::path::Path;

use granular_edmd::simulation::Driving;
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::ExperimentError;

/// A [`Driving`] that a study saves with an unfinished value, and restores with it.
///
/// Every driving that serde writes and reads implements this trait.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a driving that can be saved",
    note = "implement `simulation::Driving`, and derive `Serialize` and `Deserialize`"
)]
pub trait SavedDriving: Driving + Send {
    /// Returns the driving as bytes.
    ///
    /// # Errors
    /// If serde cannot write it.
    fn save(&self) -> Result<Vec<u8>, ExperimentError>;

    /// Restores the state of a saved driving.
    ///
    /// # Errors
    /// If the bytes are of another driving.
    fn load(&mut self, bytes: &[u8]) -> Result<(), ExperimentError>;
}

impl<D: Driving + Serialize + DeserializeOwned + Send> SavedDriving for D {
    fn save(&self) -> Result<Vec<u8>, ExperimentError> {
        postcard::to_stdvec(self).map_err(ExperimentError::new)
    }

    fn load(&mut self, bytes: &[u8]) -> Result<(), ExperimentError> {
        *self = postcard::from_bytes(bytes).map_err(ExperimentError::new)?;
        Ok(())
    }
}

/// The start of a value, or of the remainder of an interrupted value, for which a
/// [companion](super::Experiment::companion) is made.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Start<'a> {
    /// Folder of the study.
    pub folder: &'a Path,
    /// Index of the ramp.
    pub ramp: usize,
    /// Index of the value in the ramp.
    pub value: usize,
    /// Seed of the ramp.
    pub seed: u64,
    /// Absolute time from which the run starts or continues.
    pub time: f64,
    /// True if the value continues from a saved state. A value that was killed before its first save starts
    /// anew, and files of its companion may exist already.
    pub is_resumed: bool,
}

/// A step of a value: a part of its settling, or the interval that ends with a sample.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub struct Interval {
    /// Index of the step in its value, settling included.
    pub index: u64,
    /// Index of the sample with which the step ends; `None` while the value settles.
    pub sample: Option<u64>,
}
