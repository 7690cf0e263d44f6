//! Disks of several sizes: the smallest class has the cells of the engine, each larger one a layer of its own above them.

use super::cell_size::CellSize;
use super::grid::{Grid, LEAST_PITCH, Layout, Place};
use super::layer::{Layer, LayerLayout, gather};
use super::reach::{Distances, Homes, Reach};
use super::size_class::{SizeClass, class_of, classes, together};
use crate::boundary::{Boundary, Domain};

/// Cells per disk of the smallest class at most.
const CELLS_PER_SMALL_DISK: f64 = 6.0;

/// Cells of the smallest class that are always allowed.
const SPARE_SMALL_CELLS: f64 = 64.0;

/// The layers of all classes but the smallest.
#[derive(Debug, Clone)]
pub(super) struct Layers {
    /// Class of each disk.
    classes: Vec<u8>,
    larger: Vec<Layer>,
    /// For each layer, its homes that a disk of the smallest class may touch.
    upward: Vec<Reach>,
}

/// Returns the layouts of the cells of these classes; `None` if the domain is too narrow for them.
pub(super) fn layouts(
    domain: &Domain,
    classes: &[SizeClass],
    cell_size: CellSize,
    highest: f64,
) -> Option<Layouts> {
    let SizeClass { largest: diameter, count, .. } = classes[0];
    // Large disks look into many of these cells: fewer than where all disks have the same.
    let most = CELLS_PER_SMALL_DISK * count as f64 + SPARE_SMALL_CELLS;
    let smallest = Layout::new(domain, diameter, cell_size, most, highest)?;
    let grid = Grid::new(domain, smallest, diameter);
    let layout = |class: usize| {
        let layout = LayerLayout::new(domain, classes, class, cell_size, highest)?;
        let widest = widest(domain, &grid, diameter, classes[class].largest);
        if domain.periodic { layout.narrower(widest) } else { Some(layout) }
    };
    let larger: Option<Vec<LayerLayout>> = (1..classes.len()).map(layout).collect();
    Some(Layouts { smallest, larger: larger? })
}

/// Returns how wide a cell of a class may be at periodic sides.
///
/// Two disks meet at the image that is nearest now, if both can move in their cells and no other image comes nearer: their
/// distance now is at most that at which they touch and the widths of both cells, and that must be less than half a period.
pub(super) fn widest(domain: &Domain, grid: &Grid, smallest: f64, diameter: f64) -> f64 {
    let half = 0.5 * domain.width();
    let small_cell = grid.layout.pitch.x + 2.0 * grid.margin().x;
    let beside_equal = 0.5 * (half - LEAST_PITCH * diameter);
    let beside_small = half - 0.5 * LEAST_PITCH * (diameter + smallest) - small_cell;
    beside_equal.min(beside_small)
}

