//! The time for which a roll keeps its sense, and for which two rolls last where one roll is stable, too.
//!
//! The example reads the order parameters that `docs/reproduction/protocols/long` has recorded, a million
//! oscillations for each value, names the state of each sample, and counts how long states last. It writes
//! `residence_times` as a table and a picture.
//!
//! ```text
//! cargo run --release -p gallery --all-features --bin residence_times
//! ```

use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Parser;
use granular_edmd::statistics::RunningMean;
use granular_edmd_study::Plan;
use granular_edmd_study::vibrated_box::VibratedBox;

use gallery::command_line::{self, Failure};
use gallery::look::{BLUE, GREEN, Look, Mark, VERMILION};
use gallery::panel::{self, COLUMN, Margins, Place};
use gallery::results::Results;
use gallery::runs;
use gallery::sheet::Sheet;

/// Residence times of one roll of either sense, and of two rolls, from runs of a million oscillations.
#[derive(Parser)]
struct Arguments {
    /// Folder of the studies; by default, the runs kept with the repository.
    #[arg(long, value_name = "FOLDER")]
    studies: Option<PathBuf>,
    /// Shortest stay that counts, in oscillations: two rolls that last less are a fluctuation of one roll,
    /// and vice versa.
    #[arg(long, default_value_t = 2000)]
    shortest: u64,
    /// Reads only the first tenth of each run.
    #[arg(long)]
    quick: bool,
    #[command(flatten)]
    results: Results,
}

