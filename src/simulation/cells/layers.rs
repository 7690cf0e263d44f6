//! Layers of cells for disks of several sizes.
//!
//! The smallest class has the cells of the engine, and each larger class has a layer above them. The picture
//! shows a large disk over the homes of a smaller class, one character for each home:
//!
//! ```text
//!     . . . . . . . . . . .     c  the cell of the large disk: its center is somewhere in it
//!     . r r r r r r r r r .     r  the reach of that cell: a small disk that touches the large
//!     . r r r r r r r r r .        one has its center in one of these homes
//!     . r r o o o o o r r .     o  the hole in the reach: these homes lie inside the large disk,
//!     . r r o o o o o r r .        wherever in its cell it is, so no small disk can be there
//!     . r r o o c o o r r .
//!     . r r o o o o o r r .     The home of the large disk is not drawn. It is about as large as
//!     . r r o o o o o r r .     the disk, and consists of a power of two of cells along each side.
//!     . r r r r r r r r r .     Disks of the same and of larger classes look for it there.
//!     . r r r r r r r r r .
//!     . . . . . . . . . . .
//! ```
//!
//! A disk keeps its partners until it leaves its cell, and others look for it in its home. In the smallest
//! class, cell and home are the same. A large disk needs both. With a home alone, it would have to predict
//! its collisions with the thousands of small disks that it could touch from anywhere in the home. With cells
//! as small as `c` alone, the others would have too many cells to search.
//!
//! The two disks of a pair must find each other, whichever of them searches. The large disk searches the
//! homes within its reach. The small disk cannot search for large ones, since too many cells of the larger
//! classes reach its home. Each home therefore keeps a list of *visitors*, the larger disks in whose reach it
//! lies. When the large disk enters the next cell, only the rims of the reach and of the hole change. The
//! lists are brought up to date there, and only the small disks there are new partners.

use glam::DVec2;

use super::contents::Contents;
use super::grid::{Grid, Place};
use super::layer::{Layer, LayerLayout, widest};
use super::layout::{CellSize, LEAST_PITCH, Layout, SPARE_SMALL_CELLS, SizeClass, class_of};
use super::reach::{Distances, Homes, Reach};
use crate::boundary::{Boundary, Domain};

/// Returns the largest number of cells for each disk of the smallest class.
///
/// Few cells are best in a dilute gas, but they are too few where disks crowd in a part of the domain. The
/// two numbers are so close that a run does not go back and forth between the sizes of cells.
const fn cells_per_small_disk(cell_size: CellSize) -> f64 {
    match cell_size {
        CellSize::Small | CellSize::Medium => 6.0,
        CellSize::Large => 2.0,
    }
}

/// The layers of all classes but the smallest.
#[derive(Debug, Clone)]
pub(super) struct Layers {
    /// Class of each disk. While a disk is being added, it is not in its cell yet; while a disk is being
    /// removed, it is not in its cell any more.
    pub(super) classes: Vec<u8>,
    larger: Vec<Layer>,
    /// The visitors of each home of each class, the smallest class first: the larger disks that reach the
    /// home from their cells.
    visitors: Vec<Contents>,
    /// True if a disk that enters another cell must examine all partners again.
    pub(super) is_narrow: bool,
}

/// Returns the layouts of the cells of these classes; `None` if the domain is too narrow for them.
pub(super) fn layouts(
    domain: &Domain,
    classes: &[SizeClass],
    cell_size: CellSize,
    highest: f64,
) -> Option<Layouts> {
    let SizeClass { largest: diameter, count, .. } = classes[0];
    // Large disks search many of these cells, so there are fewer cells than if all disks had the same size.
    let most = cells_per_small_disk(cell_size) * count as f64 + SPARE_SMALL_CELLS;
    let smallest = Layout::new(domain, diameter, cell_size, most, highest)?;
    let grid = Grid::new(domain, smallest, diameter);
    let layout = |class: usize| {
        let layout = LayerLayout::new(domain, classes, class, cell_size, highest)?;
        layout.narrower(widest(domain, &grid, diameter, classes[class].largest))
    };
    // If one class has no room for cells that are narrow enough, no class gets a layer: all disks then share
    // the cells of the largest, which is slow but correct.
    let larger: Option<Vec<LayerLayout>> = (1..classes.len()).map(layout).collect();
    Some(Layouts { smallest, larger: larger?, classes: classes.to_vec() })
}

