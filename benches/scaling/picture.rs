//! The picture: time per collision over the number of disks.

use kuva::prelude::{Layout, Plot};

use crate::Row;
use crate::look::Look;
use crate::panel::{self, Margins, Place};
use crate::sheet::Sheet;

const WIDTH: f64 = 620.0;
const HEIGHT: f64 = 430.0;
const HEADER: f64 = 56.0;
const MARGINS: Margins = [66.0, 16.0, 10.0, 52.0];

/// Draws the picture.
pub(crate) fn draw(subtitle: &str, rows: &[Row]) -> Sheet {
    let mut sheet = Sheet::new(WIDTH, HEADER + HEIGHT);
    sheet.header(MARGINS[0], "Time per collision of two disks", &[subtitle]);
    let lines = lines(rows);
    let looks = || lines.iter().enumerate().map(|(k, (name, points))| (Look::number(k), name, points));
    let curves: Vec<Plot> = looks().map(|(look, _, points)| look.curve(points.iter().copied())).collect();
    let place = Place { x: 0.0, y: HEADER, width: WIDTH, height: HEIGHT };
    let panel = sheet.panel(place, MARGINS, curves, layout(rows));
    looks().for_each(|(look, _, points)| sheet.marks(&panel, look, points.iter().copied()));
    let names: Vec<_> = looks().map(|(look, name, _)| (look, name.as_str())).collect();
    sheet.legend((panel.place.x + 14.0, panel.place.y + 26.0), &names);
    sheet
}

type Points = Vec<(f64, f64)>;

/// Returns a line for each scheduler and numbering, which shows the growth of its time.
fn lines(rows: &[Row]) -> Vec<(String, Points)> {
    let mut lines: Vec<(String, Points)> = Vec::new();
    for row in rows {
        let point = (row.disks as f64, row.nanoseconds().median);
        let name = format!("{}, numbered {}", row.scheduler, row.numbering.name());
        match lines.iter_mut().find(|line| line.0 == name) {
            Some(line) => line.1.push(point),
            None => lines.push((name, vec![point])),
        }
    }
    lines
}

fn layout(rows: &[Row]) -> Layout {
    let most = rows.iter().map(|row| row.nanoseconds().median).fold(0.0, f64::max);
    let few = rows.iter().map(|row| row.disks).min().unwrap_or(1) as f64;
    let many = rows.iter().map(|row| row.disks).max().unwrap_or(10) as f64;
    let layout = panel::axes((few / 1.6, 1.6 * many), (0.0, 1.1 * most)).with_log_x();
    layout.with_x_label("number of disks").with_y_label("time per collision, in ns")
}
