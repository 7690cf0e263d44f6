//! The picture: the states as dots, and over them the transitions with their errors.

use granular_edmd::ParameterError;
use granular_edmd::analysis::{ConvectiveRegime, PlaneTransition, TransitionLine};
use granular_edmd::kinetic::{IsoLine, Maxwellian, Piece};
use granular_edmd::study::Leg;
use kuva::plot::scatter::MarkerShape;
use kuva::prelude::{Layout, LinePlot, Plot, ScatterPlot};
use kuva::render::layout::TickFormat;
use std::sync::Arc;

use crate::common::sheet::{self, INK, Place, QUIET, Sheet};
use crate::plan::Gravity;
use crate::states::Point;

/// Colors of the regimes, in their order from little energy loss to much.
const REGIMES: [(ConvectiveRegime, &str, &str); 5] = [
    (ConvectiveRegime::Conductive, "#9aa3ad", "0 rolls"),
    (ConvectiveRegime::OneRoll, "#2c6fbb", "1 roll"),
    (ConvectiveRegime::Coexistence, "#8e5bb5", "1 and 2 in turn"),
    (ConvectiveRegime::TwoRolls, "#d9722e", "2 rolls"),
    (ConvectiveRegime::Collapsed, "#22272e", "collapse"),
];

/// Colors of the lines, and the mean energy changes that the paper has for them at both gravities (Table I).
const LINES: [(TransitionLine, &str, [f64; 2]); 4] = [
    (TransitionLine::ZeroOne, "#3f8fd6", [-0.090, -0.047]),
    (TransitionLine::OneTwoBeginning, "#8e5bb5", [-0.351, -0.137]),
    (TransitionLine::OneTwoEnd, "#d9722e", [-0.377, -0.147]),
    (TransitionLine::TwoCollapse, "#b0202c", [-0.614, -0.290]),
];

/// Frictions at the edges of the picture.
const FRICTIONS: (f64, f64) = (0.004, 4.0);

const MARGINS: [f64; 4] = [70.0, 20.0, 12.0, 52.0];
const WIDTH: f64 = 980.0;
const HEADER: f64 = 122.0;
const HEIGHT: f64 = 600.0;

/// Draws the picture, and returns it as a PNG file.
pub(crate) fn draw(
    gravity: Gravity,
    caption: &str,
    points: &[Point],
    lines: &[PlaneTransition],
) -> Result<Vec<u8>, Box<dyn std::error::Error>> {
    let mut sheet = Sheet::new(WIDTH, HEADER + HEIGHT);
    write_header(&mut sheet, gravity, caption);
    let mut plots = iso_lines(gravity)?;
    plots.extend(dots(points));
    plots.extend(transitions(lines));
    let place = Place { x: 0.0, y: HEADER, width: WIDTH, height: HEIGHT };
    sheet.panel(place, MARGINS, plots, layout(gravity));
    Ok(sheet.png(1.6)?)
}

fn write_header(sheet: &mut Sheet, gravity: Gravity, caption: &str) {
    let title = format!("Convective states at g = {}", gravity.value());
    sheet.text(MARGINS[0], 28.0, 20, INK, &title);
    for (line, text) in caption.lines().enumerate() {
        sheet.text(MARGINS[0], 48.0 + 18.0 * line as f64, 12, QUIET, text);
    }
    let key = MARGINS[0] + 215.0;
    sheet.text(MARGINS[0], 88.0, 12, QUIET, "states (ring: coming from above)");
    sheet.key(key, 88.0, &REGIMES.map(|(_, color, name)| (color, name)));
    sheet.text(MARGINS[0], 106.0, 12, QUIET, "transitions, with error bars");
    let names = LINES.map(|(line, color, _)| (color, line.to_string()));
    sheet.key(key, 106.0, &names.each_ref().map(|(color, name)| (*color, name.as_str())));
    let note = "thin: ⟨dE⟩ constant, at the paper's value for each (Table I)";
    sheet.text(key + 290.0, 106.0, 12, QUIET, note);
}

fn layout(gravity: Gravity) -> Layout {
    let most = gravity.largest_inelasticity();
    // The axis begins a little below zero, so that the dots there are whole.
    sheet::axes(FRICTIONS, (-0.03 * most, most))
        .with_log_x()
        .with_x_tick_format(TickFormat::Custom(Arc::new(|value| value.to_string())))
        .with_y_tick_step(most / 8.0)
        .with_y_tick_format(TickFormat::Fixed(if most > 0.1 { 3 } else { 2 }))
        .with_x_label("friction κ, static = dynamic")
        .with_y_label("inelasticity q, normal = tangential")
        .with_show_grid(false)
        .with_box_axes()
}

