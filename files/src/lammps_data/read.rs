//! Data files of LAMMPS, read into a table.

use std::cmp::Ordering;
use std::collections::HashMap;

use super::header::Header;
use crate::ReadError;
use crate::lines::{Lines, Text, whole};
use crate::table::Table;
use granular_edmd::boundary::Domain;

/// Columns of an atom of the style `sphere`, and of `hybrid sphere`.
const SPHERE: &str = "id type diameter density x y z";
const HYBRID: &str = "id type x y z diameter density";

/// Returns whether a text has lines of the header of a data file.
pub(crate) fn is_data(text: &str) -> bool {
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
        if let Some(first) = self.of_id.insert(id, self.rows.len()) {
            let first = self.rows[first].1;
            return Err(ReadError::Doubled { line, first, what: format!("{what} {id}") });
        }
        self.rows.push((row, line));
        Ok(id)
    }
}

/// The sections of a file.
#[derive(Default)]
struct Sections<'a> {
    /// Columns of the atoms, whether the file names the atoms' style, and the line that may name it.
    columns: (&'a str, bool),
    line: usize,
    atoms: Section<'a>,
    velocities: Option<Section<'a>>,
    /// Masses by type, of styles in which an atom has no density.
    masses: HashMap<&'a str, &'a str>,
    /// Numbers of types by their labels.
    labels: HashMap<&'a str, &'a str>,
    /// An item that only other styles have, with its line.
    other: Option<(&'a str, usize)>,
}

/// Reads a data file.
pub(crate) fn table(text: &Text) -> Result<Table, ReadError> {
    let mut lines = text.lines()?;
    let (header, mut section) = Header::read(&mut lines)?;
    let count = header.atoms(lines.line())?;
    let domain = header.domain(lines.line())?;
    let mut sections = Sections { other: header.other, columns: (SPHERE, false), ..Sections::default() };
    while let Some(name) = section {
        section = sections.read(&mut lines, name)?;
    }
    sections.check(count, lines.line())?;
    let mut table = sections.table(domain, header.periodic)?;
    table.time = header.time;
    if !sections.columns.1 {
        table.notes.push(format!(
            "the atoms are read as those of the style `sphere` ({SPHERE}), since the file does not name it; \
             `Atoms # full` would name another"
        ));
    }
    Ok(table)
}

impl<'a> Sections<'a> {
    /// Reads a section, and returns the name of the next section, or `None` after the last one.
    fn read(&mut self, lines: &mut Lines<'a>, name: &'a str) -> Result<Option<&'a str>, ReadError> {
        let Self { atoms, labels, masses, .. } = self;
        match words(name)[..] {
            ["Atoms"] => {
                (self.columns, self.line) = (columns(name, lines.line())?, lines.line());
                read_section(lines, |row, line| atoms.add("the atom", row, line).map(drop))
            }
            ["Velocities"] => {
                let section = self.velocities.get_or_insert_default();
                read_section(lines, |row, line| {
                    let id = section.add("the velocity of atom", row, line)?;
                    let missing = || format!("the atom {id}, which has a velocity here,");
                    let is_there = atoms.of_id.contains_key(&id);
                    is_there.then_some(()).ok_or_else(|| ReadError::missing(line, missing()))
                })
            }
            ["Atom", "Type", "Labels"] => read_section(lines, |row, _| {
                if let [number, label] = words(row)[..] {
                    labels.insert(label, number);
                }
                Ok(())
            }),
            ["Masses"] => {
                self.other = self.other.or(Some((name, lines.line())));
                read_section(lines, |row, _| {
                    if let [number, mass] = words(row)[..] {
                        masses.insert(number, mass);
                    }
                    Ok(())
                })
            }
            ["Bodies" | "Ellipsoids" | "Lines" | "Triangles" | "Bonds"] => {
                self.other = self.other.or(Some((name, lines.line())));
                read_section(lines, |_, _| Ok(()))
            }
            _ => read_section(lines, |_, _| Ok(())),
        }
    }

    /// Checks that the atoms are of the style `sphere`, and that none is missing.
    fn check(&self, count: usize, line: usize) -> Result<(), ReadError> {
        if let (false, Some((other, line))) = (self.columns.1, self.other) {
            let found = format!("one with `{other}`");
            return Err(ReadError::unexpected(line, "the style of atoms", "`sphere`", found));
        }
        check_number("atom", self.atoms.rows.len(), count, line)?;
        let velocities = self.velocities.as_ref();
        velocities.map_or(Ok(()), |section| check_number("velocity", section.rows.len(), count, line))
    }

    /// Returns the table of the disks. If the file does not say where the box is periodic, an image other
    /// than 0 makes it periodic, since disks cross only periodic sides.
    fn table(&self, mut domain: Domain, periodic: Option<[bool; 2]>) -> Result<Table, ReadError> {
        let mut names: Vec<&str> = self.columns.0.split_whitespace().collect();
        let (kind, size) = (names.iter().position(|&name| name == "type"), names.len());
        let has_images = self.atoms.rows.first().is_some_and(|(row, _)| words(row).len() == size + 3);
        names.extend(["ix", "iy", "iz"].iter().filter(|_| has_images));
        let has_spins = names.contains(&"diameter");
        let others = match &self.velocities {
            Some(_) if has_spins => "vx vy vz wx wy wz",
            Some(_) => "vx vy vz",
            None => "",
        };
        let has_masses = !has_spins && !self.masses.is_empty();
        let others = others.split_whitespace().chain(has_masses.then_some("mass"));
        let mut sides = periodic.unwrap_or_default();
        let mut table = Table::of_lammps(names.iter().copied().chain(others), self.line);
        for &(row, line) in &self.atoms.rows {
            let mut atom = words(row);
            if atom.len() != names.len() {
                let columns = format!("of {size} or {} columns ({})", size + 3, self.columns.0);
                return Err(ReadError::unexpected(line, "an atom", columns, atom.join(" ")));
            }
            if let Some(kind) = kind.and_then(|kind| atom.get_mut(kind)) {
                *kind = self.labels.get(kind).copied().unwrap_or(kind);
            }
            if let (None, [right, up, _]) = (periodic, &atom[size..]) {
                sides[0] |= whole::<i32>("an image", right, line)? != 0;
                sides[1] |= whole::<i32>("an image", up, line)? != 0;
            }
            let mass =
                kind.filter(|_| has_masses).map(|kind| self.masses.get(atom[kind]).copied().unwrap_or("1"));
            table
                .push(atom.into_iter().chain(self.velocity(id(row, line)?, has_spins)?).chain(mass), line)?;
        }
        [domain.periodic_sides, domain.periodic_ends] = sides;
        table.domain = Some(domain);
        if periodic.is_none() {
            table.notes.push(guess(sides));
        }
        // The names of kinds, from number 0 to the first missing name.
        let of_number: HashMap<&str, &str> =
            self.labels.iter().map(|(label, number)| (*number, *label)).collect();
        let names = (1..).map_while(|number: usize| of_number.get(number.to_string().as_str()));
        table.kind_names = names.map(|&name| name.to_owned()).collect();
        Ok(table)
    }

    /// Returns the velocity and the angular velocity of an atom, if the file has velocities.
    fn velocity(&self, id: u64, has_spins: bool) -> Result<Vec<&'a str>, ReadError> {
        let found = self.velocities.as_ref().and_then(|section| Some(section.rows[*section.of_id.get(&id)?]));
        let Some((row, line)) = found else { return Ok(Vec::new()) };
        let cells = words(row);
        let size = if has_spins { 7 } else { 4 };
        if cells.len() == size {
            return Ok(cells[1..].to_vec());
        }
        Err(ReadError::unexpected(line, "a velocity", format!("of {size} columns"), cells.join(" ")))
    }
}

