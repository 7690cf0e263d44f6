//! The paper's Fig. 4: samples in the plane of the order parameters where one roll and two coexist.
//!
//! The system has 1000 disks in the vibrated box, with `g = 0.015625`, `q = 0` and friction 0.0605. The
//! samples of a run form up to three clouds: one roll of either sense, and two rolls. A finite number of
//! disks makes the state jump between the clouds, and not every run visits all of them. The example does some
//! independent runs, and draws one of those that show the most clusters.
//!
//! ```text
//! cargo run --release -p gallery --all-features --bin fig4_clusters -- --quick
//! ```
//!
//! The example writes `fig4_clusters.svg` and `.png`, `clusters.csv` and the tables of the study. After an
//! interruption, the same command continues.

use std::error::Error;
use std::path::Path;
use std::process::ExitCode;

use clap::Parser;
use granular_edmd::glam::DVec2;
use granular_edmd::statistics::RunningMean;
use granular_edmd_study::analysis::{Classification, ConvectiveState, StateCriteria};
use granular_edmd_study::vibrated_box::VibratedBox;
use granular_edmd_study::{Plan, PlanError, Protocol, Record, Study};
use kuva::prelude::Plot;

use gallery::command_line::{non_negative, whole};
use gallery::look::{BLUE, GREEN, INK, Look, Mark, QUIET, VERMILION};
use gallery::panel::{self, COLUMN, Margins, Panel, Place};
use gallery::results;
use gallery::sheet::Sheet;

/// Clusters of the order parameters where one roll and two coexist (paper, Fig. 4).
#[derive(Parser)]
struct Arguments {
    #[command(flatten)]
    common: gallery::studies::Common,
    /// Friction.
    #[arg(long, default_value_t = 0.0605, value_parser = non_negative)]
    friction: f64,
    /// Independent runs.
    #[arg(long, default_value_t = 6, value_parser = whole::<10_000>)]
    runs: u64,
}

impl Arguments {
    fn plan(&self) -> Result<Plan<VibratedBox>, PlanError> {
        let experiment = gallery::studies::vibrated_box(0.015_625).with_friction(self.friction);
        // The paper does 100 000 oscillations, samples every 100, and discards the first half.
        let protocol =
            if self.common.quick { Protocol::new(4_000, 400, 20) } else { Protocol::new(50_000, 500, 100) }?;
        Plan::new(experiment, protocol, self.common.seed)?.with_repeats(self.runs as usize)
    }
}

/// A run and its clusters.
struct Run {
    record: Record<VibratedBox>,
    found: Classification,
}

impl Run {
    fn of(record: Record<VibratedBox>) -> Result<Self, Box<dyn Error>> {
        let found = StateCriteria::default().classify(
            &record.order(),
            record.thermal_noise(),
            record.densest_layer(),
        )?;
        Ok(Self { record, found })
    }

    fn clusters(&self) -> usize {
        self.found.clusters().len()
    }
}

fn main() -> ExitCode {
    gallery::command_line::main(run)
}

fn run(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    let Some(study) = arguments.common.complete("fig4_clusters", &arguments.plan()?)? else { return Ok(()) };
    let runs: Vec<Run> = study.records().map(|record| Run::of(record?)).collect::<Result<_, _>>()?;
    runs.iter().for_each(print);
    let three = runs.iter().filter(|run| run.clusters() == 3).count();
    gallery::say!("{three} of {} runs show three clusters", runs.len());
    print_weights(&runs);
    write_clusters(&runs, study.folder())?;
    // The first of the runs with the most clusters is shown.
    let Some(shown) = runs.iter().rev().max_by_key(|run| run.clusters()) else { return Ok(()) };
    let path = study.folder().join("fig4_clusters");
    draw(arguments, &study, shown).write(&path)?;
    gallery::say!(
        "wrote {0}.svg and {0}.png; the tables beside them are clusters.csv, values.csv and samples.csv",
        path.display()
    );
    let tables = ["clusters", "values"].map(|name| (name, study.folder().join(name).with_extension("csv")));
    arguments.common.results.write_tables_as_json(&tables)
}

fn print(run: &Run) {
    gallery::say!("run {}, seed {}:", run.record.ramp_index() + 1, run.record.seed());
    for (state, cluster) in run.found.iter() {
        let DVec2 { x, y } = cluster.center();
        gallery::say!("    {:3.0} %  Psi1 = {x:6.3}  Psi2 = {y:6.3}  {state}", 100.0 * cluster.weight());
    }
}

/// Prints the long-time weight of each state: the mean over the runs, which are independent, and its error.
fn print_weights(runs: &[Run]) {
    for state in
        [ConvectiveState::CounterclockwiseRoll, ConvectiveState::TwoRollsUp, ConvectiveState::ClockwiseRoll]
    {
        let weights: RunningMean = runs.iter().map(|run| run.found.weight(state)).collect();
        let (mean, error) = (100.0 * weights.mean(), 100.0 * weights.standard_error());
        gallery::say!("    {state}: {mean:.1} ± {error:.1} % of the time");
    }
}

