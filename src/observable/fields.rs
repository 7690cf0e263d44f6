//! Density, flow and temperatures on a grid.

use glam::DVec2;

use super::{Observer, SampleTimes, Snapshot};
use crate::boundary::Region;
use crate::quantity::{accept, finite};
use crate::{Disk, ParameterError};

/// Most cells of a grid.
const MOST_CELLS: usize = 1 << 22;

/// The fields in one cell of a grid, averaged over all samples; made by [`Fields`]. All are 0 where no disk was seen.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct FieldCell {
    /// Middle of the cell.
    pub center: DVec2,
    /// How many disks were seen here, over all samples.
    pub count: u64,
    /// Disks per area.
    pub number_density: f64,
    /// Area of the disks per area, each counted where its centre is.
    pub packing_fraction: f64,
    /// Velocity of the flow, `$u = \langle mv\rangle/\langle m\rangle$`.
    pub velocity: DVec2,
    /// Mean angular velocity, `$\langle I\omega\rangle/\langle I\rangle$`.
    pub angular_velocity: f64,
    /// `$T = \tfrac12\langle m|v-u|^2\rangle$`, per degree of freedom and about the flow.
    pub translational_temperature: f64,
    /// `$T_{rot} = \langle I(\omega-\bar\omega)^2\rangle$`, about the mean angular velocity.
    pub rotational_temperature: f64,
}

/// An observer that averages density, flow and temperatures on a grid over samples: the rolls.
///
/// A disk counts in the cell of its centre. Temperatures are about the mean velocity *of the cell*, over all samples: a
/// flow that is not steady over them, such as a roll that changes its sense, counts as temperature. With `$n$` disks seen
/// in a cell they are too small by a factor `$1 - 1/n$`, for independent samples.
///
/// ```
/// use granular_edmd::boundary::{Domain, Region};
/// use granular_edmd::glam::DVec2;
/// use granular_edmd::observable::{Fields, Observer, SampleTimes, Snapshot};
/// use granular_edmd::Disk;
///
/// let region = Region::new(DVec2::ZERO, DVec2::new(4.0, 2.0));
/// let mut fields = Fields::new(region, 2, 1, SampleTimes::every(1.0)?)?;
/// let disk = |x, vx| Disk::new(DVec2::new(x, 1.0), 0.4)?.with_velocity(DVec2::new(vx, 0.0));
/// let disks = [disk(0.5, 1.0)?, disk(1.5, 3.0)?];
/// let domain = Domain::new(0.0, 4.0, 0.0, 2.0);
/// fields.on_sample(&Snapshot::new(1.0, &disks, domain, 0.0));
/// let left = fields.cell(0, 0).unwrap();
/// assert_eq!((left.number_density, left.velocity.x, left.translational_temperature), (0.5, 2.0, 0.5));
/// assert_eq!(fields.cell(1, 0).unwrap().count, 0);
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
#[derive(Debug, Clone)]
pub struct Fields {
    region: Region,
    columns: usize,
    rows: usize,
    sample_times: SampleTimes,
    sums: Vec<Sums>,
    samples: u64,
}

impl Fields {
    /// A grid of `columns` times `rows` cells over a region; what is outside is left out.
    ///
    /// # Errors
    /// If an edge of the region is not finite, it has no area, or the number of cells is not in `1..=2^22`.
    pub fn new(
        region: Region,
        columns: usize,
        rows: usize,
        times: SampleTimes,
    ) -> Result<Self, ParameterError> {
        let corners = [region.min.x, region.min.y, region.max.x, region.max.y];
        corners.into_iter().try_for_each(|edge| finite("edge of the grid", edge).map(|_| ()))?;
        let cells = columns.saturating_mul(rows);
        accept((1..=MOST_CELLS).contains(&cells), "number of cells", "in 1..=2^22", cells as f64)?;
        let cell = cell_size(&region, columns, rows);
        let area = if cell.min_element() > 0.0 { cell.x * cell.y } else { 0.0 };
        accept(area.is_normal(), "area of a cell", "finite and positive", area)?;
        Ok(Self {
            region,
            columns,
            rows,
            sample_times: times,
            sums: vec![Sums::default(); cells],
            samples: 0,
        })
    }

