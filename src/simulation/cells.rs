//! Neighbor cells: until it leaves its cell, a disk can collide only with disks in that cell and the eight
//! cells around it.
//!
//! A disk passes to a neighbor cell when it leaves its own cell, which is widened by a margin (`layout.rs`,
//! `grid.rs`). The function `prediction::leave_cell` gives this time. The disk then searches the three cells
//! ahead (`Cells::ahead`).

mod contents;
mod crowd;
mod division;
mod grid;
mod layer;
mod layers;
mod layout;
mod reach;

use glam::DVec2;

use super::state::Exit;
use crate::boundary::{Boundary, Region};
use crate::instructions::prefetch;
use contents::Contents;
use division::classes;
pub(super) use grid::{Grid, Place};
pub(super) use layers::Layouts;
use layers::{Chosen, Layers, layouts};
pub(crate) use layout::FEWEST;
pub(super) use layout::{CELLS_PER_DISK, CellSize, Layout, SPARE_CELLS, SizeClass};
use layout::{class_of, count, together};

/// Number of disks that may be added or removed before the numbers of disks are compared with the numbers for
/// which the cells were made.
pub(super) const SPARE_DISKS: usize = 64;

/// The disks in the cells of a grid.
///
/// A ring of ghost cells surrounds the grid. Beyond walls, ghosts are empty; at periodic sides and ends, they
/// mirror the cells of the opposite side. Where disks differ in size, the grid belongs to the smallest class,
/// and each larger class has a layer above it.
#[derive(Debug, Clone, Default)]
pub(super) struct Cells {
    pub(super) grid: Grid,
    contents: Contents,
    /// Column and row of each disk, in the grid of its class.
    pub(super) places: Vec<Place>,
    layers: Option<Box<Layers>>,
    /// The classes of disks for which the cells were made, with their numbers of disks at that time.
    classes: Vec<SizeClass>,
}

impl Cells {
    /// Creates cells for disks at these positions, with these radii; `None` if the domain is too small for
    /// them. The cells also suit a disk of the diameter `further` and, if this diameter is the largest, any
    /// smaller disk.
    pub(super) fn new(
        boundary: &dyn Boundary,
        cell_size: CellSize,
        disks: impl ExactSizeIterator<Item = (DVec2, f64)> + Clone,
        further: Option<f64>,
    ) -> Option<Self> {
        let domain = boundary.domain();
        let diameters = disks.clone().map(|(_, radius)| 2.0 * radius);
        let highest = disks.clone().map(|(position, _)| position.y).fold(domain.bottom, f64::max);
        let classes = classes(diameters.clone().chain(further));
        let largest =
            classes.last().map_or_else(|| SizeClass::of_nobody(&domain).largest, |class| class.largest);
        let most = CELLS_PER_DISK * disks.len() as f64 + SPARE_CELLS;
        // This layout is needed with layers, too: it decides whether the domain has room for the largest disk
        // at all.
        let single = Layout::new(&domain, largest, cell_size, most, highest)?;
        // All disks share the cells of the largest if periodic sides or ends are too close for layers.
        let layered = if classes.len() > 1 { layouts(&domain, &classes, cell_size, highest) } else { None };
        let layouts = layered.unwrap_or_else(|| {
            let together = together(&classes).unwrap_or_else(|| SizeClass::of_nobody(&domain));
            Layouts { smallest: single, larger: Vec::new(), classes: vec![together] }
        });
        let mut cells = Self::empty(boundary, &layouts, diameters);
        let place = |(disk, (position, _))| cells.grid_of(disk).place_of(position);
        cells.fill((0..).zip(disks).map(place).collect());
        Some(cells)
    }

