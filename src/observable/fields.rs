//! Density, flow and temperatures on a grid.

use glam::DVec2;

use super::free_shares::{FreeShares, check_area};
use super::grid::CellSums;
use super::table::{ENERGY, Table, headings};
use super::{Accumulator, Grid, Heading, Snapshot};
use crate::ParameterError;

/// The fields in one cell of a grid, averaged over all samples; made by [`Fields`].
///
/// In a cell where no disk was seen, everything but the center is 0.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct FieldCell {
    /// Middle of the cell.
    pub center: DVec2,
    /// Number of disks seen in the cell, over all samples.
    pub count: u64,
    /// Number of disks divided by the area that walls leave free.
    pub number_density: f64,
    /// Area of the disks divided by the area that walls leave free.
    ///
    /// Each disk counts in the cell of its center.
    pub packing_fraction: f64,
    /// Velocity of the flow, u = ⟨m v⟩/⟨m⟩.
    pub velocity: DVec2,
    /// Mean angular velocity, ⟨I ω⟩/⟨I⟩.
    pub angular_velocity: f64,
    /// Translational temperature, T = ½⟨m|v − u|²⟩, per degree of freedom and about the flow.
    pub translational_temperature: f64,
    /// Rotational temperature, T_rot = ⟨I(ω − ω̄)²⟩, about the mean angular velocity.
    pub rotational_temperature: f64,
}

/// Density, flow and temperatures on a grid, averaged over samples: for example, to show convection rolls.
///
/// A disk counts in the cell of its center. Densities refer to the free part of a cell, which
/// [`Boundary::area`](crate::boundary::Boundary::area) gives at each sample; a run ends with an error if the
/// boundary does not know it. Temperatures are taken about the mean velocity *of the cell*, over all samples.
/// A flow that changes between samples, such as a roll that reverses, counts as temperature. If $`n`$ disks
/// are seen in a cell in independent samples, its temperatures are too small by a factor $`1 - 1/n`$.
///
/// ```
/// use granular_edmd::boundary::{Domain, Region};
/// use granular_edmd::glam::DVec2;
/// use granular_edmd::observable::{Accumulator, Fields, Grid, Snapshot};
/// use granular_edmd::Disk;
///
/// let region = Region::new(DVec2::ZERO, DVec2::new(4.0, 2.0));
/// let mut fields = Fields::new(Grid::new(region, 2, 1)?);
/// let disk = |x, vx| Disk::new(DVec2::new(x, 1.0), 0.4)?.with_velocity(DVec2::new(vx, 0.0));
/// let disks = [disk(0.5, 1.0)?, disk(1.5, 3.0)?];
/// let domain = Domain::new(0.0, 4.0, 0.0, 2.0);
/// fields.add(&Snapshot::new(1.0, &disks, domain, 0.0));
/// let left = fields.cell(0, 0).unwrap();
/// assert_eq!((left.number_density, left.velocity.x, left.translational_temperature), (0.5, 2.0, 0.5));
/// assert_eq!(fields.cell(1, 0).unwrap().count, 0);
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Fields {
    grid: Grid,
    sums: Vec<CellSums>,
    /// Free shares of the cells, summed over the samples.
    free: Vec<f64>,
    samples: u64,
    #[cfg_attr(feature = "serde", serde(skip))]
    shares: FreeShares,
}

impl Fields {
    /// Creates fields over the cells of a grid.
    ///
    /// Disks outside the grid are left out. A run ends with an error if the whole grid is outside the domain.
    pub fn new(grid: Grid) -> Self {
        let (sums, free) = (vec![CellSums::default(); grid.count()], vec![0.0; grid.count()]);
        Self { grid, sums, free, samples: 0, shares: FreeShares::default() }
    }

    /// Returns the number of samples that were taken.
    pub const fn samples(&self) -> u64 {
        self.samples
    }

    /// Returns the grid.
    pub const fn grid(&self) -> &Grid {
        &self.grid
    }

