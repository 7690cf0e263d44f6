//! The table of points: the repeats of each value together.

use granular_edmd::statistics::Estimate;

use super::leading::{Place, row};
use super::rows::{Row, Rows, not_converged};
use crate::{Experiment, Plan, StudyError};

/// The repeats of one point: a list for each value.
#[derive(Default)]
pub(super) struct Repeats(Vec<Vec<Repeat>>);

/// The estimates of one repeat of a value, with the names of columns.
pub(super) struct Repeat {
    pub(super) estimates: Vec<(String, Estimate)>,
    /// True if the engine could not finish this repeat.
    pub(super) is_failed: bool,
}

impl Repeats {
    /// Adds the estimates of one repeat of a value.
    pub(super) fn add(&mut self, value: usize, repeat: Repeat) {
        if self.0.len() <= value {
            self.0.resize_with(value + 1, Vec::new);
        }
        self.0[value].push(repeat);
    }

    /// Writes a row for each value that has a finished repeat.
    pub(super) fn write<E: Experiment>(
        self,
        plan: &Plan<E>,
        ramp: usize,
        table: &mut Rows,
    ) -> Result<(), StudyError> {
        let done = self.0.iter().enumerate().filter(|(_, repeats)| !repeats.is_empty());
        for (value, repeats) in done {
            let place = Place { is_point: true, ..Place::in_plan(plan, ramp, value) };
            table.push(with_repeats(row(plan, place), repeats))?;
        }
        Ok(())
    }
}

fn with_repeats(row: Row, repeats: &[Repeat]) -> Row {
    let failed = repeats.iter().filter(|repeat| repeat.is_failed).count();
    let row = row.with(&repeats.len().into()).with(&failed.into());
    let of_column = |column: usize| repeats.iter().map(move |repeat| repeat.estimates[column].1);
    let names = repeats[0].estimates.iter().map(|(name, _)| name.clone()).enumerate();
    let together: Vec<(String, Estimate)> =
        names.map(|(column, name)| (name, Estimate::over_repeats(of_column(column)))).collect();
    let row = together.iter().fold(row, |row, (_, estimate)| row.with_estimate(estimate));
    row.with(&not_converged(&together).into())
}
