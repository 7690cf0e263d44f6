//! The picture: the disks with the mean flow over them, and the series beside them.

use std::ops::Range;

use granular_edmd::Disk;
use kuva::prelude::Plot;

use crate::arguments::Arguments;
use crate::experiment::Outcome;
use crate::report::{QUANTITIES, Quantity};
use gallery::faces::{GAP, faces};
use gallery::flow::Arrows;
use gallery::look::{self, LOOKS, Look, NOISE};
use gallery::panel::{self, Margins, Place};
use gallery::sheet::Sheet;

const HEADER: f64 = 116.0;
const HEIGHT: f64 = 724.0;
const SERIES_WIDTH: f64 = 560.0;
const MARGINS: Margins = [72.0, 26.0, 30.0, 58.0];

/// Space that a panel saves if its time axis has no name.
const UNNAMED: f64 = 28.0;

/// The panels of series: name, height, and the quantities in it. Only the last panel has a name at its time
/// axis.
const PANELS: [(&str, f64, Range<usize>); 3] =
    [("order parameters", 300.0, 0..2), ("height", 190.0, 2..3), ("energy per disk", 234.0, 3..5)];

/// Draws the picture.
pub(crate) fn draw(arguments: &Arguments, outcome: &Outcome) -> Sheet {
    let disks = outcome.simulation.disks();
    let highest = disks.iter().map(|disk| disk.position().y + disk.radius()).fold(0.0, f64::max);
    let seen = (arguments.width, arguments.shown().min(1.04 * highest));
    let [left, right, top, bottom] = MARGINS;
    let unit = ((HEIGHT - top - bottom) / seen.1).min(620.0 / seen.0);
    let (width, height) = (unit * seen.0 + left + right, unit * seen.1 + top + bottom);

    let mut sheet = Sheet::new(width + SERIES_WIDTH, HEADER + HEIGHT);
    let title =
        format!("{} disks after {} oscillations: {}", disks.len(), arguments.oscillations(), outcome.flow);
    let colors = "disks: blue if they spin clockwise, red if counterclockwise";
    sheet.header(left, &title, &[&arguments.to_string(), colors]);
    let arrows = Arrows::of(&outcome.fields, 0.1, 1.1);
    if let Some((speed, length)) = arrows.scale() {
        let units = "units: diameter and mass of a disk, and time as in ω";
        let words = format!("mean velocity {speed}, in the second half; {units}");
        sheet.arrow((left, HEADER - 16.0), unit * length, &words);
    }
    let place = Place { x: 0.0, y: HEADER + HEIGHT - height, width, height };
    let [rims, faces] = rims_and_faces(&disks, unit, seen.1);
    let axes = panel::axes((0.0, seen.0), (0.0, seen.1)).with_x_label("x, in diameters");
    let plots = vec![rims, faces, arrows.plot(2.2)];
    sheet.panel(place, MARGINS, plots, axes.with_y_label("height, in diameters"));
    draw_series(&mut sheet, width, arguments, outcome);
    sheet
}

/// Returns the disks below this height. Their color is full at twice the root mean square of their spin.
fn rims_and_faces(disks: &[Disk], unit: f64, height: f64) -> [Plot; 2] {
    let square = disks.iter().map(|disk| disk.angular_velocity().powi(2)).sum::<f64>() / disks.len() as f64;
    let full = 2.0 * square.sqrt().max(f64::MIN_POSITIVE);
    let seen = disks.iter().filter(move |disk| disk.position().y < height);
    let color = |disk: &Disk| look::diverging(disk.angular_velocity() / full);
    [faces(seen.clone(), unit, 0.0, |_| "#8d96a0"), faces(seen, unit, GAP, color)]
}

/// Draws the series, one panel below the other.
fn draw_series(sheet: &mut Sheet, left: f64, arguments: &Arguments, outcome: &Outcome) {
    let mut top = HEADER;
    for (name, height, quantities) in PANELS {
        let (place, mut margins) = (Place { x: left, y: top, width: SERIES_WIDTH, height }, MARGINS);
        let lowest = quantities.end == QUANTITIES.len();
        let (plots, names) = lines(arguments, outcome, quantities);
        let axes = panel::axes((0.0, arguments.oscillations() as f64), range(&plots)).with_y_label(name);
        let axes = if lowest { axes.with_x_label("oscillations") } else { axes };
        margins[3] -= if lowest { 0.0 } else { UNNAMED };
        sheet.panel(place, margins, plots, axes);
        sheet.legend_in_row((left + margins[0], top + 22.0), &names);
        top += height;
    }
}

/// Returns the curves of some quantities and their names. The order parameters are drawn over their noise.
fn lines(
    arguments: &Arguments,
    outcome: &Outcome,
    of: Range<usize>,
) -> (Vec<Plot>, Vec<(Look, &'static str)>) {
    let (mut plots, mut names) = (Vec::new(), Vec::new());
    if of.start == 0 {
        let noise = [0.0, arguments.oscillations() as f64].map(|end| (end, 2.0 * outcome.noise));
        plots.push(look::noise(&noise));
        names.push((NOISE, "2 × noise"));
    }
    for (Quantity(_, name, value), look) in QUANTITIES[of].iter().zip(LOOKS) {
        let look = look.without_marks().with_width(1.6);
        let point = |(time, sample)| (time / arguments.period(), value(sample));
        plots.push(look.curve(outcome.series.iter().map(point)));
        names.push((look, *name));
    }
    (plots, names)
}

/// Returns the range of all values with a small margin.
fn range(plots: &[Plot]) -> (f64, f64) {
    let heights = plots.iter().filter_map(Plot::bounds).flat_map(|(_, (low, high))| [low, high]);
    let (low, high) = panel::ends(heights);
    let air = 0.08 * (high - low).max(1e-9);
    (low - air, high + air)
}
