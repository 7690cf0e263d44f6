//! The cells of another class of disks that matter to a disk, wherever it is in its own cell.

use super::grid::{Grid, Place};

/// Cells that follow each other in a row or a column.
#[derive(Debug, Clone, Copy)]
struct Span {
    first: u32,
    count: u32,
}

/// The homes of a class of disks: rectangles of one or more cells of a grid.
pub(super) struct Homes<'a> {
    pub(super) grid: &'a Grid,
    /// Cells of the grid in a home, along each side.
    pub(super) cells: usize,
    /// Distance in memory between homes next to each other in a row.
    pub(super) stride: usize,
    /// Index of the first home.
    pub(super) first: usize,
}

/// How near the disks of two classes can be.
#[derive(Debug, Clone, Copy)]
pub(super) struct Distances {
    /// The distance of the centers of the largest disks when they touch.
    pub(super) most: f64,
    /// The distance of the centers of the smallest disks when they touch.
    pub(super) least: f64,
}

/// For each column and row of one grid, the homes of a class whose disks may be touched from there.
///
/// They make a rectangle with a hole: homes that lie in the disk itself hold nobody.
#[derive(Debug, Clone)]
pub(super) struct Reach {
    columns: Vec<[Span; 2]>,
    rows: Vec<[Span; 2]>,
    /// Number of columns of homes, after which periodic sides begin anew.
    period: u32,
    stride: usize,
    first: usize,
}

impl Reach {
    /// Finds the homes of disks that touch those in the cells of `from`.
    pub(super) fn new(from: &Grid, homes: &Homes<'_>, distances: Distances) -> Self {
        let [columns, rows] = homes.grid.edges().map(|edges| every(homes.cells, &edges));
        let margin = homes.grid.margin();
        let [from_columns, from_rows] = from.ranges();
        let is_periodic = homes.grid.period() > 0.0;
        // A square in the circle that the nearest centers lie on.
        let hole = distances.least * std::f64::consts::FRAC_1_SQRT_2;
        let spans = |edges: &[f64], range: &(f64, f64), margin: f64, is_periodic: bool| {
            let distance = distances.most + margin;
            let (low, high) = (range.0 - distance, range.1 + distance);
            let outer = if is_periodic { around(edges, low, high) } else { between(edges, low, high) };
            [outer, within(edges, range.1 - hole + margin, range.0 + hole - margin)]
        };
        Self {
            columns: from_columns.iter().map(|range| spans(&columns, range, margin.x, is_periodic)).collect(),
            rows: from_rows.iter().map(|range| spans(&rows, range, margin.y, false)).collect(),
            period: columns.len() as u32 - 1,
            stride: homes.stride,
            first: homes.first,
        }
    }

    /// Does something with the homes within reach of a place, given the index of the first of some that follow each other in
    /// memory, and their number.
    #[inline]
    pub(super) fn for_each_run(&self, place: Place, mut act: impl FnMut(usize, usize)) {
        let [columns, hole_columns] = self.columns[place.column as usize - 1];
        let [rows, hole_rows] = self.rows[place.row as usize - 1];
        for k in columns.first..columns.first + columns.count {
            let column = if k >= self.period { k - self.period } else { k };
            let start = self.first + column as usize * self.stride;
            if column.wrapping_sub(hole_columns.first) < hole_columns.count && hole_rows.count > 0 {
                let behind = hole_rows.first + hole_rows.count;
                act(start + rows.first as usize, (hole_rows.first - rows.first) as usize);
                act(start + behind as usize, (rows.first + rows.count - behind) as usize);
            } else {
                act(start + rows.first as usize, rows.count as usize);
            }
        }
    }
}

/// Every so many of the edges, from the first to the last.
fn every(cells: usize, edges: &[f64]) -> Vec<f64> {
    edges.iter().copied().step_by(cells).collect()
}

/// The spaces between edges that hold numbers from `low` to `high`; the first and the last have no end.
fn between(edges: &[f64], low: f64, high: f64) -> Span {
    let inner = &edges[1..edges.len() - 1];
    let first = inner.partition_point(|&edge| edge < low);
    let last = inner.partition_point(|&edge| edge <= high);
    Span { first: first as u32, count: (last - first) as u32 + 1 }
}

/// The spaces that lie wholly between two numbers; none of those without an end.
fn within(edges: &[f64], low: f64, high: f64) -> Span {
    let inner = &edges[1..edges.len() - 1];
    let first = inner.partition_point(|&edge| edge < low);
    let last = inner.partition_point(|&edge| edge <= high);
    let count = last.saturating_sub(first + 1);
    Span { first: first as u32 + 1, count: count as u32 }
}

/// The spaces that hold numbers from `low` to `high`, between edges of the same distance, after the last of which the first follows.
fn around(edges: &[f64], low: f64, high: f64) -> Span {
    let count = edges.len() - 1;
    let (start, pitch) = (edges[0], (edges[count] - edges[0]) / count as f64);
    let space = |x: f64| ((x - start) / pitch).floor() as i64;
    let within = (space(high) - space(low) + 1).min(count as i64);
    Span { first: space(low).rem_euclid(count as i64) as u32, count: within as u32 }
}

#[cfg(test)]
mod tests {
    use super::{around, between, within};

    #[test]
    fn spans_hold_what_lies_between_and_no_more() {
        let edges = [0.0, 1.0, 2.0, 3.0, 4.0];
        let span = |low, high| (between(&edges, low, high).first, between(&edges, low, high).count);
        assert_eq!(span(1.2, 2.7), (1, 2));
        assert_eq!(span(f64::NEG_INFINITY, 0.3), (0, 1));
        assert_eq!(span(3.5, f64::INFINITY), (3, 1));
        assert_eq!(span(-7.0, 9.0), (0, 4));
        let span = |low, high| (within(&edges, low, high).first, within(&edges, low, high).count);
        assert_eq!(span(1.0, 3.0), (1, 2));
        assert_eq!(span(0.9, 2.9), (1, 1));
        assert_eq!(span(1.1, 1.9).1, 0);
        assert_eq!(span(-9.0, 9.0), (1, 2));
        assert_eq!(span(3.0, 1.0).1, 0);
        let span = |low, high| (around(&edges, low, high).first, around(&edges, low, high).count);
        assert_eq!(span(1.2, 2.7), (1, 2));
        assert_eq!(span(-0.5, 0.5), (3, 2));
        assert_eq!(span(3.5, 5.5), (3, 3));
        assert_eq!(span(-9.0, 9.0), (3, 4));
    }
}
