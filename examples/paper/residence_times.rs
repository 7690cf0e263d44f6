//! How long does a roll keep its sense, and how long do two rolls stay where one is stable, too?
//!
//! The example reads the order parameters that `docs/reproduction/long/run` has recorded, a million
//! oscillations for each value, names the state of each sample, and counts how long states last. It writes
//! `residence_times` as a table and a picture.
//!
//! ```text
//! cargo run --release --features serde --example residence_times
//! ```

#[path = "../common/mod.rs"]
mod common;

use std::error::Error;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Parser;
use flate2::read::GzDecoder;
use granular_edmd::study::Plan;
use granular_edmd::study::vibrated_box::VibratedBox;

use common::command_line::{self, Failure};
use common::look::{BLUE, Look, Mark, VERMILION};
use common::panel::{self, COLUMN, Margins, Place};
use common::results::Results;
use common::sheet::Sheet;

/// Residence times of one roll of either sense, and of two rolls, from runs of a million oscillations.
#[derive(Parser)]
struct Arguments {
    /// Folder of the studies.
    #[arg(long, value_name = "FOLDER", default_value = "docs/reproduction/long")]
    studies: PathBuf,
    /// Reads the first tenth of each run.
    #[arg(long)]
    quick: bool,
    #[command(flatten)]
    results: Results,
}

