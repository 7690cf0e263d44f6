//! The paper's Fig. 1: lines of equal mean energy loss per collision in the plane of friction and
//! inelasticity.
//!
//! The example writes `fig1_energy_loss.svg` and `.png` (both panels), `fig1_energy_loss.csv` (the lines) and
//! `fig1_largest_loss.csv` (the friction of the largest loss for each inelasticity). It also compares the
//! closed form with Monte Carlo averages at a few points.
//!
//! ```text
//! cargo run --release -p gallery --bin fig1_energy_loss -- --out out
//! ```

use std::error::Error;
use std::process::ExitCode;

use clap::Parser;
use granular_edmd::ParameterError;
use granular_edmd::collision::Frictional;
use granular_edmd::kinetic::{
    IsoLine, Maxwellian, MonteCarlo, Piece, friction_of_largest_loss, mean_energy_change,
};
use kuva::prelude::{Layout, TickFormat};

use gallery::command_line::{self, positive};
use gallery::look::{BLUE, INK, Look, SKY, VERMILION};
use gallery::panel::{self, COLUMN, Margins, Place, SMALL};
use gallery::results::Results;
use gallery::sheet::Sheet;

/// Lines of equal mean energy loss per collision (paper, Fig. 1).
#[derive(Parser)]
struct Arguments {
    /// Rotational temperature in units of the translational one; the paper has 1.
    #[arg(long, default_value_t = 1.0, value_parser = positive)]
    rotational_temperature: f64,
    /// Seed of the Monte Carlo comparison.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Uses fewer collisions for the Monte Carlo comparison.
    #[arg(long)]
    quick: bool,
    #[command(flatten)]
    results: Results,
}

/// A part of the plane, and the levels that are drawn in it.
struct Panel {
    name: &'static str,
    logarithmic: bool,
    frictions: Vec<f64>,
    largest_inelasticity: f64,
    levels: Vec<f64>,
}

impl Panel {
    fn whole() -> Self {
        Self {
            name: "whole",
            logarithmic: false,
            frictions: (0..=500).map(|step| f64::from(step) / 500.0).collect(),
            largest_inelasticity: 0.2,
            levels: (1..=10).map(|step| -f64::from(step) / 10.0).collect(),
        }
    }

    fn detail() -> Self {
        Self {
            name: "detail",
            logarithmic: true,
            frictions: (-300..=100).map(|step| 10f64.powf(f64::from(step) / 100.0)).collect(),
            largest_inelasticity: 0.05,
            levels: [0.02]
                .into_iter()
                .chain((1..=10).map(|step| f64::from(step) / 20.0))
                .map(|loss| -loss)
                .collect(),
        }
    }

    fn trace(&self, gas: &Maxwellian) -> Result<Vec<(f64, Vec<Piece>)>, ParameterError> {
        let trace = |level| IsoLine::new(level, gas)?.trace(&self.frictions, self.largest_inelasticity);
        self.levels.iter().map(|&level| Ok((level, trace(level)?))).collect()
    }

    fn layout(&self) -> Layout {
        let frictions = if self.logarithmic { (1e-3, 10.0) } else { (0.0, 1.0) };
        let layout = panel::axes(frictions, (0.0, self.largest_inelasticity))
            .with_x_label("friction κ, static = dynamic")
            .with_y_label("inelasticity q, normal = tangential")
            .with_y_tick_step(self.largest_inelasticity / 5.0)
            .with_y_tick_format(TickFormat::Fixed(2));
        if self.logarithmic { layout.with_log_x() } else { layout.with_x_tick_step(0.2) }
    }

    /// Returns the position of a point in the panel, from 0 to 1 in both directions.
    fn fraction(&self, (friction, inelasticity): (f64, f64)) -> (f64, f64) {
        let across = if self.logarithmic { (friction.log10() + 3.0) / 4.0 } else { friction };
        (across, inelasticity / self.largest_inelasticity)
    }

    /// Returns the point of a line that carries its label. Neighboring lines have their labels at different
    /// heights.
    fn label_place(&self, index: usize, piece: &Piece) -> (f64, f64) {
        let lowest = piece.iter().map(|&point| self.fraction(point).1).fold(1.0, f64::min);
        let height = (0.25 + 0.11 * (index % 5) as f64).max(lowest + 0.15);
        let distance = |&point: &(f64, f64)| {
            let (across, up) = self.fraction(point);
            let edge = (0.07 - across).max(across - 0.92).max(0.03 - up).max(up - 0.97).max(0.0);
            let wanted = if self.logarithmic { up - height } else { across - 0.7 };
            wanted.abs() + 100.0 * edge
        };
        let nearest = piece.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
        let short = !self.logarithmic && piece.iter().all(|&(friction, _)| friction < 0.7);
        let middle = piece[piece.len() / 2];
        if short { middle } else { nearest.copied().unwrap_or(middle) }
    }

    /// Returns points of the curve on which friction loses most.
    fn maxima(&self, gas: &Maxwellian) -> Result<Piece, ParameterError> {
        let inelasticity = |step: i32| self.largest_inelasticity * f64::from(step) / 100.0;
        let maxima: Result<Vec<_>, _> = (0..=100)
            .map(inelasticity)
            .map(|q| {
                Ok(friction_of_largest_loss(&Frictional::from_inelasticity(q, q, 0.0)?, gas)
                    .map(|friction| (friction, q)))
            })
            .collect();
        Ok(maxima?.into_iter().flatten().collect())
    }
}

