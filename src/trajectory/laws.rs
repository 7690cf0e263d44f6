//! Checks of a format's contract, for formats of your own.

use std::io;

use glam::DVec2;
use thiserror::Error;

use super::{Format, Frame};
use crate::boundary::Domain;
use crate::error::Readable;
use crate::observable::Snapshot;
use crate::{Disk, ParameterError};

/// A way in which a format breaks its [contract](Format).
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum Violation {
    /// A frame cannot be written or skipped.
    #[error("frame {number}: {reason}")]
    Failed {
        /// Number of the frame.
        number: usize,
        /// The error of the format.
        reason: String,
    },
    /// The same frame gave other bytes when it was written again.
    #[error("frame {number}, written twice, has other bytes the second time")]
    NotAlike {
        /// Number of the frame.
        number: usize,
    },
    /// The time that was read is not the time of the frame.
    #[error(
        "frame {number} of time {written} is read as one of time {read}",
        written = Readable(*written), read = Readable(*read)
    )]
    Time {
        /// Number of the frame.
        number: usize,
        /// Time of the frame.
        written: f64,
        /// The time that was read.
        read: f64,
    },
    /// The format skipped more or fewer bytes than it had written.
    #[error("frame {number} has {written} bytes, of which {read} are passed over")]
    Length {
        /// Number of the frame.
        number: usize,
        /// Number of its bytes.
        written: usize,
        /// Number of the bytes that were skipped.
        read: usize,
    },
    /// The format did not notice that a frame was cut short.
    #[error("frame {number}, cut after {kept} of its {written} bytes, does not answer `None`")]
    Torn {
        /// Number of the frame.
        number: usize,
        /// Number of its bytes.
        written: usize,
        /// Number of the bytes that were left.
        kept: usize,
    },
}

/// Checks that a format keeps its contract, with some frames of made-up disks.
///
/// A format that cannot skip frames ([`io::ErrorKind::Unsupported`]) is checked as far as it goes.
///
/// # Errors
/// The first promise that is broken.
///
/// ```
/// use granular_edmd::trajectory::{ExtendedXyz, LammpsDump, laws};
/// assert_eq!(laws::check(&ExtendedXyz), Ok(()));
/// assert_eq!(laws::check(&LammpsDump), Ok(()));
/// ```
pub fn check(format: &dyn Format) -> Result<(), Violation> {
    let failed = |number| move |error: io::Error| Violation::Failed { number, reason: error.to_string() };
    let disks = disks().map_err(|error| failed(0)(io::Error::other(error)))?;
    let snapshots = snapshots(&disks);
    let mut frames = Vec::new();
    for (number, snapshot) in snapshots.iter().enumerate() {
        let frame = Frame::new(number, snapshot);
        let [mut once, mut again] = [Vec::new(), Vec::new()];
        format.write_frame(&frame, &mut once).map_err(failed(number))?;
        format.write_frame(&frame, &mut again).map_err(failed(number))?;
        if once != again {
            return Err(Violation::NotAlike { number });
        }
        frames.push(once);
    }
    let text = frames.concat();
    let mut rest = text.as_slice();
    for (number, (frame, snapshot)) in frames.iter().zip(&snapshots).enumerate() {
        let before = rest.len();
        let read = match format.skip_frame(&mut rest) {
            Err(error) if error.kind() == io::ErrorKind::Unsupported => return Ok(()),
            read => read.map_err(failed(number))?.unwrap_or(f64::NAN),
        };
        if read.to_bits() != snapshot.time().to_bits() {
            return Err(Violation::Time { number, written: snapshot.time(), read });
        }
        let (written, read) = (frame.len(), before - rest.len());
        if written != read {
            return Err(Violation::Length { number, written, read });
        }
        check_torn(format, number, frame)?;
    }
    Ok(())
}

/// Checks that the format notices a frame that is cut short at any byte.
fn check_torn(format: &dyn Format, number: usize, frame: &[u8]) -> Result<(), Violation> {
    let written = frame.len();
    match (1..written).find(|&kept| !matches!(format.skip_frame(&mut &frame[..kept]), Ok(None))) {
        None => Ok(()),
        Some(kept) => Err(Violation::Torn { number, written, kept }),
    }
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
fn snapshots(disks: &[Disk]) -> [Snapshot<'_>; 4] {
    let closed = Domain::new(0.0, 7.0, -0.1, 9.0);
    let open = Domain::new(0.0, 7.0, -0.1, f64::INFINITY).with_periodic_sides();
    [
        Snapshot::new(-0.5, disks, closed, 1.0),
        Snapshot::new(1.0 / 3.0, &[], open, 0.0),
        Snapshot::new(12_345_678.9, &disks[..1], closed.with_periodic_ends(), -1e-9),
        Snapshot::new(1e16, disks, open, 0.1),
    ]
}