impl Layers {
    /// Creates the layers of these layouts, without disks.
    pub(super) fn empty(
        domain: &Domain,
        grid: &Grid,
        classes: &[SizeClass],
        layouts: &[LayerLayout],
        diameters: impl Iterator<Item = f64>,
    ) -> Self {
        let mut larger: Vec<Layer> = layouts.iter().map(|&layout| Layer::empty(domain, layout)).collect();
        let distances = |a: usize, b: usize| Distances {
            most: 0.5 * LEAST_PITCH * (classes[a].largest + classes[b].largest),
            // The smallest distance is below the distance of a touch, with an allowance for overlaps by
            // rounding. Within a class there is no hole, since a home is too large to fit inside a disk.
            least: if a == b { 0.0 } else { 0.5 / LEAST_PITCH * (classes[a].smallest + classes[b].smallest) },
        };
        let homes = |class: usize| match class {
            // In the smallest class, cell and home are the same.
            0 => Homes { grid, cells: 1, stride: grid.stride, first: grid.stride + 1 },
            class => larger[class - 1].homes(),
        };
        let reach = |a: usize, b: usize| Reach::new(&larger[a - 1].grid, &homes(b), distances(a, b));
        let among = |a: usize| (0..=a).map(|b| reach(a, b)).collect();
        let reaches: Vec<Vec<Reach>> = (1..classes.len()).map(among).collect();
        let visitors = std::iter::once(grid.len()).chain(larger.iter().map(Layer::len)).map(Contents::empty);
        let visitors = visitors.collect();
        let is_narrow = !are_homes_narrow(domain, &larger, classes);
        for (layer, reaches) in larger.iter_mut().zip(reaches) {
            layer.reaches = reaches;
        }
        let classes = diameters.map(|diameter| class_of(classes, diameter)).collect();
        Self { classes, larger, visitors, is_narrow }
    }

    pub(super) fn mark_walls(&mut self, boundary: &dyn Boundary, classes: &[SizeClass]) {
        for (layer, class) in self.larger.iter_mut().zip(&classes[1..]) {
            layer.mark_walls(boundary, 0.5 * class.largest);
        }
    }

    #[cfg(feature = "serde")]
    pub(super) fn layouts(&self) -> Vec<LayerLayout> {
        self.larger.iter().map(|layer| layer.layout).collect()
    }

    /// Returns the layer of a disk, or `None` for a disk of the smallest class.
    #[inline]
    pub(super) fn of(&self, disk: usize) -> Option<&Layer> {
        self.of_class(self.classes[disk])
    }

    /// Returns the layer of a class, or `None` for the smallest class.
    #[inline]
    pub(super) fn of_class(&self, class: u8) -> Option<&Layer> {
        self.larger.get(usize::from(class).wrapping_sub(1))
    }

    /// Writes a disk of a larger class into its home and into all homes that it reaches, or removes the disk
    /// from all these homes.
    pub(super) fn change(&mut self, disk: usize, place: Place, change: impl Fn(&mut Contents, usize, usize)) {
        let Some(layer) = self.larger.get_mut(usize::from(self.classes[disk]).wrapping_sub(1)) else {
            return;
        };
        let home = layer.home(place);
        change(&mut layer.contents, home, disk);
        for (visitors, reach) in self.visitors.iter_mut().zip(layer.reaches().0) {
            reach.for_each_run(place, |first, count| {
                (first..first + count).for_each(|home| change(visitors, home, disk));
            });
        }
    }

