//! The frames of a file, whose format is recognized by its contents.

use std::fs::File;
use std::io::{BufRead, BufReader, Cursor, Read, Seek};

use super::ReadError;
use super::found::{Found, Frames};
use super::lines::Input;
use super::{csv, extended_xyz, gsd, lammps_data, lammps_dump};

/// Number of bytes by which the format is recognized.
const HEAD: u64 = 1 << 14;

/// Returns the frames of a file. A GSD file is not read completely.
pub(super) fn frames_of_file<'a>(mut file: File) -> Result<Frames<'a>, ReadError> {
    let failed = |cause| ReadError::Io { line: 1, cause };
    let mut head = Vec::new();
    file.by_ref().take(8).read_to_end(&mut head).map_err(failed)?;
    file.rewind().map_err(failed)?;
    if gsd::is_gsd(&head) { Ok(gsd::frames_of_file(file)) } else { frames(BufReader::new(file)) }
}

/// Returns the frames of an input, which may be compressed.
pub(super) fn frames<'a>(input: impl BufRead + 'a) -> Result<Frames<'a>, ReadError> {
    let (head, input) = with_head(Box::new(input))?;
    if !head.starts_with(&[0x1f, 0x8b]) {
        return Ok(of_format(&head, input));
    }
    let (head, input) = with_head(inflated(input)?)?;
    Ok(of_format(&head, input))
}

type Boxed<'a> = Box<dyn BufRead + 'a>;

/// Returns the first bytes of an input, and the input from its start.
fn with_head(mut input: Boxed<'_>) -> Result<(Vec<u8>, Boxed<'_>), ReadError> {
    let mut head = Vec::new();
    let read = input.by_ref().take(HEAD).read_to_end(&mut head);
    read.map_err(|cause| ReadError::Io { line: 1, cause })?;
    Ok((head.clone(), Box::new(Cursor::new(head).chain(input))))
}

#[cfg(feature = "gzip")]
#[expect(clippy::unnecessary_wraps, reason = "without the feature, it is an error")]
fn inflated(input: Boxed<'_>) -> Result<Boxed<'_>, ReadError> {
    Ok(Box::new(BufReader::new(flate2::bufread::MultiGzDecoder::new(input))))
}

#[cfg(not(feature = "gzip"))]
fn inflated(_: Boxed<'_>) -> Result<Boxed<'_>, ReadError> {
    let cause =
        std::io::Error::other("it is compressed, which needs the feature `gzip` of granular-edmd-files");
    Err(ReadError::Io { line: 1, cause })
}

/// Returns the frames of an input that begins with these bytes.
fn of_format<'a>(head: &[u8], input: Boxed<'a>) -> Frames<'a> {
    if gsd::is_gsd(head) {
        return gsd::frames(input);
    }
    let text = String::from_utf8_lossy(head);
    let mut lines = text.trim_start_matches('\u{feff}').trim_start().lines();
    let [first, second] = [(); 2].map(|()| lines.next().unwrap_or_default().trim());
    let is_count = !first.is_empty() && first.bytes().all(|letter| letter.is_ascii_digit());
    if first.starts_with("ITEM:") {
        return Box::new(lammps_dump::frames(Input::new(input)));
    }
    if is_count || second.contains("Properties") {
        return Box::new(extended_xyz::frames(Input::new(input)));
    }
    if lammps_data::is_data(&text) {
        let read = || Ok(Found::in_text(Input::new(input).rest()?, None, lammps_data::table));
        return Box::new(std::iter::once_with(read));
    }
    match Input::new(input).rest().and_then(|text| csv::frames(&text)) {
        Ok(frames) => Box::new(frames.into_iter().map(Ok)),
        Err(error) => Box::new(std::iter::once(Err(error))),
    }
}
