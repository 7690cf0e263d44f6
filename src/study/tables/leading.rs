//! The leading columns of every table, which tell the place of a row in the study.

use crate::study::experiment::Experiment;
use crate::study::experiment::record::Record;
use crate::study::leg::Leg;
use crate::study::plan::Plan;
use crate::study::scalar::Scalar;

/// The place of a row.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place {
    pub(super) ramp: usize,
    pub(super) value: usize,
    pub(super) leg: Option<Leg>,
    /// Value of the ramped parameter.
    pub(super) at: Option<f64>,
    pub(super) kind: Kind,
}

/// The thing that a row is about.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Kind {
    Value,
    /// All repeats of a value.
    Point,
    /// A place between two values.
    Transition,
}

impl Place {
    /// Returns the place of a record.
    pub(super) fn of<E: Experiment>(record: &Record<E>) -> Self {
        let (ramp, value) = (record.ramp_index(), record.value_index());
        Self { ramp, value, leg: record.leg(), at: record.ramped_value(), kind: Kind::Value }
    }

    /// Returns the place of the first value of a plan.
    pub(super) fn first<E: Experiment>(plan: &Plan<E>) -> Self {
        let (leg, at) = plan.step(0).unzip();
        Self { ramp: 0, value: 0, leg, at, kind: Kind::Value }
    }

    /// Returns the place of all repeats of the value.
    pub(super) const fn of_point(self) -> Self {
        Self { kind: Kind::Point, ..self }
    }

    /// Returns the place of a transition of the ramp.
    pub(super) const fn of_transition(self) -> Self {
        Self { kind: Kind::Transition, at: None, ..self }
    }
}

/// Returns the names and cells of the leading columns.
pub(super) fn leading<E: Experiment>(plan: &Plan<E>, place: Place) -> Vec<(&str, Scalar)> {
    let (repeats, kind) = (plan.repeats(), place.kind);
    let mut cells = vec![match kind {
        Kind::Point => ("point", (place.ramp / repeats).into()),
        Kind::Value | Kind::Transition => ("ramp", place.ramp.into()),
    }];
    cells.extend((kind != Kind::Transition).then(|| ("value", place.value.into())));
    cells.push(("leg", place.leg.map_or_else(String::new, |leg| leg.to_string()).into()));
    cells.extend((kind != Kind::Point && repeats > 1).then(|| ("repeat", (place.ramp % repeats).into())));
    cells.extend(plan.parameters_at(place.ramp, place.at));
    cells
}
