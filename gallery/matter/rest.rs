//! Matter at rest: a column of 50 grains falls into a heap on a rough floor, under each remedy.
//!
//! Without a remedy the run stalls, and says so. With one, the example measures what it costs and what it
//! does to the heap: events per grain and time, the height of the heap, the heat that it keeps, and how far
//! its grains creep. Diameter, mass and gravity are 1; `q = 0.1`, `κ = 0.5`.
//!
//! ```text
//! cargo run --release -p gallery --bin rest
//! cargo run --release -p gallery --bin rest -- --flat --end 1000 --out heaps
//! ```
//!
//! The example writes `rest.svg`, `rest.png` and `rest.csv`. `docs/rest.md` explains the remedies.

use std::error::Error;
use std::process::ExitCode;
use std::time::Instant;

use clap::Parser;
use granular_edmd::boundary::{Container, WallError};
use granular_edmd::collision::TangentialResponse::{Reversing, Unchanged};
use granular_edmd::collision::{ElasticBelow, SpeedDependent};
use granular_edmd::prelude::*;
use granular_edmd::simulation::{BoxedRule, Counters, RunEnd, RunError};
use kuva::prelude::Layout;

use gallery::command_line::{self, Failure, positive};
use gallery::faces::{GAP, faces};
use gallery::look::{INK, Look, Mark, QUIET, SKY};
use gallery::panel::{self, Margins, Place, SMALL};
use gallery::progress::Progress;
use gallery::results::Results;
use gallery::sheet::Sheet;

/// Grains that come to rest, under each remedy: events, height, heat and creep.
#[derive(Parser)]
struct Arguments {
    /// End of each run, in units of √(d/g), the time in which a grain falls half a diameter.
    #[arg(long, default_value_t = 200.0, value_parser = positive)]
    end: f64,
    /// Largest number of collisions of a run, in millions; unlike a time limit, it ends the run at the same
    /// event on any machine.
    #[arg(long, default_value_t = 6.0, value_parser = positive)]
    collisions: f64,
    /// Uses a flat floor, with no grains glued to it.
    #[arg(long)]
    flat: bool,
    /// Runs to time 40 at most, for a million collisions at most.
    #[arg(long)]
    quick: bool,
    #[command(flatten)]
    results: Results,
}

const GRAINS: usize = 50;

/// Durations and speeds of the remedies.
const PARAMETERS: [f64; 5] = [0.02, 0.05, 0.1, 0.2, 0.4];

/// Width of the floor, and of the column at first.
const WIDTH: f64 = 24.0;
const COLUMN: f64 = 6.6;

/// Share of a run after which the heap is measured.
const SETTLED: f64 = 0.2;

fn main() -> ExitCode {
    command_line::main(run)
}

fn run(arguments: &Arguments) -> Result<(), Failure> {
    arguments.results.make_folder()?;
    gallery::say!(
        "| remedy | parameter | time | events per grain and time | height | heat | creep | ended by |"
    );
    gallery::say!("|---|---|---|---|---|---|---|---|");
    let mut heaps = Vec::new();
    for remedy in remedies().map_err(Failure::run)? {
        let heap = settled(arguments, remedy).map_err(Failure::run)?;
        gallery::say!("{heap}");
        heaps.push(heap);
    }
    write(arguments, &heaps).map_err(Failure::run)
}

/// A remedy with its parameter.
struct Remedy {
    name: &'static str,
    parameter: f64,
    rule: BoxedRule,
}

