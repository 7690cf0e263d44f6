//! The edges of columns and rows.

use super::layout::Layout;
use crate::boundary::Domain;

/// Moves the outermost edges outward by a margin, or inward if it is negative.
pub(super) fn widen(edges: &mut [f64], margin: f64) {
    // Cells keep their disks up to a margin beyond their edges (`Grid::region`). At periodic sides, the
    // margin would take disks out of the domain. `Grid::new` therefore moves the outermost edges inward by
    // the margin, so that the outermost cells, margin included, end at the side of the domain, and
    // `Grid::edges` moves them back.
    if let [first, .., last] = edges {
        *first -= margin;
        *last += margin;
    }
}

/// Returns the edges of `count` intervals of equal width. At walls, the first and the last edge are infinite.
pub(super) fn edges(start: f64, pitch: f64, count: u32, walls: bool) -> Vec<f64> {
    let mut edges: Vec<f64> = (0..=count).map(|k| start + f64::from(k) * pitch).collect();
    if walls {
        edges[0] = f64::NEG_INFINITY;
        edges[count as usize] = f64::INFINITY;
    }
    edges
}

/// Returns the edges of the rows. In an open container, the rows in the upper half become higher in
/// proportion to their height above the floor, so a disk that flies high does not share its cell with all
/// other disks at great heights.
pub(super) fn row_edges(domain: &Domain, layout: &Layout) -> Vec<f64> {
    /// Ratio of heights from row to row. A few more rows then reach exponentially higher.
    const GROWTH: f64 = 1.1;
    let mut edges = edges(domain.bottom, layout.pitch.y, layout.rows, !domain.periodic_ends);
    if domain.top.is_infinite() {
        let even = (layout.rows as usize / 2).max(1);
        for row in even + 1..edges.len() - 1 {
            let height = edges[row - 1] - domain.bottom.min(edges[row - 1]);
            edges[row] = edges[row - 1] + (height * (GROWTH - 1.0)).max(layout.pitch.y);
        }
    }
    edges
}
