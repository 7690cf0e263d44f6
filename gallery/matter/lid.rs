//! Hard disks under a heavy lid: from a fluid to a crystal.
//!
//! The lid is a piston under its weight, so the mean pressure is the weight over the width, `P = Mg/W`. The
//! floor is thermal, at temperature 1, and the sides are periodic. The heavier the lid, the denser the disks;
//! above `P = 9.2 T/d²` they freeze, and their directions to their neighbors agree (hexatic order).
//!
//! ```text
//! cargo run --release -p gallery --bin lid
//! cargo run --release -p gallery --bin lid -- --pressures 6,9,12 --time 4000 --out lid
//! ```
//!
//! The example writes `lid.svg`, `lid.png` and `lid.csv`. Literature: D. Henderson, Mol. Phys. 30, 971
//! (1975), for the fluid; J. G. Kirkwood, J. Chem. Phys. 18, 380 (1950), for the free area in the crystal; E.
//! P. Bernard and W. Krauth, Phys. Rev. Lett. 107, 155704 (2011), for the transition.

use std::error::Error;
use std::f64::consts::PI;
use std::process::ExitCode;

use clap::Parser;
use granular_edmd::boundary::Thermal;
use granular_edmd::observable::{HexaticOrder, measured_by};
use granular_edmd::prelude::*;
use granular_edmd::wall::Piston;

use gallery::command_line::{self, Failure, positive};
use gallery::faces::{GAP, faces};
use gallery::look::{BLUE, GREEN, INK, Look, Mark, ORANGE, QUIET, SKY, VERMILION};
use gallery::panel::{self, Margins, Place, SMALL};
use gallery::progress::Progress;
use gallery::results::Results;
use gallery::sheet::Sheet;

/// Density and hexatic order of hard disks under lids of various weights.
#[derive(Parser)]
struct Arguments {
    /// Pressures of the lids, in T/d².
    #[arg(long, value_delimiter = ',', default_value = "1,2,4,6,8,9,10,12,16,20", value_parser = positive)]
    pressures: Vec<f64>,
    /// Time for which each lid is measured, after an equal time to settle, in units of d √(m/T).
    #[arg(long, default_value_t = 400.0, value_parser = positive)]
    time: f64,
    /// Measures for a time of 10 at most.
    #[arg(long)]
    quick: bool,
    #[command(flatten)]
    results: Results,
}

const DISKS: usize = 288;

/// Width of the box, and the initial height of the lid. Sixteen disks in a row fit at a distance of 1.07.
const WIDTH: f64 = 17.1;
const HEIGHT: f64 = 24.0;

/// Mass of the lid, whatever its weight.
const MASS: f64 = 50.0;

/// Distance of centers below which disks are neighbors: about the first minimum of g(r).
const RANGE: f64 = 1.5;

/// Distance from floor and lid beyond which disks count for the filling, which is the packing fraction.
const EDGE: f64 = 2.0;

/// The pressure at which fluid and hexatic phase are in balance, in T/d² (Bernard and Krauth).
const FREEZING: f64 = 9.185;

/// A lid, with means and errors for the disks under it.
struct Lid {
    pressure: f64,
    filling: Estimate,
    local: Estimate,
    global: Estimate,
    shot: Vec<Disk>,
    /// The magnitude of each disk's ψ6.
    order: Vec<f64>,
    /// The height of the lid.
    top: f64,
}

fn main() -> ExitCode {
    command_line::main(run)
}

fn run(arguments: &Arguments) -> Result<(), Failure> {
    arguments.results.make_folder()?;
    let lids = arguments.pressures.iter().map(|&pressure| pressed(arguments, pressure));
    let lids = lids.collect::<Result<Vec<_>, _>>().map_err(Failure::run)?;
    write(arguments, &lids).map_err(Failure::run)
}