fn main() -> ExitCode {
    command_line::main(|arguments: &Arguments| {
        let values = read(arguments).map_err(Failure::usage)?;
        arguments.results.make_folder()?;
        finish(&values, &arguments.results).map_err(Failure::run)
    })
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum State {
    Clockwise,
    Counterclockwise,
    TwoRolls,
}

/// A row of a table of values; other columns are left out.
#[derive(serde::Deserialize)]
struct Row {
    ramp: u32,
    value: u32,
    #[serde(default)]
    leg: String,
    friction: Option<f64>,
    inelasticity: Option<f64>,
    thermal_noise: f64,
}

/// The states in the course of one value.
struct Value {
    study: String,
    row: Row,
    /// Oscillations between two samples.
    every: u64,
    /// Oscillations of the shortest stay that counts.
    shortest: u64,
    states: Vec<State>,
    /// Mean of the larger order parameter, divided by the noise of a gas at rest.
    strength: f64,
}

impl Value {
    /// Returns the share of the time in a state.
    fn share(&self, state: State) -> f64 {
        self.states.iter().filter(|seen| **seen == state).count() as f64 / self.states.len() as f64
    }

    /// Returns how long one roll keeps its sense; `None` where two rolls have more than a quarter of the
    /// time. Two rolls between two stays of one roll do not count, nor does a short time with one roll
    /// between stays of two.
    fn sense(&self) -> Option<Residence> {
        let are_two = self.two_rolls().unwrap_or_else(|| vec![false; self.states.len()]);
        let alone = self.states.iter().zip(are_two).filter(|(state, two)| !two && **state != State::TwoRolls);
        let senses: Vec<bool> = alone.map(|(state, _)| *state == State::Clockwise).collect();
        let changes = senses.windows(2).filter(|pair| pair[0] != pair[1]).count();
        self.residence(senses.len(), changes).filter(|_| self.share(State::TwoRolls) < 0.25)
    }

    /// Returns how long two rolls last, or one roll of either sense.
    fn rolls(&self, two: bool) -> Option<Residence> {
        let are_two = self.two_rolls()?;
        let ends = are_two.windows(2).filter(|pair| pair[0] == two && pair[1] != two).count();
        self.residence(are_two.iter().filter(|seen| **seen == two).count(), ends)
    }

    /// Returns where there are two rolls, without fluctuations; `None` where rolls are weak: there,
    /// fluctuations turn one roll into two, and at the edge of the collapse they make rolls from none.
    fn two_rolls(&self) -> Option<Vec<bool>> {
        let are_two: Vec<bool> = self.states.iter().map(|state| *state == State::TwoRolls).collect();
        (self.strength >= 8.0).then(|| without_short(&are_two, (self.shortest / self.every) as usize))
    }

    /// Returns the total time of the samples divided by the number of ends, so that the last stay, whose end
    /// is not seen, counts, too. The stays are independent, so their number has the error of a count.
    fn residence(&self, samples: usize, ends: usize) -> Option<Residence> {
        let mean = (samples as u64 * self.every) as f64 / ends as f64;
        (ends > 0).then(|| Residence { mean, error: mean / (ends as f64).sqrt(), ends })
    }
}

/// A mean residence time in oscillations, with its standard error.
#[derive(Debug, Clone, Copy)]
struct Residence {
    mean: f64,
    error: f64,
    /// Number of stays whose end was seen.
    ends: usize,
}

impl Residence {
    /// Returns whether too few stays have ended to bound their mean from above.
    const fn is_bound(&self) -> bool {
        self.ends <= 2
    }

    /// Returns the means for which this number of ends is within one standard deviation of a count. Without a
    /// bound from above, the bar extends to the edge of the picture.
    fn interval(&self) -> [f64; 2] {
        let (ends, deviation) = (self.ends as f64, (self.ends as f64).sqrt());
        let above = if self.is_bound() { f64::INFINITY } else { self.mean * ends / (ends - deviation) };
        [self.mean * ends / (ends + deviation), above]
    }
}

/// Returns a series of two values in which stays shorter than `least` samples are merged into the stay
/// before.
fn without_short(series: &[bool], least: usize) -> Vec<bool> {
    let mut steady: Vec<bool> = Vec::with_capacity(series.len());
    for stay in series.chunk_by(|before, after| before == after) {
        let value = steady.last().copied().filter(|_| stay.len() < least).unwrap_or(stay[0]);
        steady.extend(stay.iter().map(|_| value));
    }
    steady
}

/// Names the state of each sample. A state lasts until the order parameter of another state is above three
/// times the noise of a gas at rest, and the sample lies on that state's side of Ψ₂ = 2 |Ψ₁|, the border
/// between one roll and two, by at least twice the noise. With smaller margins, noise would count as changes.
/// Samples before the first one that meets both conditions are left out.
fn states(order: impl Iterator<Item = (f64, f64)>, noise: f64) -> Vec<State> {
    let (least, margin) = (3.0 * noise, 2.0 * noise);
    let mut now = None;
    let named = order.map(move |(one, two)| {
        if two > least.max(2.0 * (one.abs() + margin)) {
            now = Some(State::TwoRolls);
        } else if one.abs() > least.max(0.5 * two + margin) {
            now = Some(if one > 0.0 { State::Clockwise } else { State::Counterclockwise });
        }
        now
    });
    named.flatten().collect()
}

fn read(arguments: &Arguments) -> Result<Vec<Value>, Box<dyn Error>> {
    let folder = &arguments.studies.clone().unwrap_or_else(|| runs::folder("long"));
    let mut studies = runs::entries(folder)?;
    studies.retain(|study| study.join("order.csv").is_file());
    let values: Vec<Vec<Value>> = studies
        .iter()
        .map(|study| read_study(study, arguments).map_err(|error| format!("{}: {error}", study.display())))
        .collect::<Result<_, _>>()?;
    if values.is_empty() {
        return Err(format!("{} has no long runs", folder.display()).into());
    }
    Ok(values.into_iter().flatten().collect())
}

fn read_study(folder: &Path, arguments: &Arguments) -> Result<Vec<Value>, Box<dyn Error>> {
    let plan = Plan::<VibratedBox>::from_toml(&fs::read_to_string(folder.join("plan.toml"))?)?;
    let (every, samples) = (plan.protocol().every(), plan.protocol().samples() as usize);
    let rows: Vec<Row> =
        csv::Reader::from_path(folder.join("values.csv"))?.deserialize().collect::<Result<_, _>>()?;
    let mut order = csv::ReaderBuilder::new().has_headers(false).from_path(folder.join("order.csv"))?;
    // Ramp, value, and both order parameters in units of 1e-3.
    let order: Vec<(u32, u32, f64, f64)> = order.deserialize().collect::<Result<_, _>>()?;
    let study = folder.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let take = if arguments.quick { samples / 10 } else { samples };
    let value = |row: Row| {
        let of_value = order.iter().filter(|sample| (sample.0, sample.1) == (row.ramp, row.value)).take(take);
        let of_value = of_value.map(|sample| (1e-3 * sample.2, 1e-3 * sample.3));
        let larger: RunningMean = of_value.clone().map(|(one, two)| two.max(one.abs())).collect();
        let states = states(of_value, row.thermal_noise);
        let strength = larger.mean() / row.thermal_noise;
        Value { study: study.clone(), row, every, shortest: arguments.shortest, states, strength }
    };
    Ok(rows.into_iter().map(value).collect())
}

/// A stay that is counted: its name, its length at a value, and its look.
struct Stay {
    name: &'static str,
    of: fn(&Value) -> Option<Residence>,
    look: Look,
}

const STAYS: [Stay; 3] = [
    Stay {
        name: "one roll, until it turns the other way",
        of: Value::sense,
        look: Look::marks(BLUE, Mark::Disk),
    },
    Stay {
        name: "one roll, until there are two",
        of: |value| value.rolls(false),
        look: Look::marks(GREEN, Mark::Triangle),
    },
    Stay {
        name: "two rolls, until there is one",
        of: |value| value.rolls(true),
        look: Look::marks(VERMILION, Mark::Square),
    },
];

const COLUMNS: [&str; 14] = [
    "study",
    "leg",
    "friction",
    "inelasticity",
    "oscillations",
    "clockwise",
    "counterclockwise",
    "two_rolls",
    "sense_residence",
    "sense_residence_error",
    "one_roll_residence",
    "one_roll_residence_error",
    "two_rolls_residence",
    "two_rolls_residence_error",
];

fn finish(values: &[Value], results: &Results) -> Result<(), Box<dyn Error>> {
    let mut table = results.table("residence_times", &COLUMNS)?;
    for value in values {
        let Row { leg, friction, inelasticity, .. } = &value.row;
        let oscillations = value.states.len() as u64 * value.every;
        let shares = [State::Clockwise, State::Counterclockwise, State::TwoRolls].map(|s| value.share(s));
        let stays: Vec<_> = STAYS.iter().map(|stay| (stay.of)(value)).collect();
        let cells = stays.iter().flat_map(|stay| {
            stay.map_or_else(<[String; 2]>::default, |time| {
                [time.mean, time.error].map(|t| format!("{t:.0}"))
            })
        });
        let cells: Vec<String> = shares.iter().map(|share| format!("{share:.4}")).chain(cells).collect();
        table.serialize((&value.study, leg, friction, inelasticity, oscillations, cells))?;
        print(value, shares, &stays);
    }
    results.finish_table("residence_times", table, Some(&draw(values)))
}

fn print(value: &Value, shares: [f64; 3], stays: &[Option<Residence>]) {
    let Row { leg, friction, inelasticity, .. } = &value.row;
    let at = friction.map(|at| format!("κ = {at}")).or(inelasticity.map(|at| format!("q = {at}")));
    let [clockwise, counterclockwise, two] = shares.map(|share| format!("{:.0}", 100.0 * share));
    gallery::say!(
        "{} {leg} {}: {clockwise} % clockwise, {counterclockwise} % counterclockwise, {two} % two rolls",
        value.study,
        at.unwrap_or_default()
    );
    for (Stay { name, .. }, stay) in STAYS.iter().zip(stays) {
        if let Some(Residence { mean, error, .. }) = stay {
            gallery::say!("    {name}: {mean:.0} ± {error:.0} oscillations");
        }
    }
}

const MARGINS: Margins = [74.0, 26.0, 16.0, 60.0];
const HEADER: f64 = 234.0;
const SIZE: (f64, f64) = (COLUMN, 360.0);

/// Ranges of friction and of residence times.
const RANGES: [(f64, f64); 2] = [(0.0, 0.07), (1e3, 2e6)];

/// Draws the residence times at the larger gravity over friction.
fn draw(values: &[Value]) -> Sheet {
    let mut sheet = Sheet::new(SIZE.0, HEADER + SIZE.1);
    let notes = "N = 1000, g = 0.015625, q = 0, A = 0.1, ω = 10; a million oscillations for each friction. Open: one or \
                 two changes, no bound from above. From κ = 0.025 to 0.055 no roll changed; below 0.0175, noise passes for rolls";
    sheet.header(MARGINS[0], "How long states last", &[notes]);
    sheet.legend((MARGINS[0], HEADER - 66.0), &STAYS.map(|stay| (stay.look, stay.name)));
    let layout = panel::axes(RANGES[0], RANGES[1])
        .with_log_y()
        .with_x_label("friction κ")
        .with_y_label("mean residence time, in oscillations");
    let place = Place { x: 0.0, y: HEADER, width: SIZE.0, height: SIZE.1 };
    let panel = sheet.panel(place, MARGINS, Vec::new(), layout);
    for stay in &STAYS {
        let ends = |(at, time): (f64, Residence)| {
            time.interval().map(|end| (at, end.clamp(RANGES[1].0, RANGES[1].1)))
        };
        sheet.bars(&panel, stay.look, times(stay, values).map(ends));
        for (at, time) in times(stay, values) {
            let look = if time.is_bound() { stay.look.open() } else { stay.look };
            sheet.marks(&panel, look, [(at, time.mean)]);
        }
    }
    sheet
}

/// Returns the friction and the length of a stay at each value of the larger gravity that is not part of a
/// ramp.
fn times(stay: &Stay, values: &[Value]) -> impl Iterator<Item = (f64, Residence)> {
    let of_sweep = values.iter().filter(|value| value.row.leg.is_empty());
    of_sweep.filter_map(|value| Some((value.row.friction?, (stay.of)(value)?)))
}
