//! Consecutive frames in one file, plain or compressed.

use std::hash::{DefaultHasher, Hasher};
use std::io::{self, BufRead, BufReader, Read, Seek, SeekFrom};
use std::path::Path;

use super::format::no_frame;
use super::recording::{Growing, Layout, Recording, Start};
use super::{Frame, FrameFormat, RecordError};

#[cfg(feature = "gzip")]
mod gzip;

/// Frames in one file.
struct OneFile<F> {
    format: F,
    packing: Packing,
    /// Digests of the bytes of the frames.
    digests: Vec<u64>,
}

/// Opens a file, and finds its complete frames.
pub(super) fn open(
    path: &Path,
    format: impl FrameFormat + Send + Sync + 'static,
    start: Start,
) -> Result<Recording, RecordError> {
    let mut packing = Packing::of(path)?;
    let (mut file, is_new) = Growing::open(path, start)?;
    let mut found = Found::default();
    if !is_new {
        let frames = packing.frames(&mut BufReader::new(&file.file), &format);
        found = frames.map_err(RecordError::io("continue", path))?;
        file.resume(found.end, packing.ending());
    }
    if !found.times.is_empty() {
        packing.mend(&mut file)?;
    }
    Recording::new(file, is_new, found.times, OneFile { format, packing, digests: found.digests })
}

impl<F: FrameFormat> Layout for OneFile<F> {
    fn make(&self, frame: &Frame<'_>, bytes: &mut Vec<u8>) -> io::Result<()> {
        self.format.write_frame(frame, bytes)
    }

    fn push(&mut self, file: &mut Growing, _: &Frame<'_>, bytes: &[u8]) -> Result<(), RecordError> {
        self.packing.push(file, bytes)?;
        self.digests.push(digest(bytes));
        Ok(())
    }

    fn has(&self, _: &Growing, number: usize, bytes: &[u8]) -> Result<bool, RecordError> {
        Ok(self.digests.get(number) == Some(&digest(bytes)))
    }
}

/// The complete frames of a file: their times, digests of their bytes, and the end of the last frame.
#[derive(Debug, Default)]
pub(super) struct Found {
    times: Vec<f64>,
    digests: Vec<u64>,
    end: u64,
}

impl Found {
    /// Adds a frame that was found in a file.
    pub(super) fn add(&mut self, time: f64, bytes: &[u8], end: u64) -> io::Result<()> {
        check_later(&self.times, time)?;
        self.times.push(time);
        self.digests.push(digest(bytes));
        self.end = end;
        Ok(())
    }
}

/// Checks that a frame in a file is later than the frames before it.
pub(super) fn check_later(times: &[f64], time: f64) -> io::Result<()> {
    if times.last().is_some_and(|&last| last >= time) || !time.is_finite() {
        return Err(no_frame("a frame later than the previous one", &format!("time {time:?}")));
    }
    Ok(())
}

/// Returns a hash of these bytes, for comparisons within one process.
fn digest(bytes: &[u8]) -> u64 {
    let mut hasher = DefaultHasher::new();
    hasher.write(bytes);
    hasher.finish()
}

/// The encoding of frames as bytes of the file.
#[derive(Debug)]
enum Packing {
    Plain,
    #[cfg(feature = "gzip")]
    Gzip(gzip::Member),
}

impl Packing {
    /// Returns the packing for the name of a file.
    fn of(path: &Path) -> Result<Self, RecordError> {
        #[cfg(feature = "gzip")]
        let gzip = Ok(Self::Gzip(gzip::Member::default()));
        #[cfg(not(feature = "gzip"))]
        let gzip =
            Err(RecordError::unusable(path, "compression needs the feature `gzip` of granular-edmd-files"));
        if is_gzip(path) { gzip } else { Ok(Self::Plain) }
    }

    /// Returns the bytes that follow the last frame.
    fn ending(&self) -> Vec<u8> {
        match self {
            Self::Plain => Vec::new(),
            #[cfg(feature = "gzip")]
            Self::Gzip(member) => member.ending(),
        }
    }

    fn push(&mut self, file: &mut Growing, bytes: &[u8]) -> Result<(), RecordError> {
        match self {
            Self::Plain => file.push(bytes, &[]),
            #[cfg(feature = "gzip")]
            Self::Gzip(member) => {
                let packed = member.packed(bytes);
                let (piece, longer) = packed.map_err(RecordError::io("make a frame of", &file.path))?;
                file.push(&piece, &longer.ending())?;
                *member = longer;
                Ok(())
            }
        }
    }

    /// Writes the ending again if it was cut off. Without the ending, readers consider the file damaged, and
    /// the file would stay damaged if the run ended before its next frame.
    fn mend(&self, file: &mut Growing) -> Result<(), RecordError> {
        let (ending, mut there, mut medium) = (self.ending(), Vec::new(), &file.file);
        let read = medium
            .seek(SeekFrom::Start(file.length))
            .and_then(|_| medium.take(ending.len() as u64).read_to_end(&mut there));
        read.map_err(RecordError::io("read", &file.path))?;
        if there == ending { Ok(()) } else { file.push(&[], &ending) }
    }

    /// Finds the complete frames of a file.
    fn frames(&mut self, input: &mut impl BufRead, format: &impl FrameFormat) -> io::Result<Found> {
        match self {
            Self::Plain => plain_frames(input, format),
            #[cfg(feature = "gzip")]
            Self::Gzip(member) => gzip::frames(member, input, format),
        }
    }
}

/// Returns whether a recorder compresses a file with this name.
pub(super) fn is_gzip(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending == "gz")
}

fn plain_frames(input: &mut impl BufRead, format: &impl FrameFormat) -> io::Result<Found> {
    let mut frames = Found::default();
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
