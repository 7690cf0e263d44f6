//! Neighbour cells: a disk can only collide with disks in its own cell and the eight around it.

use glam::DVec2;

use super::event::Exit;
use crate::boundary::{Boundary, Domain, Region};

/// Cells per disk at most; more would cost memory and save nothing.
const CELLS_PER_DISK: f64 = 8.0;

/// Cells that are always allowed.
const SPARE_CELLS: f64 = 4096.0;

/// Least size of a cell in diameters: above 1 by more than rounding.
const LEAST_PITCH: f64 = 1.000_001;

/// A regular grid with, around it, a ring of cells that stay empty, so that every cell has eight neighbours.
///
/// The disks of a cell form a linked list through `next` and `previous`. One array serves for the links of disks
/// (index = disk), the end of all lists (index = number of disks) and the heads of the cells (after it), so that linking
/// and unlinking need no branch.
#[derive(Debug, Clone)]
pub(super) struct Cells {
    next: Vec<u32>,
    previous: Vec<u32>,
    /// Column and row of each disk.
    places: Vec<Place>,
    end: u32,
    /// Cells in a row of the grid, ring included.
    stride: u32,
    rows: u32,
    columns: u32,
    /// `column_edges[c]` and `column_edges[c + 1]` bound column `c`, counted without the ring; infinite at walls.
    column_edges: Vec<f64>,
    row_edges: Vec<f64>,
    /// Columns to the left and right of each, with the ring; around the corner if the sides are periodic.
    left_of: Vec<u32>,
    right_of: Vec<u32>,
    /// Whether disks in a cell can touch a wall.
    at_wall: Vec<bool>,
    /// What to add to `x` on leaving through the periodic sides.
    period: f64,
    layout: Layout,
}

/// The grid and where the disks are in it: what a checkpoint keeps.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct GridState {
    layout: Layout,
    places: Vec<Place>,
}

#[cfg(feature = "serde")]
impl GridState {
    pub(super) fn len(&self) -> usize {
        self.places.len()
    }

    /// Whether the grid has a sensible size, and every disk is in it.
    pub(super) fn is_valid(&self) -> bool {
        let Layout { columns, rows, pitch } = self.layout;
        let most = 2.0 * (CELLS_PER_DISK * self.places.len() as f64 + SPARE_CELLS);
        let sized = columns > 0 && rows > 0 && f64::from(columns) * f64::from(rows) <= most;
        let inside = |place: &Place| (1..=columns).contains(&place.column) && (1..=rows).contains(&place.row);
        sized && pitch.is_finite() && self.places.iter().all(inside)
    }
}

/// A cell by its column and row, ring included: the first real ones are 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Place {
    pub(super) column: u32,
    pub(super) row: u32,
}

/// The size of the grid.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct Layout {
    columns: u32,
    rows: u32,
    pitch: DVec2,
}

impl Layout {
    /// The grid for `count` disks of at most this diameter; `None` if the domain is too small.
    fn new(domain: &Domain, diameter: f64, pitch: f64, count: usize, highest: f64) -> Option<Self> {
        let width = domain.width();
        let height =
            if domain.top.is_finite() { domain.height() } else { open_height(domain, highest, diameter) };
        let most = CELLS_PER_DISK * count as f64 + SPARE_CELLS;
        let pitch = (pitch * diameter).max((width * height / most).sqrt());
        let along = |length: f64, pitch: f64| (length / pitch).floor().max(1.0);
        let mut columns = along(width, pitch).min(most.floor());
        if domain.periodic && columns < 4.0 {
            // With fewer columns a disk could meet a neighbour on both sides.
            columns = 4.0;
            if width < columns * LEAST_PITCH * diameter {
                return None;
            }
        }
        let rows = along(height, pitch).min((most / columns).max(1.0).floor());
        let valid = width > 0.0 && height > 0.0 && width.is_finite() && height.is_finite();
        let pitch = DVec2::new(width / columns, height / rows);
        valid.then_some(Self { columns: columns as u32, rows: rows as u32, pitch })
    }
}

/// How high the grid of an open container reaches: its last row holds all that is above.
fn open_height(domain: &Domain, highest: f64, diameter: f64) -> f64 {
    4.0 * (highest - domain.bottom).max(0.0) + 64.0 * diameter
}

