//! A plan with comments.

use std::collections::HashSet;

use super::keys;
use crate::parameters;
use crate::{Column, Experiment, Plan, PlanError};

/// Explanations of the sections of a plan.
const NOTES: [(&str, &str); 4] = [
    ("[experiment]", "The system: each of its parameters can be ramped or swept."),
    ("[protocol]", "What is measured at each value, and when."),
    ("[ramp]", "A hysteresis experiment: one run, whose parameter changes step by step."),
    ("[[sweep]]", "Independent runs."),
];

/// Examples of optional sections, shown for plans that lack them.
const EXAMPLES: [(&str, &str); 3] = [
    ("repeats", "repeats = 8   (before [experiment])"),
    ("[ramp]", "[ramp]\n# parameter = \"NAME\"\n# values = [0.1, 0.2]\n# course = \"up\""),
    ("[[sweep]]", "[[sweep]]\n# parameter = \"NAME\"\n# values = [0.1, 0.2]"),
];

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
            lines.extend(without_values::<E>(&bare));
        }
        let note = NOTES.iter().find(|(start, _)| line == *start).map(|(_, note)| *note);
        lines.extend(note.or_else(|| meaning::<E>(section, line)).map(|note| format!("# {note}")));
        lines.push(line.to_owned());
    }
    let absent = EXAMPLES.iter().filter(|(start, _)| !bare.lines().any(|line| begins(line, start)));
    lines.extend(absent.map(|(_, example)| format!("\n# {example}")));
    let names = parameters::names(&parameters::tree(&plan.experiment)?).join(", ");
    let columns = E::columns();
    // A column of the values and a column of the samples may have the same name.
    let mut known = HashSet::new();
    let columns: Vec<_> = columns.iter().map(Column::name).filter(|name| known.insert(*name)).collect();
    lines.push(format!("\n# Parameters: {names}."));
    lines.push(format!("# Measured: {}.\n", columns.join(", ")));
    Ok(lines.join("\n"))
}

/// Returns the meaning of the key on a line.
fn meaning<E: Experiment>(section: &str, line: &str) -> Option<&'static str> {
    let key = line.split_once(" = ")?.0;
    match section.strip_prefix("experiment") {
        Some(group) => keys::meaning::<E>(format!("{group}.{key}").trim_start_matches('.')),
        None if section.is_empty() => keys::meaning::<E>(key),
        None => keys::meaning::<E>(&format!("{section}.{key}")),
    }
}

/// Returns the parameters that have no value in the plan, as comments.
fn without_values<E: Experiment>(bare: &str) -> impl Iterator<Item = String> {
    let is_given = |name: &str| bare.lines().any(|line| line.split(' ').next() == Some(name));
    let absent = keys::parameters::<E>().filter(move |(name, _)| !name.contains('.') && !is_given(name));
    absent.map(|(name, meaning)| format!("# {meaning}\n# {name} ="))
}

fn begins(line: &str, start: &str) -> bool {
    if start.starts_with('[') { line == start } else { line.split(' ').next() == Some(start) }
}
