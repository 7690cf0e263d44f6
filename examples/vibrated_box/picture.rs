//! The picture: the disks with the mean flow over them, and the series beside them.

use granular_edmd::Disk;
use kuva::plot::quiver::QuiverPivot;
use kuva::prelude::{Layout, LegendPosition, LinePlot, Plot, QuiverPlot, ScatterPlot};

use crate::arguments::Arguments;
use crate::common::sheet::{self, BLUE, GREEN, INK, MARGINS, ORANGE, Place, QUIET, Sheet};
use crate::experiment::{Outcome, Sample};
use crate::report::Means;

const HEADER: f64 = 62.0;
const FOOTER: f64 = 14.0;
const HEIGHT: f64 = 700.0;
const SERIES_WIDTH: f64 = 620.0;

/// Cells that hold less than this share of what the fullest cell holds show no arrow.
const ENOUGH: f64 = 0.02;

/// The picture as a PNG file.
pub(crate) fn draw(arguments: &Arguments, outcome: &Outcome) -> Result<Vec<u8>, String> {
    let view = View::of(arguments, &outcome.disks);
    let width = view.place.width + SERIES_WIDTH;
    let mut sheet = Sheet::new(width + 10.0, HEADER + HEIGHT + FOOTER);
    write_header(&mut sheet, arguments, outcome);
    sheet.panel(view.place, disks_and_flow(&view, outcome), view.layout());
    draw_series(&mut sheet, view.place.width, arguments, outcome);
    sheet.png(2.0)
}

/// The part of the box that is shown, and how large.
struct View {
    width: f64,
    height: f64,
    /// Length of a diameter on the sheet.
    unit: f64,
    place: Place,
}

impl View {
    fn of(arguments: &Arguments, disks: &[Disk]) -> Self {
        let highest = disks.iter().map(|disk| disk.position().y + disk.radius()).fold(0.0, f64::max);
        let height = arguments.height.0.unwrap_or(f64::INFINITY).min(1.04 * highest);
        let [left, right, top, bottom] = MARGINS;
        let unit = ((HEIGHT - top - bottom) / height).min(620.0 / arguments.width);
        let size = (unit * arguments.width + left + right, unit * height + top + bottom);
        let place = Place { x: 0.0, y: HEADER + HEIGHT - size.1, width: size.0, height: size.1 };
        Self { width: arguments.width, height, unit, place }
    }

    fn layout(&self) -> Layout {
        let axes = sheet::axes((0.0, self.width), (0.0, self.height)).with_show_grid(false).with_box_axes();
        axes.with_x_label("x").with_y_label("height")
    }
}

fn disks_and_flow(view: &View, outcome: &Outcome) -> Vec<Plot> {
    let centers = || outcome.disks.iter().map(|disk| (disk.position().x, disk.position().y));
    let radius = |disk: &Disk| disk.radius() * view.unit;
    let rims = ScatterPlot::new().with_data(centers()).with_color("#8d96a0");
    let rims = rims.with_sizes(outcome.disks.iter().map(radius));
    let faces = ScatterPlot::new().with_data(centers()).with_colors(colors(&outcome.disks));
    let faces =
        faces.with_sizes(outcome.disks.iter().map(|disk| (0.86 * radius(disk)).max(radius(disk) - 0.5)));
    vec![rims.into(), faces.into(), arrows(outcome, "white", 4.2).into(), arrows(outcome, INK, 1.9).into()]
}

/// Blue for disks that rotate clockwise, red for the others; full colour at twice the root mean square.
fn colors(disks: &[Disk]) -> Vec<String> {
    let square = disks.iter().map(|disk| disk.angular_velocity().powi(2)).sum::<f64>() / disks.len() as f64;
    let full = 2.0 * square.sqrt().max(f64::MIN_POSITIVE);
    disks.iter().map(|disk| sheet::diverging(disk.angular_velocity() / full)).collect()
}