/// Returns the note about a box whose file does not say where it is periodic.
fn guess(sides: [bool; 2]) -> String {
    let directions = match sides {
        [true, true] => "x and y",
        [true, false] => "x only",
        [false, true] => "y only",
        [false, false] => {
            return "no side is periodic, since the file does not say which are, and all images are 0"
                .to_owned();
        }
    };
    let reason = "since the file does not say where it is, and images along it are not 0";
    format!("the box is periodic in {directions}, {reason}")
}

/// Reads the rows of a section, and returns the name of the next section, or `None` after the last one.
fn read_section<'a>(
    lines: &mut Lines<'a>,
    mut take: impl FnMut(&'a str, usize) -> Result<(), ReadError>,
) -> Result<Option<&'a str>, ReadError> {
    while let Some((text, line)) = lines.next_filled() {
        if text.starts_with(char::is_alphabetic) {
            return Ok(Some(text));
        }
        if !text.starts_with('#') {
            take(text, line)?;
        }
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

/// Columns of styles without radii.
const STYLES: [(&str, &str); 6] = [
    ("atomic", "id type x y z"),
    ("charge", "id type q x y z"),
    ("bond", "id molecule type x y z"),
    ("angle", "id molecule type x y z"),
    ("molecular", "id molecule type x y z"),
    ("full", "id molecule type q x y z"),
];

/// Returns the columns of the style that the comment after `Atoms` names, and whether it names the style
/// `sphere`. The comment may list the names of the columns after the style. LAMMPS writes the style `hybrid`
/// without names.
fn columns(name: &str, line: usize) -> Result<(&str, bool), ReadError> {
    let style = name.split_once('#').map_or("", |(_, style)| style.trim());
    let words: Vec<&str> = style.split_whitespace().collect();
    match words[..] {
        [] => Ok((SPHERE, false)),
        ["sphere"] => Ok((SPHERE, true)),
        ["hybrid"] => Ok((HYBRID, false)),
        ["hybrid", "sphere"] => Ok((HYBRID, true)),
        ["sphere", ..] if words.contains(&"diameter") => Ok((style.trim_start_matches("sphere"), true)),
        _ => {
            let known = STYLES.iter().find(|(name, _)| *name == style).map(|(_, columns)| (*columns, true));
            known.ok_or_else(|| ReadError::unexpected(line, "the style of atoms", "`sphere`", style))
        }
    }
}