    /// Returns the fields in a cell, or `None` outside the grid.
    ///
    /// Columns are counted from the left, and rows from below.
    pub fn cell(&self, column: usize, row: usize) -> Option<FieldCell> {
        let (columns, rows) = self.grid.shape();
        let inside = column < columns && row < rows;
        inside.then(|| self.averaged(column, row))
    }

    /// Iterates over the fields in all cells, row by row from below.
    pub fn iter(&self) -> impl Iterator<Item = FieldCell> {
        let (columns, rows) = self.grid.shape();
        (0..rows).flat_map(move |row| (0..columns).map(move |column| self.averaged(column, row)))
    }

    /// Forgets all samples so far.
    pub fn clear(&mut self) {
        self.sums.fill(CellSums::default());
        self.free.fill(0.0);
        self.samples = 0;
    }

    fn averaged(&self, column: usize, row: usize) -> FieldCell {
        let size = self.grid.cell_size();
        let cell = row * self.grid.shape().0 + column;
        let CellSums { count, area, velocity: [x, y], angular_velocity } = self.sums[cell];
        // A cell without free area holds no disks.
        let free = if self.free[cell] == 0.0 { 1.0 } else { self.free[cell] };
        let seen = size.x * size.y * free;
        let disks = count.max(1) as f64;
        FieldCell {
            center: self.grid.center(column, row),
            count,
            number_density: count as f64 / seen,
            packing_fraction: area / seen,
            velocity: DVec2::new(x.mean, y.mean),
            angular_velocity: angular_velocity.mean,
            translational_temperature: 0.5 * (x.squares + y.squares) / disks,
            rotational_temperature: angular_velocity.squares / disks,
        }
    }
}

impl Accumulator for Fields {
    fn add(&mut self, snapshot: &Snapshot<'_>) -> Result<(), ParameterError> {
        self.shares.check(snapshot, self.grid.cells())?;
        for disk in snapshot.disks() {
            if let Some(cell) = self.grid.cell_of(disk, &snapshot.domain()) {
                self.sums[cell].add(disk);
            }
        }
        let shares = self.shares.of(snapshot, self.grid.cells());
        self.free.iter_mut().zip(shares).for_each(|(sum, share)| *sum += share);
        self.samples += 1;
        Ok(())
    }

    fn check(&self, start: &Snapshot<'_>) -> Result<(), ParameterError> {
        self.grid.check_against(&start.domain())?;
        check_area(&start.domain().region(), self.grid.cells(), start)
    }
}

impl Table for Fields {
    fn headings(&self) -> Vec<Heading> {
        let places = [
            ("x", "length"),
            ("y", "length"),
            ("count", "1"),
            ("number_density", "1/length^2"),
            ("packing_fraction", "1"),
        ];
        let motions =
            [("velocity_x", "length/time"), ("velocity_y", "length/time"), ("angular_velocity", "1/time")];
        let temperatures = [("translational_temperature", ENERGY), ("rotational_temperature", ENERGY)];
        headings(&[&places[..], &motions, &temperatures].concat(), &[])
    }

    fn rows(&self) -> Box<dyn Iterator<Item = Vec<f64>> + '_> {
        Box::new(self.iter().map(|cell| {
            let FieldCell { center, velocity, .. } = cell;
            let places = [center.x, center.y, cell.count as f64, cell.number_density, cell.packing_fraction];
            let motions = [velocity.x, velocity.y, cell.angular_velocity];
            let temperatures = [cell.translational_temperature, cell.rotational_temperature];
            [&places[..], &motions, &temperatures].concat()
        }))
    }
}

crate::gate::from_file! {
    Fields { grid: Grid, sums: Vec<CellSums>, free: Vec<f64>, samples: u64 } => {
        for given in [sums.len(), free.len()] {
            let requirement = "the number of cells";
            crate::quantity::accept(grid.count() == given, "number of sums", requirement, given as f64)?;
        }
        sums.iter().try_for_each(CellSums::check)?;
        free.iter().try_for_each(|&share| crate::quantity::non_negative("free share", share).map(drop))?;
        Ok(Self { grid, sums, free, samples, shares: FreeShares::default() })
    }
}
