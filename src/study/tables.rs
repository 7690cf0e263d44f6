//! Records as tables: header and rows from the same columns.

use std::fmt::{Display, Write};

use super::column::{Column, Kind};
use super::{Bracket, Experiment, Plan, Record, Scalar, Table};
use crate::statistics::{Estimate, RunningMean};

/// The tables of a study, as they grow.
pub(super) struct Tables<'a, E: Experiment> {
    plan: &'a Plan<E>,
    columns: Vec<Column<E>>,
    more: Vec<(Table<E>, String)>,
    values: String,
    samples: String,
    transitions: String,
    points: String,
    /// The estimates of the values of a point, repeat after repeat, each by value and column.
    repeats: Vec<Vec<Vec<Estimate>>>,
}

impl<'a, E: Experiment> Tables<'a, E> {
    /// Makes tables with a first line and no rows.
    pub(super) fn new(plan: &'a Plan<E>) -> Self {
        let columns = E::columns();
        let names = |table: Vec<Described>| {
            let names: Vec<String> = table.into_iter().map(|column| column.name).collect();
            format!("{}\n", names.join(","))
        };
        let more = E::tables().into_iter().map(|table| {
            let header = names(describe_more(plan, &table));
            (table, header)
        });
        Self {
            plan,
            more: more.collect(),
            values: names(describe_values(plan, &columns)),
            samples: names(describe_samples(plan, &columns)),
            transitions: names(describe_transitions(plan)),
            points: names(describe_points(plan, &columns)),
            repeats: Vec::new(),
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
        self.add_repeat(record);
    }

    /// Returns the tables, by their names.
    pub(super) fn finish(self) -> Vec<(String, String)> {
        let described = self.describe();
        let is_refined = self.is_refined();
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

    fn is_refined(&self) -> bool {
        self.plan.ramp().is_some_and(|ramp| ramp.refine().is_some())
    }

    /// Adds the transitions of a ramp.
    pub(super) fn add_transitions(&mut self, ramp: usize, brackets: &[Bracket]) {
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
        let mut place = format!("{},{},", record.ramp(), record.value());
        if let Some(leg) = record.leg() {
            place.push_str(&leg.to_string());
        }
        if self.plan.repeats() > 1 {
            append(&mut place, &(record.ramp() % self.plan.repeats()));
        }
        let parameters = self.plan.parameters_at(record.ramp(), record.at());
        for (_, value) in &parameters {
            append(&mut place, value);
        }
        place
    }

    fn add_value(&mut self, record: &Record<E>, place: &str) {
        let (outcome, samples) = (record.outcome().name(), record.samples().len());
        let mut line = format!("{place},{},{outcome},{samples}", record.seed());
        let mut not_converged = Vec::new();
        for column in self.columns.iter().filter(|column| column.is_in_values()) {
            if let Some(estimate) = column.estimate(record) {
                append_estimate(&mut line, &estimate);
                not_converged.extend((!estimate.is_converged()).then_some(column.name()));
            } else if let Kind::Record(value) = column.kind() {
                append(&mut line, &value(record));
            }
        }
        append(&mut line, &not_converged.join(" "));
        self.values.push_str(&line);
        self.values.push('\n');
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

    /// Keeps the estimates of a record, and adds the rows of its point after the last value of the last repeat.
    fn add_repeat(&mut self, record: &Record<E>) {
        let repeats = self.plan.repeats();
        // The values of a refinement are others in each repeat.
        if repeats < 2 || record.value() >= self.plan.values() {
            return;
        }
        let in_values = self.columns.iter().filter(|column| column.is_in_values());
        let estimates = in_values.filter_map(|column| column.estimate(record)).collect();
        let (repeat, value) = (record.ramp() % repeats, record.value());
        if repeat == 0 && value == 0 {
            self.repeats = Vec::new();
        }
        self.repeats.resize_with(self.plan.values(), Vec::new);
        self.repeats[value].push(estimates);
        if repeat + 1 == repeats && value + 1 == self.plan.values() {
            self.add_point(record.ramp() / repeats);
        }
    }

    fn add_point(&mut self, point: usize) {
        for (value, repeats) in std::mem::take(&mut self.repeats).iter().enumerate() {
            let mut line = format!("{point},{value},");
            if let Some(leg) = self.plan.leg(value) {
                line.push_str(&leg.to_string());
            }
            let parameters = self.plan.parameters(point * self.plan.repeats(), value);
            for (_, value) in &parameters {
                append(&mut line, value);
            }
            append(&mut line, &repeats.len());
            for column in 0..repeats.first().map_or(0, Vec::len) {
                let means = repeats.iter().map(|estimates| estimates[column].mean());
                let known: Vec<f64> = means.filter(|mean| !mean.is_nan()).collect();
                let mean = known.iter().copied().collect::<RunningMean>().estimate();
                append(&mut line, &Scalar::from(mean.mean()));
                append(&mut line, &Scalar::from(mean.standard_error()));
            }
            self.points.push_str(&line);
            self.points.push('\n');
        }
    }

    /// Returns the table of the columns of all tables.
    fn describe(&self) -> String {
        let mut tables = vec![
            ("values", describe_values(self.plan, &self.columns)),
            ("samples", describe_samples(self.plan, &self.columns)),
        ];
        if self.plan.repeats() > 1 {
            tables.push(("points", describe_points(self.plan, &self.columns)));
        }
        if self.is_refined() {
            tables.push(("transitions", describe_transitions(self.plan)));
        }
        tables.extend(self.more.iter().map(|(table, _)| (table.name(), describe_more(self.plan, table))));
        let mut text = String::from("table,column,unit\n");
        for (table, columns) in tables {
            for Described { name, unit } in columns {
                // Writing to a string does not fail.
                let _ = writeln!(text, "{table},{name},{}", Scalar::from(unit));
            }
        }
        text
    }
}

/// A column by name and unit.
struct Described {
    name: String,
    unit: &'static str,
}

fn described(name: impl Into<String>, unit: &'static str) -> Described {
    Described { name: name.into(), unit }
}

/// Describes the first columns of all tables but that of points.
fn describe_place<E: Experiment>(plan: &Plan<E>) -> Vec<Described> {
    let mut place: Vec<_> = ["ramp", "value", "leg"].map(|name| described(name, "")).into();
    place.extend((plan.repeats() > 1).then(|| described("repeat", "")));
    place.extend(plan.varied().map(|name| described(name, "")));
    place
}

/// Describes the columns of the table of values. Its last column names those whose error is a lower bound, apart by spaces: they
/// have too few samples for their correlations.
fn describe_values<E: Experiment>(plan: &Plan<E>, columns: &[Column<E>]) -> Vec<Described> {
    let mut all = describe_place(plan);
    all.extend(["seed", "outcome", "samples"].map(|name| described(name, "")));
    for column in columns.iter().filter(|column| column.is_in_values()) {
        let (name, unit) = (column.name(), column.unit());
        all.push(described(name, unit));
        if !matches!(column.kind(), Kind::Record(_)) {
            all.push(described(format!("{name}_error"), unit));
            all.push(described(format!("{name}_independent_samples"), ""));
        }
    }
    all.push(described("not_converged", ""));
    all
}

fn describe_samples<E: Experiment>(plan: &Plan<E>, columns: &[Column<E>]) -> Vec<Described> {
    let mut all = describe_place(plan);
    all.push(described("time", "time"));
    let sampled = columns.iter().filter(|column| column.is_in_samples());
    all.extend(sampled.map(|column| described(column.name(), column.unit())));
    all
}

/// Describes the columns of the table of points: means over repeats, with errors from their scatter.
fn describe_points<E: Experiment>(plan: &Plan<E>, columns: &[Column<E>]) -> Vec<Described> {
    let mut all: Vec<_> = ["point", "value", "leg"].map(|name| described(name, "")).into();
    all.extend(plan.varied().map(|name| described(name, "")));
    all.push(described("repeats", ""));
    let estimated = |column: &&Column<E>| column.is_in_values() && !matches!(column.kind(), Kind::Record(_));
    for column in columns.iter().filter(estimated) {
        all.push(described(column.name(), column.unit()));
        all.push(described(format!("{}_error", column.name()), column.unit()));
    }
    all
}

/// Describes the columns of the table of transitions: the values of the ramped parameter and the states on both sides.
fn describe_transitions<E: Experiment>(plan: &Plan<E>) -> Vec<Described> {
    let mut all: Vec<_> = ["ramp", "leg"].map(|name| described(name, "")).into();
    all.extend((plan.repeats() > 1).then(|| described("repeat", "")));
    let swept = plan.varied().count() - usize::from(plan.ramp().is_some());
    all.extend(plan.varied().take(swept).map(|name| described(name, "")));
    all.extend(["near", "far", "from_state", "to_state"].map(|name| described(name, "")));
    all
}

fn describe_more<E: Experiment>(plan: &Plan<E>, table: &Table<E>) -> Vec<Described> {
    let mut all = describe_place(plan);
    all.extend(table.columns().iter().map(|(name, unit)| described(*name, unit)));
    all
}

/// Adds a mean, its error, and the number of independent samples that they rest on.
fn append_estimate(line: &mut String, estimate: &Estimate) {
    append(line, &Scalar::from(estimate.mean()));
    append(line, &Scalar::from(estimate.standard_error()));
    append(line, &Scalar::from(independent_samples(estimate)));
}

/// Returns the number of independent samples that tell as much as those of an estimate.
pub(super) fn independent_samples(estimate: &Estimate) -> f64 {
    let samples = estimate.samples() as f64;
    samples / estimate.correlated_samples().max(1.0)
}

fn append(line: &mut String, cell: &impl Display) {
    // Writing to a string does not fail.
    let _ = write!(line, ",{cell}");
}
