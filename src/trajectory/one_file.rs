//! Consecutive frames in one file, plain or compressed.

use std::io::{self, BufRead, BufReader, Read, Seek, SeekFrom};
use std::path::Path;

use super::frames::{Frames, digest};
#[cfg(feature = "gzip")]
use super::gzip::{self, Member};
use super::media::{self, is_gzip};
use super::sink::{Layout, Sink};
use super::{Format, Frame, RecordError};
use crate::file::{Growing, Locked};

/// Frames in one file.
pub(super) struct OneFile {
    format: Box<dyn Format + Send + Sync>,
    packing: Packing,
    /// Digests of the bytes of the frames.
    digests: Vec<u64>,
}

/// The encoding of frames as bytes of the file.
#[derive(Debug)]
enum Packing {
    Plain,
    #[cfg(feature = "gzip")]
    Gzip(Member),
}

impl OneFile {
    /// Begins a file.
    pub(super) fn create(
        path: &Path,
        format: Box<dyn Format + Send + Sync>,
        may_exist: bool,
    ) -> Result<Sink, RecordError> {
        let packing = Packing::of(path)?;
        Ok(Sink::new(media::create(path, may_exist)?, Self { format, packing, digests: Vec::new() }))
    }

    /// Continues after the last complete frame of a file.
    pub(super) fn reopen(path: &Path, format: Box<dyn Format + Send + Sync>) -> Result<Sink, RecordError> {
        let mut packing = Packing::of(path)?;
        let file = media::reopen(path)?;
        let frames = packing.frames(&mut BufReader::new(file.file()), &*format);
        let Frames { times, digests, end } = frames.map_err(RecordError::io("continue", path))?;
        let mut file = Growing::new(path, file, end, packing.ending());
        if !times.is_empty() {
            packing.mend(&mut file).map_err(RecordError::io("write to", path))?;
        }
        Sink::new(file, Self { format, packing, digests }).with_frames(times)
    }
}

impl Layout for OneFile {
    fn make(&self, frame: &Frame<'_>, bytes: &mut Vec<u8>) -> io::Result<()> {
        self.format.write_frame(frame, bytes)
    }

    fn push(&mut self, file: &mut Growing<Locked>, _: &Frame<'_>, bytes: &[u8]) -> Result<(), RecordError> {
        let pushed = self.packing.push(file, bytes);
        pushed.map_err(RecordError::io("write to", &file.path))?;
        self.digests.push(digest(bytes));
        Ok(())
    }

    fn has(&self, _: &Growing<Locked>, number: usize, bytes: &[u8]) -> Result<bool, RecordError> {
        Ok(self.digests.get(number) == Some(&digest(bytes)))
    }
}

impl Packing {
    /// Creates the compressor of a file; `None` in a build without compression.
    #[cfg(feature = "gzip")]
    const GZIP: Option<fn() -> Self> = Some(|| Self::Gzip(Member::default()));
    #[cfg(not(feature = "gzip"))]
    const GZIP: Option<fn() -> Self> = None;

    /// Returns the packing for the name of a file.
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

    fn push(&mut self, file: &mut Growing<Locked>, bytes: &[u8]) -> io::Result<()> {
        match self {
            Self::Plain => file.push(bytes, &[]),
            #[cfg(feature = "gzip")]
            Self::Gzip(member) => {
                let (piece, longer) = member.packed(bytes)?;
                file.push(&piece, &longer.ending())?;
                *member = longer;
                Ok(())
            }
        }
    }

    /// Writes the ending again if it was cut off. Without the ending, readers consider the file damaged, and
    /// the file would stay damaged if the run ended before its next frame.
    fn mend(&self, file: &mut Growing<Locked>) -> io::Result<()> {
        let (ending, mut there, mut medium) = (self.ending(), Vec::new(), file.medium.file());
        medium.seek(SeekFrom::Start(file.length))?;
        medium.take(ending.len() as u64).read_to_end(&mut there)?;
        if there == ending { Ok(()) } else { file.push(&[], &ending) }
    }

    /// Finds the complete frames of a file.
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
