//! The contents of a file: columns and rows of disks, with the box, the time and gravity; and frames that
//! were found in a file.

use std::collections::HashMap;

use granular_edmd::Gravity;
use granular_edmd::boundary::Domain;

use super::ReadError;
use super::column::{Column, Quantity, Slot, settle};
use super::lines::{LARGEST_ID, Text, as_whole, number, whole};

/// A frame of a file, in the same form for all formats.
///
/// A format names the columns and pushes rows; [`disks`](super::disks) turns them into a state.
#[derive(Debug, Default)]
pub(super) struct Table {
    pub(super) columns: Vec<Column>,
    /// The line that names the columns.
    pub(super) line: usize,
    /// Values of the columns with a slot, row after row.
    values: Vec<f64>,
    /// The line number of each row.
    pub(super) lines: Vec<usize>,
    /// The index by which the values refer to each name.
    names: HashMap<String, usize>,
    /// The names that the file gives to the numbers of kinds, starting with 0.
    pub(super) kind_names: Vec<String>,
    /// True if types count from 1, and densities are densities of spheres.
    pub(super) is_of_lammps: bool,
    /// True if this crate wrote the file. The crate always writes a last line break, so a file without a last
    /// line break is incomplete.
    pub(super) is_own: bool,
    pub(super) domain: Option<Domain>,
    /// The box to which scaled positions refer, if it is not the domain.
    pub(super) extent: Option<Domain>,
    pub(super) time: Option<f64>,
    /// Indices of the columns of the time and of the number of the frame, which are the same for all disks.
    pub(super) labels: Vec<usize>,
    /// The way out that refusals name.
    pub(super) advice: &'static str,
    /// The number of the frame in a binary file, where disks count as lines.
    pub(super) binary_frame: Option<u64>,
    pub(super) gravity: Option<Gravity>,
    /// Largest error of a position, from the precision of the file.
    pub(super) rounding: f64,
    /// Sentences about the file that a user should know.
    pub(super) notes: Vec<String>,
}

impl Table {
    /// Creates a table of these columns.
    pub(super) fn new(columns: impl IntoIterator<Item = Column>, line: usize) -> Self {
        let mut columns: Vec<Column> = columns.into_iter().collect();
        let notes = settle(&mut columns);
        // Only LAMMPS counts types from 1; elsewhere, a type is a name.
        if columns.iter().all(|column| column.slot != Quantity::Name.slot(0)) {
            let types = columns.iter_mut().filter(|column| column.slot == Quantity::Type.slot(0));
            types.for_each(|column| column.slot = Quantity::Name.slot(0));
        }
        Self { columns, line, notes, ..Self::default() }
    }

    /// Creates a table of columns that have one component each, with the conventions of LAMMPS.
    pub(super) fn of_lammps<'a>(names: impl IntoIterator<Item = &'a str>, line: usize) -> Self {
        let columns = names.into_iter().flat_map(|name| Column::of(name, 1)).collect();
        Self { columns, line, is_of_lammps: true, ..Self::default() }
    }

    /// Adds a row, with one cell for each column.
    pub(super) fn push<'a>(
        &mut self,
        cells: impl IntoIterator<Item = &'a str>,
        line: usize,
    ) -> Result<(), ReadError> {
        let (mut count, mut cells) = (0, cells.into_iter());
        for column in &self.columns {
            let Some(cell) = cells.next() else { break };
            count += 1;
            if let Some((quantity, _)) = column.slot {
                self.values.push(value(&column.name, quantity, cell, line, &mut self.names)?);
            }
        }
        count += cells.count();
        if count != self.columns.len() {
            let requirement = format!("{}, one for each column", self.columns.len());
            return Err(ReadError::unexpected(line, "the number of values", requirement, count.to_string()));
        }
        self.lines.push(line);
        Ok(())
    }

    /// Adds a row of numbers, one for each column.
    pub(super) fn push_numbers(&mut self, numbers: impl Iterator<Item = f64>, line: usize) {
        let known = self.columns.iter().zip(numbers).filter(|(column, _)| column.slot.is_some());
        self.values.extend(known.map(|(_, number)| number));
        self.lines.push(line);
    }

    /// Returns the columns that have a slot, in the order of the values of a row.
    pub(super) fn known(&self) -> impl Iterator<Item = (&Column, Slot)> {
        self.columns.iter().filter_map(|column| Some((column, column.slot?)))
    }

    /// Returns the values of a slot, with the lines of their rows.
    pub(super) fn values(&self, slot: Slot) -> impl Iterator<Item = (f64, usize)> {
        let place = self.known().position(|(_, known)| known == slot);
        place.into_iter().flat_map(|place| self.rows().map(move |(row, line)| (row[place], line)))
    }

    /// Returns whether a component of a quantity is among the columns.
    pub(super) fn has(&self, quantity: Quantity, component: usize) -> bool {
        self.known().any(|(_, slot)| Some(slot) == quantity.slot(component))
    }

    /// Returns the names of columns that do not determine a property of a disk.
    pub(super) fn ignored(&self) -> Vec<String> {
        let is_idle = |(place, column): &(usize, &Column)| {
            let is_name = column.slot == Quantity::Name.slot(0);
            column.slot.is_none() && !self.labels.contains(place)
                || is_name && self.has(Quantity::Type, 0) && !self.has(Quantity::Kind, 0)
        };
        let idle = self.columns.iter().enumerate().filter(is_idle);
        let mut names: Vec<String> = idle.map(|(_, column)| column.name.clone()).collect();
        names.dedup();
        names
    }

    /// Returns the values of each row, in the order of the known columns, with its line.
    pub(super) fn rows(&self) -> impl Iterator<Item = (&[f64], usize)> {
        let stride = self.known().count().max(1);
        self.values.chunks(stride).zip(self.lines.iter().copied())
    }

    /// Returns the names of kinds by their indices.
    pub(super) fn names(&self) -> Vec<&str> {
        let mut names: Vec<&str> = self.names.keys().map(String::as_str).collect();
        names.sort_by_key(|&name| self.names[name]);
        names
    }
}

