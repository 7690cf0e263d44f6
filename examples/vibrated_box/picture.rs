//! The picture: the disks with the mean flow over them, and the series beside them.

use granular_edmd::Disk;
use kuva::plot::quiver::QuiverPivot;
use kuva::prelude::{Layout, LinePlot, Plot, QuiverPlot, ScatterPlot};

use crate::arguments::{Arguments, Base};
use crate::common::flow;
use crate::common::look::{self, INK, LOOKS, Look};
use crate::common::panel::{self, Margins, Place};
use crate::common::sheet::Sheet;
use crate::experiment::Outcome;
use crate::report::Means;

const HEADER: f64 = 108.0;
const FOOTER: f64 = 8.0;
const HEIGHT: f64 = 720.0;
const SERIES_WIDTH: f64 = 540.0;

const MARGINS: Margins = [64.0, 14.0, 30.0, 52.0];

/// Share of what the fullest cell holds, below which a cell shows no arrow.
const ENOUGH: f64 = 0.1;

/// Draws the picture.
pub(crate) fn draw(arguments: &Arguments, outcome: &Outcome, means: &Means) -> Sheet {
    let view = View::of(arguments, &outcome.disks);
    let width = view.place.width + SERIES_WIDTH;
    let mut sheet = Sheet::new(width + 10.0, HEADER + HEIGHT + FOOTER);
    write_header(&mut sheet, &view, arguments, outcome, means);
    sheet.panel(view.place, MARGINS, disks_and_flow(&view, outcome), view.layout());
    draw_series(&mut sheet, view.place.width, arguments, outcome, means);
    sheet
}

/// The part of the box that is shown, and its scale.
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
        let lid = if arguments.open { f64::INFINITY } else { arguments.height };
        let height = lid.min(1.04 * highest);
        let [left, right, top, bottom] = MARGINS;
        let unit = ((HEIGHT - top - bottom) / height).min(620.0 / arguments.width);
        let size = (unit * arguments.width + left + right, unit * height + top + bottom);
        let place = Place { x: 0.0, y: HEADER + HEIGHT - size.1, width: size.0, height: size.1 };
        Self { width: arguments.width, height, unit, place }
    }

    fn layout(&self) -> Layout {
        let axes = panel::axes((0.0, self.width), (0.0, self.height));
        axes.with_x_label("x, in diameters").with_y_label("height, in diameters")
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
    vec![rims.into(), faces.into(), arrows(outcome).into()]
}

/// Returns blue for disks that rotate clockwise and red for the others, in full color at twice the root mean
/// square.
fn colors(disks: &[Disk]) -> Vec<String> {
    let square = disks.iter().map(|disk| disk.angular_velocity().powi(2)).sum::<f64>() / disks.len() as f64;
    let full = 2.0 * square.sqrt().max(f64::MIN_POSITIVE);
    disks.iter().map(|disk| look::diverging(disk.angular_velocity() / full)).collect()
}

/// Length of the longest arrow, in cells.
const LONGEST: f64 = 1.1;

/// Returns the mean flow as arrows.
fn arrows(outcome: &Outcome) -> QuiverPlot {
    let plot = QuiverPlot::new().with_arrows(flow::arrows(&outcome.fields, ENOUGH, LONGEST));
    let plot = plot.with_scale(1.0).with_pivot(QuiverPivot::Middle);
    let plot = plot.with_color(INK).with_shaft_width(2.2).with_clip_to_plot_area();
    plot.with_head_ratio(0.36).with_head_min_px(3.0).with_head_max_px(13.0)
}

fn write_header(sheet: &mut Sheet, view: &View, arguments: &Arguments, outcome: &Outcome, means: &Means) {
    let Arguments { disks, width, gravity, inelasticity, friction, .. } = arguments;
    let verdict = means.verdict(arguments);
    let title = format!("{disks} disks after {} oscillations: {verdict}", arguments.oscillations());
    let base = match arguments.base {
        Base::Thermal => format!("thermal base T₀ = {}", arguments.temperature()),
        _ => format!("{} base A = {}, ω = {}", arguments.base_name(), arguments.amplitude(), arguments.omega),
    };
    let top = if arguments.open { "open above".to_owned() } else { format!("{} high", arguments.height) };
    let sides = if arguments.periodic { ", periodic sides" } else { "" };
    let box_and_base =
        format!("box {width} wide, {top}{sides}; {base}; g = {gravity}, q = {inelasticity}, κ = {friction}");
    let disks = "disks: blue if they spin clockwise, red if counterclockwise";
    sheet.header(MARGINS[0], &title, &[&box_and_base, disks]);
    let speed = flow::fastest(&outcome.fields, ENOUGH);
    if speed > 0.0 {
        let shown = flow::round(speed);
        let length = LONGEST * view.unit * flow::side(&outcome.fields) * shown / speed;
        sheet.arrow((MARGINS[0], 94.0), length, &format!("mean velocity {shown}, in the second half"));
    }
}

