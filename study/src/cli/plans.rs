//! The commands that need no study: a new plan, the check of a plan, the meanings of its keys, and its core
//! hours.

use std::collections::HashSet;
use std::path::Path;
use std::sync::LazyLock;
use std::time::Duration;

use granular_edmd::simulation::Limits;
use granular_edmd::speed::Meter;

use super::{Failure, LISTED, core_time, read, say, write_new};
use crate::experiment::{Meanings, OF_TABLES, find, meanings, of_error};
use crate::vibrated_box::{Base, VibratedBox};
use crate::{
    Axis, Column, Course, Experiment, Plan, PlanError, Protocol, Ramp, StudyError, Table, parameters,
};

/// Largest number of values of a ramp that `check` prints in full.
const MOST_VALUES: usize = 60;

/// Returns the plan of the program `granular-edmd`: the paper's box where it has no roll, one and two, in
/// half a minute on two cores.
///
/// # Errors
/// None: all its numbers are possible.
pub fn example() -> Result<Plan<VibratedBox>, PlanError> {
    let base = Base::BiParabolic { amplitude: 0.1, angular_frequency: 10.0 };
    let experiment = VibratedBox::new(1000, 60.0, base)
        .with_height(150.0)
        .with_gravity(0.015_625)
        .with_contact_duration(1e-4);
    Plan::new(experiment, Protocol::new(3000, 1000, 100)?, 1)?
        .with_ramp(Ramp::new("friction", [0.01, 0.03, 0.05], Course::Up)?)?
        .with_axis(Axis::new("inelasticity", [0.0, 0.01])?)
}

pub(super) fn new<E: Experiment>(
    example: impl FnOnce() -> Result<Plan<E>, PlanError>,
    file: Option<&Path>,
) -> Result<(), Failure> {
    let text = commented(&example()?)?;
    file.map_or_else(|| say(text.trim_end()), |path| write_new(path, text.as_bytes()))
}

pub(super) fn explain<E: Experiment>(key: Option<&str>) -> Result<(), Failure> {
    say(&explained::<E>(key).map_err(PlanError::Refused)?)
}

pub(super) fn check<E: Experiment>(path: &Path) -> Result<(), Failure> {
    let plan = Plan::<E>::from_toml(&read(path)?).map_err(StudyError::unreadable(path))?;
    let (ramps, values, cycles) = (plan.ramp_count(), plan.value_count(), plan.protocol().cycles());
    let repeats = match plan.repeats() {
        1 => String::new(),
        repeats => format!(", with {repeats} repeats of each point"),
    };
    let (ramp, value) = (counted(ramps, "ramp"), counted(values, "value"));
    say(&format!("{ramp} of {value} of {cycles} cycles{repeats}"))?;
    if plan.varied().next().is_none() {
        return Ok(());
    }
    let points = plan.point_count();
    (0..points.min(LISTED)).try_for_each(|point| say(&values_of(&plan, point)))?;
    if points > LISTED {
        say(&format!("and {} more", counted(ramps - LISTED * plan.repeats(), "ramp")))?;
    }
    Ok(())
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
fn of_key<E: Experiment>(key: &str) -> Option<&'static str> {
    match key.strip_prefix("experiment.") {
        Some(parameter) => find(E::meanings(), parameter),
        // A rule of values means the same in a ramp and in a sweep.
        None => find(&OF_PLANS, key).or_else(|| find(&OF_PLANS, key.split_once('.')?.1)),
    }
}

/// Explains one key or column, or all keys and columns: meaning, unit, range and default.
fn explained<E: Experiment>(key: Option<&str>) -> Result<String, String> {
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
fn commented<E: Experiment>(plan: &Plan<E>) -> Result<String, PlanError> {
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

/// Largest number of ramps whose first values are run in order to estimate the core hours of a plan.
const RAMPS: usize = 4;

/// Prints the core hours of a plan, estimated from short runs of the first values of some ramps.
pub(super) fn bench<E: Experiment>(path: &Path, json: bool, quick: bool) -> Result<(), Failure> {
    let plan = Plan::<E>::from_toml(&read(path)?).map_err(StudyError::unreadable(path))?;
    let (ramps, share) = (plan.ramp_count(), Duration::from_millis(if quick { 200 } else { 2000 }));
    let chosen: Vec<usize> = (0..ramps.min(RAMPS)).map(|k| k * ramps / ramps.min(RAMPS)).collect();
    let hours =
        chosen.iter().map(|&ramp| hours(&plan, ramp, share)).collect::<Result<Vec<f64>, Failure>>()?;
    let values = (ramps * plan.value_count()) as f64;
    let [least, most] = [f64::min as fn(f64, f64) -> f64, f64::max]
        .map(|of| values * hours.iter().copied().reduce(of).unwrap_or(0.0));
    let mean = values * hours.iter().sum::<f64>() / hours.len() as f64;
    say(&if json {
        format!(r#"{{"core_hours":{mean},"least":{least},"most":{most},"values":{values}}}"#)
    } else {
        let [mean, least, most] = [mean, least, most].map(|hours| core_time(3600.0 * hours));
        let measured = chosen.len();
        format!(
            "{mean} for {values} values, from the first ones of {measured} ramps ({least} if all were as the \
             cheapest of them, {most} if as the dearest); denser or refined values add to it"
        )
    })
}

/// Returns the core hours that the first value of a ramp takes if all its cycles take as long as the measured
/// cycles.
fn hours<E: Experiment>(plan: &Plan<E>, ramp: usize, share: Duration) -> Result<f64, Failure> {
    let cannot = |source| StudyError::Build { ramp, value: 0, source };
    let experiment = plan.experiment(ramp, 0)?;
    let mut run = experiment.build(plan.ramp_seed(ramp)).map_err(cannot)?;
    let mut observer = experiment.observer().map_err(cannot)?;
    let limits = Limits::until(f64::MAX).with_wall_clock(share);
    run.run(&limits, &mut ())?;
    let (meter, start) = (Meter::start(&run), run.time());
    run.run(&limits, &mut observer)?;
    let cycles = (run.time() - start) / experiment.cycle();
    Ok(meter.report(&run).seconds / cycles * plan.protocol().cycles() as f64 / 3600.0)
}
