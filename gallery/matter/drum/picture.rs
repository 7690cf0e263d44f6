//! The picture: the drums with their flow, the angles over time, and the flow by depth.

use std::f64::consts::TAU;

use granular_edmd::glam::DVec2;
use kuva::prelude::{LinePlot, Plot, ScatterPlot};

use crate::{Arguments, PIN, Turned};
use gallery::faces::{GAP, faces};
use gallery::flow::Arrows;
use gallery::look::{BLUE, INK, Look, QUIET};
use gallery::panel::{self, Margins, Place, SMALL};
use gallery::sheet::Sheet;

const MARGINS: Margins = [78.0, 18.0, 12.0, 60.0];
const SIDE: f64 = 268.0;
const BELOW: f64 = 330.0;

/// Grains that turn as one body with the drum.
const BODY: Look = Look::line(QUIET, "4 3").with_width(1.2);

/// Draws the drums in a row, with angles and flow below them.
pub(crate) fn draw(arguments: &Arguments, drums: &[Turned]) -> Sheet {
    let (frame, tall) = (SIDE + MARGINS[0] + MARGINS[1], SIDE + MARGINS[2] + MARGINS[3]);
    let width = frame * drums.len().max(2) as f64;
    let mut sheet = Sheet::new(width, tall + 40.0 + BELOW);
    let Arguments { pins, friction, speed, .. } = arguments;
    let grains = drums.first().map_or(0, |drum| drum.disks.len());
    let words = format!(
        "{grains} grains, {pins} pins, q = 0.1, κ = {friction}, elastic below {speed} √(gd); arrows: mean flow, dashed: mean surface"
    );
    let last = sheet.header(MARGINS[0], "A drum, half full, that turns counterclockwise", &[&words]);
    // Above a single drum, the words of the header take two lines.
    let top = last + 32.0;
    sheet.grow(top);
    let arrows = || drums.iter().map(|drum| Arrows::of(&drum.flow, 0.15, 2.0));
    let fastest = Arrows::fastest(&arrows().collect::<Vec<_>>());
    for (k, (drum, arrows)) in drums.iter().zip(arrows()).enumerate() {
        let place = Place { x: k as f64 * frame, y: top + 24.0, width: frame, height: tall };
        draw_drum(&mut sheet, place, arguments, drum, &arrows.in_scale_of(fastest));
    }
    // The scale of the arrows is the same in all drums.
    if let Some((speed, length)) = arrows().next().and_then(|arrows| arrows.in_scale_of(fastest).scale()) {
        sheet.arrow((MARGINS[0], last + 24.0), unit(arguments) * length, &format!("{speed} √(gd)"));
    }
    let place = Place { x: 0.0, y: top + tall + 40.0, width: 0.5 * width, height: BELOW };
    draw_angles(&mut sheet, place, drums);
    draw_flows(&mut sheet, Place { x: 0.5 * width, ..place }, arguments, drums);
    sheet
}

/// Returns the length of a diameter on the sheet.
fn unit(arguments: &Arguments) -> f64 {
    0.5 * SIDE / (1.02 * arguments.radius)
}

fn draw_drum(sheet: &mut Sheet, place: Place, arguments: &Arguments, drum: &Turned, arrows: &Arrows) {
    let edge = 1.02 * arguments.radius;
    let layout = panel::axes((-edge, edge), (-edge, edge))
        .with_x_label("x, in diameters")
        .with_y_label("y, in diameters");
    sheet.panel(place, MARGINS, inside(arguments, drum, unit(arguments), arrows), layout);
    let (angle, error) = (drum.angle.mean(), drum.angle.standard_error());
    let words = format!("{}: {angle:.1}° ± {error:.1}°", name(drum));
    sheet.text(place.x + MARGINS[0], place.y + 4.0, SMALL, INK, &words);
}

