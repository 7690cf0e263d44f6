//! The picture: time per collision over the number of disks.

use kuva::prelude::{Layout, LinePlot, Plot, ScatterPlot};

use crate::Row;
use crate::sheet::{self, BLUE, GREEN, INK, ORANGE, Place, QUIET, Sheet};

const WIDTH: f64 = 620.0;
const HEIGHT: f64 = 420.0;
const HEADER: f64 = 52.0;
const COLORS: [&str; 6] = [BLUE, ORANGE, GREEN, "#8a4fbf", INK, "#b23a48"];

/// Draws the picture, and returns it as a PNG file.
pub(crate) fn draw(subtitle: &str, rows: &[Row]) -> Result<Vec<u8>, String> {
    let mut sheet = Sheet::new(WIDTH, HEADER + HEIGHT);
    sheet.text(58.0, 24.0, 17, INK, "Time per collision of two disks");
    sheet.text(58.0, 42.0, 12, QUIET, subtitle);
    let lines = lines(rows);
    let plots = lines.iter().zip(COLORS).flat_map(|((_, points), color)| line(points, color)).collect();
    let place = Place { x: 0.0, y: HEADER, width: WIDTH, height: HEIGHT };
    sheet.panel(place, [58.0, 16.0, 10.0, 44.0], plots, layout(rows));
    for (index, ((name, _), color)) in lines.iter().zip(COLORS).enumerate() {
        sheet.text(74.0, HEADER + 28.0 + 17.0 * index as f64, 12, color, name);
    }
    sheet.png(1.6)
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

fn line(points: &[(f64, f64)], color: &str) -> [Plot; 2] {
    let line = LinePlot::new().with_data(points.iter().copied()).with_color(color).with_stroke_width(1.8);
    let dots = ScatterPlot::new().with_data(points.iter().copied()).with_color(color).with_size(4.0);
    [line.into(), dots.into()]
}

fn layout(rows: &[Row]) -> Layout {
    let most = rows.iter().map(|row| row.nanoseconds().median).fold(0.0, f64::max);
    let few = rows.iter().map(|row| row.disks).min().unwrap_or(1) as f64;
    let many = rows.iter().map(|row| row.disks).max().unwrap_or(10) as f64;
    let layout = sheet::axes((few / 1.6, 1.6 * many), (0.0, 1.1 * most)).with_log_x();
    layout.with_x_label("disks").with_y_label("nanoseconds")
}
