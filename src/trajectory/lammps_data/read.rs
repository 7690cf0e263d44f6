//! Data files of LAMMPS, read into a table.

use std::cmp::Ordering;
use std::collections::HashMap;
use std::iter;

use super::header::Header;
use crate::trajectory::ReadError;
use crate::trajectory::lines::{Lines, Text, whole};
use crate::trajectory::table::Table;

/// Columns of an atom and its velocity.
const COLUMNS: &str = "id type diameter density x y z ix iy iz vx vy vz wx wy wz";

/// Returns whether a text has lines of the header of a data file.
pub(in crate::trajectory) fn is_data(text: &str) -> bool {
    text.lines().skip(1).any(|line| matches!(words(line)[..], [_, "atoms"] | [_, _, "xlo", "xhi"]))
}

/// Rows of a section by the ids of their atoms, in the order of the file.
#[derive(Default)]
struct Section<'a> {
    rows: Vec<(&'a str, usize)>,
    of_id: HashMap<u64, usize>,
}

impl<'a> Section<'a> {
    fn add(&mut self, what: &str, row: &'a str, line: usize) -> Result<u64, ReadError> {
        let id = id(row, line)?;
        match self.of_id.insert(id, self.rows.len()) {
            Some(first) => {
                Err(ReadError::Doubled { line, first: self.rows[first].1, what: format!("{what} {id}") })
            }
            None => {
                self.rows.push((row, line));
                Ok(id)
            }
        }
    }
}

/// Reads a data file.
pub(in crate::trajectory) fn table(text: &Text) -> Result<Table, ReadError> {
    let mut lines = text.lines()?;
    let (header, mut section) = Header::read(&mut lines)?;
    let count = header.atoms(lines.line())?;
    let domain = header.domain(lines.line())?;
    let (mut atoms, mut velocities) = (Section::default(), None);
    while let Some(name) = section {
        section = match words(name).first().copied() {
            Some("Atoms") => {
                check_style(name, lines.line())?;
                read_section(&mut lines, |row, line| atoms.add("the atom", row, line).map(drop))?
            }
            Some("Velocities") => {
                let section = velocities.get_or_insert_with(Section::default);
                read_section(&mut lines, |row, line| {
                    let id = section.add("the velocity of atom", row, line)?;
                    let missing = || format!("the atom {id}, which has a velocity here,");
                    let is_there = atoms.of_id.contains_key(&id);
                    is_there.then_some(()).ok_or_else(|| ReadError::missing(line, missing()))
                })?
            }
            _ => read_section(&mut lines, |_, _| Ok(()))?,
        };
    }
    check_number("atom", atoms.rows.len(), count, lines.line())?;
    if let Some(velocities) = &velocities {
        check_number("velocity", velocities.rows.len(), count, lines.line())?;
    }
    let mut table = Table::of_lammps(COLUMNS.split(' '), lines.line())?;
    for &(row, line) in &atoms.rows {
        let (atom, velocity) = (atom(row, line)?, velocity(velocities.as_ref(), id(row, line)?)?);
        table.push(atom.into_iter().chain(velocity), line)?;
    }
    (table.domain, table.time) = (Some(domain), header.time);
    Ok(table)
}

/// Reads the rows of a section, and returns the name of the next one, if there is one.
fn read_section<'a>(
    lines: &mut Lines<'a>,
    mut take: impl FnMut(&'a str, usize) -> Result<(), ReadError>,
) -> Result<Option<&'a str>, ReadError> {
    while let Some((text, line)) = lines.next_filled() {
        if text.starts_with(char::is_alphabetic) {
            return Ok(Some(text));
        }
        take(text, line)?;
    }
    Ok(None)
}

/// Checks that a section has a line for each atom: a file that was cut has fewer.
fn check_number(what: &str, found: usize, count: usize, line: usize) -> Result<(), ReadError> {
    match found.cmp(&count) {
        Ordering::Less => Err(ReadError::End { line, what: format!("{what} {} of {count}", found + 1) }),
        Ordering::Equal => Ok(()),
        Ordering::Greater => {
            Err(ReadError::unexpected(line, "the number of atoms", count.to_string(), found.to_string()))
        }
    }
}

/// Returns the words before a comment.
fn words(text: &str) -> Vec<&str> {
    text.split('#').next().unwrap_or("").split_whitespace().collect()
}

/// Returns the id with which a row begins.
fn id(row: &str, line: usize) -> Result<u64, ReadError> {
    whole("id", row.split_whitespace().next().unwrap_or_default(), line)
}

/// Checks the style of atoms, if the file names it.
fn check_style(name: &str, line: usize) -> Result<(), ReadError> {
    match name.split_once('#').map(|(_, style)| style.trim()) {
        None | Some("sphere") => Ok(()),
        Some(style) => Err(ReadError::unexpected(line, "the style of atoms", "`sphere`", style)),
    }
}

/// Returns the cells of an atom: its number, type, diameter, density, position, and periods that it has passed.
fn atom(row: &str, line: usize) -> Result<Vec<&str>, ReadError> {
    let cells = words(row);
    match cells.len() {
        7 => Ok(cells.into_iter().chain(iter::repeat_n("0", 3)).collect()),
        10 => Ok(cells),
        _ => {
            let columns = "of 7 or 10 columns, as `sphere` has them";
            Err(ReadError::unexpected(line, "an atom", columns, cells.join(" ")))
        }
    }
}

/// Returns the velocity and the angular velocity of an atom, or zeros if the file has no velocities.
fn velocity<'a>(velocities: Option<&Section<'a>>, id: u64) -> Result<Vec<&'a str>, ReadError> {
    let found = velocities.and_then(|section| Some(section.rows[*section.of_id.get(&id)?]));
    let Some((row, line)) = found else { return Ok(vec!["0"; 6]) };
    let cells = words(row);
    match cells.len() {
        7 => Ok(cells[1..].to_vec()),
        _ => Err(ReadError::unexpected(line, "a velocity", "of 7 columns", cells.join(" "))),
    }
}
