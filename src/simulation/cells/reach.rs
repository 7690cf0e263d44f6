//! The homes of another class of disks that a disk may touch from anywhere in its own cell.
//!
//! The picture in `layers.rs` shows a reach and its hole. Both are rectangles, so a reach is given by its
//! columns and its rows, each with the columns or rows of the hole. The columns and rows are stored in tables
//! with one entry for each column and row of the disk's own grid. The searches of large disks need them all
//! the time, and reading a table costs one load, whereas the edges of uneven rows would have to be searched.
//! Homes of a column lie next to each other in memory, so the reach is traversed in runs of rows.
//!
//! At periodic sides and ends, the count of homes continues beyond the last one. Columns are brought back
//! immediately. Rows are kept as they are counted, so that a reach, its hole and the difference of two
//! reaches are plain intervals. They are brought back only when a run is passed to the caller, then in two
//! pieces.

use super::grid::{Grid, Place};

/// Consecutive cells in a row or a column.
#[derive(Debug, Clone, Copy)]
struct Span {
    first: u32,
    count: u32,
}

impl Span {
    const EMPTY: Self = Self { first: 0, count: 0 };

    fn between(first: u32, behind: u32) -> Self {
        Self { first, count: behind.saturating_sub(first) }
    }

    fn behind(self) -> u32 {
        self.first + self.count
    }
}

/// The homes of a class of disks: rectangles of one or more cells of a grid.
pub(super) struct Homes<'a> {
    pub(super) grid: &'a Grid,
    /// Number of cells of the grid along each side of a home.
    pub(super) cells: usize,
    /// Distance in memory between homes next to each other in a row.
    pub(super) stride: usize,
    /// Index of the first home.
    pub(super) first: usize,
}

/// The range of distances between the centers of two disks that touch, one of each of two classes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Distances {
    /// The distance between the centers when the largest disks touch.
    pub(super) most: f64,
    /// The distance between the centers when the smallest disks touch.
    pub(super) least: f64,
}

/// The homes of a class whose disks may be touched, for each column and row of a grid.
///
/// The homes form a rectangle with a hole, since homes that lie inside the disk itself hold no disks.
#[derive(Debug, Clone)]
pub(super) struct Reach {
    columns: Vec<[Span; 2]>,
    rows: Vec<[Span; 2]>,
    /// Number of columns of homes in a period.
    period_columns: u32,
    /// Number of rows of homes in a period. The rows of a span are counted beyond this number.
    period_rows: u32,
    stride: usize,
    first: usize,
}

impl Reach {
    /// Finds the homes whose disks may touch disks in the cells of `from`.
    pub(super) fn new(from: &Grid, homes: &Homes<'_>, distances: Distances) -> Self {
        let [columns, rows] = homes.grid.edges().map(|edges| every(homes.cells, &edges));
        let margin = homes.grid.margin;
        let [from_columns, from_rows] = from.ranges();
        let periods = homes.grid.periods;
        // Half the width of the square inscribed in the circle on which the nearest possible centers lie.
        // Even at its corners, a home in this square is nearer than any disk that touches. The homes between
        // square and circle hold no such disks either, but leaving them out would cost more than it saves: a
        // rectangle is quicker to traverse.
        let hole = distances.least * std::f64::consts::FRAC_1_SQRT_2;
        let spans = |edges: &[f64], range: &(f64, f64), margin: f64, is_periodic: bool| {
            // A disk stays in its home up to a margin beyond the edge, so the reach is larger by this margin.
            // The hole is smaller for the same reason.
            let distance = distances.most + margin;
            let (low, high) = (range.0 - distance, range.1 + distance);
            let outer = if is_periodic { around(edges, low, high) } else { between(edges, low, high) };
            [outer, within(edges, range.1 - hole + margin, range.0 + hole - margin)]
        };
        let row_spans = |range: &(f64, f64)| {
            let [outer, hole] = spans(&rows, range, margin.y, periods.y > 0.0);
            [outer, hole_within(outer, hole, rows.len() as u32 - 1)]
        };
        Self {
            columns: from_columns
                .iter()
                .map(|range| spans(&columns, range, margin.x, periods.x > 0.0))
                .collect(),
            rows: from_rows.iter().map(row_spans).collect(),
            period_columns: columns.len() as u32 - 1,
            period_rows: rows.len() as u32 - 1,
            stride: homes.stride,
            first: homes.first,
        }
    }