/// Returns the lines where the paper's hypothesis and its numbers put them.
fn iso_lines(gravity: Gravity) -> Result<Vec<Plot>, ParameterError> {
    let (low, high) = FRICTIONS;
    let frictions: Vec<f64> =
        (0..=400).map(|step| low * (high / low).powf(f64::from(step) / 400.0)).collect();
    let gas = Maxwellian::new(1.0)?;
    let mut plots = Vec::new();
    for (_, color, changes) in LINES {
        let line = IsoLine::new(changes[usize::from(gravity == Gravity::Large)], &gas)?;
        let pieces = line.trace(&frictions, gravity.largest_inelasticity())?;
        plots.extend(pieces.into_iter().map(|piece| path(piece, color, 0.8)));
    }
    Ok(plots)
}

/// Draws a disk for a state on the way up, and a ring around it for a state on the way down.
fn dots(points: &[Point]) -> Vec<Plot> {
    let legs = [(Some(Leg::Down), 7.5), (Some(Leg::Up), 4.2)];
    let sets = legs.iter().flat_map(|&leg| REGIMES.map(|regime| (leg, regime)));
    sets.flat_map(|((leg, size), (regime, color, _))| {
        let chosen = points.iter().filter(|point| point.leg == leg && point.regime == regime);
        let places: Vec<(f64, f64)> = chosen.map(|point| (point.friction, point.inelasticity)).collect();
        let dots = |color: &str, size| {
            ScatterPlot::new().with_data(places.clone()).with_color(color).with_size(size)
        };
        let ring = leg == Some(Leg::Down);
        let white = ring.then(|| dots("white", 5.7).into());
        [Some(dots(color, size).into()), white].into_iter().flatten().collect::<Vec<Plot>>()
    })
    .collect()
}

/// Draws each line through its points. Low and high frictions are apart if the line leaves the plane between
/// them.
fn transitions(found: &[PlaneTransition]) -> Vec<Plot> {
    let of = |line| found.iter().filter(move |at| at.line == line).collect::<Vec<_>>();
    let mut plots = Vec::new();
    for (line, color, _) in LINES {
        // The beginning of coexistence lies under its end, where both are at the same place.
        let width = if line == TransitionLine::OneTwoBeginning { 4.4 } else { 2.0 };
        plots.extend(branches(&of(line)).into_iter().map(|branch| path(branch, color, width)));
        plots.extend(diamonds(&of(line), color, 2.4 + width));
    }
    plots
}

/// Returns the points of a line by friction, in two branches if the line meets `q = 0` on both sides of the
/// largest loss.
fn branches(of: &[&PlaneTransition]) -> Vec<Piece> {
    let on_axis = |rising| of.iter().filter(move |at| at.inelasticity == 0.0 && at.rising == rising);
    let last = on_axis(true).map(|at| at.friction).reduce(f64::max);
    let first = on_axis(false).map(|at| at.friction).reduce(f64::min);
    let cut = last.zip(first).map_or(f64::INFINITY, |(last, first)| (last * first).sqrt());
    let (low, high): (Piece, Piece) =
        of.iter().map(|at| (at.friction, at.inelasticity)).partition(|at| at.0 < cut);
    [low, high].into_iter().map(means).filter(|piece| !piece.is_empty()).collect()
}

/// Returns the points in the order of their frictions. Points of equal friction are replaced by their mean.
fn means(mut points: Piece) -> Piece {
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    // The middles of the same neighbors may differ in their last digits.
    let equal = points.chunk_by(|a, b| b.0 < a.0 * (1.0 + 1e-9));
    equal.map(|at| (at[0].0, at.iter().map(|point| point.1).sum::<f64>() / at.len() as f64)).collect()
}

fn path(points: Piece, color: &str, width: f64) -> Plot {
    LinePlot::new().with_data(points).with_color(color).with_stroke_width(width).into()
}

/// Draws the points of a line, with bars to the neighbors between which they lie.
fn diamonds(of: &[&PlaneTransition], color: &str, size: f64) -> [Plot; 2] {
    let (across, up): (Vec<_>, Vec<_>) = of.iter().partition(|at| at.between[0].1 == at.between[1].1);
    let plot = |of: &[&PlaneTransition]| {
        let plot = ScatterPlot::new().with_data(of.iter().map(|at| (at.friction, at.inelasticity)));
        plot.with_color(color).with_size(size).with_marker(MarkerShape::Diamond)
    };
    let bars = |of: &[&PlaneTransition], coordinate: fn((f64, f64)) -> f64| -> Vec<(f64, f64)> {
        let bar = |at: &&PlaneTransition| {
            let middle = coordinate((at.friction, at.inelasticity));
            let [first, second] = at.between.map(coordinate);
            (middle - first, second - middle)
        };
        of.iter().map(bar).collect()
    };
    [
        plot(&across).with_x_err_asymmetric(bars(&across, |at| at.0)).into(),
        plot(&up).with_y_err_asymmetric(bars(&up, |at| at.1)).into(),
    ]
}
