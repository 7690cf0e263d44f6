//! Osmosis: a membrane that one of two kinds passes, and the pressure on a piston.
//!
//! A solution on the left and a solvent on the right are separated by a membrane, which stops the solute
//! only. The left wall is a piston on a spring, and shows the pressure. Solvent flows through the membrane
//! until as much comes back; the solution then has the greater pressure. All disks are hard, elastic and of
//! diameter 1, and the box is periodic upward.
//!
//! ```text
//! cargo run --release -p gallery --bin membrane
//! cargo run --release -p gallery --bin membrane -- --solutes 20,60 --time 20000 --out membrane
//! ```
//!
//! The example writes `membrane.svg`, `membrane.png` and `membrane.csv`. Literature: J. H. van 't Hoff, Z.
//! phys. Chem. 1, 481 (1887); for hard disks, D. Henderson, Mol. Phys. 30, 971 (1975).

use std::error::Error;
use std::f64::consts::PI;
use std::process::ExitCode;

use clap::Parser;
use granular_edmd::observable::{Crossings, OfKind, Temperatures, WallStress, measured_by};
use granular_edmd::prelude::*;
use granular_edmd::wall::Piston;

use gallery::command_line::{self, Failure, positive};
use gallery::faces::{GAP, faces};
use gallery::look::{BLUE, INK, LOOKS, Look, Mark, QUIET, SKY, VERMILION};
use gallery::panel::{self, Margins, Place};
use gallery::progress::Progress;
use gallery::results::Results;
use gallery::sheet::Sheet;

/// The osmotic pressure of a solution on a piston, as a function of the density of the solute.
#[derive(Parser)]
struct Arguments {
    /// Numbers of solute disks, at most 100.
    #[arg(long, value_delimiter = ',', default_value = "0,15,30,45,60", value_parser = clap::value_parser!(u32).range(..=100))]
    solutes: Vec<u32>,
    /// Time for which each pressure is measured, in units of d √(m/T) with the initial temperature.
    #[arg(long, default_value_t = 12000.0, value_parser = positive)]
    time: f64,
    /// Measures for a time of 200 at most.
    #[arg(long)]
    quick: bool,
    #[command(flatten)]
    results: Results,
}

const SOLVENT: Kind = Kind::new(0);
const SOLUTE: Kind = Kind::new(1);
const SOLVENTS: u32 = 100;

/// Width and height of the box, and half its width, where the membrane is.
const WIDTH: f64 = 40.0;
const HEIGHT: f64 = 20.0;
const MEMBRANE: f64 = 0.5 * WIDTH;

/// Stiffness of the piston's spring, and the displacement at which the spring is slack.
const STIFFNESS: f64 = 1.0;
const SLACK: f64 = 1.0;

/// Time before the measurement, and the length of the intervals in which crossings are counted.
const SETTLE: f64 = 400.0;
const INTERVAL: f64 = 5.0;

/// Half the width of the strips in the middle of both sides in which densities are measured.
const STRIP: f64 = 5.0;

/// Means and errors of a run.
struct Osmosis {
    /// Densities: solute and solvent in the solution, and pure solvent.
    densities: [f64; 3],
    /// Osmotic pressure over the temperature, and its error.
    pressure: [f64; 2],
    /// Times, and the net number of solvent disks that have entered the solution since the previous time.
    inflow: Vec<(f64, f64)>,
    /// The net number in equilibrium, per unit of time.
    exchange: Estimate,
    /// The disks and the position of the piston at the end.
    shot: Vec<Disk>,
    piston: f64,
}

impl Osmosis {
    /// Returns the osmotic pressure over the temperature and the density of solvent in the solution, by
    /// Henderson's equation: solute and solvent are equal disks, and the solvent has the same chemical
    /// potential on both sides.
    fn theory(&self) -> [f64; 2] {
        let [solute, _, pure] = self.densities;
        let share = |density: f64| 0.25 * PI * density;
        let factor = |density: f64| (1.0 + 0.125 * share(density).powi(2)) / (1.0 - share(density)).powi(2);
        let excess = |density: f64| {
            let (filled, free) = (share(density), 1.0 - share(density));
            1.125 * filled / free - 0.875 * free.ln() + factor(density) - 1.0
        };
        let (mut low, mut high) = (0.0, pure);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            let is_low = middle * excess(middle + solute).exp() < pure * excess(pure).exp();
            if is_low { low = middle } else { high = middle }
        }
        let all = low + solute;
        [all * factor(all) - pure * factor(pure), low]
    }
}

fn main() -> ExitCode {
    command_line::main(run)
}

fn run(arguments: &Arguments) -> Result<(), Failure> {
    arguments.results.make_folder()?;
    let runs = arguments.solutes.iter().map(|&solutes| osmosis(arguments, solutes));
    let runs = runs.collect::<Result<Vec<_>, _>>().map_err(Failure::run)?;
    write(arguments, &runs).map_err(Failure::run)
}

