//! Rows of cells, written to a file one after the other.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use granular_edmd::file::Draft;
use granular_edmd::statistics::Estimate;

use crate::{Scalar, StudyError};

/// A table that is being written to its file.
pub(super) struct Rows {
    path: PathBuf,
    draft: Draft,
}

impl Rows {
    /// Begins the table of this name in a folder.
    pub(super) fn begin(folder: &Path, name: &str) -> Result<Self, StudyError> {
        let path = super::file(folder, name);
        let draft = Draft::of(&path).map_err(StudyError::io("write", &path))?;
        Ok(Self { path, draft })
    }

    /// Adds a row.
    pub(super) fn push(&mut self, Row(mut row): Row) -> Result<(), StudyError> {
        row.push('\n');
        self.draft.write_all(row.as_bytes()).map_err(StudyError::io("write", &self.path))
    }

    /// Renames the finished table to its final name.
    pub(super) fn finish(self) -> Result<(), StudyError> {
        self.draft.finish().map_err(StudyError::io("write", &self.path))
    }
}

/// A growing row.
#[derive(Debug, Clone)]
pub(super) struct Row(String);

impl Row {
    /// Begins a row with these cells.
    pub(super) fn of(cells: impl IntoIterator<Item = impl Into<Scalar>>) -> Self {
        let mut row = String::with_capacity(256);
        for (index, cell) in cells.into_iter().enumerate() {
            row.push_str(if index == 0 { "" } else { "," });
            write_cell(&mut row, &cell.into());
        }
        Self(row)
    }

    /// Adds a cell.
    pub(super) fn with(self, value: &Scalar) -> Self {
        let Self(mut row) = self;
        row.push(',');
        write_cell(&mut row, value);
        Self(row)
    }

    /// Adds a mean, its error, and its number of independent samples.
    pub(super) fn with_estimate(self, estimate: &Estimate) -> Self {
        let Self(row) = self;
        let numbers = [estimate.mean(), estimate.standard_error(), estimate.independent_samples()];
        numbers.into_iter().fold(Self(row), |row, number| row.with(&number.into()))
    }
}

/// Adds the text of a cell. A cell without a number is empty, which every reader of tables takes for a
/// missing value; the text `NaN` spoils the means of some.
fn write_cell(row: &mut String, value: &Scalar) {
    match value {
        Scalar::Number(number) if number.is_nan() => {}
        value => {
            // Writing to a string does not fail.
            let _ = write!(row, "{value}");
        }
    }
}

/// Returns the names of the estimates whose error is only a lower bound, separated by spaces.
pub(super) fn not_converged(estimates: &[(String, Estimate)]) -> String {
    let names =
        estimates.iter().filter(|(_, estimate)| !estimate.is_converged()).map(|(name, _)| name.as_str());
    names.collect::<Vec<_>>().join(" ")
}
