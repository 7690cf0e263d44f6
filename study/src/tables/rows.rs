//! Rows of cells, written to a file one after the other, and the leading columns of every table.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use granular_edmd::file::Draft;
use granular_edmd::statistics::Estimate;

use crate::{Experiment, Leg, Plan, Scalar, StudyError};

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

/// The subject of a row: one value, all repeats of a value, or, without a value, a transition.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place {
    pub(super) ramp: usize,
    pub(super) value: Option<usize>,
    pub(super) leg: Option<Leg>,
    /// Value of the ramped parameter.
    pub(super) at: Option<f64>,
    /// True for all repeats together.
    pub(super) is_point: bool,
}

/// Returns the names and cells of the leading columns.
pub(super) fn leading<E: Experiment>(plan: &Plan<E>, place: Place) -> Vec<(&str, Scalar)> {
    let repeats = plan.repeats();
    let (name, index) = if place.is_point { ("point", place.ramp / repeats) } else { ("ramp", place.ramp) };
    let mut cells = vec![(name, index.into())];
    cells.extend(place.value.map(|value| ("value", value.into())));
    cells.push(("leg", place.leg.map_or_else(String::new, |leg| leg.to_string()).into()));
    cells.extend((!place.is_point && repeats > 1).then(|| ("repeat", (place.ramp % repeats).into())));
    cells.extend(plan.parameters_at(place.ramp, place.at));
    cells
}

/// Begins a row with the leading columns.
pub(super) fn row<E: Experiment>(plan: &Plan<E>, place: Place) -> Row {
    Row::of(leading(plan, place).into_iter().map(|(_, cell)| cell))
}
