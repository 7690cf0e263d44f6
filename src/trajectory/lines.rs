//! Lines of a text with their numbers.

use std::io::{BufRead, Read};

use super::ReadError;
use crate::boundary::Domain;

/// Most bytes of a line. No line of a file of disks is nearly as long, but a small compressed file can expand
/// to one that fills the memory.
pub(super) const LONGEST: u64 = 1 << 20;

/// With this letter, some programs begin a text.
const BYTE_ORDER_MARK: char = '\u{feff}';

/// The lines of a text, counted from 1.
#[derive(Debug)]
pub(super) struct Lines<R> {
    input: R,
    text: String,
    line: usize,
}

impl<R: BufRead> Lines<R> {
    pub(super) const fn new(input: R) -> Self {
        Self { input, text: String::new(), line: 0 }
    }

    /// Returns the number of the line that was read last.
    pub(super) const fn line(&self) -> usize {
        self.line
    }

    /// Returns the next line without its line break, and its number, if there is one.
    ///
    /// A text without a line break at its end may be torn inside its last number, which then reads as another
    /// number. A file that tools write ends with a line break, so one without is an error.
    pub(super) fn next(&mut self) -> Result<Option<(&str, usize)>, ReadError> {
        self.text.clear();
        let line = self.line + 1;
        let mut input = self.input.by_ref().take(LONGEST);
        let length = input.read_line(&mut self.text).map_err(|source| ReadError::Io { line, source })?;
        if length == 0 {
            return Ok(None);
        }
        self.line = line;
        if length as u64 == LONGEST {
            let most = format!("of fewer than {LONGEST} bytes");
            return Err(ReadError::unexpected(line, "the line", most, &self.text));
        }
        if !self.text.ends_with('\n') && !self.text.trim().is_empty() {
            return Err(ReadError::End { line, what: "a line break".to_owned() });
        }
        if line == 1 && self.text.starts_with(BYTE_ORDER_MARK) {
            self.text.remove(0);
        }
        Ok(Some((self.text.trim_end_matches(['\n', '\r']), line)))
    }

    /// Returns the next line that is not empty.
    pub(super) fn next_filled(&mut self) -> Result<Option<(&str, usize)>, ReadError> {
        while self.next()?.is_some() {
            if !self.text.trim().is_empty() {
                return Ok(Some((self.text.trim(), self.line)));
            }
        }
        Ok(None)
    }

    /// Returns the next line, which must be there.
    pub(super) fn need(&mut self, what: &str) -> Result<(&str, usize), ReadError> {
        let end = ReadError::End { line: self.line, what: what.to_owned() };
        self.next()?.ok_or(end)
    }
}

/// Reads a number.
pub(super) fn number(what: &str, text: &str, line: usize) -> Result<f64, ReadError> {
    text.trim().parse().map_err(|_| ReadError::unexpected(line, what, "a number", text))
}

/// Reads a whole number.
pub(super) fn whole<T: std::str::FromStr>(what: &str, text: &str, line: usize) -> Result<T, ReadError> {
    let requirement = format!("a whole number that fits into {}", std::any::type_name::<T>());
    text.trim().parse().map_err(|_| ReadError::unexpected(line, what, requirement, text))
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