fn write_clusters(runs: &[Run], folder: &Path) -> Result<(), Box<dyn Error>> {
    let mut table = results::table(&folder.join("clusters.csv"))?;
    table.write_record([
        "run",
        "state",
        "samples",
        "weight",
        "one_roll",
        "two_rolls",
        "spread_one_roll",
        "spread_two_rolls",
    ])?;
    for run in runs {
        for (state, cluster) in run.found.iter() {
            let (center, spread) = (cluster.center(), [DVec2::X, DVec2::Y].map(|axis| cluster.spread(axis)));
            let place = (run.record.ramp_index() + 1, state.to_string(), cluster.count(), cluster.weight());
            table.serialize((place, center.x, center.y, spread))?;
        }
    }
    Ok(table.flush()?)
}

const MARGINS: Margins = [72.0, 20.0, 10.0, 60.0];
const HEADER: f64 = 226.0;

/// Size of the panel, in which a unit is equally long in both directions.
const SIZE: (f64, f64) = (COLUMN, 314.8);

/// Ranges of both axes.
const RANGES: [(f64, f64); 2] = [(-0.25, 0.25), (-0.08, 0.22)];

/// The border of the noise of a gas at rest, and the center of a cluster.
const NOISE: Look = Look::line(QUIET, "2 3");
const CENTER: Look = Look::marks(INK, Mark::Cross).with_size(7.0);

fn draw(arguments: &Arguments, study: &Study<VibratedBox>, run: &Run) -> Sheet {
    let mut sheet = Sheet::new(SIZE.0, HEADER + SIZE.1);
    let plural = if run.clusters() == 1 { "" } else { "s" };
    let title = format!("{} cluster{plural} at κ = {}", run.clusters(), arguments.friction);
    let protocol = study.plan().protocol();
    let note = format!(
        "{} samples in the second half of {} oscillations; run {} of {}, seed {}",
        protocol.samples(),
        protocol.cycles(),
        run.record.ramp_index() + 1,
        arguments.runs,
        arguments.common.seed
    );
    let system = "N = 1000, g = 0.015625, q = 0, A = 0.1, ω = 10";
    sheet.header(MARGINS[0], &title, &[system, &note]);
    add_legend(&mut sheet, run);
    let layout = panel::axes(RANGES[0], RANGES[1]).with_x_label("Ψ₁, one roll").with_y_label("Ψ₂, two rolls");
    let place = Place { x: 0.0, y: HEADER, width: SIZE.0, height: SIZE.1 };
    let panel = sheet.panel(place, MARGINS, vec![noise(run)], layout.with_y_tick_step(0.1));
    add_clusters(&mut sheet, &panel, run);
    sheet
}

fn add_legend(sheet: &mut Sheet, run: &Run) {
    let name = |state: ConvectiveState, weight| format!("{state}, {:.0} %", 100.0 * weight);
    let names: Vec<_> =
        run.found.iter().map(|(state, cluster)| (look(state), name(state, cluster.weight()))).collect();
    let names: Vec<_> = names.iter().map(|(look, name)| (look.with_size(4.0), name.as_str())).collect();
    let others = [(CENTER, "center"), (NOISE, "three times the noise at rest")];
    sheet.legend((MARGINS[0], 124.0), &names.into_iter().chain(others).collect::<Vec<_>>());
}

/// Draws a circle about the origin, within which the samples of a gas at rest would lie.
fn noise(run: &Run) -> Plot {
    let radius = 3.0 * run.record.thermal_noise();
    let circle =
        (0..=90).map(|step| DVec2::from_angle(f64::from(step) * std::f64::consts::TAU / 90.0) * radius);
    NOISE.curve(circle.map(|at| (at.x, at.y)))
}

fn add_clusters(sheet: &mut Sheet, panel: &Panel, run: &Run) {
    let (order, labels) = (run.record.order(), run.found.clusters().labels());
    for (number, (state, cluster)) in run.found.iter().enumerate() {
        let of = order.iter().zip(labels).filter(|&(_, &label)| label == number);
        sheet.marks(panel, look(state), of.map(|(order, _)| (order.one_roll, order.two_rolls)));
        sheet.marks(panel, CENTER, [(cluster.center().x, cluster.center().y)]);
    }
}

const fn look(state: ConvectiveState) -> Look {
    let look = match state {
        ConvectiveState::ClockwiseRoll => Look::marks(BLUE, Mark::Disk),
        ConvectiveState::CounterclockwiseRoll => Look::marks(GREEN, Mark::Triangle),
        ConvectiveState::TwoRollsUp | ConvectiveState::TwoRollsDown => Look::marks(VERMILION, Mark::Square),
        _ => Look::marks(QUIET, Mark::Diamond),
    };
    look.with_size(2.4)
}
