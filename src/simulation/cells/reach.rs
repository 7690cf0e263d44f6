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

/// For each column and row of one grid, the homes of a class whose disks may be touched from there.
#[derive(Debug, Clone)]
pub(super) struct Reach {
    columns: Vec<Span>,
    rows: Vec<Span>,
    /// Number of columns of homes, after which periodic sides begin anew.
    period: u32,
    stride: usize,
    first: usize,
}

impl Reach {
    /// Finds the homes within `distance` of each cell of `from`.
    pub(super) fn new(from: &Grid, homes: &Homes<'_>, distance: f64) -> Self {
        let [columns, rows] = homes.grid.edges().map(|edges| every(homes.cells, &edges));
        let margin = homes.grid.margin();
        let [from_columns, from_rows] = from.ranges();
        let across = |(low, high): &(f64, f64)| {
            let (low, high) = (low - distance - margin.x, high + distance + margin.x);
            if homes.grid.period() > 0.0 { around(&columns, low, high) } else { between(&columns, low, high) }
        };
        let along =
            |(low, high): &(f64, f64)| between(&rows, low - distance - margin.y, high + distance + margin.y);
        Self {
            columns: from_columns.iter().map(across).collect(),
            rows: from_rows.iter().map(along).collect(),
            period: columns.len() as u32 - 1,
            stride: homes.stride,
            first: homes.first,
        }
    }

    /// Returns the homes within reach of a place: the index of the first of each column of them, and how many follow it.
    #[inline]
    pub(super) fn homes(&self, place: Place) -> impl Iterator<Item = (usize, usize)> {
        let (columns, rows) = (self.columns[place.column as usize - 1], self.rows[place.row as usize - 1]);
        (0..columns.count).map(move |k| {
            let column = columns.first + k;
            let column = if column >= self.period { column - self.period } else { column };
            (self.first + column as usize * self.stride + rows.first as usize, rows.count as usize)
        })
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

/// The same between edges of the same distance, after the last of which the first follows.
fn around(edges: &[f64], low: f64, high: f64) -> Span {
    let count = edges.len() - 1;
    let (start, pitch) = (edges[0], (edges[count] - edges[0]) / count as f64);
    let space = |x: f64| ((x - start) / pitch).floor() as i64;
    let within = (space(high) - space(low) + 1).min(count as i64);
    Span { first: space(low).rem_euclid(count as i64) as u32, count: within as u32 }
}

#[cfg(test)]
mod tests {
    use super::{around, between};

    #[test]
    fn spans_hold_what_lies_between_and_no_more() {
        let edges = [0.0, 1.0, 2.0, 3.0, 4.0];
        let span = |low, high| (between(&edges, low, high).first, between(&edges, low, high).count);
        assert_eq!(span(1.2, 2.7), (1, 2));
        assert_eq!(span(f64::NEG_INFINITY, 0.3), (0, 1));
        assert_eq!(span(3.5, f64::INFINITY), (3, 1));
        assert_eq!(span(-7.0, 9.0), (0, 4));
        let span = |low, high| (around(&edges, low, high).first, around(&edges, low, high).count);
        assert_eq!(span(1.2, 2.7), (1, 2));
        assert_eq!(span(-0.5, 0.5), (3, 2));
        assert_eq!(span(3.5, 5.5), (3, 3));
        assert_eq!(span(-9.0, 9.0), (3, 4));
    }
}
