//! The meanings of the keys of plans and of the columns of tables, for `explain`, its schema, the comments of
//! a new plan, and `columns.csv`.

use super::experiment::columns::{Column, error_names};
use super::{Experiment, Plan};

/// The keys that every plan has, whatever its experiment, by section.
pub(super) const OF_PLANS: [(&str, &str); 24] = [
    (
        "seed",
        "Seed of all random numbers, a whole number below 2^63: the same plan gives the same bytes. Required.",
    ),
    (
        "repeats",
        "Number of times that each point is done, each with another seed. 1 if not given. Eight give a mean an error that can be trusted; fewer do if all together have 120 independent samples: see not_converged in points.csv.",
    ),
    (
        "end_states",
        "`true` keeps the state at the end of each value, so that a later plan with more samples goes on from it. `false` if not given.",
    ),
    ("experiment", "The system: each of its parameters can be ramped or swept. Required."),
    ("protocol", "What is measured at each value, and when. Required."),
    (
        "protocol.settle",
        "Cycles that are run and not measured before each value, at least 0. A cycle is a period of the base, or a unit of time without one. Required.",
    ),
    (
        "protocol.samples",
        "Number of samples of each value, at least 1. Errors are trustworthy from some hundred independent ones on. Required.",
    ),
    (
        "protocol.every",
        "Cycles from one sample to the next, at least 1. Samples so close that they resemble each other add little. Required.",
    ),
    (
        "protocol.phase",
        "Part of a cycle at which samples are taken, above 0 and at most 1. 1 if not given: the end of the cycle.",
    ),
    (
        "protocol.most_collisions",
        "Number of collisions after which a value is ended, the same on every machine. No limit if not given.",
    ),
    ("ramp", "A hysteresis experiment: one run, whose parameter changes step by step. None if not given."),
    (
        "ramp.parameter",
        "Parameter that changes step by step, each value from the last state of the one before. Required.",
    ),
    ("ramp.values", "Values of the ramp, which increase: a list, or a rule. Required."),
    ("ramp.course", "`up`, `down`, or `up_and_down`, which shows hysteresis. `up` if not given."),
    (
        "ramp.refine",
        "Width to which each change of the state between two values is bisected, absolute or relative. None if not given.",
    ),
    ("ramp.refine.absolute", "Width in the unit of the parameter, above 0."),
    ("ramp.refine.relative", "Width as a fraction of the value, above 0; all values must then be positive."),
    ("sweep", "Independent runs. None if not given."),
    (
        "sweep.parameter",
        "Parameter that differs between ramps, which are independent of each other and may run side by side. Required.",
    ),
    (
        "sweep.values",
        "Values of the sweep: a list in any order, or a rule. Several sweeps make all combinations. Required.",
    ),
    ("values.from", "First value of a rule. Required."),
    ("values.to", "Last value of a rule. Required."),
    ("values.step", "Difference of neighbors, for equal steps. A rule has either this or `log`."),
    ("values.log", "Number of values, for equal ratios. A rule has either this or `step`."),
];

/// The columns that the tables of every study have.
pub(super) const OF_TABLES: [(&str, &str); 15] = [
    ("ramp", "Index of the ramp, counted from 0. The repeats of a point are ramps that follow one another."),
    ("value", "Index of the value in its ramp, counted from 0."),
    ("leg", "Direction from which the ramp comes to the value: up or down. Empty without a ramp."),
    ("repeat", "Index of the repeat of the point, counted from 0."),
    ("point", "Index of the point: all repeats of the same parameters together."),
    ("repeats", "Number of finished repeats of the point, failed ones among them."),
    ("failed", "Number of repeats that stalled, failed or reached a limit."),
    ("seed", "Seed of the ramp, in hexadecimal digits behind a letter."),
    (
        "made_by",
        "Program that made the value: its version, the number of its results, and the revision of the experiment.",
    ),
    ("outcome", "`completed`, or `stopped`, `stalled`, `limited` or `failed`."),
    ("samples", "Number of samples of the value."),
    ("time", "Time of the sample since the start of the ramp."),
    ("from_state", "State on the side from which the ramp came to the transition."),
    ("to_state", "State on the far side of the transition; empty if none is known."),
    (
        "not_converged",
        "Names of the columns whose error is only a lower bound, since they have too few independent samples.",
    ),
];

/// Returns the meaning of a key of a plan by its whole name, such as `protocol.settle` or
/// `experiment.friction`.
pub(super) fn of_key<E: Experiment>(key: &str) -> Option<&'static str> {
    match key.strip_prefix("experiment.") {
        Some(parameter) => find(E::meanings(), parameter),
        // A rule of values means the same in a ramp and in a sweep.
        None => find(&OF_PLANS, key).or_else(|| find(&OF_PLANS, key.split_once('.')?.1)),
    }
}

/// Returns the meaning of a column of a table of a plan; empty if the experiment tells none.
pub(super) fn of_column<E: Experiment>(plan: &Plan<E>, table: &str, column: &str) -> String {
    let whole_name = |name: &str| plan.varied().zip(&plan.varied).find(|(short, _)| *short == name);
    let parameter = |name: &str| whole_name(name).and_then(|(_, whole)| find(E::meanings(), whole));
    let side = |ending| column.strip_suffix(ending).filter(|_| table == "transitions");
    let sides = [("_near", "near side, from which the ramp came"), ("_far", "far side")];
    if let Some((name, side)) = sides.iter().find_map(|(ending, told)| Some((side(*ending)?, told))) {
        return format!("Value of {name} on the {side}.");
    }
    let own = find(&OF_TABLES, column).or_else(|| parameter(column)).or_else(|| find(E::meanings(), column));
    let own = own.map(|meaning| meaning.trim_end_matches(" Required.").to_owned());
    own.or_else(|| of_error::<E>(column)).unwrap_or_default()
}

/// Returns the meaning of one of the two columns that follow a mean.
pub(super) fn of_error<E: Experiment>(column: &str) -> Option<String> {
    E::columns().iter().filter(|mean| mean.has_error()).map(Column::name).find_map(|mean| {
        let told = ["Standard error of the mean", "Number of independent samples behind the mean"];
        let of = error_names(mean).into_iter().zip(told).find(|(name, _)| name == column);
        of.map(|(_, told)| format!("{told} of {mean}."))
    })
}

fn find(meanings: &[(&str, &'static str)], name: &str) -> Option<&'static str> {
    meanings.iter().find(|(known, _)| *known == name).map(|(_, meaning)| *meaning)
}
