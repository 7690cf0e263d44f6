//! Reads extended XYZ: the keys of a frame, and its rows.

use std::collections::BTreeSet;
use std::io::BufRead;

use granular_edmd::Gravity;
use granular_edmd::boundary::Domain;
use granular_edmd::glam::DVec2;

use crate::ReadError;
use crate::column::{Column, Quantity, plain};
use crate::lines::{Input, Text, checked_box, finite, is_upright, number};
use crate::table::{Found, Table};

/// Largest number of columns of a disk. Without a limit, a few characters in a file could ask for any number
/// of columns.
const MOST_COLUMNS: usize = 1000;

/// The keys that the reader understands.
const KNOWN: [&str; 8] = ["Properties", "Time", "t", "Gravity", "Domain", "Lattice", "Origin", "pbc"];

/// The keys of a frame with their values, without quotes.
pub(super) struct Keys<'a> {
    pairs: Vec<(&'a str, &'a str)>,
    line: usize,
}

impl<'a> Keys<'a> {
    /// Divides a line into keys and values. Words without a value are ignored.
    pub(super) fn parse(text: &'a str, line: usize) -> Result<Self, ReadError> {
        let (mut pairs, mut rest) = (Vec::new(), text.trim());
        while !rest.is_empty() {
            let (name, after) = word(rest, |letter| letter == '=' || letter.is_whitespace())
                .unwrap_or_else(|| rest.split_at(rest.len()));
            rest = after.trim_start();
            let Some(after) = rest.strip_prefix('=').map(str::trim_start) else { continue };
            let (value, after) = word(after, char::is_whitespace).ok_or_else(|| {
                ReadError::unexpected(line, format!("the value of `{name}`"), "within two quotes", after)
            })?;
            pairs.push((name, value.trim_end_matches(',')));
            rest = after.trim_start();
        }
        Ok(Self { pairs, line })
    }

    /// Returns the names of the keys that the reader does not understand, each of them once.
    pub(super) fn ignored(&self) -> impl Iterator<Item = String> {
        let names: BTreeSet<&str> = self.pairs.iter().map(|(name, _)| *name).collect();
        names.into_iter().filter(|name| !is_one_of(name, &KNOWN)).map(str::to_owned)
    }

    /// Returns the value of a key that may have several names.
    fn value(&self, names: &[&str]) -> Result<Option<&'a str>, ReadError> {
        let mut found = self.pairs.iter().filter(|(name, _)| is_one_of(name, names));
        let first = found.next();
        match found.find(|(_, value)| first.is_some_and(|(_, first)| first != value)) {
            None => Ok(first.map(|(_, value)| *value)),
            Some((name, _)) => {
                let what = format!("the key `{name}`");
                Err(ReadError::Doubled { line: self.line, first: self.line, what })
            }
        }
    }

    /// Returns whether the frame names its columns.
    fn has_properties(&self) -> bool {
        matches!(self.value(&["Properties"]), Ok(Some(_)))
    }

    /// Returns the time, if the frame has it.
    pub(super) fn time(&self) -> Result<Option<f64>, ReadError> {
        self.value(&["Time", "t"])?.map(|value| finite("Time", value, self.line)).transpose()
    }

    /// Returns an empty table with the columns of the frame.
    pub(super) fn table(&self) -> Result<Table, ReadError> {
        let properties = self.value(&["Properties"])?;
        let columns = columns(properties.unwrap_or("species:S:1:pos:R:3"), self.line)?;
        let mut table = Table::new(columns, self.line);
        match self.time() {
            // The comment of a plain XYZ file may hold anything.
            Err(ReadError::Unexpected { found, .. }) if properties.is_none() => {
                table.notes.push(format!("the time {found:?} is no number, and ignored"));
            }
            time => table.time = time?,
        }
        table.gravity = self.value(&["Gravity"])?.map(|value| self.gravity(value)).transpose()?;
        table.domain = self.domain(&mut table.notes)?;
        table.is_own = self.value(&["Domain"])?.is_some();
        Ok(table)
    }

    /// Reads gravity: a number for gravity that points down, or both components of the acceleration.
    fn gravity(&self, value: &str) -> Result<Gravity, ReadError> {
        let finite = || value_words(value).map(|value| finite("Gravity", value, self.line));
        match finite().collect::<Result<Vec<f64>, _>>()?[..] {
            [downward] => Ok(downward.into()),
            [x, y] => Ok(DVec2::new(x, y).into()),
            _ => Err(ReadError::unexpected(self.line, "Gravity", "1 or 2 numbers", value)),
        }
    }

    /// Returns the box from the key `Domain`, which this crate writes, or else from the lattice.
    fn domain(&self, notes: &mut Vec<String>) -> Result<Option<Domain>, ReadError> {
        let (own, lattice) = (self.value(&["Domain"])?, self.value(&["Lattice"])?);
        let domain = match (own, lattice) {
            (Some(domain), _) => {
                let [left, right, bottom, top] = self.numbers("Domain", domain, "4 numbers")?[..] else {
                    return Err(ReadError::unexpected(self.line, "Domain", "4 numbers", domain));
                };
                Domain::new(left, right, bottom, top)
            }
            (None, Some(lattice)) => self.of_lattice(lattice)?,
            (None, None) => return Ok(None),
        };
        let domain = match self.value(&["pbc"])? {
            Some(pbc) => self.periodic(domain, pbc)?,
            None if own.is_some() => domain,
            None => {
                notes.push("all sides of the lattice are periodic, since the file has no `pbc`".to_owned());
                domain.with_periodic_sides().with_periodic_ends()
            }
        };
        checked_box(domain, self.line).map(Some)
    }

    /// Returns the rectangle of a lattice: two or three vectors, or their lengths along the axes.
    fn of_lattice(&self, lattice: &str) -> Result<Domain, ReadError> {
        let numbers = "2, 3, 4 or 9 numbers";
        let (sides, tilts) = match self.numbers("Lattice", lattice, numbers)?[..] {
            [width, height] | [width, height, _] => ([width, height], [0.0; 4]),
            [width, a, b, height] => ([width, height], [a, 0.0, b, 0.0]),
            [width, a, b, c, height, d, _, _, _] => ([width, height], [a, b, c, d]),
            _ => return Err(ReadError::unexpected(self.line, "Lattice", numbers, lattice)),
        };
        if !is_upright(sides, tilts) {
            return Err(ReadError::unexpected(self.line, "Lattice", "a rectangle", lattice));
        }
        let origin = self.value(&["Origin"])?.unwrap_or("0 0 0");
        let [left, bottom, _] = self.numbers("Origin", origin, "3 numbers")?[..] else {
            return Err(ReadError::unexpected(self.line, "Origin", "3 numbers", origin));
        };
        Ok(Domain::new(left, left + sides[0], bottom, bottom + sides[1]))
    }

    /// Returns the box with the periodic directions of the file.
    fn periodic(&self, domain: Domain, pbc: &str) -> Result<Domain, ReadError> {
        let flag = |letter: &str| match letter.to_ascii_lowercase().as_str() {
            "t" | "1" | "true" => Some(true),
            "f" | "0" | "false" => Some(false),
            _ => None,
        };
        let flags: Vec<Option<bool>> = value_words(pbc).map(flag).collect();
        let (&[Some(sides), Some(ends)] | &[Some(sides), Some(ends), Some(_)]) = flags.as_slice() else {
            return Err(ReadError::unexpected(self.line, "pbc", "three letters T or F", pbc));
        };
        let domain = if sides { domain.with_periodic_sides() } else { domain };
        Ok(if ends { domain.with_periodic_ends() } else { domain })
    }

    /// Reads numbers that are separated by white space, commas or brackets.
    fn numbers(&self, what: &str, text: &str, requirement: &str) -> Result<Vec<f64>, ReadError> {
        let numbers: Vec<f64> =
            value_words(text).map(|text| number(what, text, self.line)).collect::<Result<_, _>>()?;
        // Only the top of a box may be infinite.
        let is_finite = what == "Domain" || numbers.iter().all(|number| number.is_finite());
        is_finite.then_some(numbers).ok_or_else(|| {
            ReadError::unexpected(self.line, what, format!("{requirement}, all of them finite"), text)
        })
    }
}

