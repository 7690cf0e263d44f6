//! A silo: how fast grains flow through an outlet, depending on its width.
//!
//! 600 grains stand on the floor of a silo, with an outlet that is shut by a gate. The gate is taken out. A
//! sink below removes the grains that have left, and an inlet inserts them again on top, so that the flow
//! continues with a constant number of grains. For an outlet of width `D` and grains of
//! diameter `d` in two dimensions, Beverloo's law says `W = C √g (D - kd)^{3/2}`.
//!
//! ```text
//! cargo run --release -p gallery --bin silo
//! cargo run --release -p gallery --bin silo -- --outlets 4,6,8 --time 400 --out silo
//! ```
//!
//! The example writes `silo.svg`, `silo.png` and `silo.csv`. Literature: W. A. Beverloo, H. A. Leniger and J.
//! van de Velde, Chem. Eng. Sci. 15, 260 (1961); in two dimensions, C. Mankoc et al., Granular Matter 9, 407
//! (2007).

use std::error::Error;
use std::process::ExitCode;

use clap::Parser;
use granular_edmd::Kind;
use granular_edmd::glam::DVec2;
use granular_edmd::observable::Arrivals;
use granular_edmd::prelude::*;
use granular_edmd::simulation::Inlet;
use kuva::prelude::{LinePlot, Plot};

use gallery::command_line::{self, Failure, positive};
use gallery::faces::{GAP, faces};
use gallery::look::{BLUE, INK, Look, Mark, ORANGE, SKY, VERMILION};
use gallery::panel::{self, Margins, Place, SMALL};
use gallery::progress::Progress;
use gallery::results::Results;
use gallery::sheet::Sheet;

/// Flow out of a silo as a function of the width of its outlet.
#[derive(Parser)]
struct Arguments {
    /// Widths of the outlets, in diameters of a grain.
    #[arg(long, value_delimiter = ',', default_value = "3,4,5,6,7,8", value_parser = positive)]
    outlets: Vec<f64>,
    /// Time for which each flow is measured, in units of the square root of diameter over gravity.
    #[arg(long, default_value_t = 200.0, value_parser = positive)]
    time: f64,
    /// Seed of the initial velocities and of the inlet.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Measures for a time of 10 at most.
    #[arg(long)]
    quick: bool,
    #[command(flatten)]
    results: Results,
}

const GRAINS: usize = 600;
const WIDTH: f64 = 24.0;

/// Height of the silo's floor. Grains that have fallen below `EXIT` have left the silo.
const FLOOR: f64 = 8.0;
const EXIT: f64 = 3.0;

/// Time for which the grains settle before the gate opens, and for which they flow before they are counted.
const SETTLE: f64 = 30.0;
const BEGIN: f64 = 20.0;

/// Time between two refills.
const REFILL: f64 = 0.25;

/// Heights between which grains are inserted again, and their speed.
const TOP: [f64; 2] = [36.0, 38.0];
const FALL: f64 = 2.0;

/// Number of intervals in which the grains that leave are counted.
const INTERVALS: f64 = 40.0;

/// Time after the gate opens at which the picture is taken.
const SHOT: f64 = 6.0;

/// Height of a layer of one color, and the kind of grains that were inserted again.
const LAYER: f64 = 3.0;
const AGAIN: Kind = Kind::new(99);

/// Least speed at which surfaces part, so that grains at rest do not collide ever faster. The flow does not
/// depend on it: docs/rest.md has the table, which also shows the effect of a contact duration.
const LEAST: f64 = 0.05;

/// A flow that was measured.
struct Flow {
    outlet: f64,
    /// Grains for each unit of time.
    rate: Estimate,
    shot: Vec<Disk>,
}

/// Beverloo's law, `W = prefactor (D - lost)^{3/2}`.
#[derive(Clone, Copy)]
struct Law {
    prefactor: f64,
    lost: f64,
    /// Root of the mean square of the relative deviations.
    scatter: f64,
}

fn main() -> ExitCode {
    command_line::main(run)
}

fn run(arguments: &Arguments) -> Result<(), Failure> {
    arguments.results.make_folder()?;
    if let Some(wide) = arguments.outlets.iter().find(|&&outlet| outlet > WIDTH - 2.0) {
        return Err(Failure::usage(format_args!("--outlets {wide}: the silo is {WIDTH} wide")));
    }
    let mut flows = Vec::new();
    for &outlet in &arguments.outlets {
        let flow = measured(arguments, outlet).map_err(Failure::run)?;
        gallery::say!("outlet {outlet}: {} grains for each unit of time", flow.rate);
        flows.push(flow);
    }
    let law = Law::of(&flows);
    if let Some(Law { prefactor, lost, scatter }) = law {
        gallery::say!("W = {prefactor:.2} (D - {lost:.2})^(3/2), scatter {:.1} %", 100.0 * scatter);
    }
    write(arguments, &flows, law).map_err(Failure::run)
}

