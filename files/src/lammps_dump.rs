//! Dumps of LAMMPS.

use std::io::{self, BufRead, Write};

use granular_edmd::Disk;
use granular_edmd::boundary::Domain;

use super::format::{no_frame, numbered, shown_depth, shown_top, skip_lines, whole_line};
use super::{Frame, FrameFormat};
use crate::ReadError;
use crate::column::Quantity;
use crate::lines::{Input, Text, as_whole, checked_box, finite, is_upright, number, whole};
use crate::table::{Found, Table};

/// The dump format of LAMMPS, as `dump custom` writes it.
///
/// | column | |
/// |---|---|
/// | `id`, `type` | id of the disk in the run; number of its [`Kind`](granular_edmd::Kind) plus 1 |
/// | `x y z`, `xu yu` | position of the center, also unwrapped; `z` is 0 |
/// | `ix iy` | periods that the disk has passed to the right and up |
/// | `vx vy` | velocity of the center |
/// | `angle`, `omegaz` | angle and angular velocity in radians, counterclockwise |
/// | `radius`, `mass` | of the disk |
/// | `v_time` | time of the frame |
///
/// The time step is the number of the frame. Periodic directions are `pp`, walls are `ff`. An open box is
/// `fs`, and ends above the highest disk. The format has no place for inertia factors, gravity and walls that
/// move.
///
/// The time is a column, since some programs, such as MDAnalysis, do not know `ITEM: TIME`. Only a frame
/// without disks has that item.
///
/// ```
/// use granular_edmd::boundary::Domain;
/// use granular_edmd::observable::Snapshot;
/// use granular_edmd_files::{Frame, FrameFormat, LammpsDump};
/// # use granular_edmd::{Disk, glam::DVec2};
///
/// let disks = [Disk::new(DVec2::new(1.0, 2.0), 0.5)?];
/// let snapshot = Snapshot::new(2.5, &disks, Domain::new(0.0, 4.0, 0.0, 6.0).with_periodic_sides(), 1.0);
/// let mut text = Vec::new();
/// LammpsDump.write_frame(&Frame::new(0, &snapshot), &mut text)?;
/// let text = String::from_utf8(text)?;
/// assert!(text.starts_with("ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n1\n"));
/// assert!(text.contains("ITEM: BOX BOUNDS pp ff pp\n0.0 4.0\n0.0 6.0\n"));
/// assert!(text.ends_with(" 0.5 1.0 2.5\n"), "radius, mass and time");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, Default)]
pub struct LammpsDump;

/// The line above the disks.
const COLUMNS: &str = "ITEM: ATOMS id type x y z xu yu ix iy vx vy angle omegaz radius mass v_time";

impl FrameFormat for LammpsDump {
    fn write_frame(&self, frame: &Frame<'_>, out: &mut dyn Write) -> io::Result<()> {
        let snapshot = frame.snapshot();
        let (time, domain, disks) = (snapshot.time(), snapshot.domain(), snapshot.disks());
        let (top, half) = (shown_top(&domain, disks), 0.5 * shown_depth(disks));
        let sides = if domain.periodic_sides { "pp" } else { "ff" };
        let open = if domain.top.is_finite() { "ff" } else { "fs" };
        let ends = if domain.periodic_ends { "pp" } else { open };
        if disks.is_empty() {
            writeln!(out, "ITEM: TIME\n{time:?}")?;
        }
        writeln!(out, "ITEM: TIMESTEP\n{}\nITEM: NUMBER OF ATOMS\n{}", frame.number(), disks.len())?;
        writeln!(out, "ITEM: BOX BOUNDS {sides} {ends} pp\n{:?} {:?}", domain.left, domain.right)?;
        writeln!(out, "{:?} {top:?}\n{:?} {half:?}\n{COLUMNS}", domain.bottom, -half)?;
        numbered(disks).try_for_each(|(id, disk)| {
            write_disk(out, id, disk, &domain)?;
            writeln!(out, " {time:?}")
        })
    }

    fn skip_frame(&self, input: &mut dyn BufRead) -> io::Result<Option<f64>> {
        match whole_frame(input) {
            Err(error) if error.kind() == io::ErrorKind::UnexpectedEof => Ok(None),
            time => time.map(Some),
        }
    }
}

