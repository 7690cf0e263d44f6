//! The frames of a file, by which a recorder recognizes its own file.

use std::hash::{DefaultHasher, Hasher};
use std::io;

use super::format::no_frame;

/// The complete frames of a file: their times, digests of their bytes, and the end of the last frame.
#[derive(Debug, Default)]
pub(super) struct Frames {
    pub(super) times: Vec<f64>,
    pub(super) digests: Vec<u64>,
    pub(super) end: u64,
}

impl Frames {
    /// Adds a frame that was found in a file.
    pub(super) fn add(&mut self, time: f64, bytes: &[u8], end: u64) -> io::Result<()> {
        if self.times.last().is_some_and(|&last| last >= time) || !time.is_finite() {
            return Err(no_frame("a frame later than the previous one", &format!("time {time:?}")));
        }
        self.times.push(time);
        self.digests.push(digest(bytes));
        self.end = end;
        Ok(())
    }
}

/// Returns a hash of these bytes, for comparisons within one process.
pub(super) fn digest(bytes: &[u8]) -> u64 {
    let mut hasher = DefaultHasher::new();
    hasher.write(bytes);
    hasher.finish()
}
