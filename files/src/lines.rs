//! Reading of a text line by line, with line numbers, and of the values in each line.

use std::io::{BufRead, Read};
use std::str::FromStr;

use granular_edmd::boundary::Domain;

use super::ReadError;

/// Largest number of bytes of a line. No line of a file of disks is nearly as long, but a small compressed
/// file can expand to one that fills the memory.
pub(super) const LONGEST: u64 = 1 << 20;

/// Largest id of a disk. All whole numbers up to it are exact as floating-point numbers.
pub(super) const LARGEST_ID: u64 = 1 << 53;

/// The character with which some programs begin a text.
const BYTE_ORDER_MARK: char = '\u{feff}';

/// A text that is read line by line. Lines are counted from 1.
#[derive(Debug)]
pub(super) struct Input<R> {
    input: R,
    line: usize,
}

impl<R: BufRead> Input<R> {
    pub(super) const fn new(input: R) -> Self {
        Self { input, line: 0 }
    }

    /// Returns an empty text that begins with the next line.
    pub(super) const fn text(&self) -> Text {
        Text { first: self.line + 1, bytes: Vec::new() }
    }

    /// Adds the next line to a text, and returns false at the end of the input.
    fn copy(&mut self, text: &mut Text) -> Result<bool, ReadError> {
        let (line, start) = (self.line + 1, text.bytes.len());
        let read = self.input.by_ref().take(LONGEST).read_until(b'\n', &mut text.bytes);
        let length = read.map_err(|cause| ReadError::Io { line, cause })?;
        if length as u64 == LONGEST {
            let most = format!("of fewer than {LONGEST} bytes");
            return Err(ReadError::unexpected(line, "the line", most, lossy(&text.bytes[start..])));
        }
        self.line += usize::from(length > 0);
        Ok(length > 0)
    }

    /// Adds this number of lines of disks to a text.
    pub(super) fn copy_disks(&mut self, count: usize) -> Result<Text, ReadError> {
        let mut text = self.text();
        for number in 0..count {
            if !self.copy(&mut text)? {
                let what = format!("disk {} of {count}", number + 1);
                return Err(ReadError::End { line: self.line, what });
            }
        }
        Ok(text)
    }

    /// Returns the next line without white space around it, and its number, or `None` at the end of the
    /// input.
    pub(super) fn next(&mut self) -> Result<Option<(String, usize)>, ReadError> {
        let mut text = self.text();
        let is_there = self.copy(&mut text)?;
        Ok(text.lines()?.next().filter(|_| is_there).map(|(text, line)| (text.trim().to_owned(), line)))
    }

    /// Returns the next line that is not empty.
    pub(super) fn next_filled(&mut self) -> Result<Option<(String, usize)>, ReadError> {
        while let Some((text, line)) = self.next()? {
            if !text.is_empty() {
                return Ok(Some((text, line)));
            }
        }
        Ok(None)
    }

    /// Returns the next line, or an error if there is none.
    pub(super) fn need(&mut self, what: &str) -> Result<(String, usize), ReadError> {
        let end = ReadError::End { line: self.line, what: what.to_owned() };
        self.next()?.ok_or(end)
    }

    /// Returns all remaining lines.
    pub(super) fn rest(mut self) -> Result<Text, ReadError> {
        let mut text = self.text();
        while self.copy(&mut text)? {}
        Ok(text)
    }
}

/// Lines of a file in memory: one frame, or the whole file.
#[derive(Debug)]
pub(super) struct Text {
    first: usize,
    bytes: Vec<u8>,
}

impl Text {
    /// Returns whether the last line lacks a line break, in which case its last number may be incomplete.
    pub(super) fn is_torn(&self) -> bool {
        self.bytes.last().is_some_and(|&last| last != b'\n')
    }

    /// Returns the lines, or an error if the bytes are not text.
    pub(super) fn lines(&self) -> Result<Lines<'_>, ReadError> {
        let text = str::from_utf8(&self.bytes).map_err(|error| {
            let before = &self.bytes[..error.valid_up_to()];
            let lines = || before.rsplit(|&byte| byte == b'\n');
            let start = before.len() - lines().next().map_or(0, <[u8]>::len);
            let line = self.first + lines().count() - 1;
            ReadError::unexpected(line, "the text", "UTF-8", lossy(&self.bytes[start..]))
        })?;
        let text = if self.first == 1 { text.trim_start_matches(BYTE_ORDER_MARK) } else { text };
        Ok(Lines { rest: text, line: self.first - 1 })
    }
}

