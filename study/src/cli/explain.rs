//! The meanings of the keys of plans: the text of the command `explain`, the JSON schema with which editors
//! complete and check plans, and the comments of a new plan.

use std::collections::HashSet;
use std::sync::LazyLock;

use serde_json::{Map, Value, json};

use super::shape::{Kind, Shape};
use crate::experiment::columns::{Meanings, OF_TABLES, find, meanings, of_error};
use crate::parameters;
use crate::plan::values::Steps;
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

/// Returns all names with their meanings. A meaning of the experiment is left out if its name is neither a
/// parameter nor a column.
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

/// Returns the schema of the plans of an experiment.
pub(super) fn schema<E: Experiment>() -> Value {
    let mut schema = of::<E>("", &Shape::of::<Plan<E>>());
    schema["$schema"] = "http://json-schema.org/draft-07/schema#".into();
    schema["title"] = "A plan of a study".into();
    schema
}

/// Returns the schema of the values of a key.
fn of<E: Experiment>(key: &str, shape: &Shape) -> Value {
    let mut schema = match shape.kind {
        Kind::Flag => json!({ "type": "boolean" }),
        Kind::Integer => json!({ "type": "integer" }),
        Kind::Number => json!({ "type": "number" }),
        Kind::Text => json!({ "type": "string" }),
        Kind::List => {
            let items: Vec<Value> = shape.parts.iter().map(|(_, item)| of::<E>(key, item)).collect();
            json!({ "type": "array", "items": items.first() })
        }
        Kind::Table | Kind::Choice => group::<E>(key, shape),
        Kind::Any if key.ends_with(".values") => {
            json!({ "anyOf": [{ "type": "array" }, of::<E>(key, &Shape::of::<Steps>())] })
        }
        Kind::Any | Kind::Word | Kind::Unknown => json!({}),
    };
    if let Some(meaning) = of_key::<E>(key) {
        schema["description"] = meaning.into();
    }
    schema
}

/// Returns the schema of a table or a choice.
fn group<E: Experiment>(key: &str, shape: &Shape) -> Value {
    let whole = |name: &str| format!("{key}.{name}").trim_start_matches('.').to_owned();
    let names = || shape.parts.iter().map(|(name, _)| *name);
    if shape.parts.iter().all(|(_, part)| part.kind == Kind::Word) {
        return json!({ "enum": names().collect::<Vec<_>>() });
    }
    let parts = shape.parts.iter();
    let properties: Map<String, Value> =
        parts.map(|(name, part)| ((*name).to_owned(), of::<E>(&whole(name), part))).collect();
    let mut schema = json!({ "type": "object", "properties": properties, "additionalProperties": false });
    if shape.kind == Kind::Choice {
        schema["minProperties"] = 1.into();
        schema["maxProperties"] = 1.into();
    } else {
        let is_required =
            |name: &&str| of_key::<E>(&whole(name)).is_some_and(|meaning| meaning.ends_with("Required."));
        schema["required"] = names().filter(is_required).collect();
    }
    schema
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

/// Returns comments that list the parameters without a value in the plan.
fn without_values<E: Experiment>(plan: &Plan<E>) -> Result<Vec<String>, PlanError> {
    let given = parameters::tree(&plan.parts.experiment)?;
    let parts = Shape::of::<E>().parts.into_iter();
    let absent = parts.map(|(name, _)| name).filter(|name| !given.contains_key(*name));
    Ok(absent
        .map(|name| {
            let meaning = of_key::<E>(&format!("experiment.{name}"));
            meaning.map_or_else(String::new, |meaning| format!("# {meaning}\n")) + &format!("# {name} =")
        })
        .collect())
}

fn begins(line: &str, start: &str) -> bool {
    if start.starts_with('[') { line == start } else { line.split(' ').next() == Some(start) }
}
