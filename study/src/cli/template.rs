//! A plan with comments.

use std::collections::HashSet;

use crate::parameters;
use crate::{Column, Experiment, Plan, PlanError};

/// Explanations of lines of a plan, by the beginning of the line.
const NOTES: [(&str, &str); 6] = [
    ("seed", "Seed of all random numbers: the same plan gives the same bytes."),
    (
        "repeats",
        "Times that each point is done, with different seeds. Eight give a mean an error that can be trusted; fewer do\n# if all together have 120 independent samples: see not_converged in points.csv.",
    ),
    ("[experiment]", "The system: each of its parameters can be ramped or swept."),
    (
        "[protocol]",
        "In cycles (periods of the base): wait `settle`, then take `samples` samples, `every` cycles apart.",
    ),
    (
        "[ramp]",
        "A parameter that changes step by step, each value from the last state of the one before.\n# course: up, down or up_and_down.",
    ),
    ("[[sweep]]", "A parameter that differs between ramps, which are independent of each other."),
];

/// Examples of sections that a plan may have, for a plan that lacks them.
const EXAMPLES: [(&str, &str); 3] = [
    ("repeats", "repeats = 8   (before [experiment])"),
    ("[ramp]", "[ramp]\n# parameter = \"NAME\"\n# values = [0.1, 0.2]\n# course = \"up\""),
    ("[[sweep]]", "[[sweep]]\n# parameter = \"NAME\"\n# values = [0.1, 0.2]"),
];

/// Returns a plan in TOML with explanations.
pub(super) fn commented<E: Experiment>(plan: &Plan<E>) -> Result<String, PlanError> {
    let bare = plan.to_toml()?;
    let mut lines = vec!["# A plan of a study.".to_owned(), String::new()];
    for line in bare.lines() {
        let note = NOTES.iter().find(|(start, _)| begins(line, start));
        lines.extend(note.map(|(_, note)| format!("# {note}")));
        lines.push(line.to_owned());
    }
    let absent = EXAMPLES.iter().filter(|(start, _)| !bare.lines().any(|line| begins(line, start)));
    lines.extend(absent.map(|(_, example)| format!("\n# {example}")));
    let names = parameters::names(&parameters::tree(&plan.experiment)?).join(", ");
    let columns = E::columns();
    // A column of the values and one of the samples may have the same name.
    let mut known = HashSet::new();
    let columns: Vec<_> = columns.iter().map(Column::name).filter(|name| known.insert(*name)).collect();
    lines.push(format!("\n# Parameters: {names}."));
    lines.push("# Parameters that have no value in this plan are not listed.".to_owned());
    lines.push(format!("# Measured: {}.\n", columns.join(", ")));
    Ok(lines.join("\n"))
}

fn begins(line: &str, start: &str) -> bool {
    if start.starts_with('[') { line == start } else { line.split(' ').next() == Some(start) }
}