/// Skips a frame, and returns its time, or an error if the frame is cut short.
fn whole_frame(input: &mut dyn BufRead) -> io::Result<f64> {
    let (mut name, mut time) = (line(input)?, None);
    if name == "ITEM: TIME" {
        time = Some(line(input)?);
        name = line(input)?;
    }
    check("ITEM: TIMESTEP", &name)?;
    line(input)?;
    check("ITEM: NUMBER OF ATOMS", &line(input)?)?;
    let count = line(input)?;
    let count: usize = count.parse().map_err(|_| no_frame("a number of atoms", &count))?;
    check("ITEM: BOX BOUNDS", &line(input)?)?;
    (0..3).try_for_each(|_| line(input).map(drop))?;
    let columns = line(input)?;
    if columns != COLUMNS {
        return Err(no_frame("the columns of this version", &columns));
    }
    let is_in_row = time.is_none() && count > 0;
    let time = if is_in_row { line(input)? } else { time.unwrap_or_default() };
    let time = time.rsplit(' ').next().unwrap_or_default();
    let time = time.parse().map_err(|_| no_frame("a time", time))?;
    let is_whole = skip_lines(input, count - usize::from(is_in_row))?;
    if is_whole { Ok(time) } else { Err(io::ErrorKind::UnexpectedEof.into()) }
}

/// Returns the next line, which must be complete.
fn line(input: &mut dyn BufRead) -> io::Result<String> {
    whole_line(input)?.ok_or_else(|| io::ErrorKind::UnexpectedEof.into())
}

/// Checks that a line begins with this name.
fn check(name: &str, line: &str) -> io::Result<()> {
    if line.starts_with(name) { Ok(()) } else { Err(no_frame(&format!("`{name}`"), line)) }
}

fn write_disk(out: &mut dyn Write, id: u64, disk: &Disk, domain: &Domain) -> io::Result<()> {
    let (position, velocity, unwrapped) = (disk.position(), disk.velocity(), domain.unwrapped(disk));
    let [right, up] = disk.image();
    write!(out, "{id} {} {:?} {:?} 0.0 ", u32::from(disk.kind().number()) + 1, position.x, position.y)?;
    write!(out, "{:?} {:?} {right} {up} {:?} {:?} ", unwrapped.x, unwrapped.y, velocity.x, velocity.y)?;
    write!(out, "{:?} {:?} ", disk.angle(), disk.angular_velocity())?;
    write!(out, "{:?} {:?}", disk.radius(), disk.mass())
}

/// The column of the time, which is the same for all disks.
const TIME: &str = "v_time";

/// The lines above the disks of a frame, with their numbers.
#[derive(Default)]
struct Head {
    time: Option<(String, usize)>,
    /// The words after `BOX BOUNDS`, and the three lines below.
    bounds: Option<(String, [(String, usize); 3])>,
}

/// Reads the next frame of a file.
pub(crate) fn next<'a, R: BufRead>(input: &mut Input<R>) -> Result<Option<Found<'a>>, ReadError> {
    let (mut head, mut step, mut count) = (Head::default(), None, None);
    let Some((mut item, mut line)) = input.next_filled()? else { return Ok(None) };
    loop {
        let [name, rest] = item.strip_prefix("ITEM:").map_or([""; 2], |item| name_and_rest(item.trim()));
        let value = format!("the value of `{name}`");
        match [name, rest] {
            ["TIMESTEP", _] => {
                let (text, line) = input.need(&value)?;
                let number = number("the time step", &text, line)?;
                step = as_whole(&text).or(Some(number as u64).filter(|_| number >= 0.0));
            }
            ["NUMBER OF ATOMS", _] => {
                let (text, line) = input.need(&value)?;
                count = Some(whole("the number of atoms", &text, line)?);
            }
            ["TIME", _] => head.time = Some(input.need(&value)?),
            ["UNITS", _] => drop(input.need(&value)?),
            ["BOX BOUNDS", words] => {
                let bounds = [input.need(&value)?, input.need(&value)?, input.need(&value)?];
                head.bounds = Some((words.to_owned(), bounds));
            }
            ["ATOMS", names] => {
                let count = count.ok_or_else(|| ReadError::missing(line, "`ITEM: NUMBER OF ATOMS`"))?;
                let (names, rows) = (names.to_owned(), input.copy_disks(count)?);
                return Ok(Some(Found::in_text(rows, step, move |rows| head.table(&names, line, rows))));
            }
            _ => {
                let known = "`ITEM:` with TIMESTEP, TIME, UNITS, NUMBER OF ATOMS, BOX BOUNDS or ATOMS";
                return Err(ReadError::unexpected(line, "a line between frames", known, &item));
            }
        }
        (item, line) = input.need("`ITEM: ATOMS`")?;
    }
}

