//! Checks of a format's contract, for custom formats.

use std::io;

use glam::DVec2;

use super::{Format, Frame};
use crate::boundary::Domain;
use crate::observable::Snapshot;
use crate::violation::require;
use crate::{Disk, ParameterError, Violation};

const PART: &str = "format";

/// Number of rounds plus one. In odd rounds, each frame is written twice in a row; in even rounds, once.
const ROUNDS: usize = 40;

/// Numbers of the frames.
const NUMBERS: [usize; 6] = [0, 1, 2, 3, 4, 1_000_000];

/// Number of bytes that a slow input gives at a time.
const PIECE: usize = 1;

/// Checks that a format keeps its contract. Writes a few frames of made-up disks about sixty times each: in
/// alternate rounds, once or twice in a row.
///
/// A format that cannot skip frames ([`io::ErrorKind::Unsupported`]) is checked only for the bytes that it
/// writes. The page "Validation" says which planted faults the check finds.
///
/// # Errors
/// The first broken promise.
///
/// ```
/// use granular_edmd::trajectory::{ExtendedXyz, LammpsDump, laws};
/// assert_eq!(laws::check(&ExtendedXyz), Ok(()));
/// assert_eq!(laws::check(&LammpsDump), Ok(()));
/// ```
pub fn check(format: &dyn Format) -> Result<(), Violation> {
    let disks = disks().map_err(|error| failed(0, &io::Error::other(error)))?;
    let snapshots = snapshots(&disks);
    let frames = snapshots.iter().enumerate().map(|(index, snapshot)| written(format, index, snapshot));
    let frames: Vec<Vec<u8>> = frames.collect::<Result<_, _>>()?;
    for round in 1..ROUNDS {
        for (number, once) in frames.iter().enumerate() {
            for _ in 0..=round % 2 {
                let is_same = *once == written(format, number, &snapshots[number])?;
                require!(PART, "alike", is_same;
                    "frame {number} of {} bytes differs when it is written again", once.len());
            }
        }
    }
    let text = frames.concat();
    let mut rest = text.as_slice();
    for (number, (frame, snapshot)) in frames.iter().zip(&snapshots).enumerate() {
        let before = rest.len();
        let read = match format.skip_frame(&mut rest) {
            Err(error) if error.kind() == io::ErrorKind::Unsupported => return Ok(()),
            read => read.map_err(|error| failed(number, &error))?.unwrap_or(f64::NAN),
        };
        let time = snapshot.time();
        let is_time = read.to_bits() == time.to_bits();
        require!(PART, "time", is_time; "frame {number} of time {time:?} is read as one of time {read:?}");
        let (written, skipped) = (frame.len(), before - rest.len());
        require!(PART, "length", written == skipped;
            "frame {number} has {written} bytes, of which {skipped} are skipped");
        check_pieces(format, number, frame, time)?;
        check_torn(format, number, frame)?;
    }
    Ok(())
}

/// An input that gives its bytes one by one, as a file may anywhere give only a part.
struct Trickle<'a>(&'a [u8]);

impl io::Read for Trickle<'_> {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        let few = into.len().min(PIECE);
        self.0.read(&mut into[..few])
    }
}

/// Checks that a frame is skipped as a whole, however few bytes the input gives at a time.
fn check_pieces(format: &dyn Format, number: usize, frame: &[u8], time: f64) -> Result<(), Violation> {
    let mut input = io::BufReader::with_capacity(PIECE, Trickle(frame));
    let read = format.skip_frame(&mut input).map_err(|error| failed(number, &error))?;
    let left = input.buffer().len() + input.get_ref().0.len();
    let is_whole = left == 0 && read.is_some_and(|read| read.to_bits() == time.to_bits());
    require!(PART, "pieces", is_whole;
        "frame {number} of time {time:?} is read as {read:?} if the input gives {PIECE} bytes at a time, and {left} bytes \
         are left");
    Ok(())
}

fn failed(number: usize, error: &io::Error) -> Violation {
    Violation::new(PART, "no failure", format!("frame {number}: {error}"))
}

/// Returns the bytes of a frame.
fn written(format: &dyn Format, index: usize, snapshot: &Snapshot<'_>) -> Result<Vec<u8>, Violation> {
    let mut bytes = Vec::new();
    let frame = Frame::new(NUMBERS[index], snapshot);
    format.write_frame(&frame, &mut bytes).map_err(|error| failed(index, &error))?;
    Ok(bytes)
}

/// Checks that the format notices a frame that is cut short at any byte.
fn check_torn(format: &dyn Format, number: usize, frame: &[u8]) -> Result<(), Violation> {
    let written = frame.len();
    let passed = (1..written).find(|&kept| !matches!(format.skip_frame(&mut &frame[..kept]), Ok(None)));
    let kept = passed.unwrap_or_default();
    require!(PART, "cut short", passed.is_none();
        "frame {number}, cut after {kept} of its {written} bytes, is not reported as `None`");
    Ok(())
}

fn disks() -> Result<[Disk; 3], ParameterError> {
    let disk = Disk::new(DVec2::new(1.0 / 3.0, 0.7), 0.3)?.with_velocity(DVec2::new(-1e-9, 1e9))?;
    let spinning = Disk::new(DVec2::new(2.0, 3.0), 0.25)?.with_angular_velocity(-0.1)?.with_angle(1e5)?;
    Ok([
        disk,
        spinning.with_kind(crate::Kind::new(7)),
        Disk::new(DVec2::new(5.0, 1.0), 1.0)?.with_image([-2, 1]),
    ])
}

/// Returns snapshots of no disk, one disk and all disks, in boxes that are closed, open and periodic.
fn snapshots(disks: &[Disk]) -> [Snapshot<'_>; 6] {
    let closed = Domain::new(0.0, 7.0, -0.1, 9.0);
    let open = Domain::new(0.0, 7.0, -0.1, f64::INFINITY).with_periodic_sides();
    [
        Snapshot::new(-0.5, disks, closed, 1.0),
        Snapshot::new(1.0 / 3.0, &[], open, 0.0),
        Snapshot::new(12_345_678.9, &disks[..1], closed.with_periodic_ends(), -1e-9),
        Snapshot::new(1e16, disks, open, 0.1),
        Snapshot::new(-0.0, disks, closed, 1.0),
        Snapshot::new(5e-324, &disks[1..], open, 1.0),
    ]
}
