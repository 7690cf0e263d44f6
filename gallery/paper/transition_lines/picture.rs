//! Pictures: the energy change at the crossings, computed in two ways, and the phase diagrams of the ramps.

use std::error::Error;

use granular_edmd::ParameterError;
use granular_edmd_study::analysis::TransitionLine;
use kuva::prelude::Plot;

use crate::numbers::{Number, average};
use crate::phase_diagram::{self, Diagram, State};
use crate::ramps::{Crossing, Ramp};
use gallery::look::{BLUE, GREEN, INK, Look, Mark, VERMILION};
use gallery::panel::{self, COLUMN, MEDIUM, Margins, Place};
use gallery::sheet::Sheet;

/// Gravities of the panels, from above, and the end of the axis of the energy loss.
const PANELS: [(f64, f64); 2] = [(0.015_625, 0.4), (0.002_025, 0.7)];

const LINES: [(TransitionLine, Look, &str); 4] = [
    (TransitionLine::ZeroOne, Look::marks(BLUE, Mark::Disk), "0–1"),
    (TransitionLine::OneTwoBeginning, Look::marks(GREEN, Mark::TriangleDown), "1–2 (a)"),
    (TransitionLine::OneTwoEnd, Look::marks(VERMILION, Mark::Triangle), "1–2 (b)"),
    (TransitionLine::TwoCollapse, Look::marks(INK, Mark::Square), "2–collapse"),
];

const FRICTIONS: (f64, f64) = (0.003, 5.0);

/// Friction of the largest loss.
const LARGEST_LOSS: f64 = 0.3;

const MARGINS: Margins = [74.0, 16.0, 34.0, 60.0];
const HEIGHT: f64 = 380.0;
const HEADER: f64 = 186.0;

/// Draws the energy loss at the crossings: open marks at equal temperatures, full ones at the ratio of
/// temperatures that the runs have, with bars over the width to which a crossing is known.
pub(crate) fn draw(crossings: &[(&Ramp, Crossing)]) -> Result<Sheet, ParameterError> {
    let mut sheet = Sheet::new(COLUMN, HEADER + HEIGHT * PANELS.len() as f64);
    sheet.header(MARGINS[0], "One number for the transitions?", &[
        "Energy loss per collision in a Maxwellian gas. Open: at equal temperatures, as in the paper. Full: at the ratio of \
         temperatures of the runs, with their means on both sides of κ = 0.3. Bars: how well a transition is known",
    ]);
    sheet.legend_in_row((MARGINS[0], HEADER - 12.0), &LINES.map(|(_, look, name)| (look, name)));
    for (number, (gravity, most)) in PANELS.into_iter().enumerate() {
        let place = Place { x: 0.0, y: HEADER + HEIGHT * number as f64, width: COLUMN, height: HEIGHT };
        let layout = panel::axes(FRICTIONS, (0.0, most))
            .with_log_x()
            .with_x_label("friction κ")
            .with_y_label("energy loss −⟨dE⟩/T");
        let panel = sheet.panel(place, MARGINS, means(gravity, crossings)?, layout);
        sheet.centered(
            (place.x + 0.5 * (COLUMN + MARGINS[0]), place.y + 22.0),
            MEDIUM,
            INK,
            &format!("g = {gravity}"),
        );
        for (line, look, _) in LINES {
            for (_, at) in crossings.iter().filter(|(ramp, at)| ramp.gravity() == gravity && at.line == line)
            {
                let loss = |number: Number, at: &Crossing| Ok((at.friction, -number.at(at)?));
                let ends = at.ends().map(|end| loss(Number::MeasuredRatio, &end));
                let [from, to]: [Result<_, ParameterError>; 2] = ends;
                sheet.bars(&panel, look, [[from?, to?]]);
                sheet.marks(&panel, look.open(), [loss(Number::EqualTemperatures, at)?]);
                sheet.marks(&panel, look, [loss(Number::MeasuredRatio, at)?]);
            }
        }
    }
    Ok(sheet)
}

/// Returns thin lines for each transition, at the means of its full marks on both sides of the largest loss.
fn means(gravity: f64, crossings: &[(&Ramp, Crossing)]) -> Result<Vec<Plot>, ParameterError> {
    let mut lines = Vec::new();
    for (line, look, _) in LINES {
        for (from, to) in [(FRICTIONS.0, LARGEST_LOSS), (LARGEST_LOSS, FRICTIONS.1)] {
            let of_side = crossings.iter().filter(|(ramp, at)| {
                ramp.gravity() == gravity && at.line == line && (from..to).contains(&at.friction)
            });
            let along = average(Number::MeasuredRatio, &of_side.collect::<Vec<_>>())?.along;
            if along.count() == 0 {
                continue;
            }
            let mean = -along.mean();
            lines.push(Look::line(look.color, "").with_width(0.8).curve([(from, mean), (to, mean)]));
        }
    }
    Ok(lines)
}

/// Draws the phase diagram of the ramps at this gravity.
pub(crate) fn draw_diagram(
    gravity: f64,
    ramps: &[Ramp],
    crossings: &[(&Ramp, Crossing)],
) -> Result<Sheet, Box<dyn Error>> {
    let ramps: Vec<&Ramp> = ramps.iter().filter(|ramp| ramp.gravity() == gravity).collect();
    let oscillations = ramps.first().map_or(0, |ramp| ramp.oscillations);
    let observed = ramps.iter().flat_map(|ramp| &ramp.observations);
    let states: Vec<State> = observed
        .map(|seen| State {
            friction: seen.friction,
            inelasticity: seen.inelasticity,
            regime: seen.regime,
            down: seen.leg == "down",
        })
        .collect();
    let crossings: Vec<phase_diagram::Crossing> = crossings
        .iter()
        .filter(|(ramp, _)| ramp.gravity() == gravity)
        .map(|(_, at)| at.in_the_plane())
        .collect();
    let walls = ramps.first().map_or("", |ramp| ramp.walls());
    let notes = format!(
        "N = 1000, box 60 × 150, base A = 0.1, ω = 10, contact duration 1e-4; {walls}; {oscillations} oscillations for each \
         point, the first half discarded; ramps in friction and in inelasticity, from below and from above"
    );
    let title = format!("Convective states at g = {gravity}");
    Ok(phase_diagram::draw(&Diagram {
        gravity,
        title: &title,
        notes: &notes,
        states: &states,
        crossings: &crossings,
    })?)
}
