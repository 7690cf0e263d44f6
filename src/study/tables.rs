//! Records as tables: header and rows from the same columns.

mod headers;
mod points;

use std::fmt::{Display, Write};

use super::column::{Column, Kind};
use super::{Bracket, Experiment, Plan, Record, Scalar, Table};
use crate::statistics::Estimate;
use points::{Repeat, Repeats};

/// The tables of a study, as they grow.
pub(super) struct Tables<'a, E: Experiment> {
    plan: &'a Plan<E>,
    columns: Vec<Column<E>>,
    more: Vec<(Table<E>, String)>,
    values: String,
    samples: String,
    transitions: String,
    points: String,
    repeats: Repeats,
}

impl<'a, E: Experiment> Tables<'a, E> {
    /// Makes tables with a first line and no rows.
    pub(super) fn new(plan: &'a Plan<E>) -> Self {
        let columns = E::columns();
        let more = E::tables().into_iter().map(|table| {
            let header = headers::line(&headers::of_own(plan, &table));
            (table, header)
        });
        Self {
            plan,
            more: more.collect(),
            values: headers::line(&headers::of_values(plan, &columns)),
            samples: headers::line(&headers::of_samples(plan, &columns)),
            transitions: headers::line(&headers::of_transitions(plan)),
            points: headers::line(&headers::of_points(plan, &columns)),
            repeats: Repeats::default(),
            columns,
        }
    }

    /// Adds the rows of a record; records come in their order.
    pub(super) fn add(&mut self, record: &Record<E>) {
        let place = self.place(record);
        self.add_value(record, &place);
        self.add_samples(record, &place);
        for (table, text) in &mut self.more {
            for cells in table.rows(record) {
                text.push_str(&place);
                let cells = cells.into_iter().chain(std::iter::repeat(f64::NAN));
                cells.take(table.columns().len()).for_each(|cell| append(text, &Scalar::from(cell)));
                text.push('\n');
            }
        }
    }

    /// Returns the tables, by their names.
    pub(super) fn finish(self) -> Vec<(String, String)> {
        let described = headers::table(self.plan, &self.columns, self.more.iter().map(|(table, _)| table));
        let is_refined = self.plan.is_refined();
        let mut tables = vec![("values".to_owned(), self.values), ("samples".to_owned(), self.samples)];
        if self.plan.repeats() > 1 {
            tables.push(("points".to_owned(), self.points));
        }
        if is_refined {
            tables.push(("transitions".to_owned(), self.transitions));
        }
        tables.extend(self.more.into_iter().map(|(table, text)| (table.name().to_owned(), text)));
        tables.push(("columns".to_owned(), described));
        tables
    }

    /// Adds what is known once all records of a ramp have come.
    pub(super) fn end_ramp(&mut self, ramp: usize, brackets: &[Bracket]) {
        self.add_transitions(ramp, brackets);
        if (ramp + 1).is_multiple_of(self.plan.repeats()) {
            let repeats = std::mem::take(&mut self.repeats);
            repeats.write(self.plan, ramp / self.plan.repeats(), &mut self.points);
        }
    }

    fn add_transitions(&mut self, ramp: usize, brackets: &[Bracket]) {
        for Bracket { leg, near, far, from, to } in brackets {
            let mut line = format!("{ramp},");
            if let Some(leg) = leg {
                line.push_str(&leg.to_string());
            }
            if self.plan.repeats() > 1 {
                append(&mut line, &(ramp % self.plan.repeats()));
            }
            for (_, value) in self.plan.parameters_at(ramp, None) {
                append(&mut line, &value);
            }
            for cell in [Scalar::from(*near), (*far).into(), from.as_str().into(), to.as_str().into()] {
                append(&mut line, &cell);
            }
            self.transitions.push_str(&line);
            self.transitions.push('\n');
        }
    }

    /// Returns the first columns of all rows of a record.
    fn place(&self, record: &Record<E>) -> String {
        let mut place = format!("{},{},", record.ramp_index(), record.value_index());
        if let Some(leg) = record.leg() {
            place.push_str(&leg.to_string());
        }
        if self.plan.repeats() > 1 {
            append(&mut place, &(record.ramp_index() % self.plan.repeats()));
        }
        let parameters = self.plan.parameters_at(record.ramp_index(), record.ramped_value());
        for (_, value) in &parameters {
            append(&mut place, value);
        }
        place
    }

    fn add_value(&mut self, record: &Record<E>, place: &str) {
        let (outcome, samples) = (record.outcome().name(), record.samples().len());
        let mut line = format!("{place},{},{outcome},{samples}", record.seed());
        let mut estimates = Vec::new();
        for column in self.columns.iter().filter(|column| column.is_in_values()) {
            if let Some(estimate) = column.estimate(record) {
                append_estimate(&mut line, &estimate);
                estimates.push((column.name().to_owned(), estimate));
            } else if let Kind::Record(value) = column.kind() {
                append(&mut line, &value(record));
            }
        }
        append(&mut line, &not_converged(&estimates));
        self.values.push_str(&line);
        self.values.push('\n');
        // A refinement has different values in each repeat.
        if record.value_index() < self.plan.value_count() {
            let is_failed = record.outcome().reason().is_some();
            self.repeats.add(record.value_index(), Repeat { estimates, is_failed });
        }
    }

    fn add_samples(&mut self, record: &Record<E>, place: &str) {
        for (time, sample) in record.times().iter().zip(record.samples()) {
            self.samples.push_str(place);
            append(&mut self.samples, &Scalar::from(*time));
            for column in self.columns.iter().filter(|column| column.is_in_samples()) {
                if let Kind::Sample(value) = column.kind() {
                    append(&mut self.samples, &value(sample));
                }
            }
            self.samples.push('\n');
        }
    }
}

/// Adds a mean, its error, and the number of independent samples that they rest on.
fn append_estimate(line: &mut String, estimate: &Estimate) {
    append(line, &Scalar::from(estimate.mean()));
    append(line, &Scalar::from(estimate.standard_error()));
    append(line, &Scalar::from(estimate.independent_samples()));
}

/// Returns the names of the estimates whose error is only a lower bound, separated by spaces.
fn not_converged(estimates: &[(String, Estimate)]) -> String {
    let names =
        estimates.iter().filter(|(_, estimate)| !estimate.is_converged()).map(|(name, _)| name.as_str());
    names.collect::<Vec<_>>().join(" ")
}

fn append(line: &mut String, cell: &impl Display) {
    // Writing to a string does not fail.
    let _ = write!(line, ",{cell}");
}