    /// Creates cells with these layouts, one for each class; there is at least one class. The disks, of these
    /// diameters, are added afterwards.
    pub(super) fn empty(
        boundary: &dyn Boundary,
        layouts: &Layouts,
        diameters: impl Iterator<Item = f64>,
    ) -> Self {
        let domain = boundary.domain();
        let classes = layouts.classes.clone();
        let grid = Grid::new(&domain, layouts.smallest, classes[0].largest);
        let contents = Contents::empty(grid.len());
        let layers = (!layouts.larger.is_empty()).then(|| {
            let mut layers = Layers::empty(&domain, &grid, &classes, &layouts.larger, diameters);
            layers.mark_walls(boundary, &classes);
            Box::new(layers)
        });
        let largest_radius = 0.5 * classes[0].largest;
        let mut cells = Self { grid, contents, places: Vec::new(), layers, classes };
        cells.mark_walls(boundary, largest_radius);
        cells
    }

    /// Writes all disks into the cells in these places.
    pub(super) fn fill(&mut self, places: Vec<Place>) {
        self.places = places;
        for disk in 0..self.places.len() {
            self.change(disk, Contents::push);
        }
    }

    fn mark_walls(&mut self, boundary: &dyn Boundary, largest_radius: f64) {
        for place in self.grid.places() {
            if boundary.may_touch(&self.grid.region(place), largest_radius) {
                self.contents.mark_wall(self.grid.index(place));
            }
        }
    }

    /// Returns the layouts of all cells.
    #[cfg(feature = "serde")]
    pub(super) fn layouts(&self) -> Layouts {
        let larger = self.layers.as_ref().map_or_else(Vec::new, |layers| layers.layouts());
        Layouts { smallest: self.grid.layout, larger, classes: self.classes.clone() }
    }

    /// Returns whether a disk of this diameter belongs to one of the classes for which the cells were made.
    pub(super) fn suit(&self, diameter: f64) -> bool {
        let class = self.classes.get(usize::from(class_of(&self.classes, diameter)));
        class.is_some_and(|class| self.layers.is_none() || diameter >= class.smallest)
    }

    /// Returns whether there are far more or far fewer disks than when the cells were made.
    pub(super) fn are_outgrown(&self) -> bool {
        let (before, now) = (count(&self.classes), self.places.len());
        now > 2 * before + SPARE_DISKS || before > 2 * now + SPARE_DISKS
    }

    /// Adds a disk after all others.
    pub(super) fn put_in(&mut self, position: DVec2, diameter: f64) {
        if let Some(layers) = &mut self.layers {
            layers.classes.push(class_of(&self.classes, diameter));
        }
        let disk = self.places.len();
        self.places.push(self.grid_of(disk).place_of(position));
        self.change(disk, Contents::push);
    }

    /// Removes a disk. The last disk takes its index.
    pub(super) fn take_out(&mut self, disk: usize) {
        let last = self.places.len() - 1;
        self.change(disk, Contents::remove);
        // The last disk is looked up by its old number for the last time, then written under the number that
        // became free.
        if disk != last {
            self.change(last, Contents::remove);
        }
        self.places.swap_remove(disk);
        if let Some(layers) = &mut self.layers {
            layers.classes.swap_remove(disk);
        }
        if disk != last {
            self.change(disk, Contents::push);
        }
    }

    /// Writes to `found` the disks that a disk of this diameter at this place would overlap, and other disks
    /// near the place. Returns their number.
    pub(super) fn near(&self, position: DVec2, diameter: f64, found: &mut [u32]) -> usize {
        let class = class_of(&self.classes, diameter);
        match self.layers.as_ref().and_then(|layers| Some((layers, layers.of_class(class)?))) {
            Some((layers, layer)) => {
                let place = layer.grid.place_of(position);
                layers.gather(&self.contents, class, place, Chosen::AlsoInside, found)
            }
            None => self.around_cell_in_layers(self.grid.place_of(position), found),
        }
    }

    /// Returns whether a disk belongs to a larger class than the smallest.
    #[inline]
    pub(super) fn is_large(&self, disk: usize) -> bool {
        self.layers.as_ref().is_some_and(|layers| layers.of(disk).is_some())
    }

    /// Returns the grid in which a disk is.
    pub(super) fn grid_of(&self, disk: usize) -> &Grid {
        self.layers.as_ref().and_then(|layers| layers.of(disk)).map_or(&self.grid, |layer| &layer.grid)
    }