/// The mean flow; the fastest arrow is a little longer than a cell.
fn arrows(outcome: &Outcome, color: &str, thickness: f64) -> QuiverPlot {
    let arrows = outcome.flow.arrows(ENOUGH);
    let scale = 1.3 * outcome.flow.pitch() / fastest(outcome).max(f64::MIN_POSITIVE);
    let arrows = arrows.iter().map(|arrow| {
        (arrow.position.x, arrow.position.y, scale * arrow.velocity.x, scale * arrow.velocity.y)
    });
    let plot = QuiverPlot::new().with_arrows(arrows).with_scale(1.0).with_pivot(QuiverPivot::Middle);
    let head = 7.0 + thickness;
    plot.with_color(color).with_shaft_width(thickness).with_head(head, 0.45 * head).with_clip_to_plot_area()
}

fn fastest(outcome: &Outcome) -> f64 {
    outcome.flow.arrows(ENOUGH).iter().map(|arrow| arrow.velocity.length()).fold(0.0, f64::max)
}

fn write_header(sheet: &mut Sheet, arguments: &Arguments, outcome: &Outcome) {
    let Arguments { disks, width, height, gravity, inelasticity, friction, .. } = arguments;
    let verdict = Means::of(outcome).verdict(arguments.disks);
    let title = format!("{disks} disks after {} oscillations: {verdict}", arguments.oscillations);
    sheet.text(MARGINS[0], 26.0, 19, INK, &title);
    let details = format!(
        "box {width} × {height}, base {} A = {} ω = {}, g = {gravity}, q = {inelasticity}, κ = {friction}    \
         disks: spin (blue clockwise, red counterclockwise)    arrows: mean velocity, longest {:.2}",
        arguments.base,
        arguments.amplitude,
        arguments.omega,
        fastest(outcome)
    );
    sheet.text(MARGINS[0], 48.0, 12, QUIET, &details);
}

/// The three series, one above the other.
fn draw_series(sheet: &mut Sheet, left: f64, arguments: &Arguments, outcome: &Outcome) {
    let samples = &outcome.samples;
    let noise = 2.0 * Means::of(outcome).noise(arguments.disks);
    let order = vec![
        noise_band(arguments, noise),
        series(samples, BLUE, "Ψ₁ one roll", |sample| sample.order.one_roll),
        series(samples, ORANGE, "Ψ₂ two rolls", |sample| sample.order.two_rolls),
    ];
    let center = vec![series(samples, INK, "", |sample| sample.center_of_mass_height)];
    let energies = vec![
        series(samples, BLUE, "translational", |sample| sample.energies.translational),
        series(samples, GREEN, "rotational", |sample| sample.energies.rotational),
    ];
    let panels = [
        (order, "Ψ₁, Ψ₂", 0.46),
        (center, "center of mass height", 0.27),
        (energies, "energy per disk", 0.27),
    ];
    let mut top = HEADER;
    for (plots, label, share) in panels {
        let place = Place { x: left, y: top, width: SERIES_WIDTH, height: share * HEIGHT };
        let layout = series_layout(&plots, arguments, label);
        sheet.panel(place, plots, layout);
        top += share * HEIGHT;
    }
}

fn series(samples: &[Sample], color: &str, name: &str, quantity: impl Fn(&Sample) -> f64) -> Plot {
    let points = samples.iter().map(|sample| (sample.oscillation as f64, quantity(sample)));
    let line = LinePlot::new().with_data(points).with_color(color).with_stroke_width(1.6);
    if name.is_empty() { line.into() } else { line.with_legend(name).into() }
}

/// Where the order parameters of a gas without flow would be.
fn noise_band(arguments: &Arguments, noise: f64) -> Plot {
    let ends = [0.0, arguments.oscillations as f64];
    let line = LinePlot::new().with_data(ends.map(|x| (x, 0.0))).with_color("#b9c0c8").with_stroke_width(1.0);
    line.with_band([-noise, -noise], [noise, noise]).into()
}

fn series_layout(plots: &[Plot], arguments: &Arguments, label: &str) -> Layout {
    let (low, high) = range(plots);
    let axes = sheet::axes((0.0, arguments.oscillations as f64), (low, high));
    axes.with_x_label("oscillations").with_y_label(label).with_legend_position(LegendPosition::InsideTopRight)
}

/// The range of all values with a little air.
fn range(plots: &[Plot]) -> (f64, f64) {
    let ranges = plots.iter().filter_map(Plot::bounds).map(|(_, y)| y);
    let (low, high) =
        ranges.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), y| (low.min(y.0), high.max(y.1)));
    let air = 0.08 * (high - low).max(1e-9);
    (low - air, high + air)
}
