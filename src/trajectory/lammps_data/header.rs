//! The header of a data file, which is everything before the first section.

use crate::boundary::Domain;
use crate::trajectory::ReadError;
use crate::trajectory::lines::{Lines, checked_box, finite, whole};

/// The values of the header that the reader needs.
#[derive(Debug, Default)]
pub(super) struct Header {
    pub(super) time: Option<f64>,
    atoms: Found<usize>,
    sides: Found<[f64; 2]>,
    ends: Found<[f64; 2]>,
}

impl Header {
    /// Reads the header, and returns it with the name of the first section, if there is one.
    pub(super) fn read<'a>(lines: &mut Lines<'a>) -> Result<(Self, Option<&'a str>), ReadError> {
        let (title, line) = lines.need("the title")?;
        let time = title.split_once(", time = ").map(|(_, time)| finite("time", time, line)).transpose();
        // In a title that another program wrote, words may follow instead of a number.
        let time = if title.contains(super::WRITER) { time? } else { time.unwrap_or(None) };
        let mut header = Self { time, ..Self::default() };
        while let Some((text, line)) = lines.next_filled() {
            if text.starts_with(char::is_alphabetic) {
                return Ok((header, Some(text)));
            }
            header.take(text.split('#').next().unwrap_or(""), line)?;
        }
        Ok((header, None))
    }

    /// Reads a line of the header.
    fn take(&mut self, text: &str, line: usize) -> Result<(), ReadError> {
        let words: Vec<&str> = text.split_whitespace().collect();
        let ends = |low: &str, high: &str| -> Result<_, ReadError> {
            Ok([finite("a side of the box", low, line)?, finite("a side of the box", high, line)?])
        };
        match words[..] {
            [count, "atoms"] => {
                let count = whole("the number of atoms", count, line)?;
                once(&mut self.atoms, count, "the number of atoms", line)?;
            }
            [low, high, "xlo", "xhi"] => once(&mut self.sides, ends(low, high)?, "`xlo xhi`", line)?,
            [low, high, "ylo", "yhi"] => once(&mut self.ends, ends(low, high)?, "`ylo yhi`", line)?,
            [.., "xy", "xz", "yz"] | [.., "avec" | "bvec" | "cvec"] => {
                return Err(ReadError::unexpected(line, "the box", "a rectangle", text));
            }
            // Numbers of things that disks do not have, such as bonds.
            _ => {}
        }
        Ok(())
    }

    /// Returns the number of atoms.
    pub(super) fn atoms(&self, line: usize) -> Result<usize, ReadError> {
        found(self.atoms, "the number of atoms", line)
    }

    /// Returns the box.
    pub(super) fn domain(&self, line: usize) -> Result<Domain, ReadError> {
        let [left, right] = found(self.sides, "`xlo xhi`", line)?;
        let [bottom, top] = found(self.ends, "`ylo yhi`", line)?;
        checked_box(Domain::new(left, right, bottom, top), self.ends.map_or(line, |(_, line)| line))
    }
}

/// A value of the header, with its line.
type Found<T> = Option<(T, usize)>;

/// Notes a value that may appear once.
fn once<T>(place: &mut Found<T>, value: T, what: &str, line: usize) -> Result<(), ReadError> {
    match place.replace((value, line)) {
        None => Ok(()),
        Some((_, first)) => Err(ReadError::Doubled { line, first, what: what.to_owned() }),
    }
}

/// Returns a value that must be there.
fn found<T: Copy>(place: Found<T>, what: &str, line: usize) -> Result<T, ReadError> {
    place.map(|(value, _)| value).ok_or_else(|| ReadError::missing(line, what))
}