    /// Returns the rectangle in which a disk keeps its neighbors, and whether it can touch a wall there.
    #[inline(always)]
    pub(super) fn region(&self, disk: usize) -> (Region, bool) {
        let place = self.places[disk];
        match self.layers.as_ref().and_then(|layers| layers.of(disk)) {
            None => (self.grid.region(place), self.contents.is_at_wall(self.grid.index(place))),
            Some(layer) => (layer.grid.region(place), layer.is_at_wall(place)),
        }
    }

    /// Writes a disk of any class into its cell, or removes it from the cell.
    fn change(&mut self, disk: usize, change: impl Fn(&mut Contents, usize, usize)) {
        match self.layers.as_mut().filter(|layers| layers.of(disk).is_some()) {
            None => self.change_cell(disk, change),
            Some(layers) => layers.change(disk, self.places[disk], change),
        }
    }

    /// Writes a disk of the smallest class into its cell and the ghosts that mirror the cell, or removes it
    /// from them.
    #[inline(always)]
    fn change_cell(&mut self, disk: usize, change: impl Fn(&mut Contents, usize, usize)) {
        let place = self.places[disk];
        change(&mut self.contents, self.grid.index(place), disk);
        if self.grid.is_periodic {
            for ghost in self.grid.mirrors(place) {
                change(&mut self.contents, self.grid.index(ghost), disk);
            }
        }
    }

    /// Moves a disk to the cell that it enters by this exit. Returns the number of periods passed.
    #[inline(always)]
    pub(super) fn cross(&mut self, disk: usize, exit: Exit) -> [i32; 2] {
        self.change_cell(disk, Contents::remove);
        let (place, passed) = self.grid.neighbor(self.places[disk], exit.direction());
        self.places[disk] = place;
        self.change_cell(disk, Contents::push);
        passed
    }

    /// Moves a disk of a larger class to the cell that it enters by this exit. Returns the number of periods
    /// passed.
    pub(super) fn cross_large(&mut self, disk: usize, exit: Exit) -> [i32; 2] {
        let from = self.places[disk];
        let (to, passed) = self.grid_of(disk).neighbor(from, exit.direction());
        if let Some(layers) = &mut self.layers {
            layers.cross(disk, from, to);
        }
        self.places[disk] = to;
        passed
    }

    /// Returns the room that [`Self::around`] and [`Self::ahead`] need.
    #[inline]
    pub(super) fn room(&self) -> usize {
        // A search finds each disk at most once. With layers, the search of a large disk may find all disks;
        // the room of nine cells is then for the free slots that are copied behind the last disk.
        if self.layers.is_some() { self.places.len() + self.contents.room(9) } else { self.contents.room(9) }
    }

    /// Writes to `found` the disks that `disk` may touch before it leaves its cell, itself included. Returns
    /// their number.
    #[inline(always)]
    pub(super) fn around(&self, disk: usize, found: &mut [u32]) -> usize {
        match &self.layers {
            None => self.around_cell(self.places[disk], found),
            Some(layers) => self.around_in_layers(layers, disk, found),
        }
    }

    /// Writes the disks in the nine cells around a place.
    #[inline(always)]
    fn around_cell(&self, place: Place, found: &mut [u32]) -> usize {
        let center = self.grid.index(place);
        let stride = self.grid.stride;
        let mut count = 0;
        for first in [center - stride - 1, center - 1, center + stride - 1] {
            count = self.contents.gather(first, 1, found, count);
        }
        count
    }

    fn around_in_layers(&self, layers: &Layers, disk: usize, found: &mut [u32]) -> usize {
        let place = self.places[disk];
        if layers.of(disk).is_some() {
            return layers.gather(&self.contents, layers.classes[disk], place, Chosen::InReach, found);
        }
        self.around_cell_in_layers(place, found)
    }

    /// Writes the disks in the nine cells around a place, and the larger disks within reach.
    fn around_cell_in_layers(&self, place: Place, found: &mut [u32]) -> usize {
        let count = self.around_cell(place, found);
        let Some(layers) = &self.layers else { return count };
        layers.gather_visitors(self.grid.index(place), found, count)
    }

