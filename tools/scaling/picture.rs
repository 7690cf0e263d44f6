//! The picture: time per collision over the number of disks.

use kuva::prelude::{Layout, Plot};

use crate::table::Time;
use gallery::look::Look;
use gallery::panel::{self, COLUMN, Margins, Place};
use gallery::sheet::Sheet;

const HEIGHT: f64 = 400.0;
const HEADER: f64 = 88.0;
const MARGINS: Margins = [76.0, 20.0, 10.0, 60.0];

/// Draws the picture, with bars from the lower quartiles to the upper ones.
pub(crate) fn draw(subtitle: &str, times: &[Time]) -> Sheet {
    let mut sheet = Sheet::new(COLUMN, HEADER + HEIGHT);
    sheet.header(
        MARGINS[0],
        "Time per collision of two disks",
        &[subtitle, "bars: between the quartiles of the rounds"],
    );
    let lines = lines(times);
    let lines = || lines.iter().enumerate().map(|(k, (name, times))| (Look::number(k), name, times));
    let point = |time: &&Time| (time.disks as f64, time.nanoseconds.median);
    let curves: Vec<Plot> = lines().map(|(look, _, times)| look.curve(times.iter().map(point))).collect();
    let place = Place { x: 0.0, y: HEADER, width: COLUMN, height: HEIGHT };
    let panel = sheet.panel(place, MARGINS, curves, layout(times));
    for (look, _, times) in lines() {
        let bar =
            |time: &&Time| [time.nanoseconds.low, time.nanoseconds.high].map(|end| (time.disks as f64, end));
        sheet.bars(&panel, look, times.iter().map(bar));
        sheet.marks(&panel, look, times.iter().map(point));
    }
    let names: Vec<_> = lines().map(|(look, name, _)| (look, name.as_str())).collect();
    sheet.legend_inside(&panel, &names);
    sheet
}

/// Returns the times of each scheduler and numbering, with their name.
fn lines(times: &[Time]) -> Vec<(String, Vec<&Time>)> {
    let mut lines: Vec<(String, Vec<&Time>)> = Vec::new();
    for time in times {
        match lines.iter_mut().find(|line| line.0 == time.line()) {
            Some(line) => line.1.push(time),
            None => lines.push((time.line(), vec![time])),
        }
    }
    lines
}

fn layout(times: &[Time]) -> Layout {
    let (_, most) = panel::ends(times.iter().map(|time| time.nanoseconds.high));
    let (few, many) = panel::ends(times.iter().map(|time| time.disks as f64));
    let layout = panel::axes((few / 1.6, 1.6 * many), (0.0, 1.3 * most)).with_log_x();
    layout.with_x_label("number of disks").with_y_label("time per collision, in ns")
}
