//! The trait of stores of frames: one file, or a series of files.

use super::RecordError;
use crate::file::{Growing, Locked};
use crate::observable::Snapshot;

/// A store for the bytes of frames, one after another. A stored frame stays whole, even if a later one fails.
pub(super) trait Store {
    /// Returns the times of the frames, which increase.
    fn times(&self) -> &[f64];

    /// Adds a frame. If that fails, the store is as before.
    fn append(&mut self, snapshot: &Snapshot<'_>, bytes: &[u8]) -> Result<(), RecordError>;

    /// Returns whether the frame of this number has these bytes.
    fn has(&mut self, number: usize, bytes: &[u8]) -> Result<bool, RecordError>;

    /// Returns the file of the frames, or of their times.
    fn file(&self) -> &Growing<Locked>;
}
