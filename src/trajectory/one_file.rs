//! Frames one after another in one file, plain or compressed.

use std::io::{self, BufRead, BufReader, Read};
use std::path::Path;

use super::frames::{Frames, digest};
#[cfg(feature = "gzip")]
use super::gzip::{self, Member};
use super::media::{self, is_gzip};
use super::store::Store;
use super::{Format, RecordError};
use crate::file::{Growing, Locked};
use crate::observable::Snapshot;

/// Frames in one file.
#[derive(Debug)]
pub(super) struct OneFile {
    file: Growing<Locked>,
    packing: Packing,
    frames: Frames,
}

/// The way in which frames become bytes of the file.
#[derive(Debug)]
enum Packing {
    Plain,
    #[cfg(feature = "gzip")]
    Gzip(Member),
}

impl OneFile {
    /// Begins a new file.
    pub(super) fn create(path: &Path) -> Result<Self, RecordError> {
        let packing = Packing::of(path)?;
        let file = media::create(path)?;
        Ok(Self { file, packing, frames: Frames::default() })
    }

    /// Begins in a file that is there and empty.
    pub(super) fn begin_in(path: &Path) -> Result<Self, RecordError> {
        let packing = Packing::of(path)?;
        let file = Growing::new(path, media::reopen(path)?, 0, Vec::new());
        Ok(Self { file, packing, frames: Frames::default() })
    }

    /// Goes on after the last whole frame of a file.
    pub(super) fn reopen(path: &Path, format: &dyn Format) -> Result<Self, RecordError> {
        let mut packing = Packing::of(path)?;
        let file = media::reopen(path)?;
        let frames = packing.frames(&mut BufReader::new(file.file()), format);
        let frames = frames.map_err(RecordError::io("go on in", path))?;
        if frames.times.is_empty() {
            return Err(RecordError::NoFrame { path: path.to_owned() });
        }
        let file = Growing::new(path, file, frames.end, packing.ending());
        Ok(Self { file, packing, frames })
    }

    fn push(&mut self, bytes: &[u8]) -> io::Result<()> {
        match &mut self.packing {
            Packing::Plain => self.file.push(bytes, &[]),
            #[cfg(feature = "gzip")]
            Packing::Gzip(member) => {
                let (piece, longer) = member.packed(bytes)?;
                self.file.push(&piece, &longer.ending())?;
                *member = longer;
                Ok(())
            }
        }
    }
}

impl Store for OneFile {
    fn times(&self) -> &[f64] {
        &self.frames.times
    }

    fn append(&mut self, snapshot: &Snapshot<'_>, bytes: &[u8]) -> Result<(), RecordError> {
        self.push(bytes).map_err(RecordError::io("write to", &self.file.path))?;
        self.frames.push(snapshot.time(), bytes, self.file.length);
        Ok(())
    }

    fn has(&mut self, number: usize, bytes: &[u8]) -> Result<bool, RecordError> {
        Ok(self.frames.digests.get(number) == Some(&digest(bytes)))
    }

    fn file(&self) -> &Growing<Locked> {
        &self.file
    }
}

impl Packing {
    /// Makes the compressor of a file, if this program can compress.
    #[cfg(feature = "gzip")]
    const GZIP: Option<fn() -> Self> = Some(|| Self::Gzip(Member::default()));
    #[cfg(not(feature = "gzip"))]
    const GZIP: Option<fn() -> Self> = None;

    /// Returns the packing that the name of a file asks for.
    fn of(path: &Path) -> Result<Self, RecordError> {
        match (is_gzip(path), Self::GZIP) {
            (false, _) => Ok(Self::Plain),
            (true, Some(gzip)) => Ok(gzip()),
            (true, None) => Err(RecordError::Gzip { path: path.to_owned() }),
        }
    }

    /// Returns the bytes that follow the last frame.
    fn ending(&self) -> Vec<u8> {
        match self {
            Self::Plain => Vec::new(),
            #[cfg(feature = "gzip")]
            Self::Gzip(member) => member.ending(),
        }
    }

    /// Finds the whole frames of a file.
    fn frames(&mut self, input: &mut impl BufRead, format: &dyn Format) -> io::Result<Frames> {
        match self {
            Self::Plain => plain_frames(input, format),
            #[cfg(feature = "gzip")]
            Self::Gzip(member) => gzip::frames(member, input, format),
        }
    }
}

fn plain_frames(input: &mut impl BufRead, format: &dyn Format) -> io::Result<Frames> {
    let mut frames = Frames::default();
    let mut input = Copied { input, taken: Vec::new() };
    while !input.fill_buf()?.is_empty() {
        input.taken.clear();
        let Some(time) = format.skip_frame(&mut input)? else { break };
        let end = frames.end + input.taken.len() as u64;
        frames.add(time, &input.taken, end)?;
    }
    Ok(frames)
}

/// A reader that keeps a copy of the bytes that were read.
struct Copied<'a, R> {
    input: &'a mut R,
    taken: Vec<u8>,
}

impl<R: BufRead> Read for Copied<'_, R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.input.read(buffer)?;
        self.taken.extend(&buffer[..count]);
        Ok(count)
    }
}

impl<R: BufRead> BufRead for Copied<'_, R> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        self.input.fill_buf()
    }

    fn consume(&mut self, amount: usize) {
        if let Ok(bytes) = self.input.fill_buf() {
            self.taken.extend(&bytes[..amount.min(bytes.len())]);
        }
        self.input.consume(amount);
    }
}