fn remedies() -> Result<Vec<Remedy>, ParameterError> {
    let constant = Frictional::from_inelasticity(0.1, 0.1, 0.5)?;
    let bizon =
        SpeedDependent::from_restitution(0.8, 1.0)?.with_friction(Friction::from_inelasticity(0.1, 0.5)?);
    let mut remedies = vec![
        Remedy { name: "none", parameter: 0.0, rule: Box::new(constant) },
        Remedy { name: "SpeedDependent", parameter: 1.0, rule: Box::new(bizon) },
    ];
    for parameter in PARAMETERS {
        let lasting = ContactDuration::new(constant, parameter)?;
        let below = ElasticBelow::new(constant, parameter)?;
        let rules: [(&'static str, BoxedRule); 6] = [
            ("ContactDuration", Box::new(lasting)),
            ("ContactDuration, unchanged", Box::new(lasting.with_tangential_response(Unchanged))),
            ("ElasticBelow", Box::new(below)),
            ("ElasticBelow, reversing", Box::new(below.with_tangential_response(Reversing))),
            ("ElasticBelow, unchanged", Box::new(below.with_tangential_response(Unchanged))),
            ("LeastRebound", Box::new(LeastRebound::new(constant, parameter)?)),
        ];
        remedies.extend(rules.map(|(name, rule)| Remedy { name, parameter, rule }));
    }
    remedies.sort_by_key(|remedy| FAMILIES.iter().position(|name| *name == remedy.name));
    Ok(remedies)
}

impl Heap {
    fn is_cut(&self) -> bool {
        self.ended == "Collisions"
    }
}

/// The grains under a remedy, and what it costs.
struct Heap {
    name: &'static str,
    parameter: f64,
    ended: String,
    /// Time at which the run ended, and the wall-clock time that it took, in seconds.
    time: f64,
    seconds: f64,
    /// Events per grain and time, over the time in which the heap is measured, or over all of a run that
    /// does not get there.
    events: f64,
    /// Height of the highest grain's top.
    height: f64,
    /// Mean kinetic energy of a grain's motion, over the time in which the heap is measured; `None` for a run
    /// that ended before.
    heat: Option<f64>,
    /// Mean distance that a grain creeps, per unit of time, over the same time.
    creep: f64,
    disks: Vec<Disk>,
    glued: Vec<Disk>,
}

fn settled(arguments: &Arguments, remedy: Remedy) -> Result<Heap, Box<dyn Error>> {
    let quick = |value: f64, most: f64| if arguments.quick { value.min(most) } else { value };
    let end = quick(arguments.end, 40.0);
    let most = (1e6 * quick(arguments.collisions, 1.0)) as u64;
    let mut simulation =
        Simulation::builder(remedy.rule, floor(arguments.flat)?).disks(column()?).gravity(1.0).build()?;
    let started = Instant::now();
    let limits = |end: f64, done: u64| Limits::until(end).with_most_collisions(most.saturating_sub(done));
    let mut progress = Progress::of(format!("{} {}", remedy.name, remedy.parameter)).until(end);
    let mut ended = simulation.run(&limits(SETTLED * end, 0), &mut progress);
    let (mut before, mut since, start) = (*simulation.counters(), simulation.time(), simulation.disks());
    let (mut heat, mut samples) = (0.0, 0.0);
    if matches!(ended, Ok(RunEnd::Time)) {
        let mut watch = on_sample(SampleTimes::every(0.01 * end)?, |snapshot: &Snapshot<'_>| {
            heat += snapshot.disks().iter().map(Disk::translational_energy).sum::<f64>() / GRAINS as f64;
            samples += 1.0;
        });
        let done = before.disk_collisions + before.wall_collisions;
        ended = simulation.run(&limits(end, done), &mut (&mut watch, &mut progress));
    } else {
        (before, since) = (Counters::default(), 0.0);
    }
    let (time, disks) = (simulation.time(), simulation.disks());
    let events = simulation.counters().since(&before).events() as f64;
    let way = start.iter().zip(&disks).map(|(from, to)| from.position().distance(to.position()));
    Ok(Heap {
        name: remedy.name,
        parameter: remedy.parameter,
        ended: ended.map_or_else(|error| reason(&error), |end| format!("{end:?}")),
        time,
        seconds: started.elapsed().as_secs_f64(),
        events: events / (GRAINS as f64 * (time - since)),
        height: disks.iter().map(|disk| disk.position().y + disk.radius()).fold(0.0, f64::max),
        heat: (samples > 0.0).then(|| heat / samples),
        creep: way.sum::<f64>() / (GRAINS as f64 * (time - since)),
        disks,
        glued: glued(arguments.flat)?,
    })
}

