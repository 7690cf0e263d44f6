//! The meanings of the keys of a plan, for `explain` and for the comments of a new plan.

use crate::{Column, Experiment};

/// The keys that every plan has, whatever its experiment, by section.
pub(super) const OF_PLANS: [(&str, &str); 13] = [
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
    (
        "ramp.parameter",
        "Parameter that changes step by step, each value from the last state of the one before.",
    ),
    ("ramp.values", "Values of the ramp, in order."),
    ("ramp.course", "`up`, `down`, or `up_and_down`, which shows hysteresis. `up` if not given."),
    (
        "sweep.parameter",
        "Parameter that differs between ramps, which are independent of each other and may run side by side.",
    ),
    ("sweep.values", "Values of the sweep. Several sweeps make all combinations."),
];

/// The columns that the tables of every study have.
const OF_TABLES: [(&str, &str); 9] = [
    ("ramp", "Index of the ramp, counted from 0. The repeats of a point are ramps that follow one another."),
    ("value", "Index of the value in its ramp, counted from 0."),
    ("leg", "Direction from which the ramp comes to the value: up or down. Empty without a ramp."),
    ("repeat", "Index of the repeat of the point, counted from 0."),
    ("point", "Index of the point: all repeats of the same parameters together."),
    ("made_by", "Fingerprint of the program that made the value."),
    ("outcome", "`completed`, or `stopped`, `stalled`, `limited` or `failed`."),
    ("time", "Time of the sample."),
    (
        "not_converged",
        "Names of the columns whose error is only a lower bound, since they have too few independent samples.",
    ),
];

/// Returns the meaning of a key of a plan, a parameter or a column.
pub(super) fn meaning<E: Experiment>(key: &str) -> Option<&'static str> {
    all::<E>().find(|(known, _)| *known == key).map(|(_, meaning)| meaning)
}

/// Returns the parameters that have a meaning: the other names are columns.
pub(super) fn parameters<E: Experiment>() -> impl Iterator<Item = (&'static str, &'static str)> {
    let columns: Vec<String> = E::columns().iter().map(|column| column.name().to_owned()).collect();
    E::meanings().iter().copied().filter(move |(name, _)| !columns.iter().any(|column| column == name))
}

/// Explains a key, or all of them: meaning, unit, range and default.
pub(super) fn explained<E: Experiment>(key: Option<&str>) -> Result<String, String> {
    let Some(key) = key else {
        let lines = all::<E>().map(|(name, meaning)| line::<E>(name, meaning));
        return Ok(lines.collect::<Vec<_>>().join("\n"));
    };
    // `experiment.friction` and `friction` are the same key of a plan, and the end of a name is enough.
    let name = key.strip_prefix("experiment.").unwrap_or(key);
    let is_meant =
        |known: &str| known.strip_suffix(name).is_some_and(|group| group.is_empty() || group.ends_with('.'));
    let meant: Vec<String> = all::<E>()
        .filter(|(known, _)| is_meant(known))
        .map(|(name, meaning)| line::<E>(name, meaning))
        .collect();
    if !meant.is_empty() {
        return Ok(meant.join("\n"));
    }
    let near = |name: &str| strsim::jaro_winkler(name.rsplit('.').next().unwrap_or(name), key);
    let nearest = all::<E>().max_by(|a, b| near(a.0).total_cmp(&near(b.0)));
    let nearest = nearest.map_or_else(String::new, |(name, _)| format!("; the nearest is `{name}`"));
    Err(format!("there is no key `{key}`{nearest}; `explain` without a key lists all"))
}

fn all<E: Experiment>() -> impl Iterator<Item = (&'static str, &'static str)> {
    OF_PLANS.into_iter().chain(E::meanings().iter().copied()).chain(OF_TABLES)
}

/// Returns the name with the unit of its column, and the meaning.
fn line<E: Experiment>(name: &str, meaning: &str) -> String {
    let columns = E::columns();
    match columns.iter().find(|column| column.name() == name).map(Column::unit) {
        Some(unit) if !unit.is_empty() => format!("{name} [{unit}]: {meaning}"),
        _ => format!("{name}: {meaning}"),
    }
}
