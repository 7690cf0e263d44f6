//! The meanings of the keys of a plan, for `explain` and for the comments of a new plan.

use crate::{Column, Experiment};

/// The keys that every plan has, whatever its experiment, by section.
pub(super) const OF_PLANS: [(&str, &str); 12] = [
    ("seed", "Seed of all random numbers, a whole number: the same plan gives the same bytes. Required."),
    (
        "repeats",
        "Number of times that each point is done, each with another seed. 1 if not given. Eight give a mean an error that can be trusted; fewer do if all together have 120 independent samples: see not_converged in points.csv.",
    ),
    (
        "protocol.settle",
        "Cycles that are run and not measured before each value. A cycle is a period of the base, or a unit of time without one.",
    ),
    (
        "protocol.samples",
        "Number of samples of each value. Errors are trustworthy from some hundred independent ones on.",
    ),
    (
        "protocol.every",
        "Cycles from one sample to the next, at least 1. Short: samples that resemble each other tell little more.",
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
    ("ramp.course", "`up`, `down`, or `up_and_down`, which shows hysteresis."),
    (
        "sweep.parameter",
        "Parameter that differs between ramps, which are independent of each other and may run side by side.",
    ),
    ("sweep.values", "Values of the sweep. Several sweeps make all combinations."),
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
    // `experiment.friction` and `friction` are the same key of a plan.
    let name = key.strip_prefix("experiment.").unwrap_or(key);
    meaning::<E>(name).map(|meaning| line::<E>(name, meaning)).ok_or_else(|| {
        let near = |name: &str| strsim::jaro_winkler(name, key);
        let nearest = all::<E>().max_by(|a, b| near(a.0).total_cmp(&near(b.0)));
        let nearest = nearest.map_or_else(String::new, |(name, _)| format!("; the nearest is `{name}`"));
        format!("there is no key `{key}`{nearest}; `explain` without a key lists all")
    })
}

fn all<E: Experiment>() -> impl Iterator<Item = (&'static str, &'static str)> {
    OF_PLANS.into_iter().chain(E::meanings().iter().copied())
}

/// Returns the name with the unit of its column, and the meaning.
fn line<E: Experiment>(name: &str, meaning: &str) -> String {
    let columns = E::columns();
    match columns.iter().find(|column| column.name() == name).map(Column::unit) {
        Some(unit) if !unit.is_empty() => format!("{name} [{unit}]: {meaning}"),
        _ => format!("{name}: {meaning}"),
    }
}