fn reason(error: &RunError) -> String {
    if matches!(error, RunError::Stalled { .. }) { "Stalled".into() } else { error.to_string() }
}

/// Distance of the grains that are glued to the floor.
const GLUED: f64 = 1.2;

/// Returns the floor, flat or with a row of grains glued to it.
fn floor(flat: bool) -> Result<Container, WallError> {
    Container::open(WIDTH)?.with_pegs(glued(flat)?)
}

fn glued(flat: bool) -> Result<Vec<Disk>, ParameterError> {
    let count = if flat { 0 } else { (WIDTH / GLUED) as usize };
    let grain = |k| Disk::new(DVec2::new((k as f64 + 0.5) * GLUED, 0.5), 0.5);
    (0..count).map(grain).collect()
}

/// Returns a column of grains above the middle of the floor.
fn column() -> Result<Vec<Disk>, Box<dyn Error>> {
    let shift = DVec2::new(0.5 * (WIDTH - COLUMN), 1.0);
    let narrow = initial::lattice(&Container::open(COLUMN)?, GRAINS, 0.5)?;
    let moved = narrow.into_iter().map(|disk| disk.with_position(disk.position() + shift));
    Ok(initial::with_maxwellian_velocities(moved.collect::<Result<Vec<_>, _>>()?, 0.05, 1)?)
}

impl std::fmt::Display for Heap {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { name, parameter, ended, time, seconds, events, height, heat, creep, .. } = self;
        let heat = heat.map_or("–".to_owned(), |heat| format!("{heat:.1e}"));
        write!(
            formatter,
            "| {name} | {parameter} | {time:.1} | {events:.0} | {height:.2} | {heat} | {creep:.1e} | {ended}, \
             {seconds:.1} s |"
        )
    }
}

fn write(arguments: &Arguments, heaps: &[Heap]) -> Result<(), Box<dyn Error>> {
    let columns = ["remedy", "parameter", "time", "seconds", "events", "height", "heat", "creep", "ended"];
    let mut table = arguments.results.table("rest", &columns)?;
    for Heap { name, parameter, time, seconds, events, height, heat, creep, ended, .. } in heaps {
        table.serialize((name, parameter, time, seconds, events, height, heat, creep, ended))?;
    }
    let heap = |heap: &Heap| {
        let Heap { name, parameter, time, seconds, events, height, heat, creep, ended, .. } = heap;
        serde_json::json!({
            "remedy": name, "parameter": parameter, "time": time, "seconds": seconds, "ended": ended,
            "events_per_grain_and_time": events, "height": height, "heat": heat, "creep": creep,
        })
    };
    let numbers = heaps.iter().map(heap).collect();
    arguments.results.finish("rest", table, &draw(heaps), &numbers)
}

const MARGINS: Margins = [84.0, 18.0, 34.0, 60.0];
const HEADER: f64 = 64.0;
const UNIT: f64 = 17.0;

/// Height of the part of the heaps that is shown.
const SHOWN: f64 = 8.0;

/// The remedies whose heaps are drawn.
const DRAWN: [(&str, f64); 4] =
    [("ContactDuration", 0.1), ("ElasticBelow", 0.1), ("LeastRebound", 0.1), ("LeastRebound", 0.4)];

/// The remedies whose numbers are drawn over their parameters.
const FAMILIES: [&str; 4] = ["ContactDuration", "ElasticBelow", "ElasticBelow, reversing", "LeastRebound"];

