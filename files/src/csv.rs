//! Disks as a table of comma-separated values.

use std::collections::HashMap;
use std::io::{self, Write};

use super::column::{Column, FRAMES, TIMES, name_and_unit, plain};
use super::found::{Found, Settings, TORN};
use super::lines::{Lines, Text, as_whole, finite, lossy, number};
use super::shown::numbered;
use super::table::Table;
use super::{ReadError, State};

/// Units that need no conversion; `sigma` is the reduced unit of length of many programs.
const UNITS: [&str; 10] =
    ["", "1", "rad", "length", "sigma", "time", "mass", "length/time", "1/time", "rad/time"];

/// A frame of a table: its number or time, its disks or the first error in them, and the cells of its labels.
struct Group<'a> {
    key: f64,
    table: Result<Table, ReadError>,
    labels: Vec<&'a str>,
}

/// Reads a table whose first line names the columns. A column that numbers frames, or holds times, divides
/// the rows into frames.
///
/// Commas, semicolons, tabs or spaces separate the cells; the line of names shows which. A line that begins
/// with `#` is a comment, unless it holds the names.
pub(super) fn frames<'a>(text: &Text) -> Result<Vec<Found<'a>>, ReadError> {
    let mut lines = text.lines()?;
    let head = Head::read(&mut lines)?;
    let rows = lines.map(|(text, line)| (text.trim(), line));
    let rows = rows.filter(|(text, _)| !text.is_empty() && !text.starts_with('#'));
    let is_number = |cell: &str| cell.parse::<f64>().is_ok();
    // TrackMate writes more names and units below the names.
    let mut rows = rows.skip_while(|(text, _)| {
        let count = cells(text, head.divider).count();
        count == head.columns.len() && !cells(text, head.divider).any(is_number) && count > 1
    });
    let mut groups: Vec<Group<'_>> = Vec::new();
    let mut of_key: HashMap<u64, usize> = HashMap::new();
    rows.try_for_each(|(text, line)| -> Result<(), ReadError> {
        let cells_of = || cells(text, head.divider);
        let labels: Vec<&str> = head.labels.iter().filter_map(|&place| cells_of().nth(place)).collect();
        let key = match (labels.first(), head.labels.first()) {
            (Some(cell), Some(&place)) => finite(&head.columns[place].name, cell, line)?,
            _ => 0.0,
        };
        let index = *of_key.entry((key + 0.0).to_bits()).or_insert_with(|| {
            groups.push(Group { key, table: Ok(head.table()), labels: labels.clone() });
            groups.len() - 1
        });
        let Group { table, labels: first, .. } = &mut groups[index];
        let pushed = match table {
            Ok(table) if labels.len() == head.labels.len() => {
                head.push(table, cells_of(), [first.as_slice(), labels.as_slice()], line)
            }
            Ok(table) => return table.push(cells_of(), line),
            Err(_) => Ok(()),
        };
        if let Err(error) = pushed {
            *table = Err(error);
        }
        Ok(())
    })?;
    if groups.is_empty() {
        groups.push(Group { key: 0.0, table: Ok(head.table()), labels: Vec::new() });
    }
    groups.sort_by(|a, b| a.key.total_cmp(&b.key));
    let count = groups.len();
    let found = groups.into_iter().enumerate().map(|(number, Group { key, mut table, .. })| {
        if let (Ok(table), Some(&place)) = (&mut table, head.labels.first()) {
            let name = &head.columns[place].name;
            table.notes.extend((count > 1).then(|| format!("this is frame {number} of {count} by `{name}`")));
        }
        if let (Ok(table), true) = (&mut table, text.is_torn()) {
            table.notes.push(TORN.to_owned());
        }
        Found { step: as_whole(&key.to_string()), read: Box::new(|_: &Settings| table) }
    });
    Ok(found.collect())
}

/// The names of the columns.
struct Head {
    columns: Vec<Column>,
    line: usize,
    divider: Option<char>,
    /// Indices of the columns that number the frames or hold their times; the first divides the rows.
    labels: Vec<usize>,
    foreign: Vec<String>,
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
        let (mut columns, mut foreign): (Vec<Column>, Vec<String>) = (Vec::new(), Vec::new());
        for heading in cells(text, divider) {
            let (name, unit) = name_and_unit(heading);
            let column = Column::of(name, 1).next();
            let is_used =
                column.as_ref().is_some_and(|column| column.slot.is_some() || is_one(column, TIMES));
            if is_used && !UNITS.contains(&unit) {
                foreign.push(heading.to_owned());
            }
            columns.extend(column);
        }
        let labels = [FRAMES, TIMES].iter().filter_map(|names| {
            columns.iter().position(|column| column.slot.is_none() && is_one(column, names))
        });
        let labels = labels.collect();
        Self { columns, line, divider, labels, foreign }
    }

    /// Adds a column for names of rows, which has no name itself: as R, ImageJ and pandas write it.
    fn with_names_of_rows(mut self, raw: &str, row: &str) -> Self {
        let has_bare_cell = row.starts_with('"') && row.matches('"').count() <= 2 * self.columns.len();
        let is_indented = raw.starts_with(char::is_whitespace) && matches!(self.divider, None | Some('\t'));
        let has_more = cells(row, self.divider).count() == self.columns.len() + 1;
        if has_more && (has_bare_cell || is_indented) {
            self.columns.insert(0, Column { name: "(names of rows)".to_owned(), slot: None });
            self.labels.iter_mut().for_each(|place| *place += 1);
        }
        self
    }

    /// Returns a table without rows.
    fn table(&self) -> Table {
        let mut table = Table::new(self.columns.iter().cloned(), self.line);
        table.labels.clone_from(&self.labels);
        if !self.foreign.is_empty() {
            let names = self.foreign.join(", ");
            table.notes.push(format!("numbers are read without conversion of units: {names}"));
        }
        table
    }

    /// Adds a row, whose labels must be those of the first row of the frame.
    fn push<'a>(
        &self,
        table: &mut Table,
        cells: impl Iterator<Item = &'a str>,
        [first, labels]: [&[&str]; 2],
        line: usize,
    ) -> Result<(), ReadError> {
        table.push(cells, line)?;
        for ((&place, first), cell) in self.labels.iter().zip(first).zip(labels) {
            let column = &self.columns[place];
            if cell != first && number(&column.name, cell, line)? != number(&column.name, first, line)? {
                return Err(ReadError::unexpected(
                    line,
                    &column.name,
                    "the same in all rows of a frame",
                    *cell,
                ));
            }
            if is_one(column, TIMES) {
                table.time = Some(finite(&column.name, cell, line)?);
            }
        }
        Ok(())
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
