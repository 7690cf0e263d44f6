//! The command `bench`: the standard states of [`speed`], two tables of them side by side, and the core hours
//! of a plan.

use std::fmt;
use std::path::Path;
use std::time::Duration;

use granular_edmd::Simulation;
use granular_edmd::boundary::Boundary;
use granular_edmd::collision::CollisionRule;
use granular_edmd::simulation::{Limits, RunError};
use granular_edmd::speed::{self, Circumstances, Meter, Quartiles, RunReport, StateError};
use serde::{Deserialize, Serialize};

use super::{End, Failure, Plan, PlanError, StudyError, core_time, read, refused, say};
use crate::Experiment;

/// Largest number of ramps whose first values are run for the core hours of a plan.
const RAMPS: usize = 4;

/// The standard states, in the order in which they are measured.
const NAMES: [&str; 7] = ["dilute", "dense", "gas at 0.1", "gas at 0.3", "gas at 0.65", "mixture", "vessel"];

/// The standard table: the time per collision in each standard state.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Table {
    circumstances: Circumstances,
    /// Number of collisions in a measured interval. In short intervals, filling the caches takes a part of
    /// the time.
    collisions: u64,
    states: Vec<State>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct State {
    name: String,
    nanoseconds_per_collision: Quartiles,
    events_per_collision: f64,
}

/// Ratio by which the times of the same program drift from session to session, even if the times of each
/// session scatter less. A [`Comparison`](speed::Comparison) within one session has no such drift.
const DRIFT: f64 = 1.05;

type Stretch = Box<dyn Fn(u64) -> Result<RunReport, RunError>>;

/// Measures the standard table and prints it, compared with an earlier table if a file of one is given.
pub(super) fn table(json: bool, quick: bool, against: Option<&Path>) -> Result<End, Failure> {
    let (rounds, collisions) = if quick { (5, 20_000) } else { (31, 100_000) };
    let earlier = against.map(|path| earlier(path, collisions)).transpose()?;
    if let Some(earlier) = earlier.as_ref().filter(|earlier| !is_comparable(&earlier.circumstances)) {
        say(&format!("the earlier table is of another machine or build: {}", earlier.circumstances))?;
    }
    let table = measured(rounds, collisions)?;
    if json {
        say(&serde_json::to_string_pretty(&table)?)?;
    } else {
        say(&table.to_string())?;
    }
    let Some(earlier) = earlier else { return Ok(End::Done) };
    let changes: Vec<Change<'_>> = table.states.iter().filter_map(|state| earlier.change(state)).collect();
    for change in &changes {
        say(&change.to_string())?;
    }
    for state in table.states.iter().filter(|state| earlier.change(state).is_none()) {
        say(&format!("{}: not in the earlier table", state.name))?;
    }
    Ok(if changes.iter().any(|change| change.finding() == "slower") { End::Slower } else { End::Done })
}

fn earlier(path: &Path, collisions: u64) -> Result<Table, Failure> {
    let read_back: Result<Table, String> =
        serde_json::from_str(&read(path)?).map_err(|source| source.to_string());
    Ok(read_back.and_then(|table| table.checked(collisions)).map_err(|reason| {
        PlanError::Toml(format!("{} is no table of `bench --json`: {reason}", path.display()))
    })?)
}

/// Runs all states alternately, so that a slow phase of the machine slows one interval of each state.
fn measured(rounds: usize, collisions: u64) -> Result<Table, StateError> {
    let states: [Stretch; 7] = [
        stretches(speed::dilute()?),
        stretches(speed::dense()?),
        stretches(speed::gas(0.1)?),
        stretches(speed::gas(0.3)?),
        stretches(speed::gas(0.65)?),
        stretches(speed::mixture()?),
        stretches(speed::vessel()?),
    ];
    let mut times = states.each_ref().map(|_| Vec::with_capacity(rounds));
    let mut events = [0.0; 7];
    for _ in 0..rounds {
        for (k, stretch) in states.iter().enumerate() {
            let report = stretch(collisions)?;
            times[k].push(report.nanoseconds_per_collision);
            events[k] = report.events_per_collision;
        }
    }
    let states = NAMES.into_iter().zip(times).zip(events).map(|((name, times), events)| State {
        name: name.to_owned(),
        nanoseconds_per_collision: Quartiles::of(times),
        events_per_collision: events,
    });
    Ok(Table { circumstances: Circumstances::present(), collisions, states: states.collect() })
}

