//! The picture: the pair correlation, and the distribution of speeds divided by the Maxwellian distribution.

use granular_edmd::observable::VelocityDistribution;
use granular_edmd::statistics::HistogramBin;

use crate::{Arguments, Bulk, DISKS, Gas, second_cumulant};
use gallery::look::{BLUE, INK, Look, Mark, VERMILION};
use gallery::panel::{self, Margins, Place};
use gallery::sheet::Sheet;

const HEADER: f64 = 72.0;
const WIDTH: f64 = 500.0;
const HEIGHT: f64 = 440.0;
const MARGINS: Margins = [76.0, 20.0, 10.0, 60.0];

const MEASURED: Look = Look::line(BLUE, "");
const CONTACT: Look = Look::marks(VERMILION, Mark::Diamond).with_size(7.0);
const ELASTIC: Look = Look::marks(BLUE, Mark::Disk);
const COOLING: Look = Look::marks(VERMILION, Mark::Square);
const MAXWELL: Look = Look::line(INK, "").with_width(1.2);
const SONINE: Look = Look::line(VERMILION, "8 4");

/// Largest distance and speed, and the range of the ratio of distributions.
const FARTHEST: f64 = 4.0;
const FASTEST: f64 = 2.5;
const RATIOS: (f64, f64) = (0.8, 1.6);

/// Draws both panels, side by side.
pub(crate) fn draw(arguments: &Arguments, gas: &Gas, bulk: &Bulk, cooling: &VelocityDistribution) -> Sheet {
    let mut sheet = Sheet::new(2.0 * WIDTH, HEADER + HEIGHT);
    let note = format!("{DISKS} disks in a periodic box, packing fraction {}", gas.packing);
    sheet.header(MARGINS[0], "A gas of hard disks beside theory", &[&note]);
    let place = Place { x: 0.0, y: HEADER, width: WIDTH, height: HEIGHT };
    draw_pairs(&mut sheet, place, gas, bulk);
    draw_speeds(&mut sheet, Place { x: WIDTH, ..place }, arguments, [&bulk.velocities, cooling]);
    sheet
}

/// Draws the pair correlation, and Henderson's value at contact.
fn draw_pairs(sheet: &mut Sheet, place: Place, gas: &Gas, bulk: &Bulk) {
    let points: Vec<_> = bulk.pairs.iter().map(|(distance, value)| (distance, value.mean())).collect();
    let highest = points.iter().map(|(_, value)| *value).fold(gas.contact_value(), f64::max);
    let axes = panel::axes((0.0, FARTHEST), (0.0, 1.15 * highest));
    let axes = axes.with_x_label("distance r, in diameters").with_y_label("pair correlation g(r)");
    let panel = sheet.panel(place, MARGINS, vec![MEASURED.curve(points)], axes);
    sheet.marks(&panel, CONTACT, [(1.0, gas.contact_value())]);
    let names = [(MEASURED, "measured"), (CONTACT, "Henderson")];
    sheet.legend_inside(&panel, &names);
}

/// Draws the distributions of speeds in the elastic and in the cooling gas, divided by the Maxwellian
/// distribution.
fn draw_speeds(sheet: &mut Sheet, place: Place, arguments: &Arguments, gases: [&VelocityDistribution; 2]) {
    let a2 = second_cumulant(arguments.restitution);
    let sonine = |c: f64| 1.0 + a2 * (0.5 * c.powi(4) - 2.0 * c * c + 1.0);
    let speeds = (0..=100).map(|step| FASTEST * f64::from(step) / 100.0);
    let curves = vec![
        MAXWELL.curve([(0.0, 1.0), (FASTEST, 1.0)]),
        SONINE.curve(speeds.map(|speed| (speed, sonine(speed)))),
    ];
    let axes = panel::axes((0.0, FASTEST), RATIOS);
    let axes = axes.with_x_label("speed c, in thermal speeds").with_y_label("distribution of c / Maxwellian");
    let panel = sheet.panel(place, MARGINS, curves, axes);
    for (look, velocities) in [ELASTIC, COOLING].into_iter().zip(gases) {
        let bins = || velocities.speed().bins().filter(|bin| bin.high <= FASTEST).map(|bin| ratio(&bin));
        let held = || bins().filter(|(_, ratio, _)| (RATIOS.0..RATIOS.1).contains(ratio));
        sheet.bars(&panel, look, held().map(|(at, ratio, error)| [(at, ratio - error), (at, ratio + error)]));
        sheet.marks(&panel, look, held().map(|(at, ratio, _)| (at, ratio)));
    }
    let cooling = format!("cooling, r = {}", arguments.restitution);
    let names =
        [(ELASTIC, "elastic"), (COOLING, &*cooling), (MAXWELL, "Maxwellian"), (SONINE, "Sonine, theory")];
    sheet.legend_inside(&panel, &names);
}

/// Returns the middle of a bin, and the ratio of its share to the Maxwellian share, with the error.
fn ratio(bin: &HistogramBin) -> (f64, f64, f64) {
    // The whole bin counts, since the distribution falls steeply.
    let share = (-bin.low * bin.low).exp() - (-bin.high * bin.high).exp();
    let scale = (bin.high - bin.low) / share;
    (0.5 * (bin.low + bin.high), scale * bin.density.mean(), scale * bin.density.standard_error())
}