impl Layers {
    /// The layers of these layouts, without disks.
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
            // Less, by more than the depth to which rounding can press disks into each other.
            least: 0.5 / LEAST_PITCH * (classes[a].smallest + classes[b].smallest),
        };
        let homes = |class: usize| match class {
            0 => homes_of(grid),
            class => larger[class - 1].homes(),
        };
        let reach = |from: &Grid, a: usize, b: usize| Reach::new(from, &homes(b), distances(a, b));
        let upward = (1..classes.len()).map(|class| reach(grid, 0, class)).collect();
        let among = |a: usize| (0..classes.len()).map(|b| reach(&larger[a - 1].grid, a, b)).collect();
        let reaches: Vec<Vec<Reach>> = (1..classes.len()).map(among).collect();
        for (layer, reaches) in larger.iter_mut().zip(reaches) {
            layer.set_reaches(reaches);
        }
        Self { classes: diameters.map(|diameter| class_of(classes, diameter)).collect(), larger, upward }
    }

    pub(super) fn mark_walls<B: Boundary + ?Sized>(&mut self, boundary: &B, classes: &[SizeClass]) {
        for (layer, class) in self.larger.iter_mut().zip(&classes[1..]) {
            layer.mark_walls(boundary, 0.5 * class.largest);
        }
    }

    #[cfg(feature = "serde")]
    pub(super) fn layouts(&self) -> Vec<LayerLayout> {
        self.larger.iter().map(|layer| layer.layout).collect()
    }

    /// Returns the layer of a disk; `None` for the smallest class.
    #[inline]
    pub(super) fn of(&self, disk: usize) -> Option<&Layer> {
        self.larger.get(usize::from(self.classes[disk]).wrapping_sub(1))
    }

    pub(super) fn of_mut(&mut self, disk: usize) -> Option<&mut Layer> {
        self.larger.get_mut(usize::from(self.classes[disk]).wrapping_sub(1))
    }

    /// Appends the larger disks that one of the smallest class may touch to those found.
    pub(super) fn gather_above(&self, place: Place, found: &mut [u32], mut count: usize) -> usize {
        for (layer, reach) in self.larger.iter().zip(&self.upward) {
            count = layer.gather(reach, place, found, count);
        }
        count
    }

    /// Writes the disks that one of a layer may touch to `found`; returns how many.
    pub(super) fn gather_around(
        &self,
        layer: &Layer,
        smallest: &super::Contents,
        place: Place,
        found: &mut [u32],
    ) -> usize {
        let mut count = gather(smallest, layer.reach(0), place, found, 0);
        for (class, other) in self.larger.iter().enumerate() {
            count = other.gather(layer.reach(class + 1), place, found, count);
        }
        count
    }
}

/// The cells of the smallest class, each the home of its disks.
fn homes_of(grid: &Grid) -> Homes<'_> {
    Homes { grid, cells: 1, stride: grid.stride(), first: grid.stride() + 1 }
}

/// The layouts of all cells: what a run must keep to go on with the same bits.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(in crate::simulation) struct Layouts {
    /// The cells of the smallest class.
    pub(in crate::simulation) smallest: Layout,
    /// The layers of the larger ones; none if all disks share the same cells.
    pub(in crate::simulation) larger: Vec<LayerLayout>,
}

impl Layouts {
    /// Returns the classes of disks that have cells of their own; `None` if there are not as many layers.
    pub(in crate::simulation) fn classes(
        &self,
        domain: &Domain,
        diameters: impl Iterator<Item = f64>,
    ) -> Option<Vec<SizeClass>> {
        let classes = classes(diameters);
        if self.larger.is_empty() {
            // Any cells do without disks.
            let any = 0.125 * domain.width();
            let nobody = SizeClass { largest: any, smallest: any, count: 0 };
            return Some(vec![together(&classes).unwrap_or(nobody)]);
        }
        (classes.len() == self.larger.len() + 1).then_some(classes)
    }
}

/// The grids of all classes of disks, and the class of each.
#[cfg(feature = "serde")]
pub(in crate::simulation) struct Grids {
    grids: Vec<Grid>,
    classes: Vec<u8>,
}

#[cfg(feature = "serde")]
impl Grids {
    pub(in crate::simulation) fn new(
        domain: &Domain,
        layouts: &Layouts,
        classes: &[SizeClass],
        diameters: impl Iterator<Item = f64>,
    ) -> Self {
        let smallest = Grid::new(domain, layouts.smallest, classes[0].largest);
        let larger = layouts.larger.iter().map(|layer| Grid::without_margin(domain, layer.cells));
        let classes = diameters.map(|diameter| class_of(classes, diameter)).collect();
        Self { grids: std::iter::once(smallest).chain(larger).collect(), classes }
    }

    pub(in crate::simulation) fn class(&self, disk: usize) -> u8 {
        self.classes[disk]
    }

    /// Returns the grid in which a disk is.
    pub(in crate::simulation) fn of(&self, disk: usize) -> &Grid {
        &self.grids[usize::from(self.classes[disk])]
    }
}