fn stretches(
    run: Simulation<impl CollisionRule + Clone + 'static, impl Boundary + Clone + 'static>,
) -> Stretch {
    Box::new(move |collisions| speed::stretch(&run, collisions, &mut ()))
}

impl fmt::Display for Table {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let names = "| state | ns a collision (quartiles) | million a second | events a collision |";
        writeln!(formatter, "{names}\n|---|---|---|---|")?;
        for State { name, nanoseconds_per_collision: time, events_per_collision } in &self.states {
            let rate = 1e3 / time.median;
            writeln!(formatter, "| {name} | {time} | {rate:.2} | {events_per_collision:.3} |")?;
        }
        write!(formatter, "{}", self.circumstances)
    }
}

/// The times of a state in two tables.
struct Change<'a> {
    before: &'a State,
    now: &'a State,
}

/// Returns whether present times can be compared with earlier times: the machine and the build are the same.
fn is_comparable(earlier: &Circumstances) -> bool {
    let of = |it: &Circumstances| (it.processor.clone(), it.processors, it.system.clone(), it.build.clone());
    of(earlier) == of(&Circumstances::present())
}

impl Table {
    /// Returns the table, or the reason why no later table can be compared with it.
    fn checked(self, collisions: u64) -> Result<Self, String> {
        if self.collisions != collisions {
            let stretches = self.collisions;
            return Err(format!(
                "its stretches have {stretches} collisions, not {collisions}: `--quick` as then"
            ));
        }
        let is_possible = |Quartiles { low, median, high }: Quartiles| {
            0.0 < low && low <= median && median <= high && high < f64::INFINITY
        };
        let mut times = self.states.iter().map(|state| (&state.name, state.nanoseconds_per_collision));
        if let Some((name, time)) = times.find(|(_, time)| !is_possible(*time)) {
            return Err(format!("a collision in \"{name}\" takes {time} ns"));
        }
        let has_any = self.states.iter().any(|state| NAMES.contains(&state.name.as_str()));
        if has_any { Ok(self) } else { Err("it has none of the standard states".to_owned()) }
    }

    /// Returns how a state's time has changed since this table.
    fn change<'a>(&'a self, now: &'a State) -> Option<Change<'a>> {
        let before = self.states.iter().find(|before| before.name == now.name)?;
        Some(Change { before, now })
    }
}

impl Change<'_> {
    /// A difference counts if the quartiles of the two sessions differ by more than the factor [`DRIFT`].
    fn finding(&self) -> &'static str {
        let (before, now) = (self.before.nanoseconds_per_collision, self.now.nanoseconds_per_collision);
        match () {
            () if now.low > DRIFT * before.high => "slower",
            () if DRIFT * now.high < before.low => "faster",
            () => "noise",
        }
    }
}

impl fmt::Display for Change<'_> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { before, now } = self;
        let ratio = now.nanoseconds_per_collision.median / before.nanoseconds_per_collision.median;
        let same = before.events_per_collision == now.events_per_collision;
        let events = if same { "the same events" } else { "other events" };
        write!(formatter, "{}: {ratio:.3} times the earlier time: {}; {events}", now.name, self.finding())
    }
}

/// Prints the core hours of a plan, from a short run of the first values of some ramps.
pub(super) fn plan<E: Experiment>(path: &Path, json: bool, quick: bool) -> Result<End, Failure> {
    let plan = Plan::<E>::from_toml(&read(path)?).map_err(refused(path))?;
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
    })?;
    Ok(End::Done)
}

/// Returns the hours on a core of the first value of a ramp, if all its cycles take as long as the present
/// ones.
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
