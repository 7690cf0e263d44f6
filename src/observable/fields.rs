//! Profiles of the packing fraction by height, and density, flow and temperatures on a grid.

use std::f64::consts::PI;

use glam::DVec2;

use super::grid::{CellSums, FreeShares, check_area, check_heights};
use super::table::{ENERGY, table};
use super::{Accumulator, Grid, Snapshot};
use crate::ParameterError;
use crate::boundary::{Domain, Region};
use crate::statistics::Bins;

/// The bin with the largest packing fraction, and the smallest packing fraction below it; made by
/// [`HeightProfile::densest_layer`].
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct DenseLayer {
    /// Height of the middle of the bin.
    pub height: f64,
    /// Packing fraction in the bin.
    pub packing_fraction: f64,
    /// Smallest packing fraction of the bins below, or of the bin itself if it is the lowest.
    pub least_below: f64,
}

impl DenseLayer {
    /// Creates a layer from its height, its packing fraction, and the smallest packing fraction below it.
    pub const fn new(height: f64, packing_fraction: f64, least_below: f64) -> Self {
        Self { height, packing_fraction, least_below }
    }

    /// Returns the densest layer of a profile, or the lowest of several equally dense ones.
    ///
    /// The profile consists of heights and packing fractions, from the bottom up.
    ///
    /// ```
    /// use granular_edmd::observable::DenseLayer;
    /// let layer = DenseLayer::among([(0.5, 0.2), (1.5, 0.1), (2.5, 0.7)]);
    /// assert_eq!(layer, Some(DenseLayer::new(2.5, 0.7, 0.1)));
    /// ```
    pub fn among(profile: impl IntoIterator<Item = (f64, f64)>) -> Option<Self> {
        let mut least = f64::INFINITY;
        let mut densest: Option<Self> = None;
        for (height, packing_fraction) in profile {
            if densest.is_none_or(|layer| packing_fraction > layer.packing_fraction) {
                densest = Some(Self { height, packing_fraction, least_below: least.min(packing_fraction) });
            }
            least = least.min(packing_fraction);
        }
        densest
    }
}

/// The packing fraction by height, averaged over samples.
///
/// The packing fraction $`\phi(y)`$ is the area of the disks between two heights, divided by the area that
/// walls leave free there,
///
/// ```math
/// \phi_k = \Big\langle\sum_i A_i(y_k, y_k + \Delta y)\Big\rangle
/// \Big/ \langle A(y_k, y_k + \Delta y)\rangle.
/// ```
///
/// In a box at rest, the free area is $`L_x\,\Delta y`$; in a vessel of another shape and above a moving
/// floor, [`Boundary::area`](crate::boundary::Boundary::area) gives it. A bin without free area has the
/// packing fraction 0. A run ends with an error if the boundary does not know its area.
///
/// Disks are cut exactly at the edges of bins, so that a profile is smooth even with bins smaller than a
/// diameter. In the paper's box, bins of one diameter resolve a compact layer and average over its rows.
///
/// ```
/// use granular_edmd::boundary::Domain;
/// use granular_edmd::glam::DVec2;
/// use granular_edmd::observable::{Accumulator, HeightProfile, Snapshot};
/// use granular_edmd::Disk;
///
/// let mut profile = HeightProfile::new(0.0, 4.0, 4)?;
/// let disks = [Disk::new(DVec2::new(1.0, 1.5), 0.5)?, Disk::new(DVec2::new(3.0, 2.0), 0.5)?];
/// let domain = Domain::new(0.0, 4.0, 0.0, 6.0);
/// profile.add(&Snapshot::new(1.0, &disks, domain, 0.0));
/// let disk = std::f64::consts::PI / 4.0;
/// let expected = [0.0, 1.5 * disk / 4.0, 0.5 * disk / 4.0, 0.0];
/// assert!(profile.iter().zip(expected).all(|((_, packing), expected)| (packing - expected).abs() < 1e-15));
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct HeightProfile {
    bins: Bins,
    /// Areas of disks divided by the area of the bin, summed over the samples.
    sums: Vec<f64>,
    /// Free shares of the area of the bin, summed over the samples.
    free: Vec<f64>,
    samples: u64,
    #[cfg_attr(feature = "serde", serde(skip))]
    shares: FreeShares,
}

impl HeightProfile {
    /// Creates a profile of `bins` bins from the height `bottom` to `top`.
    ///
    /// Parts of disks outside the profile are left out. A run ends with an error if the whole profile is
    /// outside the domain.
    ///
    /// # Errors
    /// If a height is not finite, `top` is not above `bottom`, or the number of bins is not in `1..=2^20`.
    pub fn new(bottom: f64, top: f64, bins: usize) -> Result<Self, ParameterError> {
        let bins = Bins::new(bottom, top, bins)?;
        let (sums, free) = (vec![0.0; bins.count()], vec![0.0; bins.count()]);
        Ok(Self { bins, sums, free, samples: 0, shares: FreeShares::default() })
    }

    /// Returns the number of samples that were taken.
    pub const fn samples(&self) -> u64 {
        self.samples
    }