    /// Moves a disk of a larger class from one cell to another.
    pub(super) fn cross(&mut self, disk: usize, from: Place, to: Place) {
        let Some(layer) = self.larger.get_mut(usize::from(self.classes[disk]).wrapping_sub(1)) else {
            return;
        };
        layer.cross(disk, from, to);
        // Homes in both reaches keep the disk. At the rims of the reach and of the hole, some homes leave the
        // reach and others enter it, so both differences are needed.
        for (visitors, reach) in self.visitors.iter_mut().zip(layer.reaches().0) {
            reach.for_each_run_beyond(from, to, |first, count| {
                (first..first + count).for_each(|home| visitors.remove(home, disk));
            });
            reach.for_each_run_beyond(to, from, |first, count| {
                (first..first + count).for_each(|home| visitors.push(home, disk));
            });
        }
    }

    /// Appends to `found` the larger disks that a disk of the smallest class in this cell may touch.
    #[inline(always)]
    pub(super) fn gather_visitors(&self, cell: usize, found: &mut [u32], count: usize) -> usize {
        self.visitors[0].gather_cell(cell, found, count)
    }

    /// Prefetches the data that [`Self::gather_visitors`] needs.
    pub(super) fn prefetch_visitors(&self, cell: usize) {
        self.visitors[0].prefetch(cell);
    }

    /// Writes to `found` all disks that a disk of this larger class at this place may meet, or only those of
    /// a choice of the homes of smaller disks. Returns their number.
    pub(super) fn gather(
        &self,
        smallest: &Contents,
        class: u8,
        place: Place,
        chosen: Chosen,
        found: &mut [u32],
    ) -> usize {
        let Some(layer) = self.of_class(class) else { return 0 };
        let (smaller, own) = layer.reaches();
        let mut count = 0;
        let contents = std::iter::once(smallest).chain(self.larger.iter().map(|layer| &layer.contents));
        for (contents, reach) in contents.zip(smaller) {
            let act = |first, homes| count = contents.gather_run(first, homes, found, count);
            match chosen {
                Chosen::InReach => reach.for_each_run(place, act),
                Chosen::Beyond(before) => reach.for_each_run_beyond(place, before, act),
                Chosen::AlsoInside => reach.for_each_run_and_hole(place, act),
            }
        }
        // Disks of the same class are few and near. Finding out which of them are new would cost more than
        // gathering them all.
        if let Some(own) = own {
            own.for_each_run(place, |first, homes| {
                count = layer.contents.gather_run(first, homes, found, count);
            });
        }
        // Disks of larger classes are visitors of this disk's home, as they are of the homes of the smallest
        // class.
        self.visitors[usize::from(class)].gather_cell(layer.home(place), found, count)
    }
}

/// The homes of smaller disks that are gathered.
#[derive(Clone, Copy)]
pub(super) enum Chosen {
    /// All within reach, except those that lie inside the disk.
    InReach,
    /// Those within reach that were not within reach of another place.
    Beyond(Place),
    /// All within reach, and those that lie inside the disk.
    AlsoInside,
}

/// Returns whether a disk in its home and a disk of a larger class in its cell are less than half a period
/// apart as long as they are within each other's reach. In that case, they keep meeting at the same image.
fn are_homes_narrow(domain: &Domain, larger: &[Layer], classes: &[SizeClass]) -> bool {
    let touching = |a: usize, b: usize| 0.5 * LEAST_PITCH * (classes[a + 1].largest + classes[b + 1].largest);
    let half = 0.5 * domain.periods();
    let is_narrow = |a: usize, b: usize| {
        let apart = larger[a].layout.home_size() + larger[b].layout.cells.pitch + touching(a, b);
        (half.cmpeq(DVec2::ZERO) | apart.cmplt(half)).all()
    };
    (1..larger.len()).all(|b| (0..b).all(|a| is_narrow(a, b)))
}

/// The layouts of all cells, which a run must keep in order to continue with the same bits.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(in crate::simulation) struct Layouts {
    /// The cells of the smallest class.
    pub(in crate::simulation) smallest: Layout,
    /// The layers of the larger classes; empty if all disks share the same cells.
    pub(in crate::simulation) larger: Vec<LayerLayout>,
    /// The classes of disks that have separate cells.
    pub(in crate::simulation) classes: Vec<SizeClass>,
}