    /// Calls `act` for the homes within reach of a place. Each call gets a run of homes that follow each
    /// other in memory: the index of the first home, and the number of homes.
    #[inline]
    pub(super) fn for_each_run(&self, place: Place, mut act: impl FnMut(usize, usize)) {
        for column in self.columns_of(place) {
            for rows in self.rows_of(place, column) {
                self.act_on(column, rows, &mut act);
            }
        }
    }

    /// Calls `act`, as in [`Self::for_each_run`], for the homes within reach of a place and also for the
    /// homes of the hole.
    pub(super) fn for_each_run_and_hole(&self, place: Place, mut act: impl FnMut(usize, usize)) {
        for column in self.columns_of(place) {
            self.act_on(column, self.rows[place.row as usize - 1][0], &mut act);
        }
    }

    /// Calls `act`, as in [`Self::for_each_run`], for the homes within reach of `place`, but not of `other`.
    pub(super) fn for_each_run_beyond(&self, place: Place, other: Place, mut act: impl FnMut(usize, usize)) {
        for column in self.columns_of(place) {
            let beyond = self.rows_of(other, column).map(|rows| self.aligned(rows, place, other));
            for rows in self.rows_of(place, column) {
                let mut first = rows.first;
                // An interval minus two others, which lie in order: the pieces before each of them, and the
                // piece after the last.
                for inside in beyond.into_iter().filter(|inside| inside.count > 0) {
                    let before = Span::between(first, rows.behind().min(inside.first));
                    self.act_on(column, before, &mut act);
                    first = first.max(inside.behind());
                }
                self.act_on(column, Span::between(first, rows.behind()), &mut act);
            }
        }
    }

    /// Shifts the rows of another place by a period if the periodic boundary lies between the two places, so
    /// that both are counted from the same row.
    fn aligned(&self, rows: Span, place: Place, other: Place) -> Span {
        let first = |place: Place| i64::from(self.rows[place.row as usize - 1][0].first);
        let (ahead, period) = (first(place) - first(other), i64::from(self.period_rows));
        let turns = if 2 * ahead > period { 1 } else { -i64::from(2 * ahead < -period) };
        // Rows before the first one are not within reach of this place.
        let start = i64::from(rows.first) + turns * period;
        Span::between(start.max(0) as u32, (start + i64::from(rows.count)).max(0) as u32)
    }

    #[inline]
    fn act_on(&self, column: u32, rows: Span, act: &mut impl FnMut(usize, usize)) {
        let start = self.first + column as usize * self.stride;
        for rows in self.pieces(rows) {
            if rows.count > 0 {
                act(start + rows.first as usize, rows.count as usize);
            }
        }
    }

    /// Splits a span into the rows up to the last row, and the rows that continue at the opposite end.
    #[inline]
    fn pieces(&self, rows: Span) -> [Span; 2] {
        let last = self.period_rows;
        let beyond = Span::between(rows.first.max(last) - last, rows.behind().max(last) - last);
        [Span::between(rows.first, rows.behind().min(last)), beyond]
    }

    /// Iterates over the columns of homes within reach of a place.
    #[inline]
    fn columns_of(&self, place: Place) -> impl Iterator<Item = u32> + use<> {
        let ([columns, _], period) = (self.columns[place.column as usize - 1], self.period_columns);
        (columns.first..columns.behind()).map(move |k| if k >= period { k - period } else { k })
    }

    /// Returns the homes of a column within reach of a place: the homes below the hole, and the homes above
    /// it.
    #[inline]
    fn rows_of(&self, place: Place, column: u32) -> [Span; 2] {
        let [columns, hole_columns] = self.columns[place.column as usize - 1];
        let [rows, hole_rows] = self.rows[place.row as usize - 1];
        // A column before the first one of the reach has been brought back by a period.
        let turn = if column < columns.first { self.period_columns } else { 0 };
        if column + turn - columns.first >= columns.count {
            return [Span::EMPTY; 2];
        }
        if column.wrapping_sub(hole_columns.first) < hole_columns.count && hole_rows.count > 0 {
            let below = Span::between(rows.first, hole_rows.first);
            return [below, Span::between(hole_rows.behind(), rows.behind())];
        }
        [rows, Span::EMPTY]
    }
}