impl Cells {
    /// Cells for disks at these positions; `None` if the domain is too small for them.
    ///
    /// `pitch` is the size of a cell in diameters of the largest disk.
    pub(super) fn new<B: Boundary + ?Sized>(
        boundary: &B,
        diameter: f64,
        pitch: f64,
        positions: &[DVec2],
    ) -> Option<Self> {
        let domain = boundary.domain();
        let count = positions.len();
        let highest = positions.iter().map(|p| p.y).fold(domain.bottom, f64::max);
        let layout = Layout::new(&domain, diameter, pitch.max(LEAST_PITCH), count, highest)?;
        let mut cells = Self::empty(&domain, &layout, count);
        cells.mark_walls(boundary, 0.5 * diameter);
        for (disk, position) in positions.iter().enumerate() {
            cells.places[disk] = cells.place_of(*position, &domain, &layout);
            cells.link(disk);
        }
        Some(cells)
    }

    /// The same grid as one that was saved, with the disks where they were.
    #[cfg(feature = "serde")]
    pub(super) fn restored<B: Boundary + ?Sized>(
        boundary: &B,
        largest_radius: f64,
        saved: &GridState,
    ) -> Self {
        let mut cells = Self::empty(&boundary.domain(), &saved.layout, saved.places.len());
        cells.mark_walls(boundary, largest_radius);
        cells.places.clone_from(&saved.places);
        for disk in 0..saved.places.len() {
            cells.link(disk);
        }
        cells
    }

    #[cfg(feature = "serde")]
    pub(super) fn state(&self) -> GridState {
        GridState { layout: self.layout, places: self.places.clone() }
    }

    fn empty(domain: &Domain, layout: &Layout, count: usize) -> Self {
        let (stride, height) = (layout.columns + 2, layout.rows + 2);
        let cells = stride as usize * height as usize;
        let end = count as u32;
        Self {
            next: vec![end; count + 1 + cells],
            previous: vec![end; count + 1],
            places: vec![Place { column: 1, row: 1 }; count],
            end,
            stride,
            rows: layout.rows,
            columns: layout.columns,
            column_edges: edges(domain.left, layout.pitch.x, layout.columns, domain.periodic),
            row_edges: edges(domain.bottom, layout.pitch.y, layout.rows, false),
            left_of: neighbours(layout.columns, domain.periodic, |column| column.wrapping_sub(1)),
            right_of: neighbours(layout.columns, domain.periodic, |column| column + 1),
            at_wall: vec![false; cells],
            period: if domain.periodic { domain.width() } else { 0.0 },
            layout: *layout,
        }
    }

    fn mark_walls<B: Boundary + ?Sized>(&mut self, boundary: &B, largest_radius: f64) {
        for row in 1..=self.rows {
            for column in 1..=self.columns {
                let place = Place { column, row };
                let cell = self.index(place);
                self.at_wall[cell] = boundary.may_touch(&self.region(place), largest_radius);
            }
        }
    }

    fn place_of(&self, position: DVec2, domain: &Domain, layout: &Layout) -> Place {
        let along = |offset: f64, pitch: f64, count: u32| {
            1 + ((offset / pitch).floor().max(0.0) as u32).min(count - 1)
        };
        Place {
            column: along(position.x - domain.left, layout.pitch.x, self.columns),
            row: along(position.y - domain.bottom, layout.pitch.y, self.rows),
        }
    }

    #[inline]
    fn index(&self, place: Place) -> usize {
        place.row as usize * self.stride as usize + place.column as usize
    }

    #[inline]
    pub(super) fn place(&self, disk: usize) -> Place {
        self.places[disk]
    }

    /// Whether this disk can touch a wall where it is.
    #[inline]
    pub(super) fn is_at_wall(&self, disk: usize) -> bool {
        self.at_wall[self.index(self.places[disk])]
    }

    /// The rectangle of a cell; infinite beyond the walls.
    #[inline]
    pub(super) fn region(&self, place: Place) -> Region {
        let (column, row) = (place.column as usize, place.row as usize);
        Region {
            min: DVec2::new(self.column_edges[column - 1], self.row_edges[row - 1]),
            max: DVec2::new(self.column_edges[column], self.row_edges[row]),
        }
    }

    /// The width of the domain if its sides are periodic, else 0.
    #[inline]
    pub(super) fn period(&self) -> f64 {
        self.period
    }

    fn link(&mut self, disk: usize) {
        let head = self.end as usize + 1 + self.index(self.places[disk]);
        let first = self.next[head];
        self.next[disk] = first;
        self.previous[disk] = head as u32;
        self.previous[first as usize] = disk as u32;
        self.next[head] = disk as u32;
    }

