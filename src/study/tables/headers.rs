//! The columns of each table, by name and unit.

use std::fmt::Write;

use crate::observable::Heading;
use crate::study::column::{Column, error_names};
use crate::study::{Experiment, Plan, Scalar, Table};

/// Returns the table of the columns of all tables.
pub(super) fn table<'a, E: Experiment + 'a>(
    plan: &Plan<E>,
    columns: &[Column<E>],
    own: impl Iterator<Item = &'a Table<E>>,
) -> String {
    let mut tables = vec![("values", of_values(plan, columns)), ("samples", of_samples(plan, columns))];
    if plan.repeats() > 1 {
        tables.push(("points", of_points(plan, columns)));
    }
    if plan.is_refined() {
        tables.push(("transitions", of_transitions(plan)));
    }
    tables.extend(own.map(|table| (table.name(), of_own(plan, table))));
    let mut text = String::from("table,column,unit\n");
    for (table, columns) in tables {
        for column in columns {
            // Writing to a string does not fail.
            let _ = writeln!(text, "{table},{},{}", column.name(), Scalar::from(column.unit()));
        }
    }
    text
}

/// Returns the first line of a table.
pub(super) fn line(columns: &[Heading]) -> String {
    let names: Vec<&str> = columns.iter().map(Heading::name).collect();
    format!("{}\n", names.join(","))
}

/// Describes the first columns of all tables but that of points.
fn place<E: Experiment>(plan: &Plan<E>) -> Vec<Heading> {
    let mut place: Vec<_> = ["ramp", "value", "leg"].map(|name| Heading::new(name, "")).into();
    place.extend((plan.repeats() > 1).then(|| Heading::new("repeat", "")));
    place.extend(plan.varied().map(|name| Heading::new(name, "")));
    place
}

/// Describes the columns of the table of values. Its last column names the columns whose error is only
/// a lower bound, separated by spaces: they have too few samples for their correlations.
pub(super) fn of_values<E: Experiment>(plan: &Plan<E>, columns: &[Column<E>]) -> Vec<Heading> {
    let mut all = place(plan);
    all.extend(["seed", "outcome", "samples"].map(|name| Heading::new(name, "")));
    for column in columns.iter().filter(|column| column.is_in_values()) {
        if column.has_error() {
            all.extend(of_estimate(column));
        } else {
            all.push(column.heading().clone());
        }
    }
    all.push(Heading::new("not_converged", ""));
    all
}

pub(super) fn of_samples<E: Experiment>(plan: &Plan<E>, columns: &[Column<E>]) -> Vec<Heading> {
    let mut all = place(plan);
    all.push(Heading::new("time", "time"));
    let sampled = columns.iter().filter(|column| column.is_in_samples());
    all.extend(sampled.map(|column| column.heading().clone()));
    all
}

/// Describes the columns of the table of points: the repeats of each value together.
pub(super) fn of_points<E: Experiment>(plan: &Plan<E>, columns: &[Column<E>]) -> Vec<Heading> {
    let mut all: Vec<_> = ["point", "value", "leg"].map(|name| Heading::new(name, "")).into();
    all.extend(plan.varied().map(|name| Heading::new(name, "")));
    all.extend(["repeats", "failed"].map(|name| Heading::new(name, "")));
    let estimated = columns.iter().filter(|column| column.is_in_values() && column.has_error());
    all.extend(estimated.flat_map(of_estimate));
    all.push(Heading::new("not_converged", ""));
    all
}

/// Describes a mean, its error, and the number of independent samples that they rest on.
fn of_estimate<E: Experiment>(column: &Column<E>) -> [Heading; 3] {
    let (name, unit) = (column.name(), column.unit());
    let [error, independent] = error_names(name);
    [column.heading().clone(), Heading::new(error, unit), Heading::new(independent, "")]
}

/// Describes the columns of the table of transitions: the values of the ramped parameter and the states on
/// both sides.
pub(super) fn of_transitions<E: Experiment>(plan: &Plan<E>) -> Vec<Heading> {
    let mut all: Vec<_> = ["ramp", "leg"].map(|name| Heading::new(name, "")).into();
    all.extend((plan.repeats() > 1).then(|| Heading::new("repeat", "")));
    let swept = plan.varied().count() - usize::from(plan.ramp().is_some());
    all.extend(plan.varied().take(swept).map(|name| Heading::new(name, "")));
    all.extend(["near", "far", "from_state", "to_state"].map(|name| Heading::new(name, "")));
    all
}

pub(super) fn of_own<E: Experiment>(plan: &Plan<E>, table: &Table<E>) -> Vec<Heading> {
    let mut all = place(plan);
    all.extend(table.columns().iter().cloned());
    all
}