/// Divides an item into its name and the words after it.
fn name_and_rest(item: &str) -> [&str; 2] {
    let mut with_words = ["BOX BOUNDS", "ATOMS"].into_iter();
    let found = with_words.find_map(|name| Some([name, item.strip_prefix(name)?.trim()]));
    found.unwrap_or([item, ""])
}

impl Head {
    /// Reads the disks.
    fn table(&self, names: &str, line: usize, rows: &Text) -> Result<Table, ReadError> {
        let mut table = Table::of_lammps(names.split_whitespace(), line);
        table.labels.extend(names.split_whitespace().position(|name| name == TIME));
        table.is_own = table.has(Quantity::Angle, 0);
        table.time = self.time.as_ref().map(|(time, line)| finite("the time", time, *line)).transpose()?;
        if let Some((words, bounds)) = &self.bounds {
            let [extent, domain] = domains(words, bounds)?;
            (table.extent, table.domain) = (Some(extent), Some(domain));
            if flags(words).is_none() {
                table.notes.push("no side is periodic, since the dump does not say which are".to_owned());
            }
        }
        let at = names.split_whitespace().position(|name| name == TIME);
        for (row, line) in rows.lines()? {
            if let (None, Some(at)) = (table.time, at) {
                let cell = row.split_whitespace().nth(at).unwrap_or_default();
                table.time = Some(finite("the time", cell, line)?);
            }
            table.push(row.split_whitespace(), line)?;
        }
        Ok(table)
    }
}

/// Returns the letters of the three directions: `p` for periodic, `f` for a wall, `s` and `m` for sides
/// around the disks.
fn flags(words: &str) -> Option<[&str; 3]> {
    let words: Vec<&str> = words.split_whitespace().collect();
    let flags = *words.last_chunk()?;
    let is_flag = |word: &str| word.len() == 2 && word.bytes().all(|letter| b"pfsm".contains(&letter));
    flags.into_iter().all(is_flag).then_some(flags)
}

/// Returns the box in the file, and the actual box, which is open if its top is not a wall.
fn domains(words: &str, bounds: &[(String, usize); 3]) -> Result<[Domain; 2], ReadError> {
    let read = |(text, line): &(String, usize)| -> Result<Vec<f64>, ReadError> {
        text.split_whitespace().map(|number| finite("a side of the box", number, *line)).collect()
    };
    let [x, y, z] = [read(&bounds[0])?, read(&bounds[1])?, read(&bounds[2])?];
    let line = bounds[1].1;
    if words.contains("xy") && [&x, &y, &z].iter().any(|side| side.len() != 3) {
        return Err(ReadError::unexpected(bounds[0].1, "the box", "three lines of 3 numbers", &bounds[0].0));
    }
    let (sides, tilts) = match [&x[..], &y[..], &z[..]] {
        [&[left, right], &[bottom, top], _] => ([left, right, bottom, top], [0.0; 3]),
        [&[left, right, a], &[bottom, top, b], &[_, _, c]] => ([left, right, bottom, top], [a, b, c]),
        _ => {
            return Err(ReadError::unexpected(
                line,
                "the box",
                "three lines of 2 or 3 numbers",
                &bounds[1].0,
            ));
        }
    };
    let [left, right, bottom, top] = sides;
    if !is_upright([right - left, top - bottom], tilts) {
        return Err(ReadError::unexpected(bounds[0].1, "the box", "a rectangle", &bounds[0].0));
    }
    let [sides, ends, _] = flags(words).unwrap_or(["ff"; 3]);
    let extent = Domain::new(left, right, bottom, top);
    let mut domain = checked_box(extent, line)?;
    domain.top = if ends.ends_with(['s', 'm']) { f64::INFINITY } else { top };
    (domain.periodic_sides, domain.periodic_ends) = (sides == "pp", ends == "pp");
    Ok([extent, domain])
}
