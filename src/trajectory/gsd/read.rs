//! Frames of GSD, read one by one.

use std::io::BufRead;

use crate::trajectory::ReadError;
use crate::trajectory::found::Frames;

/// Returns whether a file that begins with these bytes is a file of GSD.
pub(in crate::trajectory) fn is_gsd(head: &[u8]) -> bool {
    head.starts_with(&0x65DF_65DF_65DF_65DF_u64.to_le_bytes())
}

/// Returns the frames of a file.
pub(in crate::trajectory) fn frames<'a>(input: impl BufRead + 'a) -> Frames<'a> {
    drop(input);
    let found = "a file of GSD";
    let error = ReadError::unexpected(1, "the file", "a text", found);
    Box::new(std::iter::once(Err(error)))
}
