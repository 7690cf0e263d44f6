//! A mean flow as arrows, one in each square cell that holds enough disks.

use granular_edmd::ParameterError;
use granular_edmd::boundary::Region;
use granular_edmd::glam::DVec2;
use granular_edmd::observable::{FieldCell, Fields, Grid, SampleTimes, Sampled};
use kuva::plot::quiver::QuiverPivot;
use kuva::prelude::{Plot, QuiverPlot};

use crate::look::INK;

/// Returns fields on square cells over a region, in `columns` columns.
pub fn on_squares(
    min: DVec2,
    max: DVec2,
    columns: usize,
    times: SampleTimes,
) -> Result<Sampled<Fields>, ParameterError> {
    let side = (max.x - min.x) / columns as f64;
    let rows = ((max.y - min.y) / side).ceil();
    let region = Region::new(min, DVec2::new(max.x, min.y + rows * side));
    Ok(Sampled::new(Fields::new(Grid::new(region, columns, rows as usize)?), times))
}

/// The arrows of a mean flow, one in each cell that is full enough.
pub struct Arrows {
    cells: Vec<FieldCell>,
    /// Largest speed of the flow, and the length of its arrow.
    fastest: f64,
    longest: f64,
}

impl Arrows {
    /// Creates the arrows of all cells that hold at least the fraction `share` of the disks in the fullest
    /// cell. The longest arrow is `cells` cells long.
    pub fn of(fields: &Fields, share: f64, cells: f64) -> Self {
        let most = fields.iter().map(|cell| cell.count).max().unwrap_or(0);
        let enough = (share * most as f64).max(1.0);
        let longest = cells * side(fields);
        let cells: Vec<_> = fields.iter().filter(|cell| cell.count as f64 >= enough).collect();
        let fastest = cells.iter().map(|cell| cell.velocity.length()).fold(0.0, f64::max);
        Self { cells, fastest, longest }
    }

    /// Returns the largest speed of these flows, for arrows of one scale.
    pub fn fastest<'a>(flows: impl IntoIterator<Item = &'a Self>) -> f64 {
        flows.into_iter().map(|arrows| arrows.fastest).fold(0.0, f64::max)
    }

    /// Returns the arrows in the scale in which this speed has the longest arrow.
    pub fn in_scale_of(self, fastest: f64) -> Self {
        Self { fastest, ..self }
    }

    /// Returns the arrows with shafts of this width.
    pub fn plot(&self, width: f64) -> Plot {
        let scale = self.longest / self.fastest.max(f64::MIN_POSITIVE);
        let arrow = |cell: &FieldCell| {
            let DVec2 { x, y } = scale * cell.velocity;
            (cell.center.x, cell.center.y, x, y)
        };
        let plot = QuiverPlot::new().with_arrows(self.cells.iter().map(arrow)).with_scale(1.0);
        let plot = plot.with_pivot(QuiverPivot::Middle).with_color(INK).with_shaft_width(width);
        let plot = plot.with_head_ratio(0.36).with_head_min_px(1.4 * width).with_head_max_px(6.0 * width);
        plot.with_clip_to_plot_area().into()
    }

    /// Returns a speed with one digit, not above the largest, and the length of its arrow, for a scale;
    /// `None` if nothing flows.
    pub fn scale(&self) -> Option<(f64, f64)> {
        let shown = round(self.fastest);
        (self.fastest > 0.0).then(|| (shown, self.longest * shown / self.fastest))
    }
}

/// Returns the side of a cell.
fn side(fields: &Fields) -> f64 {
    let middle = |column| fields.cell(column, 0).map_or(0.0, |cell| cell.center.x);
    middle(1) - middle(0)
}

/// Returns the largest number with one digit that is not above a speed.
fn round(speed: f64) -> f64 {
    let decade = speed.log10().floor();
    let digit = (speed / 10f64.powf(decade)).floor();
    // A division gives exactly 0.3; a product with 0.1 would not.
    if decade < 0.0 { digit / 10f64.powf(-decade) } else { digit * 10f64.powf(decade) }
}