fn draw_angles(sheet: &mut Sheet, place: Place, drums: &[Turned]) {
    let turns = drums.iter().filter_map(|drum| drum.surfaces.last()).map(|(turns, _)| *turns);
    let layout = panel::axes((0.5, turns.fold(0.6, f64::max)), (0.0, 80.0));
    let layout = layout.with_x_label("turns").with_y_label("angle of the surface, in degrees");
    let panel = sheet.panel(place, MARGINS, angles(drums), layout);
    let names: Vec<String> = drums.iter().map(|drum| format!("Ω²R/g = {:.3}", drum.froude)).collect();
    let names = names.iter().enumerate().map(|(k, name)| (look(k), name.as_str()));
    sheet.legend_inside(&panel, &names.collect::<Vec<_>>());
}

fn draw_flows(sheet: &mut Sheet, place: Place, arguments: &Arguments, drums: &[Turned]) {
    let fastest = drums.iter().flat_map(|drum| relative(arguments, drum)).map(|(speed, _)| -speed);
    let layout = panel::axes((-1.05 * fastest.fold(1.0, f64::max), 1.2), (-1.0, 0.5));
    let layout =
        layout.with_x_label("velocity up the surface, in ΩR").with_y_label("height above the axis, in R");
    let panel = sheet.panel(place, MARGINS, flows(arguments, drums), layout);
    sheet.legend_inside(&panel, &[(BODY, "turning as a body")]);
}

/// Returns the look of the curves of a drum.
const fn look(k: usize) -> Look {
    Look::number(k).without_marks().with_width(1.6)
}

fn name(drum: &Turned) -> String {
    format!("Ω = {} √(g/d)", drum.rate)
}

/// Returns rim, pins, grains, mean flow and mean surface.
fn inside(arguments: &Arguments, drum: &Turned, unit: f64, arrows: &Arrows) -> Vec<Plot> {
    let radius = arguments.radius;
    let rim = (0..=180).map(|k| radius * DVec2::from_angle(TAU * f64::from(k) / 180.0)).map(|p| (p.x, p.y));
    let rim = LinePlot::new().with_data(rim.collect::<Vec<_>>()).with_color(INK).with_stroke_width(1.4);
    let grains = faces(drum.disks.iter(), unit, GAP, |_| "#d8c39a");
    let (angle, end) = (drum.angle.mean().to_radians(), 0.9 * radius);
    let middle =
        drum.surfaces.iter().map(|(_, surface)| surface.middle).sum::<f64>() / drum.surfaces.len() as f64;
    let ends = [-end, end].map(|along| (along * angle.cos(), middle + along * angle.sin()));
    let line = LinePlot::new().with_data(ends.to_vec()).with_color(BLUE).with_stroke_width(2.2).with_dashed();
    let pins = (0..arguments.pins).map(|k| TAU * f64::from(k) / f64::from(arguments.pins));
    let pins =
        pins.map(|angle| (radius - PIN) * DVec2::from_angle(angle + TAU * drum.turns)).map(|p| (p.x, p.y));
    let pins = ScatterPlot::new().with_data(pins).with_color(INK).with_size(2.5);
    vec![rim.into(), grains, pins.into(), arrows.plot(1.3), line.into()]
}

fn angles(drums: &[Turned]) -> Vec<Plot> {
    let points = |drum: &Turned| {
        drum.surfaces.iter().map(|(turns, surface)| (*turns, surface.angle.to_degrees())).collect()
    };
    drums.iter().map(points).enumerate().map(|(k, points): (_, Vec<_>)| look(k).curve(points)).collect()
}

/// Returns velocities and heights, in units of the drum.
fn relative(arguments: &Arguments, drum: &Turned) -> Vec<(f64, f64)> {
    let radius = arguments.radius;
    let profile = drum.depths.profile().into_iter();
    profile.map(|(height, speed)| (speed / (drum.rate * radius), height / radius)).collect()
}

fn flows(arguments: &Arguments, drums: &[Turned]) -> Vec<Plot> {
    let curve = |(k, drum): (usize, &Turned)| look(k).curve(relative(arguments, drum));
    drums.iter().enumerate().map(curve).chain([BODY.curve([(1.0, -1.0), (-0.5, 0.5)])]).collect()
}
