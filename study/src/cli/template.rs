//! A plan with comments.

use std::collections::HashSet;

use super::keys::of_key;
use super::shape::Shape;
use crate::parameters;
use crate::{Column, Experiment, Plan, PlanError};

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
            lines.extend(without_values(plan)?);
        }
        lines.extend(meaning::<E>(section, line).map(|meaning| format!("# {meaning}")));
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

/// Returns the meaning of the key on a line, or of the section that begins there.
fn meaning<E: Experiment>(section: &str, line: &str) -> Option<&'static str> {
    let key = match line.split_once(" = ") {
        Some((key, _)) => format!("{section}.{key}"),
        None if line.starts_with('[') => section.to_owned(),
        None => return None,
    };
    of_key::<E>(key.trim_start_matches('.'))
}

/// Returns the parameters that have no value in the plan, as comments.
fn without_values<E: Experiment>(plan: &Plan<E>) -> Result<Vec<String>, PlanError> {
    let given = parameters::tree(&plan.experiment)?;
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
