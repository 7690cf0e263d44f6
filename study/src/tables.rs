//! Tables of records, written row by row, with the header and the rows from the same columns.

mod rows;

use std::path::{Path, PathBuf};

use granular_edmd::observable::Heading;
use granular_edmd::statistics::Estimate;

use super::experiment::columns::{Column, Kind, Table};
use super::meanings;
use super::{Bracket, Experiment, Plan, Record, Scalar, StudyError};
use rows::{Place, Row, Rows, leading, row};

/// The growing tables of a study. A table takes its place in the folder when all of them are whole.
pub(super) struct Tables<'a, E: Experiment> {
    plan: &'a Plan<E>,
    columns: Vec<Column<E>>,
    values: Rows,
    samples: Rows,
    points: Rows,
    transitions: Option<Rows>,
    more: Vec<(Table<E>, Rows)>,
    described: Rows,
    /// For each value of the present point, its repeats so far.
    repeats: Vec<Vec<Repeat>>,
}

/// One repeat of a value.
struct Repeat {
    /// The estimates of the columns with errors, in their order.
    estimates: Vec<Estimate>,
    /// True if the engine could not finish this repeat.
    is_failed: bool,
}

/// Returns the files of all tables of a plan in a folder.
pub(super) fn files<E: Experiment>(plan: &Plan<E>, folder: &Path) -> impl Iterator<Item = PathBuf> {
    let refined = plan.is_refined().then_some("transitions");
    let names = ["values", "samples", "points", "columns"].into_iter().chain(refined);
    let own = E::tables().into_iter().map(|table| table.name().to_owned());
    names.map(str::to_owned).chain(own).map(move |name| file(folder, &name))
}

fn file(folder: &Path, name: &str) -> PathBuf {
    folder.join(format!("{name}.csv"))
}

impl<'a, E: Experiment> Tables<'a, E> {
    /// Begins tables with a first line and no rows.
    pub(super) fn new(plan: &'a Plan<E>, folder: &Path) -> Result<Self, StudyError> {
        let columns = E::columns();
        let mut described = Rows::begin(folder, "columns")?;
        described.push(Row::of(["table", "column", "unit", "meaning"]))?;
        let mut begin = |name: &str, place: Place, own: Vec<Heading>| -> Result<Rows, StudyError> {
            let leading = leading(plan, place).into_iter().map(|(name, _)| Heading::new(name, ""));
            let headings: Vec<Heading> = leading.chain(own).collect();
            for heading in &headings {
                let meaning = meanings::of_column(plan, name, heading.name());
                described.push(Row::of([name, heading.name(), heading.unit(), &meaning]))?;
            }
            let mut rows = Rows::begin(folder, name)?;
            rows.push(Row::of(headings.iter().map(Heading::name)))?;
            Ok(rows)
        };
        let (leg, at) = plan.step(0).unzip();
        let first = Place { ramp: 0, value: Some(0), leg, at, is_point: false };
        let transition = Place { value: None, at: None, ..first };
        let in_values = columns.iter().filter(|column| column.in_values);
        let own = in_values.clone().flat_map(Column::headings);
        let values = begin("values", first, between(&["seed", "made_by", "outcome", "samples"], own))?;
        let sampled = columns.iter().filter(|column| column.in_samples).map(|column| column.heading.clone());
        let time = std::iter::once(Heading::new("time", "time"));
        let samples = begin("samples", first, time.chain(sampled).collect())?;
        let own = in_values.filter(|column| column.has_error()).flat_map(Column::headings);
        let point = Place { is_point: true, ..first };
        let points = begin("points", point, between(&["repeats", "failed"], own))?;
        let refined = plan.ramp().filter(|_| plan.is_refined());
        let transitions = refined.map(|ramp| {
            let near = ["near", "far"].map(|side| format!("{}_{side}", ramp.parameter()));
            let own = near.into_iter().chain(["from_state", "to_state"].map(str::to_owned));
            begin("transitions", transition, own.map(|name| Heading::new(name, "")).collect())
        });
        let transitions = transitions.transpose()?;
        let more = E::tables().into_iter().map(|table| {
            let rows = begin(table.name(), first, table.columns().to_vec())?;
            Ok((table, rows))
        });
        let more = more.collect::<Result<_, StudyError>>()?;
        let repeats = Vec::new();
        Ok(Self { plan, columns, values, samples, points, transitions, more, described, repeats })
    }

    /// Adds the rows of a record; records come in their order.
    pub(super) fn add(&mut self, record: &Record<E>) -> Result<(), StudyError> {
        let (ramp, value) = (record.ramp_index(), Some(record.value_index()));
        let place = Place { ramp, value, leg: record.leg(), at: record.ramped_value(), is_point: false };
        let row = row(self.plan, place);
        self.add_value(record, row.clone())?;
        self.add_samples(record, &row)?;
        for (table, rows) in &mut self.more {
            for cells in table.rows(record) {
                // Missing numbers are empty cells.
                let cells = cells.into_iter().chain(std::iter::repeat(f64::NAN)).take(table.columns().len());
                rows.push(cells.fold(row.clone(), |row, cell| row.with(&cell.into())))?;
            }
        }
        Ok(())
    }

