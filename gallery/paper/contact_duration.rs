//! The transitions between convective states as they depend on the contact duration.
//!
//! The system is the paper's at `g = 0.015625`. Friction goes up at `q = 0`, and inelasticity goes up at
//! `κ = 0.05`, with contact durations from 1e-7 to 1e-3 and three independent ramps each. The paper has no
//! contact duration: results that depend on it would be results of the remedy and not of the system.
//!
//! ```text
//! cargo run --release -p gallery --all-features --bin contact_duration
//! ```
//!
//! The example writes the studies and `contact_duration.svg` and `.png`, and prints a table. After an
//! interruption, the same command continues.

use std::error::Error;
use std::process::ExitCode;

use clap::Parser;
use granular_edmd::ParameterError;
use granular_edmd::statistics::RunningMean;
use granular_edmd_study::analysis::{
    ConvectiveRegime, StateCriteria, Transition, TransitionLine, transitions,
};
use granular_edmd_study::vibrated_box::VibratedBox;
use granular_edmd_study::{Axis, Course, Outcome, Plan, PlanError, Protocol, Ramp};
use kuva::prelude::Plot;

use gallery::look::Look;
use gallery::panel::{self, COLUMN, Margins, Place};
use gallery::sheet::Sheet;

/// Transitions at five contact durations.
#[derive(Parser)]
struct Arguments {
    #[command(flatten)]
    common: gallery::studies::Common,
}

type Record = granular_edmd_study::Record<VibratedBox>;

/// The transitions of each ramp.
type Ramps = Vec<Vec<Transition>>;

const DURATIONS: [f64; 5] = [1e-7, 1e-6, 1e-5, 1e-4, 1e-3];

/// Number of independent ramps for each duration.
const RUNS: usize = 3;

/// Frictions of the ramp, with small steps where a transition is expected.
const FRICTIONS: [f64; 19] = [
    0.005, 0.01, 0.015, 0.02, 0.025, 0.03, 0.05, 0.055, 0.06, 0.065, 0.07, 0.075, 0.08, 0.09, 0.1, 0.15,
    0.175, 0.2, 0.3,
];
const INELASTICITIES: [f64; 9] = [0.01, 0.02, 0.025, 0.03, 0.035, 0.04, 0.045, 0.05, 0.1];

/// Friction of the ramps of inelasticity.
const FRICTION: f64 = 0.05;

fn main() -> ExitCode {
    gallery::command_line::main(run)
}

fn run(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    let ramps = [
        ("contact_duration-friction", "friction", FRICTIONS.to_vec(), 0.0),
        ("contact_duration-inelasticity", "inelasticity", INELASTICITIES.to_vec(), FRICTION),
    ];
    let (mut tables, mut panels) = (Vec::new(), Vec::new());
    for (name, parameter, values, friction) in ramps {
        let plan = plan(&arguments.common, parameter, values, friction)?;
        let Some(study) = arguments.common.complete(name, &plan)? else {
            return Ok(());
        };
        let records: Vec<Record> = study.records().collect::<Result<_, _>>()?;
        print(parameter, &records)?;
        panels.push((parameter, by_duration(parameter, &records)?));
        tables.push((parameter, study.folder().join("values.csv")));
    }
    let path = arguments.common.results.path("contact_duration");
    draw(&panels).write(&path)?;
    gallery::say!("wrote {0}.svg and {0}.png", path.display());
    arguments.common.results.write_tables_as_json(&tables)
}

fn plan(
    common: &gallery::studies::Common,
    parameter: &str,
    values: Vec<f64>,
    friction: f64,
) -> Result<Plan<VibratedBox>, PlanError> {
    let experiment = gallery::studies::vibrated_box(0.015_625).with_friction(friction);
    let protocol = if common.quick { Protocol::new(100, 10, 10) } else { Protocol::new(500, 100, 10) }?;
    Plan::new(experiment, protocol, common.seed)?
        .with_ramp(Ramp::new(parameter, values, Course::Up)?)?
        .with_axis(Axis::new("contact_duration", DURATIONS)?)?
        .with_repeats(RUNS)
}

/// Prints a row for each contact duration: the positions of the transitions, and the share of collisions that
/// the model has changed.
fn print(parameter: &str, records: &[Record]) -> Result<(), Box<dyn Error>> {
    gallery::say!(
        "transitions along {parameter}; ± is the standard error from independent ramps and from a step"
    );
    gallery::say!(
        "| t_c | {} | changed, first | last value | stalled |",
        TransitionLine::ALL.map(|line| line.to_string()).join(" | ")
    );
    gallery::say!("|---|---|---|---|---|---|---|---|");
    let values = records.len() / (DURATIONS.len() * RUNS);
    for (duration, group) in DURATIONS.iter().zip(records.chunks(values * RUNS)) {
        let ramps: Vec<&[Record]> = group.chunks(values).collect();
        let found = ramps.iter().map(|ramp| rising(parameter, ramp)).collect::<Result<Ramps, _>>()?;
        let places = TransitionLine::ALL.map(|line| told(crossing(line, &found).as_ref())).join(" | ");
        let changed = [0, values - 1].map(|value| share_changed(ramps.iter().map(|ramp| &ramp[value])));
        let stalled = group.iter().filter(|record| matches!(record.outcome(), Outcome::Stalled { .. }));
        gallery::say!(
            "| {duration:e} | {places} | {:.1e} | {:.1e} | {} |",
            changed[0],
            changed[1],
            stalled.count()
        );
    }
    Ok(())
}

