//! Frames of a trajectory, the trait of the formats that write them one after another, and what formats
//! show of disks.

use std::io::{self, BufRead, Read, Write};

use granular_edmd::Disk;
use granular_edmd::boundary::Domain;
use granular_edmd::observable::Snapshot;

use super::lines::LONGEST;

/// Returns the disks with their ids, or with the ids 1, 2, 3, … if some have no id, because they do not come
/// from a simulation.
pub(super) fn numbered(disks: &[Disk]) -> impl Iterator<Item = (u64, &Disk)> {
    let are_known = disks.iter().all(|disk| disk.id() != 0);
    disks.iter().zip(1_u64..).map(move |(disk, number)| (if are_known { disk.id() } else { number }, disk))
}

/// Returns the orientation as the first and the last component of a quaternion: cosine and sine of half the
/// angle.
pub(super) fn half_turn(disk: &Disk) -> [f64; 2] {
    let half = 0.5 * disk.angle();
    [libm::cos(half), libm::sin(half)]
}

/// Returns the top of the box, above the highest disk if the box is open, for programs that have no open
/// boxes.
pub(super) fn shown_top(domain: &Domain, disks: &[Disk]) -> f64 {
    if domain.top.is_finite() {
        return domain.top;
    }
    let highest = disks.iter().map(|disk| disk.position().y + 2.0 * disk.radius());
    highest.fold(domain.bottom + domain.width(), f64::max)
}

/// Returns the depth of the box: the diameter of the largest disk, or 1 without disks.
pub(super) fn shown_depth(disks: &[Disk]) -> f64 {
    let radius = disks.iter().map(Disk::radius).fold(0.0, f64::max);
    if radius > 0.0 { 2.0 * radius } else { 1.0 }
}

/// A snapshot in a trajectory, with its number.
#[derive(Debug, Clone, Copy)]
pub struct Frame<'a> {
    number: usize,
    snapshot: &'a Snapshot<'a>,
}

impl<'a> Frame<'a> {
    /// Creates the frame of this number.
    ///
    /// The first frame of a file has the number 0.
    pub const fn new(number: usize, snapshot: &'a Snapshot<'a>) -> Self {
        Self { number, snapshot }
    }

    /// Returns the number of the frame in its file, counted from 0.
    pub const fn number(&self) -> usize {
        self.number
    }

    /// Returns the snapshot.
    pub const fn snapshot(&self) -> &Snapshot<'a> {
        self.snapshot
    }
}

/// A format that writes frames one after another into a file.
///
/// # Contract
/// 1. `write_frame` depends on the frame alone: written twice, the same frame gives the same bytes.
/// 2. `skip_frame` skips exactly the bytes that `write_frame` wrote, and returns the time of the frame to the
///    bit, even for a negative zero, and however few bytes the input gives at a time.
/// 3. `skip_frame` returns `None` for a frame that is cut short at any byte, for example by a killed process.
///
/// [`Recorder`](super::Recorder) collects each whole frame in memory, so a format may write in small pieces.
/// The recorder owns the file, its compression, and the clock.
pub trait FrameFormat {
    /// Writes a frame.
    ///
    /// # Errors
    /// If the writer fails, or the format has no place for a value of the frame.
    fn write_frame(&self, frame: &Frame<'_>, out: &mut dyn Write) -> io::Result<()>;

    /// Skips the next frame of the input, and returns its time, or `None` if the frame is cut short.
    ///
    /// [`Recorder::append`](super::Recorder::append) needs it to find the last whole frame of a file. A
    /// format without it records new files only.
    ///
    /// # Errors
    /// If the input fails, or is not a frame of this format.
    fn skip_frame(&self, input: &mut dyn BufRead) -> io::Result<Option<f64>> {
        let _ = input;
        Err(io::Error::new(io::ErrorKind::Unsupported, "the format does not say where a frame ends"))
    }
}

/// Returns the next line without its line break, or `None` if the input is cut short.
pub(super) fn whole_line(input: &mut dyn BufRead) -> io::Result<Option<String>> {
    let mut line = Vec::new();
    if !take_line(input, &mut line)? {
        return Ok(None);
    }
    let line = String::from_utf8(line).map_err(|error| io::Error::new(io::ErrorKind::InvalidData, error))?;
    Ok(Some(line.trim_end_matches(['\n', '\r']).to_owned()))
}

/// Skips `count` lines, and returns false if the input has fewer.
pub(super) fn skip_lines(input: &mut dyn BufRead, count: usize) -> io::Result<bool> {
    let mut line = Vec::new();
    for _ in 0..count {
        if !take_line(input, &mut line)? {
            return Ok(false);
        }
    }
    Ok(true)
}

/// Reads a line of bounded length, and returns false if the input ends before the line does.
fn take_line(input: &mut dyn BufRead, line: &mut Vec<u8>) -> io::Result<bool> {
    line.clear();
    let length = input.take(LONGEST).read_until(b'\n', line)? as u64;
    if length == LONGEST {
        return Err(no_frame("a shorter line", &String::from_utf8_lossy(line)));
    }
    Ok(line.ends_with(b"\n"))
}

/// Creates the error of an input that is not a frame.
pub(super) fn no_frame(expected: &str, found: &str) -> io::Error {
    let start: String = found.chars().take(40).collect();
    io::Error::new(io::ErrorKind::InvalidData, format!("expected {expected}, but found {start:?}"))
}