/// Returns the numbers of the kinds with the names in a table: the names themselves if all are numbers, or
/// else their positions in alphabetical order, which are the same for all frames with these names.
pub(super) fn kinds_of_names(table: &Table) -> Result<Vec<u16>, ReadError> {
    let names = table.names();
    let is_decimal = |name: &&&str| name.contains('.') && name.parse::<f64>().is_ok();
    if let Some(name) = names.iter().filter(|name| as_whole::<i64>(name).is_none()).find(is_decimal) {
        let requirement = format!("a name or a whole number{}", table.advice);
        return Err(ReadError::unexpected(table.line, "each kind", requirement, *name));
    }
    let ordered = ordered(table);
    let kind = |name: &&str| match &ordered {
        Some(ordered) => ordered.binary_search(name).ok().and_then(|place| u16::try_from(place).ok()),
        None => as_whole(name),
    };
    let kinds: Option<Vec<u16>> = names.iter().map(kind).collect();
    let found = names.len().to_string();
    kinds.ok_or_else(|| {
        ReadError::unexpected(table.line, "the number of names of kinds", "at most 65536", found)
    })
}

/// Returns the kind names, sorted, or `None` if all of them are numbers.
pub(super) fn ordered(table: &Table) -> Option<Vec<&str>> {
    let mut names = table.names();
    names.sort_unstable();
    names.iter().any(|name| as_whole::<u16>(name).is_none()).then_some(names)
}

/// Reads a cell. A name is replaced by its index.
fn value(
    what: &str,
    quantity: Quantity,
    cell: &str,
    line: usize,
    names: &mut HashMap<String, usize>,
) -> Result<f64, ReadError> {
    match quantity {
        Quantity::Name => {
            let next = names.len();
            Ok(*names.entry(cell.to_owned()).or_insert(next) as f64)
        }
        Quantity::Id => {
            let id: u64 = whole(what, cell, line)?;
            let too_large = || ReadError::unexpected(line, what, "at most 2^53", cell);
            if id <= LARGEST_ID { Ok(id as f64) } else { Err(too_large()) }
        }
        Quantity::Kind => whole::<u16>(what, cell, line).map(f64::from),
        Quantity::Image => whole::<i32>(what, cell, line).map(f64::from),
        _ => number(what, cell, line),
    }
}

/// Settings of a reader for data that a file lacks, or gives in few digits.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Settings {
    pub(super) tolerance: Option<f64>,
    pub(super) shrinks: bool,
    pub(super) density: Option<f64>,
    pub(super) radius: Option<f64>,
    /// The factor of all lengths in the file.
    pub(super) scale: f64,
}

/// A frame that was found in a file, and is read only on request.
pub(super) struct Found<'a> {
    /// The step with which the file labels the frame.
    pub(super) step: Option<u64>,
    pub(super) read: Reading<'a>,
}

impl<'a> Found<'a> {
    /// Creates a frame from its text and the function that reads it.
    pub(super) fn in_text(
        text: Text,
        step: Option<u64>,
        read: impl FnOnce(&Text) -> Result<Table, ReadError> + 'a,
    ) -> Self {
        let read = move |_: &Settings| {
            let mut table = read(&text)?;
            match (text.is_torn(), table.is_own, table.lines.last()) {
                (true, true, Some(&line)) => {
                    return Err(ReadError::End { line, what: "a line break".to_owned() });
                }
                (true, ..) => {
                    table.notes.push(TORN.to_owned());
                }
                _ => {}
            }
            Ok(table)
        };
        Self { step, read: Box::new(read) }
    }
}

/// The note about a text without a last line break.
pub(super) const TORN: &str = "the last line has no line break: its last number may be cut short";

/// The note about a radius that was given for a file with radii.
pub(super) const RADIUS_IGNORED: &str = "the radius that was given is ignored, since the file has radii";

/// The function that reads a frame.
type Reading<'a> = Box<dyn FnOnce(&Settings) -> Result<Table, ReadError> + 'a>;

/// The frames of a file, one after another.
pub(super) type Frames<'a> = Box<dyn Iterator<Item = Result<Found<'a>, ReadError>> + 'a>;
