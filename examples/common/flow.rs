//! A mean flow as arrows: square cells, and those that are full enough for an arrow.

use granular_edmd::ParameterError;
use granular_edmd::boundary::Region;
use granular_edmd::glam::DVec2;
use granular_edmd::observable::{FieldCell, Fields, SampleTimes};

/// Returns fields on square cells over a region, with this many columns.
pub(crate) fn on_squares(
    min: DVec2,
    max: DVec2,
    columns: usize,
    times: SampleTimes,
) -> Result<Fields, ParameterError> {
    let side = (max.x - min.x) / columns as f64;
    let rows = ((max.y - min.y) / side).ceil();
    let region = Region::new(min, DVec2::new(max.x, min.y + rows * side));
    Fields::new(region, columns, rows as usize, times)
}

/// Returns the cells that hold at least this share of what the fullest cell holds.
fn seen(fields: &Fields, share: f64) -> Vec<FieldCell> {
    let most = fields.iter().map(|cell| cell.count).max().unwrap_or(0);
    let enough = (share * most as f64).max(1.0);
    fields.iter().filter(|cell| cell.count as f64 >= enough).collect()
}

/// Returns the largest speed of the flow in these cells.
pub(crate) fn fastest(fields: &Fields, share: f64) -> f64 {
    seen(fields, share).iter().map(|cell| cell.velocity.length()).fold(0.0, f64::max)
}

/// Returns the side of a cell.
pub(crate) fn side(fields: &Fields) -> f64 {
    let middle = |column| fields.cell(column, 0).map_or(0.0, |cell| cell.center.x);
    middle(1) - middle(0)
}

/// Returns the largest number with one digit that is not above a speed, for a scale of arrows.
pub(crate) fn round(speed: f64) -> f64 {
    let decade = speed.log10().floor();
    let digit = (speed / 10f64.powf(decade)).floor();
    // A division keeps 0.3 what it is; a product with 0.1 would not.
    if decade < 0.0 { digit / 10f64.powf(-decade) } else { digit * 10f64.powf(decade) }
}

/// Returns an arrow for each of these cells: its middle and its components. The longest is this many cells
/// long.
pub(crate) fn arrows(fields: &Fields, share: f64, longest: f64) -> Vec<(f64, f64, f64, f64)> {
    let scale = longest * side(fields) / fastest(fields, share).max(f64::MIN_POSITIVE);
    let arrow =
        |FieldCell { center, velocity, .. }| (center.x, center.y, scale * velocity.x, scale * velocity.y);
    seen(fields, share).into_iter().map(arrow).collect()
}