fn main() -> ExitCode {
    command_line::main(|arguments: &Arguments| {
        let values = read(&arguments.studies, arguments.quick).map_err(Failure::usage)?;
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
    states: Vec<State>,
}

impl Value {
    fn samples(&self, state: State) -> usize {
        self.states.iter().filter(|seen| **seen == state).count()
    }

    /// Returns how often a state ends.
    fn ends(&self, state: State) -> usize {
        self.states.windows(2).filter(|pair| pair[0] == state && pair[1] != state).count()
    }

    /// Returns the share of the time in a state.
    fn share(&self, state: State) -> f64 {
        self.samples(state) as f64 / self.states.len() as f64
    }

    /// Returns the mean residence time of states in oscillations, with its standard error, if they end: all
    /// of their time over the number of their ends, which also counts the last stay, whose end is not seen.
    fn residence(&self, states: &[State]) -> Option<(f64, f64)> {
        let samples: usize = states.iter().map(|state| self.samples(*state)).sum();
        let ends: usize = states.iter().map(|state| self.ends(*state)).sum();
        let time = (samples as u64 * self.every) as f64 / ends as f64;
        (ends > 0).then(|| (time, time / (ends as f64).sqrt()))
    }
}

/// Names the state of each sample. A state lasts until another one stands out by twice the noise of a gas at
/// rest: less would count noise at the border as changes. Samples before the first that stands out are left
/// out.
fn states(order: impl Iterator<Item = (f64, f64)>, noise: f64) -> Vec<State> {
    let margin = 2.0 * noise;
    let mut now = None;
    let named = order.map(move |(one, two)| {
        if two > one.abs() + margin {
            now = Some(State::TwoRolls);
        } else if one.abs() > two.max(0.0) + margin {
            now = Some(if one > 0.0 { State::Clockwise } else { State::Counterclockwise });
        }
        now
    });
    named.flatten().collect()
}

fn read(folder: &Path, quick: bool) -> Result<Vec<Value>, Box<dyn Error>> {
    let entries = fs::read_dir(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let mut studies: Vec<PathBuf> = entries.map(|entry| Ok(entry?.path())).collect::<std::io::Result<_>>()?;
    studies.retain(|study| study.join("order.csv.gz").is_file());
    studies.sort();
    let values: Vec<Vec<Value>> = studies
        .iter()
        .map(|study| read_study(study, quick).map_err(|error| format!("{}: {error}", study.display())))
        .collect::<Result<_, _>>()?;
    if values.is_empty() {
        return Err(format!("{} has no long runs", folder.display()).into());
    }
    Ok(values.into_iter().flatten().collect())
}

fn read_study(folder: &Path, quick: bool) -> Result<Vec<Value>, Box<dyn Error>> {
    let plan = Plan::<VibratedBox>::from_toml(&fs::read_to_string(folder.join("plan.toml"))?)?;
    let (every, samples) = (plan.protocol().every(), plan.protocol().samples() as usize);
    let rows: Vec<Row> =
        csv::Reader::from_path(folder.join("values.csv"))?.deserialize().collect::<Result<_, _>>()?;
    let order = GzDecoder::new(File::open(folder.join("order.csv.gz"))?);
    let mut order = csv::ReaderBuilder::new().has_headers(false).from_reader(order);
    // Ramp, value, and both order parameters in units of 1e-3.
    let order: Vec<(u32, u32, f64, f64)> = order.deserialize().collect::<Result<_, _>>()?;
    let study = folder.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let take = if quick { samples / 10 } else { samples };
    let value = |row: Row| {
        let of_value = order.iter().filter(|sample| (sample.0, sample.1) == (row.ramp, row.value)).take(take);
        let states = states(of_value.map(|sample| (1e-3 * sample.2, 1e-3 * sample.3)), row.thermal_noise);
        Value { study: study.clone(), row, every, states }
    };
    Ok(rows.into_iter().map(value).collect())
}

/// The states whose residence is counted.
const COUNTED: [(&str, &[State], Look); 2] = [
    ("one roll of one sense", &[State::Clockwise, State::Counterclockwise], Look::new(BLUE, "", Mark::Disk)),
    ("two rolls", &[State::TwoRolls], Look::new(VERMILION, "8 4", Mark::Square)),
];

fn finish(values: &[Value], results: &Results) -> Result<(), Box<dyn Error>> {
    let columns = [
        "study",
        "leg",
        "friction",
        "inelasticity",
        "oscillations",
        "clockwise",
        "counterclockwise",
        "two_rolls",
        "one_roll_residence",
        "one_roll_residence_error",
        "two_rolls_residence",
        "two_rolls_residence_error",
    ];
    let mut table = results.table("residence_times", &columns)?;
    for value in values {
        let Row { leg, friction, inelasticity, .. } = &value.row;
        let oscillations = value.states.len() as u64 * value.every;
        let shares = [State::Clockwise, State::Counterclockwise, State::TwoRolls].map(|s| value.share(s));
        let times = COUNTED.map(|(_, states, _)| value.residence(states));
        let rounded = |number: f64, digits| format!("{number:.digits$}");
        let times_told = times.map(|time| time.map(|(mean, error)| (rounded(mean, 0), rounded(error, 0))));
        let shares_told = shares.map(|share| rounded(share, 4));
        table.serialize((
            &value.study,
            leg,
            friction,
            inelasticity,
            oscillations,
            shares_told,
            times_told,
        ))?;
        print(value, shares, times);
    }
    results.finish_table("residence_times", table, Some(&draw(values)))
}

fn print(value: &Value, shares: [f64; 3], times: [Option<(f64, f64)>; 2]) {
    let Row { leg, friction, inelasticity, .. } = &value.row;
    let at = friction.map(|at| format!("κ = {at}")).or(inelasticity.map(|at| format!("q = {at}")));
    let shares = shares.map(|share| format!("{:3.0} %", 100.0 * share));
    let told = times.map(|time| {
        time.map_or("-".to_owned(), |(mean, error)| format!("{mean:.0} ± {error:.0} oscillations"))
    });
    println!(
        "{:10} {leg:4} {:11} one roll {} clockwise, {} counterclockwise, {}; two rolls {}, {}",
        value.study,
        at.unwrap_or_default(),
        shares[0],
        shares[1],
        told[0],
        shares[2],
        told[1]
    );
}

const MARGINS: Margins = [74.0, 20.0, 16.0, 60.0];
const HEADER: f64 = 130.0;
const SIZE: (f64, f64) = (COLUMN, 360.0);

/// Ranges of friction and of residence times.
const RANGES: [(f64, f64); 2] = [(0.0, 0.07), (1e2, 1e6)];

/// Draws the residence times at the larger gravity over friction.
fn draw(values: &[Value]) -> Sheet {
    let mut sheet = Sheet::new(SIZE.0, HEADER + SIZE.1);
    let note = "N = 1000, g = 0.015625, q = 0, A = 0.1, ω = 10; a million oscillations for each friction";
    sheet.header(MARGINS[0], "How long states last", &[note]);
    sheet.legend_in_row((MARGINS[0], HEADER - 22.0), &COUNTED.map(|(name, _, look)| (look, name)));
    let layout = panel::axes(RANGES[0], RANGES[1])
        .with_log_y()
        .with_x_label("friction κ")
        .with_y_label("mean residence time, in oscillations");
    let place = Place { x: 0.0, y: HEADER, width: SIZE.0, height: SIZE.1 };
    let times = |states: &'static [State]| {
        let of_sweep = values.iter().filter(|value| value.study == "senses");
        of_sweep.filter_map(|value| Some((value.row.friction?, value.residence(states)?)))
    };
    let curves = COUNTED.map(|(_, states, look)| look.curve(times(states).map(|(at, (mean, _))| (at, mean))));
    let panel = sheet.panel(place, MARGINS, curves.into(), layout);
    for (_, states, look) in COUNTED {
        let ends = times(states)
            .map(|(at, (mean, error))| [(at, (mean - error).max(RANGES[1].0)), (at, mean + error)]);
        sheet.bars(&panel, look, ends);
        sheet.marks(&panel, look, times(states).map(|(at, (mean, _))| (at, mean)));
    }
    sheet
}
