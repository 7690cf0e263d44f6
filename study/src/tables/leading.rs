//! The leading columns of every table, which show to what part of the study a row belongs.

use super::rows::Row;
use crate::{Experiment, Leg, Plan, Record, Scalar};

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

impl Place {
    /// Returns the place of a record.
    pub(super) fn of<E: Experiment>(record: &Record<E>) -> Self {
        let (ramp, value) = (record.ramp_index(), Some(record.value_index()));
        Self { ramp, value, leg: record.leg(), at: record.ramped_value(), is_point: false }
    }

    /// Returns the place of a planned value, which needs no record.
    pub(super) fn in_plan<E: Experiment>(plan: &Plan<E>, ramp: usize, value: usize) -> Self {
        let (leg, at) = plan.step(value).unzip();
        Self { ramp, value: Some(value), leg, at, is_point: false }
    }
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
