//! The picture: the states as marks, and over them the transitions with their errors.
//!
//! It takes plain data, so that other programs can draw theirs.

use granular_edmd::ParameterError;
use granular_edmd::analysis::{ConvectiveRegime, TransitionLine};
use granular_edmd::kinetic::{IsoLine, Maxwellian, Piece};
use kuva::prelude::{Layout, Plot, TickFormat};

use gallery::look::{BLUE, INK, Look, Mark, PURPLE, QUIET, VERMILION};
use gallery::panel::{self, COLUMN, Margins, Panel, Place, SMALL};
use gallery::paper::TABLE_1;
use gallery::sheet::{Sheet, wrapped};

/// A state that was seen in the plane.
pub(crate) struct State {
    pub(crate) friction: f64,
    pub(crate) inelasticity: f64,
    pub(crate) regime: ConvectiveRegime,
    /// True if friction or inelasticity went down to this point.
    pub(crate) down: bool,
}

/// A point of a transition line.
pub(crate) struct Crossing {
    pub(crate) line: TransitionLine,
    pub(crate) friction: f64,
    pub(crate) inelasticity: f64,
    /// True if the loss grows with friction at this point.
    pub(crate) rising: bool,
    /// The ends of the error, as (κ, q), which share one coordinate.
    pub(crate) between: [(f64, f64); 2],
}

/// A phase diagram.
pub(crate) struct Diagram<'a> {
    pub(crate) gravity: f64,
    pub(crate) title: &'a str,
    /// Small text below the title.
    pub(crate) notes: &'a str,
    pub(crate) states: &'a [State],
    pub(crate) crossings: &'a [Crossing],
}

/// Looks of the regimes, in their order from little energy loss to much.
const REGIMES: [(ConvectiveRegime, Look, &str); 5] = [
    (ConvectiveRegime::Conductive, Look::marks(INK, Mark::Cross), "no roll"),
    (ConvectiveRegime::OneRoll, Look::marks(BLUE, Mark::Disk), "one roll"),
    (ConvectiveRegime::Coexistence, Look::marks(PURPLE, Mark::Diamond), "one and two in turn"),
    (ConvectiveRegime::TwoRolls, Look::marks(VERMILION, Mark::Triangle), "two rolls"),
    (ConvectiveRegime::Collapsed, Look::marks("#868c93", Mark::Square), "collapse"),
];

/// Looks of the lines.
const LINES: [(TransitionLine, Look); 4] = [
    (TransitionLine::ZeroOne, Look::line(BLUE, "")),
    (TransitionLine::OneTwoBeginning, Look::line(PURPLE, "2 3")),
    (TransitionLine::OneTwoEnd, Look::line(VERMILION, "8 3")),
    (TransitionLine::TwoCollapse, Look::line(INK, "10 3 2 3")),
];

/// Frictions at the edges of the picture.
const FRICTIONS: (f64, f64) = (0.0043, 3.5);

/// Factor between neighboring frictions of a line that has left the plane between them.
const GAP: f64 = 20.0;

/// Half the width of a mark: neighbors among the frictions from 0.05 to 0.07 do not touch.
const SIZE: f64 = 2.2;

/// Distance of the marks of both ways.
const APART: f64 = 5.5;

const MARGINS: Margins = [74.0, 14.0, 10.0, 60.0];
const HEIGHT: f64 = 410.0;
const LEGEND: f64 = 166.0;

/// Draws the picture.
pub(crate) fn draw(diagram: &Diagram) -> Result<Sheet, ParameterError> {
    let notes = wrapped(diagram.notes, COLUMN - MARGINS[0]);
    let top = 34.0 + 22.0 * notes.len() as f64;
    let mut sheet = Sheet::new(COLUMN, top + LEGEND + HEIGHT);
    sheet.header(MARGINS[0], diagram.title, &[diagram.notes]);
    write_legend(&mut sheet, top + 30.0, diagram.states.iter().any(|state| state.down));
    let mut plots = iso_lines(diagram.gravity)?;
    plots.extend(lines(diagram.crossings));
    let place = Place { x: 0.0, y: top + LEGEND, width: COLUMN, height: HEIGHT };
    let panel = sheet.panel(place, MARGINS, plots, layout(diagram.gravity));
    add_bars(&mut sheet, &panel, diagram.crossings);
    add_states(&mut sheet, &panel, diagram.states);
    Ok(sheet)
}