/// Returns disks of a kind on a grid of ten rows and columns, in this half of the box.
fn grid(kind: Kind, count: u32, left: f64) -> impl Iterator<Item = Result<Disk, ParameterError>> {
    let place = |k: u32| DVec2::new(1.95 * f64::from(k / 10) + 1.2, 2.0 * f64::from(k % 10) + 1.0);
    (0..count).map(move |k| Ok(Disk::new(place(k) + left * DVec2::X, 0.5)?.with_kind(kind)))
}

fn osmosis(arguments: &Arguments, solutes: u32) -> Result<Osmosis, Box<dyn Error>> {
    let piston = Piston::new(20.0, [-10.0, 4.0])?.with_spring(STIFFNESS, SLACK)?;
    let container =
        Container::closed(WIDTH, HEIGHT)?.with_periodic_ends()?.with_piston(Wall::Left, piston)?;
    let left = container.index(Wall::Left).unwrap_or_default();
    let line = [DVec2::new(MEMBRANE, 0.0), DVec2::new(MEMBRANE, HEIGHT)];
    let vessel = container.with_part("membrane", Part::polyline(line)?.only_for([SOLUTE]))?;
    let disks = grid(SOLUTE, solutes, 0.0).chain(grid(SOLVENT, SOLVENTS, MEMBRANE));
    let disks = initial::with_maxwellian_velocities(disks.collect::<Result<_, _>>()?, 1.0, 1)?;
    let mut run = Simulation::builder(Elastic, vessel).disks(disks).build()?;

    let end = SETTLE + if arguments.quick { arguments.time.min(200.0) } else { arguments.time };
    let mut progress = Progress::of(format!("{solutes} solutes")).until(end);
    let counter = OfKind::new(SOLVENT, Crossings::new(line, SampleTimes::every(INTERVAL)?)?);
    let (mut inflow, mut exchange) = (counter.clone(), counter);
    run.run_until(SETTLE, &mut (&mut inflow, &mut progress))?;
    let density = |snapshot: &Snapshot<'_>, kind: Kind, middle: f64| {
        let is_inside = |disk: &&Disk| disk.kind() == kind && (disk.position().x - middle).abs() < STRIP;
        snapshot.disks().iter().filter(is_inside).count() as f64 / (2.0 * STRIP * HEIGHT)
    };
    let (dilute, pure) = (0.5 * MEMBRANE, 1.5 * MEMBRANE);
    let state = measured_by(|snapshot: &Snapshot<'_>| {
        let push = snapshot.wall_point(left).map_or(f64::NAN, |point| STIFFNESS * (SLACK - point.x) / HEIGHT);
        let densities = [(SOLUTE, dilute), (SOLVENT, dilute), (SOLVENT, pure)];
        let densities = densities.map(|(kind, middle)| density(snapshot, kind, middle));
        (push, densities, Temperatures.measure(snapshot).translational())
    });
    let mut series = Series::new(state, SampleTimes::every(1.0)?);
    let mut stress = WallStress::new(SampleTimes::every(4.0 * INTERVAL)?).with_wall("right", HEIGHT)?;
    run.run_until(end, &mut (&mut exchange, (&mut series, &mut stress), &mut progress))?;
    gallery::output::warn(&run.warnings());

    let (solution, solvent) =
        (series.mean(|state| state.0)?, stress.pressure("right").ok_or("a right wall")?);
    let mean = |number: usize| series.mean(|state| state.1[number]).map(|mean| mean.mean());
    let temperature = series.mean(|state| state.2)?.mean();
    let error = solution.standard_error().hypot(solvent.standard_error());
    let pressure = [solution.mean() - solvent.mean(), error].map(|pressure| pressure / temperature);
    let inflow = inflow.inner();
    let net =
        inflow.forward().iter().zip(inflow.backward()).map(|(&there, &back)| there as f64 - back as f64);
    let inflow = inflow.times().iter().copied().zip(net).collect();
    let exchange = exchange.inner().flux()?;
    let piston = run.snapshot().wall_point(left).map_or(0.0, |point| point.x);
    let densities = [mean(0)?, mean(1)?, mean(2)?];
    Ok(Osmosis { densities, pressure, inflow, exchange, shot: run.disks(), piston })
}

fn write(arguments: &Arguments, runs: &[Osmosis]) -> Result<(), Box<dyn Error>> {
    let densities = ["solute", "solvent_in_solution", "solvent"];
    let columns = [&densities[..], &["pressure", "pressure_error", "theory", "theory_of_solvent"]].concat();
    let mut table = arguments.results.table("membrane", &columns)?;
    for run in runs {
        let ([solute, solvent, _], [pressure, error], [theory, expected]) =
            (run.densities, run.pressure, run.theory());
        gallery::say!("n = {solute:.4}: Π = {pressure:.4} ± {error:.4} T/d², theory {theory:.4}");
        gallery::say!("    solvent beside it: {solvent:.4}, theory {expected:.4}; net flow {}", run.exchange);
        table.serialize((run.densities, run.pressure, theory, expected))?;
    }
    arguments.results.finish_table("membrane", table, Some(&draw(runs)?))
}