/// Draws some heaps, and cost and heat over the parameters of the remedies.
fn draw(heaps: &[Heap]) -> Sheet {
    let frame = [WIDTH * UNIT + MARGINS[0] + MARGINS[1], SHOWN * UNIT + MARGINS[2] + MARGINS[3]];
    let mut sheet = Sheet::new(2.0 * frame[0], HEADER + 2.0 * frame[1] + 350.0);
    let flat = heaps.iter().all(|heap| heap.glued.is_empty());
    let floor = if flat { "a flat floor" } else { "a floor with grains glued to it" };
    let about = format!("a column fell onto {floor}; g = 1, q = 0.1, κ = 0.5");
    sheet.header(MARGINS[0], "Fifty grains that came to rest", &[&about]);
    let drawn = heaps.iter().filter(|heap| DRAWN.contains(&(heap.name, heap.parameter)));
    for (k, heap) in drawn.enumerate() {
        let (x, y) = ((k % 2) as f64 * frame[0], HEADER + (k / 2) as f64 * frame[1]);
        let layout = panel::axes((0.0, WIDTH), (0.0, SHOWN)).with_y_tick_step(2.0);
        let layout = layout.with_x_label("x, in diameters").with_y_label("height, in diameters");
        let place = Place { x, y, width: frame[0], height: frame[1] };
        let plots = vec![
            faces(heap.glued.iter(), UNIT, GAP, |_| QUIET),
            faces(heap.disks.iter(), UNIT, GAP, |_| SKY),
        ];
        sheet.panel(place, MARGINS, plots, layout);
        let title = format!("{} {}, at time {:.0}", in_words(heap.name), heap.parameter, heap.time);
        sheet.text(x + MARGINS[0], y + 26.0, SMALL, INK, &title);
    }
    let below = HEADER + 2.0 * frame[1];
    let panels: [(&str, Quantity); 2] = [
        ("events per grain and √(d/g)", |heap| heap.events),
        ("heat per grain, in mgd", |heap| heap.heat.unwrap_or(f64::NAN)),
    ];
    for (k, (label, value)) in panels.into_iter().enumerate() {
        let place = Place { x: k as f64 * frame[0], y: below + 20.0, width: frame[0], height: 330.0 };
        let layout = panel::axes((1e-2, 1.0), range(heaps, value)).with_log_scale();
        let layout = layout.with_x_label("duration in √(d/g), or speed in √(gd)").with_y_label(label);
        draw_curves(&mut sheet, place, layout, heaps, value);
    }
    let names = FAMILIES.into_iter().enumerate().map(|(k, name)| (Look::number(k), in_words(name)));
    let cut = heaps.iter().any(Heap::is_cut).then_some((CUT, "ended before its time"));
    sheet.legend_in_row((MARGINS[0], below + 28.0), &names.chain(cut).collect::<Vec<_>>());
    sheet
}

/// Returns the name of a remedy in the words of the field.
fn in_words(name: &str) -> &str {
    match name {
        "ContactDuration" => "contact duration",
        "ElasticBelow" => "elastic below a speed",
        "ElasticBelow, reversing" => "the same, slip reversed",
        "LeastRebound" => "least rebound speed",
        other => other,
    }
}

/// The look of a run that ended at its limit.
const CUT: Look = Look::marks(INK, Mark::Disk).open();

/// A number of a heap.
type Quantity = fn(&Heap) -> f64;

/// Returns the decades that hold all values.
fn range(heaps: &[Heap], value: Quantity) -> (f64, f64) {
    let values = || heaps.iter().map(value).filter(|value| *value > 0.0 && value.is_finite());
    let (low, high) = (values().fold(f64::INFINITY, f64::min), values().fold(0.0, f64::max));
    (10f64.powf(low.log10().floor()), 10f64.powf(high.log10().ceil()))
}

fn draw_curves(sheet: &mut Sheet, place: Place, layout: Layout, heaps: &[Heap], value: Quantity) {
    let points = |heaps: &mut dyn Iterator<Item = &Heap>| -> Vec<(f64, f64)> {
        heaps.map(|heap| (heap.parameter, value(heap))).filter(|(_, value)| *value > 0.0).collect()
    };
    let of = |name: &'static str| points(&mut heaps.iter().filter(|heap| heap.name == name));
    let families = || FAMILIES.into_iter().enumerate().map(|(k, name)| (Look::number(k), of(name)));
    let curves = families().map(|(look, points)| look.curve(points)).collect();
    let panel = sheet.panel(place, MARGINS, curves, layout);
    families().for_each(|(look, points)| sheet.marks(&panel, look, points));
    let drawn = heaps.iter().filter(|heap| FAMILIES.contains(&heap.name));
    sheet.marks(&panel, CUT, points(&mut drawn.filter(|heap| heap.is_cut())));
}