    fn unlink(&mut self, disk: usize) {
        let (next, previous) = (self.next[disk], self.previous[disk]);
        self.next[previous as usize] = next;
        self.previous[next as usize] = previous;
    }

    /// Takes a disk to the cell that it leaves for; returns what that adds to its `x`.
    #[inline]
    pub(super) fn cross(&mut self, disk: usize, exit: Exit) -> f64 {
        self.unlink(disk);
        let place = &mut self.places[disk];
        let mut shift = 0.0;
        match exit {
            Exit::Left => {
                shift = if place.column == 1 { self.period } else { 0.0 };
                place.column = self.left_of[place.column as usize];
            }
            Exit::Right => {
                shift = if place.column == self.columns { -self.period } else { 0.0 };
                place.column = self.right_of[place.column as usize];
            }
            Exit::Down => place.row -= 1,
            Exit::Up => place.row += 1,
            Exit::Stay | Exit::Wall(_) => {}
        }
        self.link(disk);
        shift
    }

    /// Writes the disks in the nine cells around `disk` (itself included) to `found`; returns how many.
    #[inline]
    pub(super) fn around(&self, disk: usize, found: &mut [u32]) -> usize {
        let place = self.places[disk];
        let columns = self.columns_around(place);
        let mut count = 0;
        for row in [place.row - 1, place.row, place.row + 1] {
            count = self.gather_heads(row, columns, found, count);
        }
        self.follow_links(found, count)
    }

    /// The same for the three cells that come within reach after `disk` has left its cell by `exit`.
    #[inline]
    pub(super) fn ahead(&self, disk: usize, exit: Exit, found: &mut [u32]) -> usize {
        let Place { column, row } = self.places[disk];
        let rows = [row - 1, row, row + 1];
        let count = match exit {
            Exit::Left => self.gather_column(rows, self.left_of[column as usize], found),
            Exit::Right => self.gather_column(rows, self.right_of[column as usize], found),
            Exit::Down => self.gather_heads(row - 1, self.columns_around(self.places[disk]), found, 0),
            Exit::Up => self.gather_heads(row + 1, self.columns_around(self.places[disk]), found, 0),
            Exit::Stay | Exit::Wall(_) => 0,
        };
        self.follow_links(found, count)
    }

    #[inline]
    fn columns_around(&self, place: Place) -> [u32; 3] {
        let column = place.column as usize;
        [self.left_of[column], place.column, self.right_of[column]]
    }

    #[inline]
    fn head(&self, column: u32, row: u32) -> u32 {
        self.next[self.end as usize + 1 + self.index(Place { column, row })]
    }

    #[inline]
    fn gather_heads(&self, row: u32, columns: [u32; 3], found: &mut [u32], mut count: usize) -> usize {
        for column in columns {
            let head = self.head(column, row);
            found[count] = head;
            count += usize::from(head != self.end);
        }
        count
    }

    #[inline]
    fn gather_column(&self, rows: [u32; 3], column: u32, found: &mut [u32]) -> usize {
        let mut count = 0;
        for row in rows {
            let head = self.head(column, row);
            found[count] = head;
            count += usize::from(head != self.end);
        }
        count
    }

    /// Appends what follows in each list: breadth first, without a branch on where a list ends.
    #[inline]
    fn follow_links(&self, found: &mut [u32], mut count: usize) -> usize {
        let mut visited = 0;
        while visited < count {
            let next = self.next[found[visited] as usize];
            found[count] = next;
            count += usize::from(next != self.end);
            visited += 1;
        }
        count
    }
}

fn edges(start: f64, pitch: f64, count: u32, open: bool) -> Vec<f64> {
    let mut edges: Vec<f64> = (0..=count).map(|k| start + f64::from(k) * pitch).collect();
    if !open {
        edges[0] = f64::NEG_INFINITY;
        edges[count as usize] = f64::INFINITY;
    }
    edges
}

/// The neighbour of each column in a direction; the ring, or around the corner, at the ends.
fn neighbours(columns: u32, periodic: bool, step: impl Fn(u32) -> u32) -> Vec<u32> {
    let wrap = |column: u32| match column {
        0 if periodic => columns,
        c if c == columns + 1 && periodic => 1,
        c => c,
    };
    (0..columns + 2).map(|column| wrap(step(column)).min(columns + 1)).collect()
}
