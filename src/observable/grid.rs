//! Grids of cells, the sums over the disks in each cell, and the shares of regions that walls leave free.

use glam::DVec2;

use super::Snapshot;
use super::snapshot::Mark;
use crate::boundary::{Domain, Region};
use crate::quantity::{accept, finite};
use crate::statistics::{Bins, RunningMean};
use crate::{Disk, ParameterError};

/// Largest number of cells of a grid.
const MOST_CELLS: usize = 1 << 22;

/// Equal cells over a region, in columns and rows.
///
/// A disk is in the cell of its center.
///
/// ```
/// use granular_edmd::boundary::Region;
/// use granular_edmd::glam::DVec2;
/// use granular_edmd::observable::Grid;
///
/// let grid = Grid::new(Region::new(DVec2::ZERO, DVec2::new(4.0, 2.0)), 4, 1)?;
/// assert_eq!((grid.shape(), grid.cell_size()), ((4, 1), DVec2::new(1.0, 2.0)));
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Grid {
    region: Region,
    columns: usize,
    rows: usize,
}

impl Grid {
    /// Creates a grid of `columns` times `rows` cells over a region.
    ///
    /// # Errors
    /// If an edge of the region is not finite, the region has no area, or the number of cells is not in
    /// `1..=2^22`.
    pub fn new(region: Region, columns: usize, rows: usize) -> Result<Self, ParameterError> {
        checked_region(region)?;
        let grid = Self { region, columns, rows };
        let cells = columns.saturating_mul(rows);
        accept((1..=MOST_CELLS).contains(&cells), "number of cells", "in 1..=2^22", cells as f64)?;
        let cell = grid.cell_size();
        accept((cell.x * cell.y).is_normal(), "area of a cell", "finite and positive", cell.x * cell.y)?;
        Ok(grid)
    }

    /// Returns the number of columns and rows.
    pub const fn shape(&self) -> (usize, usize) {
        (self.columns, self.rows)
    }

    /// Returns the width and the height of a cell.
    pub fn cell_size(&self) -> DVec2 {
        (self.region.max - self.region.min) / DVec2::new(self.columns as f64, self.rows as f64)
    }

    /// Returns the number of cells.
    pub(super) const fn count(&self) -> usize {
        self.columns * self.rows
    }

    /// Returns the middle of a cell.
    pub(super) fn center(&self, column: usize, row: usize) -> DVec2 {
        self.region.min + self.cell_size() * DVec2::new(column as f64 + 0.5, row as f64 + 0.5)
    }

    /// Returns the regions of the cells, row by row from below.
    pub(super) fn cells(&self) -> impl Iterator<Item = Region> + use<> {
        let (grid, half) = (*self, 0.5 * self.cell_size());
        let centers =
            (0..grid.rows).flat_map(move |row| (0..grid.columns).map(move |column| grid.center(column, row)));
        centers.map(move |center| Region::new(center - half, center + half))
    }

    /// Returns the cell that holds this position, counted row by row from below.
    pub(super) fn find(&self, position: DVec2) -> Option<usize> {
        let scaled = (position - self.region.min) / self.cell_size();
        let cells = Region::new(DVec2::ZERO, DVec2::new(self.columns as f64, self.rows as f64));
        cells.contains(scaled).then(|| scaled.y as usize * self.columns + scaled.x as usize)
    }

    /// Returns the cell that holds a disk. A disk exactly on the right or the upper side of a periodic domain
    /// is at the other side, too.
    pub(super) fn cell_of(&self, disk: &Disk, domain: &Domain) -> Option<usize> {
        self.find(disk.position()).or_else(|| self.find(domain.folded(disk.position())))
    }

    /// Checks that some of the cells lie inside the domain of a run. Otherwise, the run would measure
    /// nothing.
    pub(super) fn check_against(&self, domain: &Domain) -> Result<(), ParameterError> {
        let Region { min, max, .. } = self.region;
        meets("left edge of the grid", [min.x, max.x], [domain.left, domain.right])?;
        meets("lower edge of the grid", [min.y, max.y], [domain.bottom, domain.top])
    }

    /// Returns the sums over the disks in each cell.
    pub(super) fn sums(&self, snapshot: &Snapshot<'_>) -> Vec<CellSums> {
        let mut sums = vec![CellSums::default(); self.count()];
        for disk in snapshot.disks() {
            if let Some(cell) = self.cell_of(disk, &snapshot.domain()) {
                sums[cell].add(disk);
            }
        }
        sums
    }
}

/// Checks that a range overlaps another one, with an error that names the range's lower end.
fn meets(name: &'static str, [low, high]: [f64; 2], [from, to]: [f64; 2]) -> Result<(), ParameterError> {
    let requirement = "such that part of the measured region is inside the domain";
    accept(low < to && high > from, name, requirement, low).map(|_| ())
}

/// Checks that a part of a profile by height lies inside the domain of a run.
pub(super) fn check_heights(bins: &Bins, domain: &Domain) -> Result<(), ParameterError> {
    let heights = [bins.edge(0), bins.edge(bins.count())];
    meets("bottom of the profile", heights, [domain.bottom, domain.top])
}