/// Returns whether a name is one of these, in upper or lower case. The case of a single letter matters, since
/// `T` is a temperature.
fn is_one_of(name: &str, known: &[&str]) -> bool {
    known.iter().any(|known| *known == name || known.len() > 1 && known.eq_ignore_ascii_case(name))
}

/// Returns the first word of a text, without its quotes or brackets, and the rest of the text, or `None` if
/// the word does not end.
fn word(text: &str, ends: impl Fn(char) -> bool) -> Option<(&str, &str)> {
    let open = text.chars().next().unwrap_or(' ');
    let close = match open {
        '"' | '\'' => open,
        '{' => '}',
        '[' => ']',
        _ => return Some(text.split_at(text.find(ends).unwrap_or(text.len()))),
    };
    let (mut depth, mut is_escaped) = (0_usize, false);
    for (place, letter) in text.char_indices() {
        let is_mark = !is_escaped;
        is_escaped = is_mark && letter == '\\';
        if is_mark && letter == close && place > 0 {
            depth -= 1;
            if depth == 0 {
                return Some((&text[1..place], &text[place + close.len_utf8()..]));
            }
        } else if is_mark && letter == open {
            depth += 1;
        }
    }
    None
}

/// Returns the words of a list.
fn value_words(text: &str) -> impl Iterator<Item = &str> {
    text.split(|letter: char| letter.is_whitespace() || ",[]{}".contains(letter))
        .filter(|word| !word.is_empty())
}

/// Returns the columns of each disk.
fn columns(properties: &str, line: usize) -> Result<Vec<Column>, ReadError> {
    let parts: Vec<&str> = properties.split(':').collect();
    let mut columns = Vec::new();
    for part in parts.chunks(3) {
        let wrong = |found: &str| {
            Err(ReadError::unexpected(line, "each of `Properties`", "a name, a type and a number", found))
        };
        let &[name, _, count] = part else { return wrong(&part.join(":")) };
        let Ok(count @ 1..=MOST_COLUMNS) = count.parse() else { return wrong(&part.join(":")) };
        if columns.len() + count > MOST_COLUMNS {
            let most = format!("of at most {MOST_COLUMNS} columns");
            return Err(ReadError::unexpected(line, "`Properties`", most, properties));
        }
        let size = Quantity::named(&plain(name)).map_or(1, Quantity::size);
        if size == 3 && count > 3 {
            return Err(ReadError::unexpected(line, name, "of 2 or 3 columns", part.join(":")));
        }
        columns.extend(Column::of(name, count));
    }
    // If another column is the vector of positions, `Z` is ASE's atomic number.
    let is = |column: &Column, name: &str| column.name.eq_ignore_ascii_case(name);
    if columns.iter().any(|column| column.slot == Quantity::Position.slot(0) && !is(column, "x")) {
        columns.iter_mut().filter(|column| is(column, "z")).for_each(|column| column.slot = None);
    }
    Ok(columns)
}

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
