//! Data files of LAMMPS, so that one state can be run in both codes.

use std::cmp::Ordering;
use std::collections::HashMap;
use std::io::{self, Write};

use granular_edmd::Disk;
use granular_edmd::boundary::Domain;

use super::State;
use super::disks::sphere_mass;
use super::format::{numbered, shown_depth, shown_top};
use crate::ReadError;
use crate::lines::{Lines, Text, checked_box, finite, is_upright, whole};
use crate::table::Table;

/// Words in the title that distinguish the files of this crate from other files.
const WRITER: &str = "written by granular-edmd";

impl State {
    /// Writes a data file of LAMMPS with `atom_style sphere`, for its `read_data`.
    ///
    /// The file has the box, the diameters, densities, positions, images, velocities and angular velocities.
    /// The type of an atom is the number of its [`Kind`](granular_edmd::Kind) plus 1. LAMMPS interprets the
    /// density as the density of a sphere, `ρ = 3m / 4πR³`. An open box ends above the highest disk, and a
    /// state without a box gets one around the disks. The title names the time and the periodic directions,
    /// which LAMMPS ignores. The format has no place for angles, inertia factors and walls.
    ///
    /// A [`Reader`](super::Reader) reads the file back to the same bits, except that a mass may differ by a
    /// rounding error.
    ///
    /// # Errors
    /// If the writer fails.
    pub fn write_lammps_data(&self, mut out: impl Write) -> io::Result<()> {
        let disks = &self.disks;
        let domain = self.snapshot().domain();
        let (top, half) = (shown_top(&domain, disks), 0.5 * shown_depth(disks));
        let types = disks.iter().map(|disk| u32::from(disk.kind().number()) + 1).max().unwrap_or(1);
        write!(out, "LAMMPS data file, atom_style sphere, {WRITER}")?;
        self.time.map_or(Ok(()), |time| write!(out, ", time = {time:?}"))?;
        let sides = [(domain.periodic_sides, "x"), (domain.periodic_ends, "y")];
        let sides: String = sides.into_iter().filter(|(is_so, _)| *is_so).map(|(_, name)| name).collect();
        write!(out, ", periodic = {}", if sides.is_empty() { "none" } else { &sides })?;
        writeln!(out, "\n\n{} atoms\n{types} atom types\n", disks.len())?;
        writeln!(out, "{:?} {:?} xlo xhi\n{:?} {top:?} ylo yhi", domain.left, domain.right, domain.bottom)?;
        writeln!(out, "{:?} {half:?} zlo zhi", -half)?;
        if !disks.is_empty() {
            writeln!(out, "\nAtoms # sphere\n")?;
            numbered(disks).try_for_each(|(id, disk)| write_atom(&mut out, id, disk))?;
            writeln!(out, "\nVelocities\n")?;
            numbered(disks).try_for_each(|(id, disk)| write_velocity(&mut out, id, disk))?;
        }
        out.flush()
    }
}

fn write_atom(out: &mut impl Write, id: u64, disk: &Disk) -> io::Result<()> {
    let (position, [right, up]) = (disk.position(), disk.image());
    let (kind, diameter) = (u32::from(disk.kind().number()) + 1, 2.0 * disk.radius());
    let density = density(disk.mass(), disk.radius());
    writeln!(out, "{id} {kind} {diameter:?} {density:?} {:?} {:?} 0.0 {right} {up} 0", position.x, position.y)
}

fn write_velocity(out: &mut impl Write, id: u64, disk: &Disk) -> io::Result<()> {
    let (velocity, turning) = (disk.velocity(), disk.angular_velocity());
    writeln!(out, "{id} {:?} {:?} 0.0 0.0 0.0 {turning:?}", velocity.x, velocity.y)
}

/// Returns the density of a sphere of this mass, or a neighboring number if only that gives back the same
/// mass.
fn density(mass: f64, radius: f64) -> f64 {
    let density = mass / sphere_mass(1.0, radius);
    let near = [density, density.next_up(), density.next_down()];
    near.into_iter().find(|&density| sphere_mass(density, radius) == mass).unwrap_or(density)
}

/// The values of the header that the reader needs.
#[derive(Debug, Default)]
struct Header<'a> {
    time: Option<f64>,
    /// Periodicity of the box in x and in y, if the title names it.
    periodic: Option<[bool; 2]>,
    atoms: Found<usize>,
    sides: Found<[f64; 2]>,
    ends: Found<[f64; 2]>,
    tilts: Found<[f64; 3]>,
    /// Counts of items that disks do not have, such as bonds.
    other: Found<&'a str>,
}

/// Names of items that show another style of atoms.
const OTHERS: [&str; 8] =
    ["bodies", "ellipsoids", "lines", "triangles", "bonds", "angles", "dihedrals", "impropers"];

impl<'a> Header<'a> {
    /// Reads the header, and returns it with the name of the first section, if the file has a section.
    fn read(lines: &mut Lines<'a>) -> Result<(Self, Option<&'a str>), ReadError> {
        let end = || ReadError::End { line: 0, what: "the title".to_owned() };
        let (title, line) = lines.next().ok_or_else(end)?;
        let (rest, periodic) = match title.rsplit_once(", periodic = ") {
            Some((rest, sides)) if title.contains(WRITER) => {
                (rest, Some(["x", "y"].map(|side| sides.contains(side))))
            }
            _ => (title, None),
        };
        let time = rest.split_once(", time = ").map(|(_, time)| finite("time", time, line)).transpose();
        // In a title that another program wrote, words may follow instead of a number.
        let time = if title.contains(WRITER) { time? } else { time.unwrap_or(None) };
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
            [_, _, _, name @ ("avec" | "bvec" | "cvec")] => {
                let expected = "`xlo xhi` and `ylo yhi`, the sides of a rectangle";
                return Err(ReadError::unexpected(line, "the box", expected, format!("the vector `{name}`")));
            }
            [count, what] if OTHERS.contains(&what) && count != "0" => {
                self.other = Some((what, line));
            }
            _ => {}
        }
        Ok(())
    }

    /// Returns the number of atoms.
    fn atoms(&self, line: usize) -> Result<usize, ReadError> {
        found(self.atoms, "the number of atoms", line)
    }

    /// Returns the box.
    fn domain(&self, line: usize) -> Result<Domain, ReadError> {
        let (tilts, line) = self.tilts.unwrap_or(([0.0; 3], self.ends.map_or(line, |(_, line)| line)));
        let [left, right] = found(self.sides, "`xlo xhi`", line)?;
        let [bottom, top] = found(self.ends, "`ylo yhi`", line)?;
        if !is_upright([right - left, top - bottom], tilts) {
            let found = tilts.map(|tilt| tilt.to_string()).join(" ");
            return Err(ReadError::unexpected(line, "the box", "a rectangle", format!("{found} xy xz yz")));
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