/// Returns the region, or an error if it is not finite or has no area.
pub(super) fn checked_region(region: Region) -> Result<Region, ParameterError> {
    let Region { min, max, .. } = region;
    let edges = [min.x, min.y, max.x, max.y];
    edges.into_iter().try_for_each(|edge| finite("edge of the region", edge).map(|_| ()))?;
    let size = max - min;
    let area = if size.min_element() > 0.0 { size.x * size.y } else { 0.0 };
    accept(area.is_normal(), "area of the region", "finite and positive", area)?;
    Ok(region)
}

/// Returns the region, or an error if it does not lie inside the domain of a run.
pub(super) fn inside(region: Region, domain: &Domain) -> Result<Region, ParameterError> {
    let (Region { min, max, .. }, Domain { left, right, bottom, top, .. }) = (region, *domain);
    for (edge, is_inside) in
        [(min.x, min.x >= left), (max.x, max.x <= right), (min.y, min.y >= bottom), (max.y, max.y <= top)]
    {
        accept(is_inside, "edge of the region", "inside the domain", edge)?;
    }
    Ok(region)
}

/// Returns whether a region holds the center of a disk, which may lie exactly on an edge of a periodic
/// domain.
pub(super) fn holds(region: &Region, domain: &Domain, disk: &Disk) -> bool {
    region.contains(domain.folded(disk.position()))
}

/// Reads an optional region from a file, and checks it with [`checked_region`].
#[cfg(feature = "serde")]
pub(super) fn region_from_file<'de, D: serde::Deserializer<'de>>(
    file: D,
) -> Result<Option<Region>, D::Error> {
    let region: Option<Region> = serde::Deserialize::deserialize(file)?;
    region.map(checked_region).transpose().map_err(serde::de::Error::custom)
}

/// Sums over the disks seen in a cell.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub(super) struct CellSums {
    pub(super) count: u64,
    pub(super) area: f64,
    /// Components of the velocity, weighted by mass.
    pub(super) velocity: [RunningMean; 2],
    /// Angular velocity, weighted by moment of inertia.
    pub(super) angular_velocity: RunningMean,
}

impl CellSums {
    pub(super) fn add(&mut self, disk: &Disk) {
        self.count += 1;
        self.area += std::f64::consts::PI * disk.radius() * disk.radius();
        self.velocity[0].push_weighted(disk.velocity().x, disk.mass());
        self.velocity[1].push_weighted(disk.velocity().y, disk.mass());
        self.angular_velocity.push_weighted(disk.angular_velocity(), disk.moment_of_inertia());
    }

    /// Returns the velocity of the flow.
    pub(super) const fn flow(&self) -> DVec2 {
        DVec2::new(self.velocity[0].mean, self.velocity[1].mean)
    }
}

crate::gate::from_file! {
    Grid { region: Region, columns: usize, rows: usize } => Self::new(region, columns, rows)
}

/// The free shares of several regions. They are kept as long as no wall has moved.
///
/// They are not part of the measurement: no file holds them, and any two values of this type compare equal.
#[derive(Debug, Clone, Default)]
pub(super) struct FreeShares {
    walls: Mark,
    time: f64,
    points: Option<Vec<DVec2>>,
    shares: Vec<f64>,
}

impl FreeShares {
    /// Returns the share of each region that matter can fill at the time of a snapshot. All calls must pass
    /// the same regions.
    ///
    /// # Errors
    /// If a share is unknown. The error says what to use instead.
    pub(super) fn of(
        &mut self,
        snapshot: &Snapshot<'_>,
        regions: impl Iterator<Item = Region>,
    ) -> Result<&[f64], ParameterError> {
        let walls = 0..snapshot.wall_count();
        let points: Option<Vec<DVec2>> = walls.map(|wall| snapshot.wall_point(wall)).collect();
        let stays = self.time == snapshot.time() || points.is_some() && points == self.points;
        if !(stays && self.walls.is_same(snapshot.walls_mark())) {
            let shares: Option<Vec<f64>> = regions.map(|region| snapshot.free_share(&region)).collect();
            known(shares.is_some())?;
            (self.walls, self.points) = (snapshot.walls_mark(), points);
            self.shares = shares.unwrap_or_default();
        }
        self.time = snapshot.time();
        Ok(&self.shares)
    }
}

/// Checks that the free area is known for a region, or else for each part of it.
///
/// # Errors
/// If the area is unknown. The error says what to use instead.
pub(super) fn check_area(
    region: &Region,
    parts: impl IntoIterator<Item = Region>,
    start: &Snapshot<'_>,
) -> Result<(), ParameterError> {
    let is_known = |region: &Region| start.free_share(region).is_some();
    known(is_known(region) || parts.into_iter().all(|part| is_known(&part)))
}

fn known(all_are_known: bool) -> Result<(), ParameterError> {
    let requirement = "known: implement Boundary::area, let parts with an inside stop all kinds of disks, or \
                       measure in a region that no wall enters";
    accept(all_are_known, "free area between the walls of the boundary", requirement, f64::NAN).map(drop)
}

impl PartialEq for FreeShares {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}