/// Returns the transitions of one ramp to states of larger loss.
fn rising(parameter: &str, ramp: &[Record]) -> Result<Vec<Transition>, ParameterError> {
    let regime = |record: &Record| -> Result<(f64, ConvectiveRegime), ParameterError> {
        let noise = record.thermal_noise();
        let found = StateCriteria::default().classify(&record.order(), noise, record.densest_layer())?;
        let value = record.parameter(parameter).and_then(|value| value.number());
        Ok((value.unwrap_or(f64::NAN), found.regime()))
    };
    let regimes: Vec<_> =
        ramp.iter().filter(|record| !record.samples().is_empty()).map(regime).collect::<Result<_, _>>()?;
    Ok(transitions(regimes)?.into_iter().filter(|transition| transition.rising).collect())
}

/// The first crossing of a line in each ramp: the mean, its error from the scatter of the ramps and from the
/// width of a step, and the number of ramps that have it.
struct Crossing {
    value: f64,
    error: f64,
    count: u64,
}

fn crossing(line: TransitionLine, ramps: &Ramps) -> Option<Crossing> {
    let first: Vec<&Transition> =
        ramps.iter().filter_map(|found| found.iter().find(|transition| transition.line == line)).collect();
    let values: RunningMean = first.iter().map(|transition| transition.value).collect();
    let half_steps: RunningMean = first.iter().map(|transition| transition.error).collect();
    // The transition lies anywhere in a step with equal probability. Its standard deviation is the half step
    // over the root of three.
    let scatter = if values.count() > 1 { values.standard_error() } else { 0.0 };
    let error = scatter.hypot(half_steps.mean() / 3.0_f64.sqrt());
    (values.count() > 0).then(|| Crossing { value: values.mean(), error, count: values.count() })
}

fn told(crossing: Option<&Crossing>) -> String {
    let Some(Crossing { value, error, count }) = crossing else { return "–".to_owned() };
    let of = if *count < RUNS as u64 { format!(" ({count} of {RUNS})") } else { String::new() };
    format!("{value:.4} ± {error:.4}{of}")
}

/// Returns the share of all collisions, with disks and walls, that the model made elastic.
fn share_changed<'a>(records: impl Iterator<Item = &'a Record>) -> f64 {
    let (changed, all) = records.map(Record::counters).fold((0, 0), |(changed, all), counters| {
        let collisions = counters.disk_collisions + counters.wall_collisions;
        (changed + counters.contact_duration_collisions, all + collisions)
    });
    changed as f64 / all as f64
}

/// Returns the transitions of the ramps of each contact duration.
fn by_duration(parameter: &str, records: &[Record]) -> Result<Vec<Ramps>, ParameterError> {
    let values = records.len() / (DURATIONS.len() * RUNS);
    let ramps =
        |group: &[Record]| group.chunks(values).map(|ramp| rising(parameter, ramp)).collect::<Result<_, _>>();
    records.chunks(values * RUNS).map(ramps).collect()
}

const MARGINS: Margins = [74.0, 16.0, 10.0, 60.0];
const HEIGHT: f64 = 320.0;
const HEADER: f64 = 176.0;

/// Draws the positions of the transitions over the contact duration, for both parameters.
fn draw(panels: &[(&str, Vec<Ramps>)]) -> Sheet {
    let mut sheet = Sheet::new(COLUMN, HEADER + HEIGHT * panels.len() as f64);
    let system = format!("N = 1000, g = 0.015625; above: q = 0, below: κ = {FRICTION}");
    let note = format!("means of {RUNS} ramps with standard errors, a little apart sideways");
    sheet.header(MARGINS[0], "Transitions and the contact duration", &[&system, &note]);
    let names = TransitionLine::ALL.map(|line| line.to_string());
    let looks = (0..).map(Look::number);
    let entries: Vec<_> = looks.zip(names.iter().map(String::as_str)).collect();
    sheet.legend_in_row((16.0, HEADER - 14.0), &entries);
    for (number, (parameter, found)) in panels.iter().enumerate() {
        let place = Place { x: 0.0, y: HEADER + HEIGHT * number as f64, width: COLUMN, height: HEIGHT };
        add_panel(&mut sheet, place, parameter, found);
    }
    sheet
}

fn add_panel(sheet: &mut Sheet, place: Place, parameter: &str, found: &[Ramps]) {
    let (range, name) = if parameter == "friction" {
        ((0.009, 0.5), "friction κ")
    } else {
        ((0.008, 0.13), "inelasticity q")
    };
    let layout = panel::axes((4e-8, 2.5e-3), range).with_log_scale();
    let layout = layout.with_x_label("contact duration, in σ/Aω").with_y_label(name);
    let lines: Vec<(Look, Vec<(f64, Crossing)>)> = TransitionLine::ALL
        .iter()
        .enumerate()
        .map(|(number, line)| {
            let at = |(duration, ramps)| Some((duration, crossing(*line, ramps)?));
            // The lines stand a little apart, so that their bars can be seen.
            let shift = 1.0 + 0.12 * (number as f64 - 1.5);
            let durations = DURATIONS.iter().map(|duration| duration * shift);
            (Look::number(number), durations.zip(found).filter_map(at).collect())
        })
        .collect();
    let curve = |(look, points): &(Look, Vec<(f64, Crossing)>)| -> Plot {
        look.with_width(1.2).curve(points.iter().map(|(duration, at)| (*duration, at.value)))
    };
    let panel = sheet.panel(place, MARGINS, lines.iter().map(curve).collect(), layout);
    for (look, points) in &lines {
        let bar = |(duration, at): &(f64, Crossing)| {
            [at.value - at.error, at.value + at.error].map(|value| (*duration, value))
        };
        sheet.bars(&panel, *look, points.iter().map(bar));
        sheet.marks(&panel, *look, points.iter().map(|(duration, at)| (*duration, at.value)));
    }
}
