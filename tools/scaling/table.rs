//! The table of the picture: times as a file, so that a picture can be drawn anew without measuring.

use std::path::Path;

use granular_edmd::speed::Quartiles;

use crate::Row;
use benches::Outcome;

const COLUMNS: [&str; 6] = ["disks", "scheduler", "numbered", "low", "median", "high"];

/// The time per collision of one system, in ns.
pub(crate) struct Time {
    pub(crate) disks: usize,
    scheduler: String,
    numbered: String,
    pub(crate) nanoseconds: Quartiles,
}

impl Time {
    /// Takes the quartiles of a row.
    pub(crate) fn of(row: &Row) -> Self {
        let (scheduler, numbered) = (row.scheduler.to_owned(), row.numbering.name().to_owned());
        Self { disks: row.disks, scheduler, numbered, nanoseconds: row.nanoseconds() }
    }

    /// Returns the name of the line to which the time belongs.
    pub(crate) fn line(&self) -> String {
        format!("{}, numbered {}", self.scheduler, self.numbered)
    }
}

/// Writes times as CSV.
pub(crate) fn write(times: &[Time], path: &Path) -> Outcome<()> {
    let mut table = csv::Writer::from_path(path)?;
    table.write_record(COLUMNS)?;
    for Time { disks, scheduler, numbered, nanoseconds: Quartiles { low, median, high } } in times {
        table.serialize((disks, scheduler, numbered, low, median, high))?;
    }
    Ok(table.flush()?)
}

/// Reads times that were written before.
pub(crate) fn read(path: &Path) -> Outcome<Vec<Time>> {
    let failed = |error: csv::Error| format!("TABLE {}: {error}", path.display());
    let mut table = csv::Reader::from_path(path).map_err(failed)?;
    let rows = table.deserialize().map(|row| {
        let (disks, scheduler, numbered, low, median, high) = row.map_err(failed)?;
        Ok(Time { disks, scheduler, numbered, nanoseconds: Quartiles { low, median, high } })
    });
    rows.collect()
}
