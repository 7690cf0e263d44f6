//! Disks as a table of comma-separated values.

use std::io::{self, Write};

use super::column::Column;
use super::lines::{Text, finite, lossy};
use super::shown::numbered;
use super::table::Table;
use super::{ReadError, State};

/// The column of the time.
const TIME: &str = "time";

/// Units that need no conversion; `sigma` is the reduced unit of length of many programs. A unit in brackets
/// may follow the name of a column.
const UNITS: [&str; 10] =
    ["1", "rad", "length", "sigma", "time", "mass", "length/time", "1/time", "rad/time", ""];

/// Reads a table whose first line names the columns.
///
/// Commas, semicolons, tabs or spaces separate the cells; the first line shows which. After the names, a line
/// that begins with `#` is a comment.
pub(super) fn table(text: &Text) -> Result<Table, ReadError> {
    let mut lines = text.lines()?;
    let Some((head, line)) = lines.next_filled() else {
        return Err(ReadError::End { line: 0, what: "a frame".to_owned() });
    };
    let head = head.trim_start_matches('#').trim_start();
    let divider = [',', ';', '\t'].into_iter().find(|&divider| head.contains(divider));
    let mut foreign = Vec::new();
    let mut columns: Vec<Column> = Vec::new();
    for heading in cells(head, divider) {
        let (name, unit) = heading.split_once(" [").unwrap_or((heading, "1]"));
        let known = columns.len();
        columns.extend(Column::of(name, 1));
        let is_used = columns[known..].iter().any(|column| column.slot.is_some() || column.name == TIME);
        if is_used && !UNITS.contains(&unit.trim_end_matches(']')) {
            foreign.push(heading);
        }
    }
    if columns.iter().all(|column| column.slot.is_none()) {
        return Err(unknown(line, head));
    }
    let rows = std::iter::from_fn(|| lines.next_filled()).filter(|(text, _)| !text.starts_with('#'));
    let mut rows = rows.peekable();
    if rows.peek().is_some_and(|(text, _)| has_name(text, divider, columns.len())) {
        columns.insert(0, Column { name: "(names of rows)".to_owned(), slot: None });
    }
    let mut table = Table::new(columns, line);
    table.time_column = TIME;
    if !foreign.is_empty() {
        table.notes.push(format!("numbers are read without conversion of units: {}", foreign.join(", ")));
    }
    let common = common(&table.columns);
    let mut first = None;
    for (text, line) in rows {
        table.push(cells(text, divider), line)?;
        let first = *first.get_or_insert(text);
        for &place in &common {
            let [cell, known] = [text, first].map(|text| cells(text, divider).nth(place).unwrap_or_default());
            let name = table.columns[place].name.as_str();
            if cell != known {
                let requirement = "the same in all rows, since a table holds one state";
                return Err(ReadError::unexpected(line, name, requirement, cell));
            }
            if table.time.is_none() && name.eq_ignore_ascii_case(TIME) {
                table.time = Some(finite(name, cell, line)?);
            }
        }
    }
    Ok(table)
}

/// Returns the indices of the columns that have the same value in all rows of a state.
fn common(columns: &[Column]) -> Vec<usize> {
    let is_common = |column: &Column| {
        [TIME, "frame", "step", "timestep"].iter().any(|name| column.name.eq_ignore_ascii_case(name))
    };
    (0..columns.len()).filter(|&place| is_common(&columns[place])).collect()
}

/// Returns whether a row begins with a name in quotes for which there is no column, as in tables written by
/// R.
fn has_name(row: &str, divider: Option<char>, columns: usize) -> bool {
    let has_bare_cell = row.matches('"').count() <= 2 * columns;
    row.starts_with('"') && has_bare_cell && cells(row, divider).count() == columns + 1
}

/// Creates the error of a text that has none of the known formats.
fn unknown(line: usize, found: &str) -> ReadError {
    let known = "extended XYZ, a dump or a data file of LAMMPS, GSD, or a table whose first line names columns \
                 such as x, y and radius";
    ReadError::unexpected(line, "the file", known, lossy(found.as_bytes()))
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
