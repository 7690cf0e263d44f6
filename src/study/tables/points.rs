//! The table of points: the repeats of each value together.

use super::{append, append_estimate, not_converged};
use crate::statistics::Estimate;
use crate::study::{Experiment, Plan};

/// The repeats of one point: a list for each value.
#[derive(Default)]
pub(super) struct Repeats(Vec<Vec<Repeat>>);

/// The estimates of one repeat of a value, with the names of columns.
pub(super) struct Repeat {
    pub(super) estimates: Vec<(String, Estimate)>,
    /// True if the engine could not finish it.
    pub(super) is_failed: bool,
}

impl Repeats {
    /// Adds a value of one repeat.
    pub(super) fn add(&mut self, value: usize, repeat: Repeat) {
        if self.0.len() <= value {
            self.0.resize_with(value + 1, Vec::new);
        }
        self.0[value].push(repeat);
    }

    /// Writes a row for each value of which a repeat is finished.
    pub(super) fn write<E: Experiment>(self, plan: &Plan<E>, point: usize, table: &mut String) {
        let done = self.0.iter().enumerate().filter(|(_, repeats)| !repeats.is_empty());
        for (value, repeats) in done {
            table.push_str(&row(plan, point, value, repeats));
            table.push('\n');
        }
    }
}

fn row<E: Experiment>(plan: &Plan<E>, point: usize, value: usize, repeats: &[Repeat]) -> String {
    let mut line = format!("{point},{value},");
    if let Some(leg) = plan.leg(value) {
        line.push_str(&leg.to_string());
    }
    for (_, parameter) in plan.parameters(point * plan.repeats(), value) {
        append(&mut line, &parameter);
    }
    append(&mut line, &repeats.len());
    append(&mut line, &repeats.iter().filter(|repeat| repeat.is_failed).count());
    let of_column = |column: usize| repeats.iter().map(move |repeat| repeat.estimates[column].1);
    let names = repeats[0].estimates.iter().map(|(name, _)| name.clone()).enumerate();
    let together: Vec<(String, Estimate)> =
        names.map(|(column, name)| (name, Estimate::over_repeats(of_column(column)))).collect();
    for (_, estimate) in &together {
        append_estimate(&mut line, estimate);
    }
    append(&mut line, &not_converged(&together));
    line
}