/// Returns the edges of homes that are `cells` cells wide.
fn every(cells: usize, edges: &[f64]) -> Vec<f64> {
    edges.iter().copied().step_by(cells).collect()
}

/// Returns the spaces between edges that hold the numbers from `low` to `high`. The first and the last space
/// extend to infinity.
fn between(edges: &[f64], low: f64, high: f64) -> Span {
    let inner = &edges[1..edges.len() - 1];
    let first = inner.partition_point(|&edge| edge < low);
    let behind = inner.partition_point(|&edge| edge <= high) + 1;
    Span::between(first as u32, behind as u32)
}

/// Returns the spaces that lie wholly between two numbers. The first and the last space never do.
fn within(edges: &[f64], low: f64, high: f64) -> Span {
    let Span { first, count } = between(edges, low, high);
    Span { first: first + 1, count: count.saturating_sub(2) }
}

/// Counts the rows of a hole from the same row as the rows around the hole. The result is empty if the hole
/// does not lie within them.
fn hole_within(outer: Span, hole: Span, period: u32) -> Span {
    let first = if hole.first < outer.first { hole.first + period } else { hole.first };
    let hole = Span { first, count: hole.count };
    if hole.behind() <= outer.behind() { hole } else { Span::EMPTY }
}

/// Returns the spaces between equally spaced edges that hold the numbers from `low` to `high`. After the last
/// space, the first one follows.
fn around(edges: &[f64], low: f64, high: f64) -> Span {
    let (start, end, count) = (edges[0], edges[edges.len() - 1], (edges.len() - 1) as f64);
    let space = |x: f64| ((x - start) / (end - start) * count).floor();
    let within = (space(high) - space(low) + 1.0).min(count);
    Span { first: space(low).rem_euclid(count) as u32, count: within as u32 }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::{Distances, Homes, Reach, around, between, within};
    use crate::boundary::{Boundary, Container};
    use crate::simulation::cells::grid::{Grid, Place};
    use crate::simulation::cells::layout::CellSize;
    use crate::simulation::cells::layout::Layout;

    /// Returns a grid of cells of this size on a square of side 60.
    fn grid(container: &Container, pitch: f64) -> Grid {
        let count = (60.0 / pitch).round() as u32;
        let pitch = glam::DVec2::splat(60.0 / f64::from(count));
        let layout = Layout { cell_size: CellSize::Small, columns: count, rows: count, pitch };
        Grid::without_margin(&container.domain(), layout)
    }

    fn homes_within(reach: &Reach, place: Place, other: Option<Place>) -> BTreeSet<usize> {
        let mut homes = BTreeSet::new();
        let mut add = |first: usize, count: usize| {
            for home in first..first + count {
                assert!(homes.insert(home), "{home} is named twice");
            }
        };
        match other {
            Some(other) => reach.for_each_run_beyond(place, other, &mut add),
            None => reach.for_each_run(place, &mut add),
        }
        homes
    }

    #[test]
    fn what_comes_within_reach_is_what_was_not_there_before() {
        let walled = Container::closed(60.0, 60.0).unwrap();
        let periodic = Container::periodic(60.0, 60.0).unwrap();
        for container in [walled.clone(), walled.with_periodic_sides().unwrap(), periodic] {
            let (from, small) = (grid(&container, 5.0), grid(&container, 1.5));
            let homes = Homes { grid: &small, cells: 1, stride: 40, first: 3 };
            let reach = Reach::new(&from, &homes, Distances { most: 11.0, least: 10.9 });
            for place in from.places() {
                let here = homes_within(&reach, place, None);
                for direction in [(1, 0), (-1, 0), (0, 1), (0, -1)] {
                    let (other, _) = from.neighbor(place, direction);
                    if (1..=12).contains(&other.column) && (1..=12).contains(&other.row) {
                        let there = homes_within(&reach, other, None);
                        let beyond = homes_within(&reach, place, Some(other));
                        assert_eq!(beyond, &here - &there, "{place:?} {other:?}");
                    }
                }
            }
        }
    }

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