/// Returns the first line of arbitrary bytes as text.
pub(super) fn lossy(bytes: &[u8]) -> String {
    let line = bytes.split(|&byte| byte == b'\n').next().unwrap_or_default();
    String::from_utf8_lossy(&line[..line.len().min(240)]).trim().to_owned()
}

/// An iterator over the lines of a [`Text`].
#[derive(Debug, Clone)]
pub(super) struct Lines<'a> {
    rest: &'a str,
    line: usize,
}

impl<'a> Lines<'a> {
    /// Returns the number of the line that was read last.
    pub(super) const fn line(&self) -> usize {
        self.line
    }

    /// Returns the next line that is not empty, without white space around it.
    pub(super) fn next_filled(&mut self) -> Option<(&'a str, usize)> {
        self.by_ref().map(|(text, line)| (text.trim(), line)).find(|(text, _)| !text.is_empty())
    }
}

impl<'a> Iterator for Lines<'a> {
    type Item = (&'a str, usize);

    fn next(&mut self) -> Option<Self::Item> {
        if self.rest.is_empty() {
            return None;
        }
        let (line, rest) = self.rest.split_once('\n').unwrap_or((self.rest, ""));
        self.rest = rest;
        self.line += 1;
        Some((line.trim_end_matches('\r'), self.line))
    }
}

/// Reads a number. As in Fortran, its exponent may begin with a D.
pub(super) fn number(what: &str, text: &str, line: usize) -> Result<f64, ReadError> {
    let text = text.trim();
    let number = text.parse().or_else(|_| text.replace(['d', 'D'], "e").parse());
    let requirement = if text.contains(',') { "a number with a decimal point" } else { "a number" };
    number.map_err(|_| ReadError::unexpected(line, what, requirement, text))
}

/// Reads a whole number, which may be written as a float, such as `2.0` or `2.0e+00`.
pub(super) fn whole<T: FromStr>(what: &str, text: &str, line: usize) -> Result<T, ReadError> {
    let requirement = format!("a whole number that fits into {}", std::any::type_name::<T>());
    as_whole(text).ok_or_else(|| ReadError::unexpected(line, what, requirement, text.trim()))
}

/// Returns the whole number that a text represents, or `None` if it represents none.
pub(super) fn as_whole<T: FromStr>(text: &str) -> Option<T> {
    let of_float = || {
        let number = text.trim().parse::<f64>().ok()?;
        // Above this bound, not every whole number is a float.
        let is_whole = number.fract() == 0.0 && number.abs() < LARGEST_ID as f64;
        is_whole.then(|| (number as i64).to_string())?.parse().ok()
    };
    text.trim().parse().ok().or_else(of_float)
}

/// Reads a number that must be finite.
pub(super) fn finite(what: &str, text: &str, line: usize) -> Result<f64, ReadError> {
    let number = number(what, text, line)?;
    if number.is_finite() { Ok(number) } else { Err(ReadError::unexpected(line, what, "finite", text)) }
}

/// Returns the box of a file. Only its top may be infinite.
pub(super) fn checked_box(domain: Domain, line: usize) -> Result<Domain, ReadError> {
    let Domain { left, right, bottom, top, .. } = domain;
    let is_finite = (right - left).is_finite() && bottom.is_finite();
    let is_closed = top.is_finite() || !domain.periodic_ends;
    if is_finite && is_closed && left < right && bottom < top {
        return Ok(domain);
    }
    let found = format!("{left} to {right} and {bottom} to {top}");
    Err(ReadError::unexpected(line, "the box", "from smaller to larger numbers", found))
}

/// Returns whether a box is a rectangle, up to rounding.
pub(super) fn is_upright(sides: [f64; 2], tilts: impl IntoIterator<Item = f64>) -> bool {
    let most = 1e-9 * sides[0].abs().max(sides[1].abs());
    tilts.into_iter().all(|tilt: f64| tilt.abs() <= most)
}
