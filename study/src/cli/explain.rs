//! The meanings of the keys of plans: the text of the command `explain`, and the comments of a new plan.

use std::collections::HashSet;
use std::sync::LazyLock;

use crate::experiment::columns::{Meanings, OF_TABLES, find, meanings, of_error};
use crate::parameters;
use crate::{Column, Experiment, Plan, PlanError, Table};

/// The keys that the plans of all experiments have, by section.
static OF_PLANS: Meanings = LazyLock::new(|| meanings(include_str!("keys.txt")));

/// Examples of optional sections, which a new plan shows as comments if it lacks the section.
const EXAMPLES: [(&str, &str); 3] = [
    ("repeats", "repeats = 8   (before [experiment])"),
    ("[ramp]", "[ramp]\n# parameter = \"NAME\"\n# values = [0.1, 0.2]\n# course = \"up\""),
    ("[[sweep]]", "[[sweep]]\n# parameter = \"NAME\"\n# values = [0.1, 0.2]"),
];

/// Returns the meaning of the key of a plan that has the given whole name, such as `protocol.settle` or
/// `experiment.friction`.
pub(super) fn of_key<E: Experiment>(key: &str) -> Option<&'static str> {
    match key.strip_prefix("experiment.") {
        Some(parameter) => find(E::meanings(), parameter),
        // A rule of values means the same in a ramp and in a sweep.
        None => find(&OF_PLANS, key).or_else(|| find(&OF_PLANS, key.split_once('.')?.1)),
    }
}

/// Explains one key or column, or all keys and columns: meaning, unit, range and default.
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
        let other = other.or_else(|| of_error(&E::columns(), key));
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

/// Returns all names with their meanings.
fn all<E: Experiment>() -> impl Iterator<Item = (&'static str, &'static str)> {
    OF_PLANS.iter().chain(E::meanings()).chain(OF_TABLES.iter()).copied()
}

/// Returns the name with the unit of its column, and the meaning.
fn line<E: Experiment>(name: &str, meaning: &str) -> String {
    let columns = E::columns();
    match columns.iter().find(|column| column.name() == name).map(Column::unit) {
        Some(unit) if !unit.is_empty() => format!("{name} [{unit}]: {meaning}"),
        _ => format!("{name}: {meaning}"),
    }
}

/// Returns a plan in TOML with explanations.
pub(super) fn commented<E: Experiment>(plan: &Plan<E>) -> Result<String, PlanError> {
    let bare = plan.to_toml()?;
    let mut lines = vec!["# A plan of a study.".to_owned(), String::new()];
    let mut section = "";
    for line in bare.lines() {
        if let Some(header) = line.strip_prefix('[') {
            section = header.trim_matches(['[', ']']);
        }
        if section == "experiment" && line.is_empty() {
            lines.extend(without_values(plan)?);
        }
        lines.extend(meaning::<E>(section, line).map(|meaning| format!("# {meaning}")));
        lines.push(line.to_owned());
    }
    let absent = EXAMPLES.iter().filter(|(start, _)| !bare.lines().any(|line| begins(line, start)));
    lines.extend(absent.map(|(_, example)| format!("\n# {example}")));
    let names = parameters::names(&parameters::tree(&plan.parts.experiment)?).join(", ");
    let columns = E::columns();
    // A column of the values and a column of the samples may have the same name.
    let mut known = HashSet::new();
    let columns: Vec<_> = columns.iter().map(Column::name).filter(|name| known.insert(*name)).collect();
    lines.push(format!("\n# Parameters: {names}."));
    lines.push(format!("# Measured: {}.\n", columns.join(", ")));
    Ok(lines.join("\n"))
}

/// Returns the meaning of the key on a line, or of the section that begins on the line.
fn meaning<E: Experiment>(section: &str, line: &str) -> Option<&'static str> {
    let key = match line.split_once(" = ") {
        Some((key, _)) => format!("{section}.{key}"),
        None if line.starts_with('[') => section.to_owned(),
        None => return None,
    };
    of_key::<E>(key.trim_start_matches('.'))
}

/// Returns comments that list the parameters without a value in the plan: names with a meaning that are not
/// names of columns.
fn without_values<E: Experiment>(plan: &Plan<E>) -> Result<Vec<String>, PlanError> {
    let (given, columns, tables) = (parameters::tree(&plan.parts.experiment)?, E::columns(), E::tables());
    let is_column = |name: &str| {
        columns.iter().any(|column| column.name() == name)
            || tables.iter().flat_map(Table::columns).any(|heading| heading.name() == name)
    };
    let is_absent = |name: &str| !name.contains('.') && !given.contains_key(name) && !is_column(name);
    let absent = E::meanings().iter().filter(|(name, _)| is_absent(name));
    Ok(absent.map(|(name, meaning)| format!("# {meaning}\n# {name} =")).collect())
}

fn begins(line: &str, start: &str) -> bool {
    if start.starts_with('[') { line == start } else { line.split(' ').next() == Some(start) }
}
