//! The file of a recording, which grows frame by frame.

use std::io;

use super::{Frame, RecordError};
use crate::file::{Growing, Locked};
use crate::observable::Snapshot;

/// The file of a recording or, for a series, the file of its times; with the times of the frames.
pub(super) struct Sink {
    pub(super) file: Growing<Locked>,
    pub(super) times: Vec<f64>,
    layout: Box<dyn Layout + Send + Sync>,
    /// Bytes of the present frame.
    bytes: Vec<u8>,
}

/// The arrangement of the bytes of frames in one or several files.
pub(super) trait Layout {
    /// Returns the bytes of a frame.
    fn make(&self, frame: &Frame<'_>, bytes: &mut Vec<u8>) -> io::Result<()>;

    /// Adds a frame. If that fails, the file is as before.
    fn push(
        &mut self,
        file: &mut Growing<Locked>,
        frame: &Frame<'_>,
        bytes: &[u8],
    ) -> Result<(), RecordError>;

    /// Returns whether the frame of this number has these bytes.
    fn has(&self, file: &Growing<Locked>, number: usize, bytes: &[u8]) -> Result<bool, RecordError>;
}

impl Sink {
    pub(super) fn new(file: Growing<Locked>, layout: impl Layout + Send + Sync + 'static) -> Self {
        Self { file, times: Vec::new(), layout: Box::new(layout), bytes: Vec::new() }
    }

    /// Returns the same sink with the times of the frames in its file, or an error if the file has no frame.
    pub(super) fn with_frames(self, times: Vec<f64>) -> Result<Self, RecordError> {
        if times.is_empty() {
            Err(RecordError::NoFrame { path: self.file.path })
        } else {
            Ok(Self { times, ..self })
        }
    }

    /// Adds a frame or, if the file already reaches this time, checks that the file has the frame.
    pub(super) fn record(&mut self, snapshot: &Snapshot<'_>) -> Result<(), RecordError> {
        let time = snapshot.time();
        let last = self.times.last().copied().unwrap_or(f64::NEG_INFINITY);
        let is_new = time > last && time.is_finite();
        let there = self.times.binary_search_by(|other| other.total_cmp(&time));
        if let (false, Err(_)) = (is_new, there) {
            return Err(RecordError::AnotherRun {
                path: self.file.path.clone(),
                time,
                last,
                is_there: false,
            });
        }
        let (Ok(number) | Err(number)) = there;
        let frame = Frame::new(number, snapshot);
        self.bytes.clear();
        let made = self.layout.make(&frame, &mut self.bytes);
        made.map_err(RecordError::io("make a frame of", &self.file.path))?;
        if is_new {
            self.layout.push(&mut self.file, &frame, &self.bytes)?;
            self.times.push(time);
        } else if !self.layout.has(&self.file, number, &self.bytes)? {
            return Err(RecordError::AnotherRun { path: self.file.path.clone(), time, last, is_there: true });
        }
        Ok(())
    }
}