    /// Iterates over the heights of the middles of the bins, with the mean packing fractions, which are 0
    /// before the first sample.
    pub fn iter(&self) -> impl Iterator<Item = (f64, f64)> {
        let fraction = |(sum, free): (&f64, &f64)| if *free == 0.0 { 0.0 } else { sum / free };
        let fractions = self.sums.iter().zip(&self.free).map(fraction);
        fractions.enumerate().map(|(bin, fraction)| (self.bins.middle(bin), fraction))
    }

    /// Returns the bin with the largest packing fraction, or `None` before the first sample. If several bins
    /// are equally dense, it is the lowest of them.
    pub fn densest_layer(&self) -> Option<DenseLayer> {
        DenseLayer::among(self.iter().take_while(|_| self.samples > 0))
    }

    fn add_disk(&mut self, height: f64, radius: f64, domain: &Domain) {
        // The free area ends at the edge of the domain, so matter beyond it, such as the image of a disk,
        // must not count either.
        let edge = |bins: &Bins, edge: usize| bins.edge(edge).clamp(domain.bottom, domain.top);
        // A disk outside the profile counts in the first or the last bin, to which it adds no area.
        let first = self.bins.at_or_above(height - radius);
        let last = self.bins.at_or_above(height + radius).min(self.bins.count() - 1);
        let mut below = area_below(edge(&self.bins, first) - height, radius);
        for bin in first..=last {
            let above = area_below(edge(&self.bins, bin + 1) - height, radius);
            self.sums[bin] += (above - below) / (domain.width() * self.bins.width());
            below = above;
        }
    }
}

/// Returns the area of a disk below a line at this height above its center.
fn area_below(height: f64, radius: f64) -> f64 {
    let sine = (height / radius).clamp(-1.0, 1.0);
    radius * radius * (0.5 * PI + libm::asin(sine) + sine * (1.0 - sine * sine).sqrt())
}

/// Returns the regions of the bins.
fn layers(bins: Bins, domain: &Domain) -> impl Iterator<Item = Region> {
    let Domain { left, right, .. } = *domain;
    (0..bins.count())
        .map(move |bin| Region::new(DVec2::new(left, bins.edge(bin)), DVec2::new(right, bins.edge(bin + 1))))
}

impl Accumulator for HeightProfile {
    fn add(&mut self, snapshot: &Snapshot<'_>) -> Result<(), ParameterError> {
        let shares = self.shares.of(snapshot, layers(self.bins, &snapshot.domain()))?;
        self.free.iter_mut().zip(shares).for_each(|(sum, share)| *sum += share);
        let (domain, period) = (snapshot.domain(), snapshot.domain().periods().y);
        // The periodic images provide the areas of disks that extend beyond a periodic end.
        let shifts = [0.0, -period, period].into_iter().take(if period > 0.0 { 3 } else { 1 });
        for disk in snapshot.disks() {
            for shift in shifts.clone() {
                self.add_disk(disk.position().y + shift, disk.radius(), &domain);
            }
        }
        self.samples += 1;
        Ok(())
    }

    fn check(&self, start: &Snapshot<'_>) -> Result<(), ParameterError> {
        check_heights(&self.bins, &start.domain())?;
        let domain = start.domain();
        check_area(&domain.region(), layers(self.bins, &domain), start)
    }
}

table! { HeightProfile, this: for (height, fraction) in this.iter();
    "height" ["length"]: height,
    "packing_fraction" ["1"]: fraction
}

crate::gate::from_file! {
    HeightProfile { bins: Bins, sums: Vec<f64>, free: Vec<f64>, samples: u64 } => {
        bins.check_count(sums.len())?;
        bins.check_count(free.len())?;
        Ok(Self { bins, sums, free, samples, shares: FreeShares::default() })
    }
}

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
        let shares = self.shares.of(snapshot, self.grid.cells())?;
        self.free.iter_mut().zip(shares).for_each(|(sum, share)| *sum += share);
        for disk in snapshot.disks() {
            if let Some(cell) = self.grid.cell_of(disk, &snapshot.domain()) {
                self.sums[cell].add(disk);
            }
        }
        self.samples += 1;
        Ok(())
    }

    fn check(&self, start: &Snapshot<'_>) -> Result<(), ParameterError> {
        self.grid.check_against(&start.domain())?;
        check_area(&start.domain().region(), self.grid.cells(), start)
    }
}

table! { Fields, this: for cell in this.iter();
    "x" ["length"]: cell.center.x,
    "y" ["length"]: cell.center.y,
    "count" ["1"]: cell.count as f64,
    "number_density" ["1/length^2"]: cell.number_density,
    "packing_fraction" ["1"]: cell.packing_fraction,
    "velocity_x" ["length/time"]: cell.velocity.x,
    "velocity_y" ["length/time"]: cell.velocity.y,
    "angular_velocity" ["1/time"]: cell.angular_velocity,
    "translational_temperature" [ENERGY]: cell.translational_temperature,
    "rotational_temperature" [ENERGY]: cell.rotational_temperature
}

crate::gate::from_file! {
    Fields { grid: Grid, sums: Vec<CellSums>, free: Vec<f64>, samples: u64 } => {
        for given in [sums.len(), free.len()] {
            let requirement = "the number of cells";
            crate::quantity::accept(grid.count() == given, "number of sums", requirement, given as f64)?;
        }
        Ok(Self { grid, sums, free, samples, shares: FreeShares::default() })
    }
}
