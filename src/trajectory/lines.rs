//! Lines of a text with their numbers.

use std::io::BufRead;

use super::errors::ReadError;

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
    pub(super) fn next(&mut self) -> Result<Option<(&str, usize)>, ReadError> {
        self.text.clear();
        let line = self.line + 1;
        let length = self.input.read_line(&mut self.text).map_err(|source| ReadError::Io { line, source })?;
        if length == 0 {
            return Ok(None);
        }
        self.line = line;
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