    /// How many samples were taken.
    pub const fn samples(&self) -> u64 {
        self.samples
    }

    /// Number of columns and rows.
    pub const fn shape(&self) -> (usize, usize) {
        (self.columns, self.rows)
    }

    /// The fields in a cell, columns from the left and rows from below; `None` outside the grid.
    pub fn cell(&self, column: usize, row: usize) -> Option<FieldCell> {
        let inside = column < self.columns && row < self.rows;
        inside.then(|| self.averaged(column, row))
    }

    /// The fields in all cells, row by row from below.
    pub fn iter(&self) -> impl Iterator<Item = FieldCell> {
        (0..self.sums.len()).map(|cell| self.averaged(cell % self.columns, cell / self.columns))
    }

    /// Forgets all samples so far.
    pub fn clear(&mut self) {
        self.sums.fill(Sums::default());
        self.samples = 0;
    }

    fn averaged(&self, column: usize, row: usize) -> FieldCell {
        let size = cell_size(&self.region, self.columns, self.rows);
        let center = self.region.min + size * DVec2::new(column as f64 + 0.5, row as f64 + 0.5);
        let sums = &self.sums[row * self.columns + column];
        let area = size.x * size.y * self.samples.max(1) as f64;
        FieldCell { center, ..sums.averaged(area) }
    }

    /// The cell that holds this position.
    fn index(&self, position: DVec2) -> Option<usize> {
        let scaled = (position - self.region.min) / cell_size(&self.region, self.columns, self.rows);
        let inside = scaled.x >= 0.0
            && scaled.y >= 0.0
            && scaled.x < self.columns as f64
            && scaled.y < self.rows as f64;
        inside.then(|| scaled.y as usize * self.columns + scaled.x as usize)
    }
}

fn cell_size(region: &Region, columns: usize, rows: usize) -> DVec2 {
    (region.max - region.min) / DVec2::new(columns as f64, rows as f64)
}

impl Observer for Fields {
    fn next_sample(&self) -> f64 {
        self.sample_times.next()
    }

    fn on_sample(&mut self, snapshot: &Snapshot<'_>) {
        for disk in snapshot.disks() {
            if let Some(cell) = self.index(disk.position()) {
                self.sums[cell].add(disk);
            }
        }
        self.samples += 1;
        self.sample_times.advance_past(snapshot.time());
    }
}

/// Sums over the disks seen in a cell; second moments about the running means, so that no digits cancel (Welford).
#[derive(Debug, Clone, Copy, Default)]
struct Sums {
    count: u64,
    area: f64,
    mass: f64,
    velocity: DVec2,
    squares: f64,
    inertia: f64,
    angular_velocity: f64,
    angular_squares: f64,
}

impl Sums {
    fn add(&mut self, disk: &Disk) {
        self.count += 1;
        self.area += std::f64::consts::PI * disk.radius() * disk.radius();
        self.mass += disk.mass();
        let before = disk.velocity() - self.velocity;
        self.velocity += before * (disk.mass() / self.mass);
        self.squares += disk.mass() * before.dot(disk.velocity() - self.velocity);
        self.inertia += disk.moment_of_inertia();
        let before = disk.angular_velocity() - self.angular_velocity;
        self.angular_velocity += before * (disk.moment_of_inertia() / self.inertia);
        self.angular_squares +=
            disk.moment_of_inertia() * before * (disk.angular_velocity() - self.angular_velocity);
    }

    fn averaged(&self, area: f64) -> FieldCell {
        let count = self.count.max(1) as f64;
        FieldCell {
            center: DVec2::ZERO,
            count: self.count,
            number_density: self.count as f64 / area,
            packing_fraction: self.area / area,
            velocity: self.velocity,
            angular_velocity: self.angular_velocity,
            translational_temperature: 0.5 * self.squares / count,
            rotational_temperature: self.angular_squares / count,
        }
    }
}
