//! The picture: a sequence of frames of the glass, above the number of grains over time.

use granular_edmd::prelude::*;

use crate::{Arguments, Frame, Glass, Way, grains};
use gallery::look::{INK, LOOKS, Look};
use gallery::panel::{self, Margins, Place, SMALL};
use gallery::sheet::Sheet;

const MARGINS: Margins = [72.0, 18.0, 12.0, 60.0];
const HEADER: f64 = 90.0;
const FILM: f64 = 308.0;
const GAP: f64 = 16.0;

/// Draws the frames above the number of grains over time.
pub(crate) fn draw(arguments: &Arguments, glass: &Glass, ways: &[Way; 2]) -> Sheet {
    let unit = FILM / (2.0 * glass.top);
    let step = 2.0 * glass.width * unit + GAP;
    let [first, second] = ways;
    let film = [(first, 0.0), (first, 0.25), (first, 0.5), (first, 0.75), (first, 1.0), (second, 0.5)];
    let width = MARGINS[0] + film.len() as f64 * step;
    let mut sheet = Sheet::new(width, HEADER + FILM + 300.0);
    let words = format!("{} grains, neck {}, g = 1, q = 0.1, κ = 0.3", grains(arguments), arguments.neck);
    sheet.header(MARGINS[0], "An hourglass runs empty, and is turned over", &[&words]);
    for (k, (way, share)) in film.into_iter().enumerate() {
        let Some(frame) = way.frames.get((share * (way.frames.len() - 1) as f64) as usize) else { continue };
        let (is_first, x) = (std::ptr::eq(way, first), MARGINS[0] + k as f64 * step);
        let name = format!("{}t = {:.0}", if is_first { "" } else { "turned, " }, frame.time);
        sheet.text(x, HEADER - 8.0, SMALL, INK, &name);
        // Gravity points down in all pictures.
        let turned = if is_first { unit } else { -unit };
        let middle = DVec2::new(x + glass.width * unit, HEADER + 0.5 * FILM);
        let place = |point: DVec2| middle + DVec2::new(turned * point.x, -turned * point.y);
        add_glass(&mut sheet, glass, frame, unit, place);
    }
    let place = Place { x: 0.0, y: HEADER + FILM + 20.0, width: width - 4.0, height: 275.0 };
    let last = ways.iter().map(Way::end).fold(1.0, f64::max);
    let layout = panel::axes((0.0, last), (0.0, grains(arguments) as f64));
    let layout = layout.with_x_label("time t, in √(d/g)").with_y_label("grains above the neck");
    let looks = [LOOKS[0], LOOKS[1]].map(Look::without_marks);
    let points =
        |way: &Way| way.frames.iter().map(|frame| (frame.time, frame.above as f64)).collect::<Vec<_>>();
    let curves = looks.iter().zip(ways).map(|(look, way)| look.curve(points(way)));
    let panel = sheet.panel(place, MARGINS, curves.collect(), layout);
    sheet.legend_inside(&panel, &[(looks[0], "first"), (looks[1], "turned over")]);
    sheet
}

fn add_glass(sheet: &mut Sheet, glass: &Glass, frame: &Frame, unit: f64, place: impl Fn(DVec2) -> DVec2) {
    for disk in &frame.disks {
        let DVec2 { x, y } = place(disk.position());
        sheet.disk(x, y, disk.radius() * unit - 0.3, "#c79a4b");
    }
    let outline = glass.outline();
    let closed = outline.iter().chain(outline.first()).map(|point| place(*point).into());
    sheet.line(closed.collect(), INK, 1.4);
}