/// Returns a silo whose outlet is shut by a gate.
fn silo(outlet: f64) -> Result<Container, Box<dyn Error>> {
    let (from, to) = (0.5 * (WIDTH - outlet), 0.5 * (WIDTH + outlet));
    let floor = |from: f64, to: f64| Part::polyline([DVec2::new(from, FLOOR), DVec2::new(to, FLOOR)]);
    let exit = Part::polyline([DVec2::new(-1.0, EXIT), DVec2::new(WIDTH + 1.0, EXIT)])?;
    let gate = [(0.0, 0.0), (WIDTH, 0.0), (WIDTH, FLOOR), (0.0, FLOOR)].map(DVec2::from);
    Ok(Container::open(WIDTH)?
        .with_part("left half of the silo's floor", floor(-1.0, from)?)?
        .with_part("right half of the silo's floor", floor(to, WIDTH + 1.0)?)?
        .with_part("exit", exit.absorbing_centers())?
        .with_part("gate", Part::block(gate)?)?)
}

/// Measures the flow through an outlet.
fn measured(arguments: &Arguments, outlet: f64) -> Result<Flow, Box<dyn Error>> {
    let mut vessel = silo(outlet)?;
    let disks = initial::lattice(&vessel, GRAINS, 0.5)?;
    let disks = initial::with_maxwellian_velocities(disks, 0.1, arguments.seed)?;
    let rule = LeastRebound::new(Frictional::from_inelasticity(0.1, 0.1, 0.4)?, LEAST)?;
    let mut run = Simulation::builder(rule, vessel.clone()).disks(disks).gravity(1.0).build()?;
    let time = if arguments.quick { arguments.time.min(10.0) } else { arguments.time };
    let begin = if arguments.quick { 2.0 } else { BEGIN };
    let mut progress = Progress::of(format!("outlet {outlet}")).until(SETTLE + begin + time);
    run.run_until(SETTLE, &mut progress)?;

    // The grains get the colors of the layers in which they lie now.
    let layer = |disk: Disk| disk.with_kind(Kind::new(((disk.position().y - FLOOR) / LAYER) as u16));
    let settled = run.remove(|_, _| true)?;
    run.insert(settled.into_iter().map(layer))?;
    vessel.remove_part("gate")?;
    run.set_boundary(vessel)?;
    let places = [DVec2::new(0.6, TOP[0]), DVec2::new(WIDTH - 0.6, TOP[1])];
    let refill = Inlet::refill(places, DVec2::new(0.0, -FALL), SampleTimes::every(REFILL)?, arguments.seed)?;
    run.add_inlet(refill.with_kind(AGAIN))?;
    run.run_until(SETTLE + SHOT.min(begin), &mut progress)?;
    let shot = run.disks();
    run.run_until(SETTLE + begin, &mut progress)?;
    let times = SampleTimes::every(time / INTERVALS)?.starting_at(run.time())?;
    let mut flow = Arrivals::at(["exit"], times);
    run.run_until(SETTLE + begin + time, &mut (&mut flow, &mut progress))?;
    gallery::output::warn(&run.warnings());
    Ok(Flow { outlet, rate: flow.rate()?, shot })
}

impl Law {
    /// Fits a line to `W^{2/3}` as a function of `D`.
    fn of(flows: &[Flow]) -> Option<Self> {
        let points: Vec<(f64, f64)> =
            flows.iter().map(|flow| (flow.outlet, flow.rate.mean().powf(2.0 / 3.0))).collect();
        let count = points.len() as f64;
        let mean = |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / count;
        let (x, y) = (mean(|point| point.0), mean(|point| point.1));
        let covariance: f64 = points.iter().map(|point| (point.0 - x) * (point.1 - y)).sum();
        let variance: f64 = points.iter().map(|point| (point.0 - x) * (point.0 - x)).sum();
        let slope = covariance / variance;
        if !(points.len() > 2 && slope > 0.0) {
            return None;
        }
        let law = Self { prefactor: slope.powf(1.5), lost: x - y / slope, scatter: 0.0 };
        let deviation = |flow: &Flow| (flow.rate.mean() / law.rate(flow.outlet) - 1.0).powi(2);
        Some(Self { scatter: (flows.iter().map(deviation).sum::<f64>() / count).sqrt(), ..law })
    }

    fn rate(&self, outlet: f64) -> f64 {
        self.prefactor * (outlet - self.lost).max(0.0).powf(1.5)
    }
}

fn write(arguments: &Arguments, flows: &[Flow], law: Option<Law>) -> Result<(), Box<dyn Error>> {
    let mut table = arguments.results.table("silo", &["outlet", "flow", "flow_error"])?;
    for flow in flows {
        table.serialize((flow.outlet, flow.rate.mean(), flow.rate.standard_error()))?;
    }
    let picture = draw(flows, law)?;
    let flows: Vec<_> = flows.iter().map(|flow| [flow.outlet, flow.rate.mean()]).collect();
    let law = law.map(|law| serde_json::json!({ "C": law.prefactor, "k": law.lost, "scatter": law.scatter }));
    arguments.results.finish("silo", table, &picture, &serde_json::json!({ "flows": flows, "law": law }))
}

