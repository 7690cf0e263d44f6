//! Dumps of LAMMPS and LIGGGHTS, read frame by frame.

use std::io::BufRead;

use crate::ReadError;
use crate::column::Quantity;
use crate::found::Found;
use crate::lines::{Input, Text, as_whole, checked_box, finite, is_upright, number, whole};
use crate::table::Table;
use granular_edmd::boundary::Domain;

/// The column of the time, which is the same for all disks.
const TIME: &str = "v_time";

/// Returns the frames of a file.
pub(crate) fn frames<'a>(
    mut input: Input<impl BufRead + 'a>,
) -> impl Iterator<Item = Result<Found<'a>, ReadError>> + 'a {
    std::iter::from_fn(move || next(&mut input).transpose())
}

/// The lines above the disks of a frame, with their numbers.
#[derive(Default)]
struct Head {
    time: Option<(String, usize)>,
    /// The words after `BOX BOUNDS`, and the three lines below.
    bounds: Option<(String, [(String, usize); 3])>,
}

fn next<'a, R: BufRead>(input: &mut Input<R>) -> Result<Option<Found<'a>>, ReadError> {
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
        [&[width, a, _, left], &[b, height, _, bottom], _] => {
            ([left, left + width, bottom, bottom + height], [a, b, 0.0])
        }
        _ => {
            return Err(ReadError::unexpected(
                line,
                "the box",
                "three lines of 2 to 4 numbers",
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
    let open = if ends.ends_with(['s', 'm']) { f64::INFINITY } else { top };
    let mut domain = checked_box(extent, line)?;
    domain.top = open;
    let domain = if sides == "pp" { domain.with_periodic_sides() } else { domain };
    Ok([extent, if ends == "pp" { domain.with_periodic_ends() } else { domain }])
}
