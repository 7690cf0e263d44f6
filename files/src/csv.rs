//! Disks as a table of comma-separated values.

use std::collections::HashMap;
use std::io::{self, Write};

use super::column::{Column, FRAMES, TIMES, name_and_unit, plain};
use super::format::numbered;
use super::lines::{Lines, Text, as_whole, finite, lossy};
use super::table::Table;
use super::table::{Found, Settings, TORN};
use super::{ReadError, State};

/// Units that need no conversion; `sigma` is the reduced unit of length of many programs.
const UNITS: [&str; 10] =
    ["", "1", "rad", "length", "sigma", "time", "mass", "length/time", "1/time", "rad/time"];

/// Units of angles that are no radians.
const DEGREES: [&str; 4] = ["deg", "degree", "degrees", "°"];

/// Reads a table whose first line names the columns. A column that numbers frames, or else one of times,
/// divides the rows into frames.
///
/// Commas, semicolons, tabs or spaces separate the cells; the line of names shows which. A line that begins
/// with `#` is a comment, unless it holds the names.
pub(super) fn frames<'a>(text: &Text) -> Result<Vec<Found<'a>>, ReadError> {
    let mut lines = text.lines()?;
    let mut head = Head::read(&mut lines)?;
    let [frame, time] = [FRAMES, TIMES].map(|names| head.place_of(names));
    let divider = head.divider;
    let rows = lines.map(|(row, line)| (row.trim(), line));
    let mut rows = rows.filter(|(row, _)| !row.is_empty() && !row.starts_with('#')).peekable();
    // A cell that begins like a number is one that cannot be read, and so is the mark of a missing one.
    let is_word = |cell: &str| {
        let is_like_a_number =
            cell.starts_with(|first: char| first.is_ascii_digit() || "+-.,".contains(first));
        cell.parse::<f64>().is_err() && !is_like_a_number && !cell.eq_ignore_ascii_case("na")
    };
    let has_words =
        |row| cells(row, divider).all(is_word) && cells(row, divider).count() == head.columns.len();
    // TrackMate writes more names and units below the names.
    let skipped = std::iter::from_fn(|| rows.next_if(|(row, _)| has_words(row))).count();
    if skipped > 0 {
        head.notes.push(format!("lines without numbers below the names, skipped: {skipped}"));
    }
    let mut groups: Vec<(f64, Table)> = Vec::new();
    let mut of_key: HashMap<u64, usize> = HashMap::new();
    for (row, line) in rows {
        let number = |place: Option<usize>| {
            let found = place.and_then(|place| Some((place, cells(row, divider).nth(place)?)));
            found.map(|(place, cell)| finite(&head.columns[place].name, cell, line)).transpose()
        };
        let now = number(time)?;
        let key = number(frame)?.or(now).unwrap_or_default() + 0.0;
        let index = *of_key.entry(key.to_bits()).or_insert(groups.len());
        if index == groups.len() {
            groups.push((key, head.table(now)));
        }
        let table = &mut groups[index].1;
        table.push(cells(row, divider), line)?;
        if let (Some(place), Some(now)) = (time.filter(|_| table.time != now), now) {
            let requirement = "the same in all rows of a frame";
            return Err(ReadError::unexpected(line, &head.columns[place].name, requirement, now.to_string()));
        }
    }
    if groups.is_empty() {
        groups.push((0.0, head.table(None)));
    }
    groups.sort_by(|a, b| a.0.total_cmp(&b.0));
    let count = groups.len();
    let found = groups.into_iter().enumerate().map(|(number, (key, mut table))| {
        table.labels.extend([frame, time].into_iter().flatten());
        if let (Some(place), true) = (frame.or(time), count > 1) {
            let name = &head.columns[place].name;
            table.notes.push(format!("this is frame {number} of {count} by `{name}`"));
        }
        if text.is_torn() {
            table.notes.push(TORN.to_owned());
        }
        Found { step: as_whole(&key.to_string()), read: Box::new(|_: &Settings| Ok(table)) }
    });
    Ok(found.collect())
}

/// The names of the columns, and notes about them.
struct Head {
    columns: Vec<Column>,
    line: usize,
    divider: Option<char>,
    notes: Vec<String>,
}

impl Head {
    /// Finds the line of names.
    fn read(lines: &mut Lines<'_>) -> Result<Self, ReadError> {
        let mut first = None;
        while let Some((raw, line)) = lines.by_ref().find(|(text, _)| !text.trim().is_empty()) {
            let text = raw.trim();
            let is_comment = text.starts_with('#');
            let next = lines.clone().next_filled().map_or("", |(text, _)| text);
            let is_above_rows = !next.starts_with(|letter: char| letter == '#' || letter.is_alphabetic());
            first.get_or_insert((line, text));
            if text.starts_with("sep=") || is_comment && !is_above_rows {
                continue;
            }
            let head = Self::of(text.trim_start_matches('#').trim_start(), line);
            if head.columns.iter().any(|column| column.slot.is_some()) {
                return Ok(head.with_names_of_rows(raw, next));
            }
            if !is_comment {
                return Err(unknown(line, text));
            }
        }
        let (line, text) = first.ok_or_else(|| ReadError::End { line: 0, what: "a frame".to_owned() })?;
        Err(unknown(line, text))
    }