fn write_legend(sheet: &mut Sheet, top: f64, down: bool) {
    let (left, right) = (16.0, 236.0);
    let states = REGIMES.map(|(_, look, name)| (look.with_size(4.0), name));
    sheet.legend((left, top), &states);
    let names = LINES.map(|(line, look)| (look, format!("transition {line}")));
    sheet.legend((right, top), &names.each_ref().map(|(look, name)| (*look, name.as_str())));
    let thin = Look::line(QUIET, "").with_width(0.8);
    sheet.legend((right, top + 96.0), &[(thin, "⟨dE⟩ of Table I")]);
    let ways = if down { "full: way up; open: way down; " } else { "" };
    sheet.text(left, top + 122.0, SMALL, QUIET, &format!("{ways}bars: between neighbors"));
}

/// Returns the largest inelasticity of the picture. At the smaller gravity, everything needs more loss.
const fn largest_inelasticity(gravity: f64) -> f64 {
    if gravity < 0.01 { 0.24 } else { 0.08 }
}

fn layout(gravity: f64) -> Layout {
    let most = largest_inelasticity(gravity);
    // The axis begins a little below zero, so that the marks there are whole.
    panel::axes(FRICTIONS, (-0.035 * most, most))
        .with_log_x()
        .with_y_tick_step(most / 4.0)
        .with_y_tick_format(TickFormat::Fixed(2))
        .with_x_label("friction κ, static = dynamic")
        .with_y_label("inelasticity q, normal = tangential")
}

/// Returns the lines where the paper's hypothesis and its numbers put them.
fn iso_lines(gravity: f64) -> Result<Vec<Plot>, ParameterError> {
    let (low, high) = FRICTIONS;
    let frictions: Vec<f64> =
        (0..=400).map(|step| low * (high / low).powf(f64::from(step) / 400.0)).collect();
    let gas = Maxwellian::new(1.0)?;
    let mut plots = Vec::new();
    for (line, look) in LINES {
        let Some(row) = TABLE_1.iter().find(|row| row.gravity == gravity && row.line == line) else {
            continue;
        };
        let line = IsoLine::new(row.change.0, &gas)?;
        let pieces = line.trace(&frictions, largest_inelasticity(gravity))?;
        plots.extend(pieces.into_iter().map(|piece| look.with_width(0.8).curve(piece)));
    }
    Ok(plots)
}

/// Draws a full mark for a state on the way up, and an open one below it for a state on the way down.
fn add_states(sheet: &mut Sheet, panel: &Panel, states: &[State]) {
    for (regime, look, _) in REGIMES {
        for state in states.iter().filter(|state| state.regime == regime) {
            let (x, y) = panel.at((state.friction, state.inelasticity));
            let look = look.with_size(SIZE);
            if state.down { sheet.mark((x, y + APART), look.open()) } else { sheet.mark((x, y), look) }
        }
    }
}

/// Draws each line through its points. Low and high frictions are apart if the line leaves the plane between
/// them.
fn lines(crossings: &[Crossing]) -> Vec<Plot> {
    let curves = LINES.iter().flat_map(|(line, look)| {
        let of: Vec<&Crossing> = crossings.iter().filter(|at| at.line == *line).collect();
        branches(&of).into_iter().map(|branch| look.curve(branch)).collect::<Vec<_>>()
    });
    curves.collect()
}

/// Returns the points of a line by friction, in two branches if the line leaves the plane between them: it
/// meets `q = 0` on both sides of the largest loss, or has no point over a factor of `GAP` in friction.
fn branches(of: &[&Crossing]) -> Vec<Piece> {
    let on_axis = |rising| of.iter().filter(move |at| at.inelasticity == 0.0 && at.rising == rising);
    let last = on_axis(true).map(|at| at.friction).reduce(f64::max);
    let first = on_axis(false).map(|at| at.friction).reduce(f64::min);
    let points = means(of.iter().map(|at| (at.friction, at.inelasticity)).collect());
    let gap = points.windows(2).find(|pair| pair[1].0 > GAP * pair[0].0).map(|pair| pair[1].0);
    let cut = last.zip(first).map(|(last, first)| (last * first).sqrt()).or(gap).unwrap_or(f64::INFINITY);
    let (low, high): (Piece, Piece) = points.into_iter().partition(|at| at.0 < cut);
    [low, high].into_iter().filter(|piece| !piece.is_empty()).collect()
}

/// Returns the points in the order of their frictions. Points of equal friction are replaced by their mean.
fn means(mut points: Piece) -> Piece {
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    // The middles of the same neighbors may differ in their last digits.
    let equal = points.chunk_by(|a, b| b.0 < a.0 * (1.0 + 1e-9));
    equal.map(|at| (at[0].0, at.iter().map(|point| point.1).sum::<f64>() / at.len() as f64)).collect()
}

/// Draws bars between the neighbors between which the points of the lines lie.
fn add_bars(sheet: &mut Sheet, panel: &Panel, crossings: &[Crossing]) {
    for (line, look) in LINES {
        let bars = crossings.iter().filter(|at| at.line == line).map(|at| at.between);
        sheet.bars(panel, look, bars);
    }
}
