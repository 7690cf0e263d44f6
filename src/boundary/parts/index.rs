//! The index of the parts of a container: it finds the bricks near a rectangle.

use std::ops::Range;

use glam::DVec2;

use super::{Placed, PlacedBrick};
use crate::boundary::{Domain, Region};

/// Number of cells for each brick. A brick is then alone in most of its cells.
const CELLS_PER_BRICK: usize = 4;

/// Largest number of cells.
const MOST_CELLS: usize = 1 << 16;

/// A grid of cells, each with the bricks that may enter it at some time. Cells at the edges extend to
/// infinity.
#[derive(Debug, Clone)]
pub(super) struct Index {
    corner: DVec2,
    /// Cells per length.
    density: DVec2,
    pub(super) columns: usize,
    rows: usize,
    /// Index of the first entry of each cell, followed by the number of all entries.
    starts: Vec<u32>,
    entries: Vec<Entry>,
}

/// A brick, or one of its periodic images.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Entry {
    /// Index of the brick in the list of all parts' bricks.
    pub(super) brick: u32,
    /// Displacement of the image; zero for the brick itself.
    pub(super) image: DVec2,
}

impl Index {
    /// Enters bricks into the cells of a grid into which they may come at some time.
    pub(super) fn new(domain: &Domain, bricks: &[PlacedBrick], placed: &[Placed]) -> Self {
        let travel = |of: &PlacedBrick| placed[of.part].part.travel();
        let images: Vec<(u32, DVec2, Region)> = (0..)
            .zip(bricks.iter().map(|of| travel(of).bounds(&of.brick)))
            .flat_map(|(brick, bounds)| {
                domain.images_of(&bounds).map(move |image| (brick, image, bounds.shifted(image)))
            })
            .collect();
        let Region { min, max } = rectangle(domain, images.iter().map(|(_, _, bounds)| *bounds));
        let size = (max - min).max(DVec2::splat(f64::MIN_POSITIVE));
        let most = (CELLS_PER_BRICK * images.len()).clamp(1, MOST_CELLS) as f64;
        let columns = (most * size.x / size.y).sqrt().clamp(1.0, most).floor();
        let rows = (most / columns).floor().max(1.0);
        let density = DVec2::new(columns, rows) / size;
        let (columns, rows) = (columns as usize, rows as usize);
        let mut index = Self { corner: min, density, columns, rows, starts: vec![0], entries: Vec::new() };
        let mut cells = vec![Vec::new(); columns * rows];
        for (brick, image, bounds) in images {
            let of = &bricks[brick as usize];
            for cell in index.cells(&bounds) {
                if travel(of).may_reach(&of.brick, &index.region(cell).shifted(-image), 0.0) {
                    cells[cell].push(Entry { brick, image });
                }
            }
        }
        for cell in cells {
            index.entries.extend(cell);
            index.starts.push(index.entries.len() as u32);
        }
        index
    }

    /// Returns the bricks that may enter a rectangle, some of them several times.
    pub(super) fn near(&self, region: &Region) -> impl Iterator<Item = Entry> + use<'_> {
        let (columns, rows) = self.span(region);
        // In a row, the entries of a cell follow the entries of the previous cell.
        rows.flat_map(move |row| {
            let before = row * self.columns;
            self.entries_of(before + columns.start..before + columns.end)
        })
    }

    /// Returns the number of cells.
    pub(super) fn len(&self) -> usize {
        self.starts.len().saturating_sub(1)
    }

    /// Returns the cell that holds a point.
    pub(super) fn cell(&self, place: DVec2) -> usize {
        self.cells(&Region::new(place, place)).next().unwrap_or(0)
    }

    /// Returns the middle of a cell. For a cell at an edge of the grid, which extends to infinity, the result
    /// is the middle of its finite part.
    pub(super) fn middle(&self, cell: usize) -> DVec2 {
        let (column, row) = ((cell % self.columns) as f64, (cell / self.columns) as f64);
        self.corner + DVec2::new(column + 0.5, row + 0.5) / self.density
    }

    /// Returns the bricks that may enter a cell.
    pub(super) fn within(&self, cell: usize) -> impl Iterator<Item = Entry> {
        self.entries_of(cell..cell + 1)
    }

    fn entries_of(&self, cells: Range<usize>) -> impl Iterator<Item = Entry> {
        let range = match (self.starts.get(cells.start), self.starts.get(cells.end)) {
            (Some(&from), Some(&to)) => from as usize..to as usize,
            _ => 0..0,
        };
        self.entries[range].iter().copied()
    }

    /// Returns the cells that overlap a rectangle.
    pub(super) fn cells(&self, region: &Region) -> impl Iterator<Item = usize> + use<> {
        let ((columns, rows), width) = (self.span(region), self.columns);
        rows.flat_map(move |row| columns.clone().map(move |column| row * width + column))
    }

    /// Returns the columns and the rows that overlap a rectangle.
    fn span(&self, &Region { min, max }: &Region) -> (Range<usize>, Range<usize>) {
        // The conversion takes negative numbers to 0.
        let place = |value: f64, count: usize| (value as usize).min(count - 1);
        let (from, to) = ((min - self.corner) * self.density, (max - self.corner) * self.density);
        let columns = place(from.x, self.columns)..place(to.x, self.columns) + 1;
        (columns, place(from.y, self.rows)..place(to.y, self.rows) + 1)
    }

    /// Returns the rectangle of a cell, slightly enlarged, so that rounding leaves no gap between two cells.
    fn region(&self, cell: usize) -> Region {
        const ROUNDING: f64 = 1e-6;
        let place = DVec2::new((cell % self.columns) as f64, (cell / self.columns) as f64);
        let last = DVec2::new(self.columns as f64, self.rows as f64) - 1.0;
        let low = DVec2::select(place.cmpeq(DVec2::ZERO), DVec2::NEG_INFINITY, place - ROUNDING);
        let high = DVec2::select(place.cmpeq(last), DVec2::INFINITY, place + 1.0 + ROUNDING);
        Region::new(self.corner + low / self.density, self.corner + high / self.density)
    }
}

/// Returns the part of the domain that holds the bricks.
fn rectangle(domain: &Domain, bounds: impl Iterator<Item = Region>) -> Region {
    let (all, domain) = (Region::enclosing(bounds), domain.region());
    let min = all.min.max(domain.min).min(domain.max);
    Region::new(min, all.max.min(domain.max).max(min))
}