const MARGINS: Margins = [62.0, 16.0, 28.0, 58.0];
const HEADER: f64 = 66.0;
const HEIGHT: f64 = 520.0;

/// Height of the part of the silo that is shown.
const SHOWN: f64 = 38.0;

/// The flows, with marks smaller than their error bars, and the law.
const MEASURED: Look = Look::marks(BLUE, Mark::Disk).with_size(3.0);
const LAW: Look = Look::line(VERMILION, "8 3");

/// Draws the silo with the widest outlet some time after the gate was opened, and the flows with the law.
fn draw(flows: &[Flow], law: Option<Law>) -> Result<Sheet, Box<dyn Error>> {
    let unit = (HEIGHT - MARGINS[2] - MARGINS[3]) / SHOWN;
    let frame = WIDTH * unit + MARGINS[0] + MARGINS[1];
    let mut sheet = Sheet::new(frame + 560.0, HEADER + HEIGHT);
    let about = "600 grains of diameter d, q = 0.1, κ = 0.4; orange: has left, and entered again on top";
    sheet.header(MARGINS[0], "Flow out of a silo", &[about]);
    let Some(shown) = flows.last() else { return Err("no outlet to draw".into()) };
    let place = Place { x: 0.0, y: HEADER, width: frame, height: HEIGHT };
    let layout = panel::axes((0.0, WIDTH), (0.0, SHOWN));
    let seen = shown.shot.iter().filter(|grain| grain.position().y < SHOWN);
    let plots = [faces(seen, unit, GAP, color)].into_iter().chain(floor(shown.outlet)).collect();
    sheet.panel(
        place,
        MARGINS,
        plots,
        layout.with_x_label("x, in diameters").with_y_label("height, in diameters"),
    );
    let when = format!("D = {} d, at {SHOT} √(d/g)", shown.outlet);
    sheet.text(MARGINS[0], HEADER + 20.0, SMALL, INK, &when);
    draw_flows(&mut sheet, Place { x: frame, width: 560.0, ..place }, flows, law);
    Ok(sheet)
}

fn draw_flows(sheet: &mut Sheet, place: Place, flows: &[Flow], law: Option<Law>) {
    let widest = flows.iter().map(|flow| flow.outlet).fold(0.0, f64::max) + 1.0;
    let fastest = 1.15 * flows.iter().map(|flow| flow.rate.mean()).fold(1.0, f64::max);
    let layout = panel::axes((0.0, widest), (0.0, fastest));
    let layout = layout.with_x_label("width D of the outlet, in diameters d");
    let layout = layout.with_y_label("flow W, in grains per √(d/g)");
    let curve = law.map(|law| {
        let at = |k: u32| law.lost + (widest - law.lost) * f64::from(k) / 200.0;
        LAW.curve((0..=200).map(at).map(|outlet| (outlet, law.rate(outlet))))
    });
    let panel = sheet.panel(place, MARGINS, curve.into_iter().collect(), layout);
    let bar = |flow: &Flow| {
        let (mean, error) = (flow.rate.mean(), flow.rate.standard_error());
        [mean - error, mean + error].map(|rate| (flow.outlet, rate))
    };
    sheet.bars(&panel, MEASURED, flows.iter().map(bar));
    sheet.marks(&panel, MEASURED, flows.iter().map(|flow| (flow.outlet, flow.rate.mean())));
    let text = law.map(|Law { prefactor, lost, scatter }| {
        format!("W = {prefactor:.2} (D − {lost:.2})¹·⁵, scatter {:.1} %", 100.0 * scatter)
    });
    let converged = flows.iter().all(|flow| flow.rate.is_converged());
    let measured =
        if converged { "measured, with standard error" } else { "measured; errors are lower bounds" };
    let names: Vec<_> = text.iter().map(|text| (LAW, text.as_str())).chain([(MEASURED, measured)]).collect();
    sheet.legend_inside(&panel, &names);
}

/// Returns the color of the layer of a grain, or the color of grains that were inserted again.
fn color(grain: &Disk) -> &'static str {
    const LAYERS: [&str; 3] = [BLUE, SKY, "#c9ced6"];
    let layer = usize::from(grain.kind().number());
    if grain.kind() == AGAIN { ORANGE } else { LAYERS[layer % LAYERS.len()] }
}

/// Draws both halves of the silo's floor.
fn floor(outlet: f64) -> impl Iterator<Item = Plot> {
    let halves = [(0.0, 0.5 * (WIDTH - outlet)), (0.5 * (WIDTH + outlet), WIDTH)];
    halves.into_iter().map(|(from, to)| {
        let line = LinePlot::new().with_data(vec![(from, FLOOR), (to, FLOOR)]);
        line.with_color(INK).with_stroke_width(2.0).into()
    })
}