/// A panel of series: what it shows, under which names, and how high it is.
struct Panel {
    label: &'static str,
    share: f64,
    lines: Vec<Line>,
}

/// A line of a panel: its look, its name, its values.
struct Line(Look, &'static str, Vec<f64>);

fn panels(outcome: &Outcome) -> [Panel; 3] {
    let values = || outcome.series.values().iter();
    let [first, second] = [LOOKS[0], LOOKS[1]].map(|look| look.without_marks().with_width(1.6));
    let order = vec![
        Line(first, "Ψ₁, one roll", values().map(|(order, ..)| order.one_roll).collect()),
        Line(second, "Ψ₂, two rolls", values().map(|(order, ..)| order.two_rolls).collect()),
    ];
    let height = Line(
        Look::line(INK, "").with_width(1.6),
        "center of mass",
        values().map(|(_, center, _)| center.y).collect(),
    );
    let energies = vec![
        Line(first, "translation", values().map(|(.., energy)| energy.translational).collect()),
        Line(second, "rotation", values().map(|(.., energy)| energy.rotational).collect()),
    ];
    [
        Panel { label: "order parameters", share: 0.42, lines: order },
        Panel { label: "height", share: 0.27, lines: vec![height] },
        Panel { label: "energy per disk", share: 0.31, lines: energies },
    ]
}

/// Draws the series, one panel above the other.
fn draw_series(sheet: &mut Sheet, left: f64, arguments: &Arguments, outcome: &Outcome, means: &Means) {
    let noise = 2.0 * means.noise(arguments.disks);
    let mut top = HEADER;
    for (index, panel) in panels(outcome).iter().enumerate() {
        let place = Place { x: left, y: top, width: SERIES_WIDTH, height: panel.share * HEIGHT };
        let oscillations = || outcome.series.times().iter().map(|time| time / arguments.period());
        let mut plots: Vec<Plot> = panel.lines.iter().map(|line| plot(oscillations(), line)).collect();
        if index == 0 {
            plots.insert(0, noise_band(arguments, noise));
        }
        let (mut layout, mut margins) = (series_layout(&plots, arguments, panel.label), MARGINS);
        if index < 2 {
            margins[3] = 26.0;
        } else {
            layout = layout.with_x_label("oscillations");
        }
        sheet.panel(place, margins, plots, layout);
        let band = (index == 0).then_some((Look::line(BAND_FACE, "").with_width(10.0), "2 × noise"));
        let names: Vec<_> = panel.lines.iter().map(|line| (line.0, line.1)).chain(band).collect();
        sheet.legend_in_row((left + MARGINS[0], top + 22.0), &names);
        top += place.height;
    }
}

fn plot(oscillations: impl Iterator<Item = f64>, Line(look, _, values): &Line) -> Plot {
    look.curve(oscillations.zip(values.iter().copied()))
}

/// Color of the middle of the band of noise, and its paler face.
const BAND: &str = "#9aa0a6";
const BAND_FACE: &str = "#e1e3e5";

/// Returns the band in which the order parameters of a gas without flow would be.
fn noise_band(arguments: &Arguments, noise: f64) -> Plot {
    let ends = [0.0, arguments.oscillations() as f64];
    let line = LinePlot::new().with_data(ends.map(|x| (x, 0.0))).with_color(BAND).with_stroke_width(1.0);
    line.with_band([-noise, -noise], [noise, noise]).into()
}

fn series_layout(plots: &[Plot], arguments: &Arguments, label: &str) -> Layout {
    let axes = panel::axes((0.0, arguments.oscillations() as f64), range(plots));
    axes.with_y_label(label)
}

/// Returns the range of all values with a little air.
fn range(plots: &[Plot]) -> (f64, f64) {
    let ranges = plots.iter().filter_map(Plot::bounds).map(|(_, y)| y);
    let (low, high) =
        ranges.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), y| (low.min(y.0), high.max(y.1)));
    let air = 0.08 * (high - low).max(1e-9);
    (low - air, high + air)
}