const MARGINS: Margins = [66.0, 16.0, 12.0, 58.0];
const HEADER: f64 = 66.0;
const FLOW: f64 = 260.0;
const COLUMN: f64 = 500.0;

/// Draws the last run and its flow, and the pressures of all runs.
fn draw(runs: &[Osmosis]) -> Result<Sheet, Box<dyn Error>> {
    let unit = (COLUMN - MARGINS[0] - MARGINS[1]) / (WIDTH + 10.0);
    let box_height = HEIGHT * unit + MARGINS[2] + MARGINS[3];
    let mut sheet = Sheet::new(2.0 * COLUMN, HEADER + box_height + FLOW);
    let about = "Hard disks of diameter d; only the solvent (light) passes the membrane; piston and spring on the left";
    sheet.header(MARGINS[0], "Osmotic pressure", &[about]);
    let Some(shown) = runs.last() else { return Err("no run to draw".into()) };
    let place = Place { x: 0.0, y: HEADER, width: COLUMN, height: box_height };
    let layout = panel::axes((-10.0, WIDTH), (0.0, HEIGHT)).with_x_label("x, in diameters");
    let color = |disk: &Disk| if disk.kind() == SOLUTE { VERMILION } else { SKY };
    let wall = |x: f64, look: Look| look.curve([(x, 0.0), (x, HEIGHT)]);
    let plots = vec![
        faces(shown.shot.iter(), unit, GAP, color),
        wall(MEMBRANE, Look::line(INK, "5 4")),
        wall(shown.piston, Look::line(INK, "").with_width(5.0)),
    ];
    sheet.panel(place, MARGINS, plots, layout.with_y_label("y, in diameters"));
    draw_flow(&mut sheet, Place { y: HEADER + box_height, height: FLOW, ..place }, runs);
    draw_pressures(&mut sheet, Place { x: COLUMN, height: box_height + FLOW, ..place }, runs);
    Ok(sheet)
}

/// Draws the solvent in the solution over time.
fn draw_flow(sheet: &mut Sheet, place: Place, runs: &[Osmosis]) {
    let layout =
        panel::axes((0.0, SETTLE), (0.0, 1.1 * f64::from(SOLVENTS))).with_x_label("time, in d √(m/T)");
    let looks = [LOOKS[0], LOOKS[1]].map(Look::without_marks);
    let shown = [runs.first(), runs.last()].into_iter().flatten();
    let names: Vec<_> = shown.clone().map(|run| format!("n = {:.2} of solute", run.densities[0])).collect();
    let within = |run: &Osmosis| {
        let sum = |sum: &mut f64, &(time, net): &(f64, f64)| {
            *sum += net;
            Some((time, *sum))
        };
        std::iter::once((0.0, 0.0)).chain(run.inflow.iter().scan(0.0, sum)).collect::<Vec<_>>()
    };
    let curves = looks.iter().zip(shown).map(|(look, run)| look.curve(within(run))).collect();
    let panel = sheet.panel(place, MARGINS, curves, layout.with_y_label("solvent on the left"));
    let names: Vec<_> = looks.into_iter().zip(names.iter().map(String::as_str)).collect();
    sheet
        .legend((panel.place.x + 0.5 * panel.place.width, panel.place.y + 0.78 * panel.place.height), &names);
}

fn draw_pressures(sheet: &mut Sheet, place: Place, runs: &[Osmosis]) {
    let densest = 1.15 * runs.iter().map(|run| run.densities[0]).fold(0.01, f64::max);
    let highest = 1.15 * runs.iter().map(|run| run.pressure[0]).fold(0.01, f64::max);
    let layout = panel::axes((0.0, densest), (0.0, highest)).with_x_label("density of the solute, in 1/d²");
    let (theory, ideal) = (Look::line(VERMILION, ""), Look::line(QUIET, "6 4"));
    let measured = Look::marks(BLUE, Mark::Disk);
    let curves = vec![
        theory.curve(runs.iter().map(|run| (run.densities[0], run.theory()[0]))),
        ideal.curve([(0.0, 0.0), (densest, densest)]),
    ];
    let margins = [86.0, MARGINS[1], MARGINS[2], MARGINS[3]];
    let panel = sheet.panel(place, margins, curves, layout.with_y_label("osmotic pressure Π, in T/d²"));
    let points = || runs.iter().map(|run| (run.densities[0], run.pressure));
    sheet.bars(&panel, measured, points().map(|(x, [y, error])| [(x, y - error), (x, y + error)]));
    sheet.marks(&panel, measured, points().map(|(x, [y, _])| (x, y)));
    let names = [(measured, "piston"), (theory, "Henderson's equation"), (ideal, "van 't Hoff, Π = nT")];
    sheet.legend((panel.place.x + 16.0, panel.place.y + 28.0), &names);
}