    /// Adds the rows that need all records of a ramp.
    pub(super) fn end_ramp(&mut self, ramp: usize, brackets: &[Bracket]) -> Result<(), StudyError> {
        for Bracket { leg, near, far, from, to } in brackets {
            let Some(rows) = &mut self.transitions else { break };
            let place = Place { ramp, value: None, leg: *leg, at: None, is_point: false };
            let cells = [Scalar::from(*near), (*far).into(), from.as_str().into(), to.as_str().into()];
            rows.push(cells.iter().fold(row(self.plan, place), Row::with))?;
        }
        if (ramp + 1).is_multiple_of(self.plan.repeats()) {
            self.end_point(ramp)?;
        }
        Ok(())
    }

    /// Adds a row for each value of a point: all its finished repeats together.
    fn end_point(&mut self, ramp: usize) -> Result<(), StudyError> {
        let all = std::mem::take(&mut self.repeats).into_iter().enumerate();
        for (value, repeats) in all.filter(|(_, repeats)| !repeats.is_empty()) {
            let (leg, at) = self.plan.step(value).unzip();
            let place = Place { ramp, value: Some(value), leg, at, is_point: true };
            let failed = repeats.iter().filter(|repeat| repeat.is_failed).count();
            let row = row(self.plan, place).with(&repeats.len().into()).with(&failed.into());
            let of_column = |column: usize| repeats.iter().map(move |repeat| repeat.estimates[column]);
            let columns = 0..repeats[0].estimates.len();
            let together: Vec<_> = columns.map(|column| Estimate::over_repeats(of_column(column))).collect();
            let row = together.iter().fold(row, Row::with_estimate);
            self.points.push(row.with(&self.not_converged(&together)))?;
        }
        Ok(())
    }

    /// Returns the names of the columns whose error is only a lower bound, separated by spaces: they have too
    /// few samples for their correlations.
    fn not_converged(&self, estimates: &[Estimate]) -> Scalar {
        let columns = self.columns.iter().filter(|column| column.in_values && column.has_error());
        let found = columns.zip(estimates).filter(|(_, estimate)| !estimate.is_converged());
        found.map(|(column, _)| column.name()).collect::<Vec<_>>().join(" ").into()
    }

    /// Renames the finished tables to their final names.
    pub(super) fn finish(self) -> Result<(), StudyError> {
        let own = self.more.into_iter().map(|(_, rows)| rows);
        let all = [self.values, self.samples, self.points, self.described].into_iter();
        all.chain(self.transitions).chain(own).try_for_each(Rows::finish)
    }

    fn add_value(&mut self, record: &Record<E>, row: Row) -> Result<(), StudyError> {
        // A double cannot hold every number of 64 bits. With a letter before it, it is text for every reader
        // of tables.
        let row = row.with(&format!("x{:016x}", record.seed()).into());
        let row = row.with(&record.contents.origin.maker.to_string().into());
        let mut row = row.with(&record.outcome().name().into()).with(&record.samples().len().into());
        let mut estimates = Vec::new();
        for column in self.columns.iter().filter(|column| column.in_values) {
            if let Some(estimate) = column.estimate(record) {
                row = row.with_estimate(&estimate);
                estimates.push(estimate);
            } else if let Kind::Record(value) = &column.kind {
                row = row.with(&value(record));
            }
        }
        self.values.push(row.with(&self.not_converged(&estimates)))?;
        // A refinement has different values in each repeat.
        let value = record.value_index();
        if value < self.plan.value_count() {
            self.repeats.resize_with(self.repeats.len().max(value + 1), Vec::new);
            self.repeats[value].push(Repeat { estimates, is_failed: record.outcome().reason().is_some() });
        }
        Ok(())
    }

    fn add_samples(&mut self, record: &Record<E>, row: &Row) -> Result<(), StudyError> {
        for (time, sample) in record.times().iter().zip(record.samples()) {
            let mut row = row.clone().with(&(*time).into());
            for column in self.columns.iter().filter(|column| column.in_samples) {
                if let Kind::Sample(value) = &column.kind {
                    row = row.with(&value(sample));
                }
            }
            self.samples.push(row)?;
        }
        Ok(())
    }
}

/// Returns the headings of a table between its leading columns and the last one.
fn between(first: &[&str], own: impl Iterator<Item = Heading>) -> Vec<Heading> {
    let plain = |name: &&str| Heading::new(*name, "");
    first.iter().map(plain).chain(own).chain([Heading::new("not_converged", "")]).collect()
}