fn main() -> ExitCode {
    command_line::main(run)
}

fn run(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    arguments.results.make_folder()?;
    let gas = Maxwellian::new(1.0)?.with_rotational_temperature(arguments.rotational_temperature)?;
    gallery::say!(
        "Maxwellian gas, T = 1, T_rot = {}; q = q_n = q_t, kappa = kappa_s = kappa_d",
        gas.rotational_temperature()
    );
    let collisions = if arguments.quick { 1 << 14 } else { 1 << 20 };
    compare(&gas, &MonteCarlo::new(arguments.seed).with_samples(collisions))?;
    let panels = [Panel::whole(), Panel::detail()];
    let picture = arguments.results.path("fig1_energy_loss");
    draw(&panels, &gas)?.write(&picture)?;
    gallery::say!("wrote {0}.svg and {0}.png", picture.display());
    tabulate(&panels, &gas, &arguments.results)
}

/// Compares closed form and Monte Carlo at the largest loss of a few inelasticities.
fn compare(gas: &Maxwellian, monte_carlo: &MonteCarlo) -> Result<(), ParameterError> {
    gallery::say!(
        "largest loss:   q   kappa     <dE>      Monte Carlo (standard error of independent samples)"
    );
    for q in [0.0, 0.025, 0.05, 0.1, 0.2] {
        let Some(friction) = friction_of_largest_loss(&Frictional::from_inelasticity(q, q, 0.0)?, gas) else {
            continue;
        };
        let rule = Frictional::from_inelasticity(q, q, friction)?;
        let estimate = monte_carlo.mean_energy_change(&rule, gas);
        let exact = mean_energy_change(&rule, gas);
        gallery::say!(
            "            {q:5.3}  {friction:.4}  {exact:.6}  {:.6} ({:.6})",
            estimate.mean(),
            estimate.standard_error()
        );
    }
    Ok(())
}

fn tabulate(panels: &[Panel], gas: &Maxwellian, results: &Results) -> Result<(), Box<dyn Error>> {
    let names = ["fig1_energy_loss", "fig1_largest_loss"];
    let columns = ["panel", "mean_energy_change", "piece", "friction", "inelasticity"];
    let mut lines = results.table(names[0], &columns)?;
    let mut maxima = results.table(names[1], &["panel", "friction", "inelasticity"])?;
    for panel in panels {
        for (level, pieces) in panel.trace(gas)? {
            for (index, piece) in pieces.iter().enumerate() {
                for point in piece {
                    lines.serialize((panel.name, level, index, point.0, point.1))?;
                }
            }
        }
        panel.maxima(gas)?.iter().try_for_each(|point| maxima.serialize((panel.name, point.0, point.1)))?;
    }
    lines.flush()?;
    maxima.flush()?;
    let tables = names.map(|name| (name, results.path(name).with_extension("csv")));
    for (_, path) in &tables {
        gallery::say!("wrote {}", path.display());
    }
    results.write_tables_as_json(&tables)
}

const MARGINS: Margins = [72.0, 20.0, 10.0, 60.0];
const HEIGHT: f64 = 380.0;
const HEADER: f64 = 94.0;

/// The curve of the largest loss.
const LARGEST: Look = Look::line(INK, "8 4").with_width(1.6);

/// Draws both panels, one above the other.
fn draw(panels: &[Panel], gas: &Maxwellian) -> Result<Sheet, ParameterError> {
    let mut sheet = Sheet::new(COLUMN, HEADER + HEIGHT * panels.len() as f64);
    let temperature = gas.rotational_temperature();
    let note = format!("Maxwellian gas, rotational temperature {temperature} T");
    sheet.header(MARGINS[0], "Mean energy change per collision, ⟨dE⟩/T", &[&note]);
    sheet.legend((MARGINS[0], HEADER - 12.0), &[(LARGEST, "largest loss at each q; numbers: ⟨dE⟩/T")]);
    for (number, panel) in panels.iter().enumerate() {
        let place = Place { x: 0.0, y: HEADER + HEIGHT * number as f64, width: COLUMN, height: HEIGHT };
        draw_panel(&mut sheet, place, panel, gas)?;
    }
    Ok(sheet)
}

fn draw_panel(
    sheet: &mut Sheet,
    place: Place,
    panel: &Panel,
    gas: &Maxwellian,
) -> Result<(), ParameterError> {
    let (mut plots, mut labels) = (Vec::new(), Vec::new());
    for (index, (level, pieces)) in panel.trace(gas)?.into_iter().enumerate() {
        let look = look(level);
        for piece in pieces.iter().filter(|piece| piece.len() > 1) {
            let place = panel.label_place(index, piece);
            // A short piece in a corner has no room for a label.
            if panel.fraction(place).0 > 0.06 {
                labels.push((place, format!("{level}").replace('-', "−")));
            }
            plots.push(look.curve(piece.iter().copied()));
        }
    }
    plots.push(LARGEST.curve(panel.maxima(gas)?));
    let drawn = sheet.panel(place, MARGINS, plots, panel.layout());
    for (point, text) in labels {
        let (x, y) = drawn.at(point);
        sheet.on_white((x, y + 5.0), SMALL, &text);
    }
    Ok(())
}

/// Returns the look of a line: in one of three colors, by its loss. The labels show the numbers.
fn look(level: f64) -> Look {
    let color = match -level {
        ..0.25 => SKY,
        ..0.55 => BLUE,
        _ => VERMILION,
    };
    Look::line(color, "").with_width(1.6)
}
