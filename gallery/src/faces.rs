//! Disks as a plot.

use granular_edmd::Disk;
use kuva::prelude::{Plot, ScatterPlot};

/// Distance by which disks are drawn too small, so that touching disks look separate.
pub const GAP: f64 = 0.4;

/// Returns disks in their colors, for a panel on which a unit of length is `unit` units of the sheet. On the
/// sheet, the radii are smaller by `gap`.
pub fn faces<'a, C: Into<String>>(
    disks: impl Iterator<Item = &'a Disk> + Clone,
    unit: f64,
    gap: f64,
    color: impl Fn(&Disk) -> C,
) -> Plot {
    let centers = disks.clone().map(|disk| (disk.position().x, disk.position().y));
    let sizes = disks.clone().map(|disk| (disk.radius() * unit - gap).max(0.5));
    ScatterPlot::new().with_data(centers).with_sizes(sizes).with_colors(disks.map(color)).into()
}
