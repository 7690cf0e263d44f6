//! The header of a data file, which is everything before the first section.

use std::io::BufRead;

use crate::boundary::Domain;
use crate::trajectory::errors::ReadError;
use crate::trajectory::lines::{Lines, number, whole};

/// The values of the header that the reader needs.
#[derive(Debug, Default)]
pub(super) struct Header {
    pub(super) time: Option<f64>,
    pub(super) atoms: Option<usize>,
    sides: Option<[f64; 2]>,
    ends: Option<[f64; 2]>,
}

impl Header {
    /// Reads the header, and returns it with the name of the first section, if there is one.
    pub(super) fn read<R: BufRead>(lines: &mut Lines<R>) -> Result<(Self, Option<String>), ReadError> {
        let (title, line) = lines.need("the title")?;
        let time = title.split_once(", time = ").map(|(_, time)| number("time", time, line)).transpose();
        // In a title that another program wrote, words may follow instead of a number.
        let mut header = Self { time: time.unwrap_or(None), ..Self::default() };
        while let Some((text, line)) = lines.next_filled()? {
            if text.starts_with(char::is_alphabetic) {
                return Ok((header, Some(text.to_owned())));
            }
            header.take(text.split('#').next().unwrap_or(""), line)?;
        }
        Ok((header, None))
    }

    /// Reads a line of the header.
    fn take(&mut self, text: &str, line: usize) -> Result<(), ReadError> {
        let words: Vec<&str> = text.split_whitespace().collect();
        let ends = |low: &str, high: &str| -> Result<_, ReadError> {
            Ok(Some([number("a side of the box", low, line)?, number("a side of the box", high, line)?]))
        };
        match words[..] {
            [count, "atoms"] => self.atoms = Some(whole("the number of atoms", count, line)?),
            [low, high, "xlo", "xhi"] => self.sides = ends(low, high)?,
            [low, high, "ylo", "yhi"] => self.ends = ends(low, high)?,
            [.., "xy", "xz", "yz"] | [.., "avec" | "bvec" | "cvec"] => {
                return Err(ReadError::unexpected(line, "the box", "a rectangle", text));
            }
            // Numbers of things that disks do not have, such as bonds.
            _ => {}
        }
        Ok(())
    }

    /// Returns the box.
    pub(super) fn domain(&self, line: usize) -> Result<Domain, ReadError> {
        let missing = |what| ReadError::missing(line, what);
        let [left, right] = self.sides.ok_or_else(|| missing("`xlo xhi`"))?;
        let [bottom, top] = self.ends.ok_or_else(|| missing("`ylo yhi`"))?;
        Ok(Domain::new(left, right, bottom, top))
    }
}