    fn of(text: &str, line: usize) -> Self {
        let divider = [',', ';', '\t'].into_iter().find(|&divider| text.contains(divider));
        let (mut columns, mut foreign, mut notes) = (Vec::<Column>::new(), Vec::<&str>::new(), Vec::new());
        for heading in cells(text, divider) {
            let (name, unit) = name_and_unit(heading);
            let mut column = Column::of(name, 1).next();
            if let Some(column) = column.as_mut().filter(|_| DEGREES.contains(&unit)) {
                column.slot = None;
                notes.push(format!("`{heading}` is in degrees, and ignored"));
            }
            let is_used =
                column.as_ref().is_some_and(|column| column.slot.is_some() || is_one(column, TIMES));
            if is_used && !UNITS.contains(&unit) {
                foreign.push(heading);
            }
            columns.extend(column);
        }
        if !foreign.is_empty() {
            notes.push(format!("numbers are read without conversion of units: {}", foreign.join(", ")));
        }
        Self { columns, line, divider, notes }
    }

    /// Returns the place of the first column that has one of these names, and no other meaning.
    fn place_of(&self, names: &str) -> Option<usize> {
        self.columns.iter().position(|column| column.slot.is_none() && is_one(column, names))
    }

    /// Adds a column for names of rows, which has no name itself: as R, ImageJ and pandas write it.
    fn with_names_of_rows(mut self, raw: &str, row: &str) -> Self {
        let has_bare_cell = row.starts_with('"') && row.matches('"').count() <= 2 * self.columns.len();
        let is_indented = raw.starts_with(char::is_whitespace) && matches!(self.divider, None | Some('\t'));
        let has_more = cells(row, self.divider).count() == self.columns.len() + 1;
        if has_more && (has_bare_cell || is_indented) {
            self.columns.insert(0, Column { name: "(names of rows)".to_owned(), slot: None });
        }
        self
    }

    /// Returns a table without rows.
    fn table(&self, time: Option<f64>) -> Table {
        let mut table = Table::new(self.columns.iter().cloned(), self.line);
        table.time = time;
        table.notes.extend_from_slice(&self.notes);
        table
    }
}

/// Returns whether a column has one of these names.
fn is_one(column: &Column, names: &str) -> bool {
    names.split(' ').any(|name| name == plain(&column.name))
}

/// Creates the error of a text that has none of the known formats.
fn unknown(line: usize, found: &str) -> ReadError {
    let known = "extended XYZ, a dump or a data file of LAMMPS, GSD, or a table whose first line names columns \
                 such as x, y and radius";
    let is_row =
        found.split([',', ';', '\t', ' ']).all(|cell| cell.is_empty() || cell.parse::<f64>().is_ok());
    let (what, known) = if is_row {
        ("the first line of a table", "the names of its columns, such as x,y,radius")
    } else {
        ("the file", known)
    };
    ReadError::unexpected(line, what, known, lossy(found.as_bytes()))
}

/// Returns the cells of a line without their quotes.
fn cells(text: &str, divider: Option<char>) -> impl Iterator<Item = &str> {
    let mut rest = Some(text);
    std::iter::from_fn(move || {
        let text = rest?;
        let mut is_quoted = false;
        let ends = |letter: char| {
            is_quoted ^= letter == '"';
            !is_quoted && divider.map_or(letter.is_whitespace(), |divider| letter == divider)
        };
        let (cell, after) = match text.find(ends) {
            Some(end) => (&text[..end], Some(&text[end..])),
            None => (text, None),
        };
        rest = after.map(|after| {
            let after = &after[after.chars().next().map_or(0, char::len_utf8)..];
            if divider.is_none() { after.trim_start() } else { after }
        });
        let cell = cell.trim();
        Some(cell.strip_prefix('"').and_then(|cell| cell.strip_suffix('"')).unwrap_or(cell))
    })
}

/// Columns of the tables that are written.
const COLUMNS: &str = "id,kind,x,y,vx,vy,angle,angular_velocity,radius,mass,inertia_factor,image_x,image_y";

impl State {
    /// Writes the disks as a table that a [`Reader`](super::Reader) reads back to the same bits.
    ///
    /// # Errors
    /// If the writer fails.
    pub fn write_csv(&self, mut out: impl Write) -> io::Result<()> {
        writeln!(out, "{COLUMNS}")?;
        for (id, disk) in numbered(&self.disks) {
            let (position, velocity, [right, up]) = (disk.position(), disk.velocity(), disk.image());
            write!(out, "{id},{},{:?},{:?},", disk.kind().number(), position.x, position.y)?;
            write!(out, "{:?},{:?},{:?},", velocity.x, velocity.y, disk.angle())?;
            write!(out, "{:?},{:?},{:?},", disk.angular_velocity(), disk.radius(), disk.mass())?;
            writeln!(out, "{:?},{right},{up}", disk.inertia_factor())?;
        }
        out.flush()
    }
}
