//! The header of a data file, which is everything before the first section.

use crate::ReadError;
use crate::lines::{Lines, checked_box, finite, is_upright, whole};
use granular_edmd::boundary::Domain;

/// The values of the header that the reader needs.
#[derive(Debug, Default)]
pub(super) struct Header<'a> {
    pub(super) time: Option<f64>,
    /// Whether the box is periodic in x and in y, if the title says so.
    pub(super) periodic: Option<[bool; 2]>,
    atoms: Found<usize>,
    sides: Found<[f64; 2]>,
    ends: Found<[f64; 2]>,
    tilts: Found<[f64; 3]>,
    /// The vectors of a general box and its origin.
    vectors: [Found<[f64; 3]>; 4],
    /// Counts of items that disks do not have, such as bonds.
    pub(super) other: Found<&'a str>,
}

/// Names of items that show another style of atoms.
const OTHERS: [&str; 8] =
    ["bodies", "ellipsoids", "lines", "triangles", "bonds", "angles", "dihedrals", "impropers"];

/// Names of the vectors of a general box.
const VECTORS: [&str; 4] = ["avec", "bvec", "cvec", "origin"];

impl<'a> Header<'a> {
    /// Reads the header, and returns it with the name of the first section, if the file has a section.
    pub(super) fn read(lines: &mut Lines<'a>) -> Result<(Self, Option<&'a str>), ReadError> {
        let (title, line) = lines.need("the title")?;
        let (rest, periodic) = match title.rsplit_once(", periodic = ") {
            Some((rest, sides)) if title.contains(super::WRITER) => {
                (rest, Some(["x", "y"].map(|side| sides.contains(side))))
            }
            _ => (title, None),
        };
        let time = rest.split_once(", time = ").map(|(_, time)| finite("time", time, line)).transpose();
        // In a title that another program wrote, words may follow instead of a number.
        let time = if title.contains(super::WRITER) { time? } else { time.unwrap_or(None) };
        let mut header = Self { time, periodic, ..Self::default() };
        while let Some((text, line)) = lines.next_filled() {
            if text.starts_with(char::is_alphabetic) {
                return Ok((header, Some(text)));
            }
            header.take(text.split('#').next().unwrap_or(""), line)?;
        }
        Ok((header, None))
    }

    /// Reads one line of the header into the fields.
    fn take(&mut self, text: &'a str, line: usize) -> Result<(), ReadError> {
        let words: Vec<&'a str> = text.split_whitespace().collect();
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
            [xy, xz, yz, "xy", "xz", "yz"] => {
                let tilt = |tilt| finite("a tilt of the box", tilt, line);
                once(&mut self.tilts, [tilt(xy)?, tilt(xz)?, tilt(yz)?], "`xy xz yz`", line)?;
            }
            [x, y, z, name @ ("avec" | "bvec" | "cvec")] | [x, y, z, "abc", name @ "origin"] => {
                let what = "a vector of the box";
                let vector = [finite(what, x, line)?, finite(what, y, line)?, finite(what, z, line)?];
                let index = VECTORS.iter().position(|known| *known == name).unwrap_or_default();
                once(&mut self.vectors[index], vector, &format!("`{name}`"), line)?;
            }
            [count, what] if OTHERS.contains(&what) && count != "0" => {
                self.other = Some((what, line));
            }
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
        let vectors = self.vectors;
        let is_general = vectors[..3].iter().all(Option::is_some);
        let [width, height, depth, origin] = vectors.map(|found| found.unwrap_or(([0.0; 3], line)));
        let ([left, right], [bottom, top], tilts, line, name) = if is_general {
            let ([width, a, b], [c, height, d], [e, f, _]) = (width.0, height.0, depth.0);
            let [left, bottom, _] = origin.0;
            let (sides, ends) = ([left, left + width], [bottom, bottom + height]);
            (sides, ends, vec![a, b, c, d, e, f], depth.1, "off the diagonal")
        } else {
            let (tilts, line) = self.tilts.unwrap_or(([0.0; 3], self.ends.map_or(line, |(_, line)| line)));
            let (sides, ends) = (found(self.sides, "`xlo xhi`", line), found(self.ends, "`ylo yhi`", line));
            (sides?, ends?, tilts.to_vec(), line, "xy xz yz")
        };
        if !is_upright([right - left, top - bottom], tilts.iter().copied()) {
            let found = tilts.iter().map(f64::to_string).collect::<Vec<_>>().join(" ");
            return Err(ReadError::unexpected(line, "the box", "a rectangle", format!("{found} {name}")));
        }
        checked_box(Domain::new(left, right, bottom, top), line)
    }
}

/// A value of the header, with its line.
type Found<T> = Option<(T, usize)>;

/// Stores a value that may appear only once.
fn once<T>(place: &mut Found<T>, value: T, what: &str, line: usize) -> Result<(), ReadError> {
    match place.replace((value, line)) {
        None => Ok(()),
        Some((_, first)) => Err(ReadError::Doubled { line, first, what: what.to_owned() }),
    }
}

/// Returns a required value, or an error if it is missing.
fn found<T: Copy>(place: Found<T>, what: &str, line: usize) -> Result<T, ReadError> {
    place.map(|(value, _)| value).ok_or_else(|| ReadError::missing(line, what))
}
