//! Frames of the extended XYZ format, read one by one.

use std::io::BufRead;

use super::keys::Keys;
use crate::ReadError;
use crate::column::Column;
use crate::found::Found;
use crate::lines::{Input, Text};
use crate::table::Table;

/// Returns the frames of a file.
pub(crate) fn frames<'a>(
    mut input: Input<impl BufRead + 'a>,
) -> impl Iterator<Item = Result<Found<'a>, ReadError>> + 'a {
    std::iter::from_fn(move || next(&mut input).transpose())
}

fn next<'a, R: BufRead>(input: &mut Input<R>) -> Result<Option<Found<'a>>, ReadError> {
    let Some((count, line)) = input.next_filled()? else { return Ok(None) };
    let count = count.parse().map_err(|_| {
        ReadError::unexpected(line, "the first line of a frame", "the number of its disks", &count)
    })?;
    let (keys, line) = input.need("the keys of a frame")?;
    let rows = input.copy_disks(count)?;
    Ok(Some(Found::in_text(rows, None, move |rows| table(&keys, line, rows))))
}

fn table(keys: &str, line: usize, rows: &Text) -> Result<Table, ReadError> {
    let keys = Keys::parse(keys, line)?;
    let mut table = keys.table()?;
    if !keys.has_properties() {
        table.advice = "; the columns of plain XYZ are a name, x, y and z, and `Properties=` names others";
    }
    // A plain XYZ file may have more columns than the usual ones.
    let known = table.columns.len();
    let most = if keys.has_properties() { usize::MAX } else { known };
    let mut widest = known;
    for (row, line) in rows.lines()? {
        table.push(row.split_whitespace().take(most), line)?;
        widest = widest.max(row.split_whitespace().count());
    }
    if widest > known {
        let first = known + 1;
        let name = if widest == first { first.to_string() } else { format!("{first} to {widest}") };
        table.columns.push(Column { name, slot: None });
    }
    table.columns.extend(keys.ignored().map(|name| Column { name, slot: None }));
    Ok(table)
}
