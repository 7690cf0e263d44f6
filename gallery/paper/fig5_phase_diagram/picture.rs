//! The picture: the states as marks, and over them the transitions with their errors.
//!
//! It takes plain data, so that other programs can draw their own diagrams.

use granular_edmd::ParameterError;
use granular_edmd::kinetic::{IsoLine, Maxwellian, Piece};
use granular_edmd_study::analysis::{ConvectiveRegime, TransitionLine};
use kuva::prelude::{Layout, Plot, TickFormat};

use gallery::look::{BLUE, INK, Look, Mark, PURPLE, QUIET, VERMILION};
use gallery::panel::{self, Margins, Panel, Place};
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
    (ConvectiveRegime::NoRoll, Look::marks(INK, Mark::Cross), "no roll"),
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

/// Ratio of neighboring frictions above which the line counts as having left the plane between them.
const GAP: f64 = 20.0;

/// Half the width of a mark on the way up, and of the open mark around it on the way down. With these sizes,
/// the marks of neighboring frictions from 0.05 to 0.07 do not touch.
const SIZE: f64 = 2.2;
const AROUND: f64 = 4.4;

const MARGINS: Margins = [74.0, 14.0, 10.0, 60.0];

/// Width of the whole picture and of its panel; the legend is beside it.
const WIDTH: f64 = 850.0;
const PANEL: f64 = 600.0;
const HEIGHT: f64 = 430.0;

/// Bars are pale, so that they are not taken for the lines.
const BAR: Look = Look::line("#b4b9bf", "");

/// Draws the picture.
pub(crate) fn draw(diagram: &Diagram) -> Result<Sheet, ParameterError> {
    let notes = wrapped(diagram.notes, WIDTH - MARGINS[0]);
    let top = 44.0 + 22.0 * notes.len() as f64;
    let mut sheet = Sheet::new(WIDTH, top + HEIGHT);
    sheet.header(MARGINS[0], diagram.title, &[diagram.notes]);
    write_legend(&mut sheet, top + 30.0, diagram.states.iter().any(|state| state.down));
    let place = Place { x: 0.0, y: top, width: PANEL, height: HEIGHT };
    // The panel is begun twice, so that the bars lie below the lines.
    let panel = sheet.panel(place, MARGINS, Vec::new(), layout(diagram.gravity));
    add_bars(&mut sheet, &panel, diagram.crossings);
    let mut plots = iso_lines(diagram.gravity)?;
    let islands: Vec<_> = diagram.states.iter().filter(|state| is_island(state, diagram.states)).collect();
    plots.extend(lines(diagram.crossings.iter().filter(|at| !islands.iter().any(|state| at.borders(state)))));
    sheet.panel(place, MARGINS, plots, layout(diagram.gravity));
    add_states(&mut sheet, &panel, diagram.states);
    Ok(sheet)
}

fn write_legend(sheet: &mut Sheet, top: f64, down: bool) {
    let left = PANEL + 6.0;
    let states = REGIMES.map(|(_, look, name)| (look.with_size(4.0), name));
    sheet.legend((left, top), &states);
    if down {
        let ways = [(Look::marks(INK, Mark::Disk).with_size(SIZE), "full: way up")];
        sheet.legend((left, top + 134.0), &ways);
        let ways = [(Look::marks(INK, Mark::Disk).with_size(AROUND).open(), "open: way down")];
        sheet.legend((left, top + 158.0), &ways);
    }
    let names = LINES.map(|(line, look)| (look, format!("transition {line}")));
    sheet.legend((left, top + 196.0), &names.each_ref().map(|(look, name)| (*look, name.as_str())));
    let thin = Look::line(QUIET, "").with_width(0.8);
    sheet.legend((left, top + 292.0), &[(thin, "⟨dE⟩ of Table I"), (BAR, "between neighbors")]);
}

/// Returns the largest inelasticity of the picture. At the smaller gravity, the transitions need more loss.
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

/// Draws a full mark for a state on the way up, and an open one around it for a state on the way down: both
/// where they belong.
fn add_states(sheet: &mut Sheet, panel: &Panel, states: &[State]) {
    for down in [true, false] {
        for state in states.iter().filter(|state| state.down == down) {
            let Some((_, look, _)) = REGIMES.iter().find(|(regime, ..)| *regime == state.regime) else {
                continue;
            };
            let look = if down { look.with_size(AROUND).open() } else { look.with_size(SIZE) };
            sheet.mark(panel.at((state.friction, state.inelasticity)), look);
        }
    }
}

/// Returns whether the regime of this state is above, or below, the regimes of all its nearest neighbors in
/// friction, and likewise in inelasticity. The state is drawn, but no transition line is drawn around such a
/// single run.
fn is_island(state: &State, states: &[State]) -> bool {
    let place = |state: &State| (state.friction, state.inelasticity);
    let turned = |state: &State| (state.inelasticity, state.friction);
    one_sided(state, states, place) && one_sided(state, states, turned)
}

/// Returns whether the next states on either side along the first of two coordinates have regimes that are
/// all above, or all below, this one's.
fn one_sided(state: &State, states: &[State], place: impl Fn(&State) -> (f64, f64)) -> bool {
    let (along, across) = place(state);
    let others = || states.iter().filter(|other| place(other).1 == across);
    let nearest = |sign: f64| {
        let distance = |other: &State| sign * (place(other).0 - along);
        let least = others().map(distance).filter(|way| *way > 0.0).fold(f64::INFINITY, f64::min);
        others().filter(move |other| distance(other) == least).map(|other| other.regime).collect::<Vec<_>>()
    };
    let (before, after) = (nearest(-1.0), nearest(1.0));
    let all = || before.iter().chain(&after);
    let sided = all().all(|regime| *regime > state.regime) || all().all(|regime| *regime < state.regime);
    !before.is_empty() && !after.is_empty() && sided
}

impl Crossing {
    /// Returns whether the state is one of the two between which this transition lies.
    fn borders(&self, state: &State) -> bool {
        // The neighbors were computed from their middle.
        let near = |a: f64, b: f64| (a - b).abs() <= 1e-6 * b.abs();
        self.between.iter().any(|end| near(end.0, state.friction) && near(end.1, state.inelasticity))
    }
}

/// Draws each line through its points. The branches at low and at high friction are separate if the line
/// leaves the plane between them.
fn lines<'a>(crossings: impl Iterator<Item = &'a Crossing>) -> Vec<Plot> {
    let crossings: Vec<_> = crossings.collect();
    let curves = LINES.iter().flat_map(|(line, look)| {
        let of: Vec<&Crossing> = crossings.iter().copied().filter(|at| at.line == *line).collect();
        branches(&of).into_iter().map(|branch| look.curve(branch)).collect::<Vec<_>>()
    });
    curves.collect()
}

/// Returns the points of a line by friction, in two branches if the line leaves the plane between them: it
/// meets `q = 0` on both sides of the largest loss, or has no point over more than a factor of `GAP` in
/// friction.
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

/// Draws a bar for each point of the lines, between the two neighbors on its sides.
fn add_bars(sheet: &mut Sheet, panel: &Panel, crossings: &[Crossing]) {
    sheet.bars(panel, BAR, crossings.iter().map(|at| at.between));
}
