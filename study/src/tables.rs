//! Tables of records, written row by row, with the header and the rows from the same columns.

mod leading;
mod points;
mod rows;

use std::path::{Path, PathBuf};

use granular_edmd::observable::Heading;

use super::experiment::columns::{Column, Kind, Table, error_names};
use super::meanings;
use super::{Bracket, Experiment, Plan, Record, Scalar, StudyError};
use leading::{Place, leading, row};
use points::{Repeat, Repeats};
use rows::{Row, Rows, not_converged};

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
    repeats: Repeats,
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
        let first = Place::in_plan(plan, 0, 0);
        let transition = Place { value: None, at: None, ..first };
        let values = begin("values", first, of_values(&columns))?;
        let samples = begin("samples", first, of_samples(&columns))?;
        let points = begin("points", Place { is_point: true, ..first }, of_points(&columns))?;
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
        let repeats = Repeats::default();
        Ok(Self { plan, columns, values, samples, points, transitions, more, described, repeats })
    }

    /// Adds the rows of a record; records come in their order.
    pub(super) fn add(&mut self, record: &Record<E>) -> Result<(), StudyError> {
        let row = row(self.plan, Place::of(record));
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
            std::mem::take(&mut self.repeats).write(self.plan, ramp, &mut self.points)?;
        }
        Ok(())
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
                estimates.push((column.name().to_owned(), estimate));
            } else if let Kind::Record(value) = &column.kind {
                row = row.with(&value(record));
            }
        }
        self.values.push(row.with(&not_converged(&estimates).into()))?;
        // A refinement has different values in each repeat.
        if record.value_index() < self.plan.value_count() {
            let is_failed = record.outcome().reason().is_some();
            self.repeats.add(record.value_index(), Repeat { estimates, is_failed });
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

/// Describes the columns of the table of values after the leading ones. The last one names the columns whose
/// error is only a lower bound, separated by spaces: they have too few samples for their correlations.
fn of_values<E: Experiment>(columns: &[Column<E>]) -> Vec<Heading> {
    let mut all = plain(["seed", "made_by", "outcome", "samples"]);
    for column in columns.iter().filter(|column| column.in_values) {
        if column.has_error() {
            all.extend(of_estimate(column));
        } else {
            all.push(column.heading.clone());
        }
    }
    all.extend(plain(["not_converged"]));
    all
}

fn of_samples<E: Experiment>(columns: &[Column<E>]) -> Vec<Heading> {
    let sampled = columns.iter().filter(|column| column.in_samples);
    let sampled = sampled.map(|column| column.heading.clone());
    std::iter::once(Heading::new("time", "time")).chain(sampled).collect()
}

/// Describes the columns of the table of points: the repeats of each value together.
fn of_points<E: Experiment>(columns: &[Column<E>]) -> Vec<Heading> {
    let mut all = plain(["repeats", "failed"]);
    let estimated = columns.iter().filter(|column| column.in_values && column.has_error());
    all.extend(estimated.flat_map(of_estimate));
    all.extend(plain(["not_converged"]));
    all
}

fn plain<const N: usize>(names: [&str; N]) -> Vec<Heading> {
    names.map(|name| Heading::new(name, "")).into()
}

/// Describes a mean, its error, and its number of independent samples.
fn of_estimate<E: Experiment>(column: &Column<E>) -> [Heading; 3] {
    let (name, unit) = (column.name(), column.unit());
    let [error, independent] = error_names(name);
    [column.heading.clone(), Heading::new(error, unit), Heading::new(independent, "")]
}
