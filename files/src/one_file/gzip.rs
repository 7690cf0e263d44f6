//! Compressed trajectories: gzip files of one member, which is complete after each frame.
//!
//! Frames are compressed one by one. Each ends at a whole byte (a sync flush), and the ending of the member
//! follows the last frame. The next frame takes the place of the ending. A member for each frame would be
//! simpler, but OVITO reads only the first member.

use std::io::{self, BufRead, Read, Write};

use flate2::write::DeflateEncoder;
use flate2::{Compression, Crc, Decompress, FlushDecompress, Status};

use super::Found;
use crate::FrameFormat;
use crate::format::no_frame;

/// First bytes of a member: deflated, without a name or a time, from an unknown system.
const HEAD: [u8; 10] = [0x1f, 0x8b, 8, 0, 0, 0, 0, 0, 0, 255];

/// The last block of a member, which is empty.
const LAST_BLOCK: [u8; 2] = [3, 0];

/// The last bytes of a sync flush.
const FLUSHED: [u8; 4] = [0, 0, 255, 255];

/// The bytes of the flush and of the last block, which the checksum and the length follow.
const WHOLE: [u8; 6] = [0, 0, 255, 255, 3, 0];

/// The state of a member that is being written: the checksum of its data, and whether it has begun.
#[derive(Debug, Default)]
pub(super) struct Member {
    crc: Crc,
    has_head: bool,
}

impl Member {
    /// Returns the compressed bytes of the next frame, and the member that includes it.
    pub(super) fn packed(&self, bytes: &[u8]) -> io::Result<(Vec<u8>, Self)> {
        let head: &[u8] = if self.has_head { &[] } else { &HEAD };
        // The usual level takes several times as long for files that are hardly smaller, since digits are
        // random.
        let mut encoder = DeflateEncoder::new(head.to_vec(), Compression::fast());
        encoder.write_all(bytes)?;
        encoder.flush()?;
        // The bytes are copied out, because finishing the encoder would end the stream.
        Ok((encoder.get_ref().clone(), self.with(bytes)))
    }

    /// Returns the ending of the member.
    pub(super) fn ending(&self) -> Vec<u8> {
        let (sum, amount) = (self.crc.sum().to_le_bytes(), self.crc.amount().to_le_bytes());
        [LAST_BLOCK.as_slice(), &sum, &amount].concat()
    }

    fn with(&self, bytes: &[u8]) -> Self {
        let mut crc = Crc::new();
        crc.combine(&self.crc);
        crc.update(bytes);
        Self { crc, has_head: true }
    }
}

/// Finds the complete frames of a file, and adds them to the member.
///
/// A frame can end only at the bytes of a sync flush. A sync flush ends a frame if the bytes since the last
/// frame are exactly one frame of the format.
pub(super) fn frames(
    member: &mut Member,
    input: &mut impl BufRead,
    format: &impl FrameFormat,
) -> io::Result<Found> {
    let mut frames = Found::default();
    let mut piece = vec![0; HEAD.len()];
    input.read_exact(&mut piece)?;
    if piece != HEAD {
        return Err(no_frame("the head of a compressed file of granular-edmd", "another"));
    }
    let (mut end, mut packed, mut bytes) = (HEAD.len() as u64, Vec::new(), Vec::new());
    let mut inflater = Decompress::new(false);
    loop {
        let start = packed.len();
        if input.read_until(FLUSHED[3], &mut packed)? == 0 {
            // A process that was killed in the middle of a frame left these bytes, unless they end as a whole
            // frame does: damage may hide the flush from the decompressor.
            let is_ended = packed.len() >= 14 && packed[packed.len() - 14..].starts_with(&WHOLE);
            return if is_ended { Err(no_frame("a whole frame", "a damaged one")) } else { Ok(frames) };
        }
        if !goes_on(&mut inflater, &packed[start..], &mut bytes) {
            return check_ending(packed, input, &member.ending()).map(|()| frames);
        }
        let mut rest = bytes.as_slice();
        if packed.ends_with(&FLUSHED)
            && let Ok(Some(time)) = format.skip_frame(&mut rest)
            && rest.is_empty()
        {
            end += packed.len() as u64;
            frames.add(time, &bytes, end)?;
            *member = member.with(&bytes);
            packed.clear();
            bytes.clear();
            inflater.reset(false);
        }
    }
}

/// Checks the bytes after the last complete frame: the ending or a part of it, or a part of a frame that a
/// killed process wrote over the ending.
///
/// An ending with another checksum shows that a frame is damaged. A new ending would hide the damage forever.
fn check_ending(mut packed: Vec<u8>, input: &mut impl BufRead, ending: &[u8]) -> io::Result<()> {
    let room = (ending.len() + 1).saturating_sub(packed.len());
    input.take(room as u64).read_to_end(&mut packed)?;
    // The first bit of a frame shows that its block is not the last.
    let is_frame = packed.first().is_some_and(|first| first & 1 == 0);
    if packed.len() > ending.len() {
        Err(no_frame("a whole frame", "a damaged one"))
    } else if is_frame || ending.starts_with(&packed) {
        Ok(())
    } else {
        Err(no_frame("frames that match the checksum after them", "others"))
    }
}

/// Decompresses the next bytes of a stream, and returns false at the end of the stream or if it is damaged.
fn goes_on(inflater: &mut Decompress, mut packed: &[u8], bytes: &mut Vec<u8>) -> bool {
    loop {
        bytes.reserve(4 * packed.len() + 1024);
        let before = (inflater.total_in(), inflater.total_out());
        match inflater.decompress_vec(packed, bytes, FlushDecompress::None) {
            Ok(Status::Ok | Status::BufError) => {}
            Ok(Status::StreamEnd) | Err(_) => return false,
        }
        packed = &packed[(inflater.total_in() - before.0) as usize..];
        let is_stuck = before == (inflater.total_in(), inflater.total_out());
        if is_stuck || (packed.is_empty() && bytes.len() < bytes.capacity()) {
            return packed.is_empty();
        }
    }
}
