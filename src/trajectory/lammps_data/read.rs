//! Data files of LAMMPS, read into disks.

use std::cmp::Ordering;
use std::collections::BTreeMap;
use std::io::BufRead;

use glam::DVec2;

use super::header::Header;
use crate::Kind;
use crate::trajectory::entry::{Draft, Entry, flat};
use crate::trajectory::lines::{Lines, number, whole};
use crate::trajectory::{ReadError, State};

/// The atoms of a file by their numbers, with their lines.
type Atoms = BTreeMap<u64, (usize, Draft)>;

/// The number of the line with the velocity of each atom.
type Seen = BTreeMap<u64, usize>;

impl State {
    /// Reads a data file of LAMMPS with `atom_style sphere`, as its command `write_data` writes it.
    ///
    /// Disks come in the order of the atoms' numbers. The kind of a disk is the type of its atom minus 1. The
    /// mass is that of a sphere, `m = 4π/3 ρR³`. Without a section of velocities, all are at rest. The box
    /// has walls on all sides, since the file does not say which directions are periodic. Other sections are
    /// skipped. Particles that overlap, as soft ones do, are an error here, as in any other file.
    ///
    /// # Errors
    /// If the input fails, the box, the number of atoms, an atom or one of the velocities is missing, an atom
    /// or a velocity appears twice, the atom style is not `sphere`, a number cannot be read or is out of
    /// range, a third component is not 0, or disks overlap or are outside the box. The error names the line.
    ///
    /// ```
    /// use granular_edmd::trajectory::State;
    /// let data = "title\n\n1 atoms\n1 atom types\n\n0 4 xlo xhi\n0 6 ylo yhi\n\n\
    ///             Atoms # sphere\n\n1 1 1.0 1.5 2.0 3.0 0.0\n";
    /// let state = State::from_lammps_data(data.as_bytes())?;
    /// assert_eq!(state.disks()[0].radius(), 0.5);
    /// assert!((state.disks()[0].mass() - 0.25 * std::f64::consts::PI).abs() < 1e-15);
    /// # Ok::<(), granular_edmd::trajectory::ReadError>(())
    /// ```
    pub fn from_lammps_data(input: impl BufRead) -> Result<Self, ReadError> {
        let mut lines = Lines::new(input);
        let (header, mut section) = Header::read(&mut lines)?;
        let count = header.atoms(lines.line())?;
        let domain = header.domain(lines.line())?;
        let (mut atoms, mut seen, mut has_velocities) = (Atoms::new(), Seen::new(), false);
        while let Some(name) = section {
            section = match words(&name).first().copied() {
                Some("Atoms") => {
                    check_style(&name, lines.line())?;
                    read_section(&mut lines, |cells, line| add_atom(&mut atoms, cells, line))?
                }
                Some("Velocities") => {
                    has_velocities = true;
                    read_section(&mut lines, |cells, line| add_velocity(&mut atoms, &mut seen, cells, line))?
                }
                _ => read_section(&mut lines, |_, _| Ok(()))?,
            };
        }
        check_number("atom", atoms.len(), count, lines.line())?;
        if has_velocities {
            check_number("velocity", seen.len(), count, lines.line())?;
        }
        let entries = atoms.into_values().map(|(line, draft)| draft.entry(line));
        let disks = Entry::checked(entries.collect::<Result<_, _>>()?, Some(&domain))?;
        Ok(Self { disks, domain: Some(domain), time: header.time, gravity: None })
    }
}

/// Reads the lines of a section, and returns the name of the next one, if there is one.
fn read_section<R: BufRead>(
    lines: &mut Lines<R>,
    mut take: impl FnMut(&[&str], usize) -> Result<(), ReadError>,
) -> Result<Option<String>, ReadError> {
    while let Some((text, line)) = lines.next_filled()? {
        if text.starts_with(char::is_alphabetic) {
            return Ok(Some(text.to_owned()));
        }
        take(&words(text), line)?;
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

/// Checks the style of atoms, if the file names it.
fn check_style(name: &str, line: usize) -> Result<(), ReadError> {
    match name.split_once('#').map(|(_, style)| style.trim()) {
        None | Some("sphere") => Ok(()),
        Some(style) => Err(ReadError::unexpected(line, "the style of atoms", "`sphere`", style)),
    }
}

/// Adds an atom from its number, type, diameter, density, position, and the periods that it has passed if
/// they are given.
fn add_atom(atoms: &mut Atoms, cells: &[&str], line: usize) -> Result<(), ReadError> {
    let wrong = || {
        let columns = "of 7 or 10 columns, as `sphere` has them";
        ReadError::unexpected(line, "an atom", columns, cells.join(" "))
    };
    let (&[id, kind, diameter, density, x, y, z], image) = cells.split_first_chunk().ok_or_else(wrong)?;
    let image = match *image {
        [] => [0; 2],
        [right, up, _] => [whole("image", right, line)?, whole("image", up, line)?],
        _ => return Err(wrong()),
    };
    flat(z, line)?;
    let radius = 0.5 * number("diameter", diameter, line)?;
    let id = whole("id", id, line)?;
    let draft = Draft {
        id: Some(id),
        kind: of_type(kind, line)?,
        position: DVec2::new(number("x", x, line)?, number("y", y, line)?),
        radius,
        mass: Some(super::mass(number("density", density, line)?, radius)),
        image,
        ..Draft::default()
    };
    match atoms.insert(id, (line, draft)) {
        None => Ok(()),
        Some((first, _)) => Err(ReadError::Doubled { line, first, what: format!("the atom {id}") }),
    }
}

/// Returns the kind for an atom type.
fn of_type(kind: &str, line: usize) -> Result<Kind, ReadError> {
    let number = whole::<u32>("type", kind, line)?.checked_sub(1).and_then(|kind| u16::try_from(kind).ok());
    let number = number.ok_or_else(|| ReadError::unexpected(line, "type", "from 1 to 65536", kind))?;
    Ok(Kind::new(number))
}

/// Adds the velocity and the angular velocity of an atom.
fn add_velocity(atoms: &mut Atoms, seen: &mut Seen, cells: &[&str], line: usize) -> Result<(), ReadError> {
    let &[id, vx, vy, vz, _, _, turning] = cells else {
        return Err(ReadError::unexpected(line, "a velocity", "of 7 columns", cells.join(" ")));
    };
    flat(vz, line)?;
    let id = whole("id", id, line)?;
    if let Some(first) = seen.insert(id, line) {
        return Err(ReadError::Doubled { line, first, what: format!("the velocity of atom {id}") });
    }
    let Some((_, atom)) = atoms.get_mut(&id) else {
        return Err(ReadError::missing(line, format!("the atom {id}, which has a velocity here,")));
    };
    atom.velocity = DVec2::new(number("vx", vx, line)?, number("vy", vy, line)?);
    atom.angular_velocity = number("angular velocity", turning, line)?;
    Ok(())
}