/// Presses disks with a lid whose weight, divided by the width, is `pressure`.
fn pressed(arguments: &Arguments, pressure: f64) -> Result<Lid, Box<dyn Error>> {
    // A light lid rises; the stops are far away. The disks are packed while the lid is held.
    let piston = Piston::new(MASS, [-6.0 * HEIGHT, 0.9 * HEIGHT])?.with_force(pressure * WIDTH)?;
    let held = Container::closed(WIDTH, HEIGHT)?.with_periodic_sides()?;
    let disks = initial::packed_mix(&held, initial::disks_from_radii([0.5; DISKS], 1.0)?, HEIGHT, 1)?;
    let container = held.with_temperature(Wall::Floor, Thermal::new(1.0)?)?.with_piston(Wall::Lid, piston)?;
    let lid = container.index(Wall::Lid).ok_or("a lid")?;
    let disks = initial::with_maxwellian_velocities(disks, 1.0, 1)?;
    let mut run = Simulation::builder(Elastic, container).disks(disks).build()?;

    let time = if arguments.quick { arguments.time.min(10.0) } else { arguments.time };
    let mut progress = Progress::of(format!("pressure {pressure}")).until(2.0 * time);
    run.run_until(time, &mut progress)?;
    // The window has soft edges, so that the layers of a crystal at the edges do not affect the filling.
    let filling = measured_by(|snapshot: &Snapshot<'_>| {
        let size = snapshot.wall_point(lid).map_or(f64::NAN, |point| point.y) - 2.0 * EDGE;
        let phase = |disk: &Disk| PI * ((disk.position().y - EDGE) / size).clamp(0.0, 1.0);
        let inside: f64 = snapshot.disks().iter().map(|disk| 2.0 * phase(disk).sin().powi(2)).sum();
        0.25 * PI * inside / (WIDTH * size)
    });
    let mut series = Series::new((filling, HexaticOrder::new(RANGE)?), SampleTimes::every(0.5)?);
    run.run_until(2.0 * time, &mut (&mut series, &mut progress))?;
    gallery::output::warn(&run.warnings());
    let (filling, local) = (series.mean(|value| value.0)?, series.mean(|value| value.1.local)?);
    let global = series.mean(|value| value.1.global)?;
    let snapshot = run.snapshot();
    let top = snapshot.wall_point(lid).map_or(f64::NAN, |point| point.y);
    Ok(Lid { pressure, filling, local, global, order: order(&snapshot)?, top, shot: run.disks() })
}

/// Returns the magnitude of ψ6 of each disk.
fn order(snapshot: &Snapshot<'_>) -> Result<Vec<f64>, ParameterError> {
    let neighbors = snapshot.neighbors(RANGE)?;
    let of = |disk: usize| {
        let turned = |way: DVec2| DVec2::from_angle(6.0 * way.to_angle());
        let sum: DVec2 = neighbors.of(disk).map(|other| turned(other.separation)).sum();
        sum.length() / neighbors.of(disk).count().max(1) as f64
    };
    Ok((0..snapshot.len()).map(of).collect())
}

/// Returns the pressure of the fluid at a filling, by Henderson's equation.
fn fluid(filling: f64) -> f64 {
    filling / (0.25 * PI) * (1.0 + 0.125 * filling * filling) / (1.0 - filling).powi(2)
}

/// Returns the pressure of the crystal at a filling, by the free area of a disk among its neighbors.
fn crystal(filling: f64) -> f64 {
    filling / (0.25 * PI) / (1.0 - (filling / (PI / 12_f64.sqrt())).sqrt())
}

fn write(arguments: &Arguments, lids: &[Lid]) -> Result<(), Box<dyn Error>> {
    let columns = ["pressure", "filling", "filling_error", "theory", "local_order", "global_order"];
    let mut table = arguments.results.table("lid", &columns)?;
    for Lid { pressure, filling, local, global, .. } in lids {
        let theory = theory(*pressure);
        gallery::say!(
            "P = {pressure}: filling {filling}, theory {theory:.4}; order {local}, of all {global}"
        );
        let means = (filling.mean(), filling.standard_error(), theory, local.mean(), global.mean());
        table.serialize((pressure, means))?;
    }
    arguments.results.finish_table("lid", table, Some(&draw(lids)))
}

/// Returns the filling at a pressure: the fluid's below the transition, the crystal's above.
fn theory(pressure: f64) -> f64 {
    let (mut low, mut high) = (0.0, 0.9);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        let reached = if pressure < FREEZING { fluid(middle) } else { crystal(middle) };
        if reached < pressure { low = middle } else { high = middle }
    }
    low
}

const MARGINS: Margins = [62.0, 16.0, 28.0, 58.0];
const HEADER: f64 = 66.0;
const TALL: f64 = 560.0;
const COLUMN: f64 = 420.0;

/// Height of the box that is shown.
const SHOWN: f64 = 22.0;