    /// Writes to `found` the disks that come within reach of a disk of a larger class when it enters its cell
    /// by `exit`, and some that were within reach before. Returns their number.
    pub(super) fn ahead_of_large(&self, disk: usize, exit: Exit, found: &mut [u32]) -> usize {
        let Some(layers) = &self.layers else { return 0 };
        let (place, (right, up)) = (self.places[disk], exit.direction());
        let (before, _) = self.grid_of(disk).neighbor(place, (-right, -up));
        // If two images of a disk cannot be distinguished, a disk within reach of the last cell may now be
        // met at another image, so all disks within reach are gathered again.
        let chosen = if layers.is_narrow { Chosen::InReach } else { Chosen::Beyond(before) };
        layers.gather(&self.contents, layers.classes[disk], place, chosen, found)
    }

    /// Writes to `found` the disks that come within reach of a disk of the smallest class when it enters its
    /// cell by `exit`. Returns their number.
    #[inline(always)]
    pub(super) fn ahead(&self, disk: usize, exit: Exit, found: &mut [u32]) -> usize {
        self.ahead_of(self.places[disk], exit, found)
    }

    /// Writes to `found` the same disks as [`Self::ahead`], for a disk that has yet to leave its cell by
    /// `exit`.
    #[inline]
    pub(super) fn ahead_of_next(&self, disk: usize, exit: Exit, found: &mut [u32]) -> usize {
        self.ahead_of(self.next_place(disk, exit), exit, found)
    }

    #[inline(always)]
    fn ahead_of(&self, place: Place, exit: Exit, found: &mut [u32]) -> usize {
        let (first, step) = self.three_ahead(place, exit);
        let count = self.contents.gather(first, step, found, 0);
        match &self.layers {
            None => count,
            // There are few larger disks, so filtering out those that were already within reach of the
            // previous cell would not pay.
            Some(layers) => layers.gather_visitors(self.grid.index(place), found, count),
        }
    }

    /// Returns the first of the three cells ahead of a place that a disk enters by `exit`, and the distance
    /// between them in memory.
    #[inline(always)]
    fn three_ahead(&self, place: Place, exit: Exit) -> (usize, usize) {
        let (right, up) = exit.direction();
        let stride = self.grid.stride;
        let middle =
            self.grid.index(place).wrapping_add_signed(right as isize * stride.cast_signed() + up as isize);
        let step = if up == 0 { 1 } else { stride };
        (middle - step, step)
    }

    /// Returns the place of a disk after it has left its cell by `exit`.
    #[inline]
    fn next_place(&self, disk: usize, exit: Exit) -> Place {
        self.grid.neighbor(self.places[disk], exit.direction()).0
    }

    #[inline]
    pub(super) fn prefetch_place(&self, disk: usize) {
        prefetch(&self.places, disk);
    }

    /// Prefetches the nine cells around a disk of the smallest class. Does nothing for larger disks.
    #[inline]
    pub(super) fn prefetch_around(&self, disk: usize) {
        if self.is_large(disk) {
            return;
        }
        let (center, stride) = (self.grid.index(self.places[disk]), self.grid.stride);
        for middle in [center - stride, center, center + stride] {
            self.contents.prefetch(middle - 1);
            self.contents.prefetch(middle + 1);
        }
        self.prefetch_visitors(center);
    }

    #[inline]
    fn prefetch_visitors(&self, cell: usize) {
        if let Some(layers) = &self.layers {
            layers.prefetch_visitors(cell);
        }
    }

    /// Prefetches the cells that a disk leaves and enters by `exit`, and the cells that then come within its
    /// reach.
    #[inline]
    pub(super) fn prefetch_ahead(&self, disk: usize, exit: Exit) {
        let (from, to) = (self.places[disk], self.next_place(disk, exit));
        self.grid.prefetch_region(to);
        let (first, step) = self.three_ahead(to, exit);
        for cell in [self.grid.index(from), self.grid.index(to), first, first + step, first + 2 * step] {
            self.contents.prefetch(cell);
        }
        self.prefetch_visitors(self.grid.index(to));
    }
}
