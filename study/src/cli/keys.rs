//! The meanings of the keys of plans, for the command `explain`, its schema, and the comments of a new plan.

use std::sync::LazyLock;

use super::shape::Shape;
use crate::experiment::columns::{Meanings, OF_TABLES, meanings};
use crate::meanings::{find, of_error};
use crate::{Column, Experiment, Table};

/// The keys that every plan has, whatever its experiment, by section.
static OF_PLANS: Meanings = LazyLock::new(|| meanings(include_str!("keys.txt")));

/// Returns the meaning of a key of a plan by its whole name, such as `protocol.settle` or
/// `experiment.friction`.
pub(super) fn of_key<E: Experiment>(key: &str) -> Option<&'static str> {
    match key.strip_prefix("experiment.") {
        Some(parameter) => find(E::meanings(), parameter),
        // A rule of values means the same in a ramp and in a sweep.
        None => find(&OF_PLANS, key).or_else(|| find(&OF_PLANS, key.split_once('.')?.1)),
    }
}

/// Explains a key, or all of them: meaning, unit, range and default.
pub(super) fn explained<E: Experiment>(key: Option<&str>) -> Result<String, String> {
    let Some(key) = key else {
        let lines = all::<E>().map(|(name, meaning)| line::<E>(name, meaning));
        return Ok(lines.collect::<Vec<_>>().join("\n"));
    };
    // `experiment.friction` and `friction` are the same key of a plan, and the end of a name is enough.
    let name = key.strip_prefix("experiment.").unwrap_or(key);
    let is_meant = |known: &str| {
        let [part, group] = [known.strip_suffix(name), known.strip_prefix(name)];
        part.is_some_and(|group| group.is_empty() || group.ends_with('.'))
            || group.is_some_and(|part| part.starts_with('.'))
    };
    let meant = all::<E>().filter(|(known, _)| is_meant(known));
    let mut meant: Vec<String> = meant.map(|(name, meaning)| line::<E>(name, meaning)).collect();
    if meant.is_empty() {
        let other = of_key::<E>(key).filter(|_| name == key).map(str::to_owned);
        let other = other.or_else(|| of_error::<E>(key));
        meant.extend(other.map(|meaning| line::<E>(key, &meaning)));
    }
    if !meant.is_empty() {
        return Ok(meant.join("\n"));
    }
    let near = |name: &str| strsim::jaro_winkler(name.rsplit('.').next().unwrap_or(name), key);
    let nearest = all::<E>().max_by(|a, b| near(a.0).total_cmp(&near(b.0)));
    let nearest = nearest.map_or_else(String::new, |(name, _)| format!("; the nearest is `{name}`"));
    Err(format!("there is no key `{key}`{nearest}; `explain` without a key lists all"))
}

/// Returns all names with their meanings, except for names that are neither parameters nor columns.
fn all<E: Experiment>() -> impl Iterator<Item = (&'static str, &'static str)> {
    let (shape, columns, tables) = (Shape::of::<E>(), E::columns(), E::tables());
    let exists = move |name: &str| {
        shape.has(name)
            || columns.iter().any(|column| column.name() == name)
            || tables.iter().flat_map(Table::columns).any(|heading| heading.name() == name)
    };
    let own = E::meanings().iter().copied().filter(move |(name, _)| exists(name));
    OF_PLANS.iter().copied().chain(own).chain(OF_TABLES.iter().copied())
}

/// Returns the name with the unit of its column, and the meaning.
fn line<E: Experiment>(name: &str, meaning: &str) -> String {
    let columns = E::columns();
    match columns.iter().find(|column| column.name() == name).map(Column::unit) {
        Some(unit) if !unit.is_empty() => format!("{name} [{unit}]: {meaning}"),
        _ => format!("{name}: {meaning}"),
    }
}