/// Draws the disks under two lids, and the filling and the order under all lids.
fn draw(lids: &[Lid]) -> Sheet {
    let unit = (TALL - MARGINS[2] - MARGINS[3]) / SHOWN;
    let frame = WIDTH * unit + MARGINS[0] + MARGINS[1];
    let mut sheet = Sheet::new(2.0 * frame + COLUMN, HEADER + TALL);
    let about = "288 hard disks of diameter d; a thermal floor, T = 1; periodic sides; color: |ψ₆| of a disk, blue below 0.5, orange above 0.8";
    sheet.header(MARGINS[0], "Hard disks under a heavy lid", &[about]);
    let shown = [lids.iter().rfind(|lid| lid.pressure < 0.8 * FREEZING), lids.last()];
    for (number, lid) in shown.into_iter().flatten().enumerate() {
        draw_lid(
            &mut sheet,
            Place { x: number as f64 * frame, y: HEADER, width: frame, height: TALL },
            lid,
            unit,
        );
    }
    let right = Place { x: 2.0 * frame, y: HEADER, width: COLUMN, height: 0.5 * TALL };
    let heaviest = 1.05 * lids.iter().map(|lid| lid.pressure).fold(1.0, f64::max);
    let measured = Look::marks(BLUE, Mark::Disk);
    let points = |of: fn(&Lid) -> f64| lids.iter().map(move |lid| (lid.pressure, of(lid)));

    let curve = |look: Look, law: fn(f64) -> f64, [from, to]: [f64; 2]| {
        look.curve(
            (0..=100).map(|k| from + (to - from) * f64::from(k) / 100.0).map(|share| (law(share), share)),
        )
    };
    let (liquid, solid) = (Look::line(VERMILION, "8 4"), Look::line(GREEN, "2 3"));
    let freezing = || Look::line(QUIET, "1 3").with_width(1.2).curve([(FREEZING, 0.0), (FREEZING, 1.05)]);
    let curves = vec![curve(liquid, fluid, [0.0, 0.75]), curve(solid, crystal, [0.68, 0.85]), freezing()];
    let layout = panel::axes((0.0, heaviest), (0.2, 0.9)).with_y_label("filling");
    let panel = sheet.panel(right, MARGINS, curves, layout.with_x_label("pressure Mg/W, in T/d²"));
    sheet.marks(&panel, measured, points(|lid| lid.filling.mean()));
    let names = [(measured, "lid"), (liquid, "fluid (Henderson)"), (solid, "crystal (free area)")];
    sheet.legend((panel.place.x + 0.36 * panel.place.width, panel.place.y + 110.0), &names);

    let layout = panel::axes((0.0, heaviest), (0.0, 1.05)).with_x_label("pressure Mg/W, in T/d²");
    let looks = [measured, Look::marks(ORANGE, Mark::Square)];
    let place = Place { y: HEADER + 0.5 * TALL, ..right };
    let panel = sheet.panel(place, MARGINS, vec![freezing()], layout.with_y_label("hexatic order"));
    sheet.marks(&panel, looks[0], points(|lid| lid.local.mean()));
    sheet.marks(&panel, looks[1], points(|lid| lid.global.mean()));
    let names = [(looks[0], "of a disk, ⟨|ψ₆|⟩"), (looks[1], "of all, |⟨ψ₆⟩|")];
    sheet
        .legend((panel.place.x + 0.5 * panel.place.width, panel.place.y + 0.66 * panel.place.height), &names);
    sheet
}

fn draw_lid(sheet: &mut Sheet, place: Place, lid: &Lid, unit: f64) {
    let layout = panel::axes((0.0, WIDTH), (0.0, SHOWN)).with_x_label("x, in diameters");
    let color = |order: f64| {
        if order < 0.5 {
            BLUE
        } else if order < 0.8 {
            SKY
        } else {
            ORANGE
        }
    };
    let plots = lid.shot.iter().zip(&lid.order);
    let plots = plots.map(|(disk, &order)| faces(std::iter::once(disk), unit, GAP, |_| color(order)));
    let edge = Look::line(INK, "").with_width(6.0).curve([(0.0, lid.top), (WIDTH, lid.top)]);
    sheet.panel(place, MARGINS, plots.chain([edge]).collect(), layout.with_y_label("height, in diameters"));
    let words = format!("P = {} T/d²", lid.pressure);
    sheet.text(place.x + MARGINS[0], place.y + 20.0, SMALL, INK, &words);
}
