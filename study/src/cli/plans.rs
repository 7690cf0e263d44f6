//! The commands that need no study: a new plan, the check of a plan, the meanings of its keys, and
//! completions.

use std::path::Path;

use clap::{CommandFactory, ValueEnum};

use super::arguments::Arguments;
use super::terminal::{read, say, write_new};
use super::{End, Failure, LISTED, explain};
use crate::{Experiment, Plan, PlanError, Ramp, StudyError};

/// Largest number of values of a ramp that `check` prints in full.
const MOST_VALUES: usize = 60;

pub(super) fn new<E: Experiment>(
    example: impl FnOnce() -> Result<Plan<E>, PlanError>,
    file: Option<&Path>,
) -> Result<End, Failure> {
    let text = explain::commented(&example()?)?;
    file.map_or_else(|| say(text.trim_end()), |path| write_new(path, text.as_bytes()))?;
    Ok(End::Done)
}

pub(super) fn explain<E: Experiment>(key: Option<&str>) -> Result<End, Failure> {
    say(&explain::explained::<E>(key).map_err(PlanError::Refused)?)?;
    Ok(End::Done)
}

pub(super) fn check<E: Experiment>(path: &Path) -> Result<End, Failure> {
    let plan = Plan::<E>::from_toml(&read(path)?).map_err(StudyError::unreadable(path))?;
    let (ramps, values, cycles) = (plan.ramp_count(), plan.value_count(), plan.protocol().cycles());
    let repeats = match plan.repeats() {
        1 => String::new(),
        repeats => format!(", with {repeats} repeats of each point"),
    };
    let (ramp, value) = (counted(ramps, "ramp"), counted(values, "value"));
    say(&format!("{ramp} of {value} of {cycles} cycles{repeats}"))?;
    if plan.varied().next().is_none() {
        return Ok(End::Done);
    }
    let points = plan.point_count();
    (0..points.min(LISTED)).try_for_each(|point| say(&values_of(&plan, point)))?;
    if points > LISTED {
        say(&format!("and {} more", counted(ramps - LISTED * plan.repeats(), "ramp")))?;
    }
    Ok(End::Done)
}

fn counted(count: usize, name: &str) -> String {
    format!("{count} {name}{}", if count == 1 { "" } else { "s" })
}

/// Returns a line for a point: the indices of its repeats, and the values of all parameters that vary.
fn values_of<E: Experiment>(plan: &Plan<E>, point: usize) -> String {
    let ramp = point * plan.repeats();
    let changing = plan.ramp().map(Ramp::parameter);
    let fixed = plan.parameters(ramp, 0).into_iter().filter(|(name, _)| Some(*name) != changing);
    let mut parts: Vec<String> = fixed.map(|(name, value)| format!("{name} = {value}")).collect();
    if let Some(ramp) = plan.ramp() {
        let mut values: Vec<String> = ramp.path().map(|(_, value)| value.to_string()).collect();
        if values.len() > MOST_VALUES {
            values.splice(LISTED..values.len() - 1, ["…".to_owned()]);
        }
        parts.push(format!("{} = {}", ramp.parameter(), values.join(", ")));
    }
    let repeats = match plan.repeats() {
        1 => ramp.to_string(),
        repeats => format!("{ramp} to {}", ramp + repeats - 1),
    };
    format!("  {repeats}: {}", parts.join("; "))
}

pub(super) fn completions(shell: &str) -> Result<End, Failure> {
    let (mut command, mut text) = (Arguments::command(), Vec::new());
    if shell == "man" {
        clap_mangen::Man::new(command).render(&mut text)?;
    } else {
        let shell = clap_complete::Shell::from_str(shell, true).map_err(|_| {
            format!("completions are for bash, elvish, fish, powershell, zsh and man, not {shell}")
        })?;
        clap_complete::generate(shell, &mut command, "granular-edmd", &mut text);
    }
    say(String::from_utf8(text)?.trim_end())?;
    Ok(End::Done)
}
