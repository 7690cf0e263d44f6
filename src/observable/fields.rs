//! Density, flow and temperatures on a grid.

use glam::DVec2;

use super::{Moment, Observer, SampleTimes, Snapshot};
use crate::boundary::Region;
use crate::quantity::{accept, finite};
use crate::statistics::Moments;
use crate::{Disk, ParameterError};

/// Largest number of cells of a grid.
const MOST_CELLS: usize = 1 << 22;

/// The fields in one cell of a grid, averaged over all samples; made by [`Fields`]. All fields are 0 where no
/// disk was seen.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct FieldCell {
    /// Middle of the cell.
    pub center: DVec2,
    /// Number of disks seen in the cell, over all samples.
    pub count: u64,
    /// Disks per area.
    pub number_density: f64,
    /// Area of the disks per area. Each disk counts in the cell of its center.
    pub packing_fraction: f64,
    /// Velocity of the flow, `$u = \langle mv\rangle/\langle m\rangle$`.
    pub velocity: DVec2,
    /// Mean angular velocity, `$\langle I\omega\rangle/\langle I\rangle$`.
    pub angular_velocity: f64,
    /// Translational temperature `$T = \tfrac12\langle m|v-u|^2\rangle$`, per degree of freedom and about the
    /// flow.
    pub translational_temperature: f64,
    /// Rotational temperature `$T_{rot} = \langle I(\omega-\bar\omega)^2\rangle$`, about the mean angular
    /// velocity.
    pub rotational_temperature: f64,
}

/// An observer that averages density, flow and temperatures on a grid over samples: the convection rolls.
///
/// A disk counts in the cell of its center. Temperatures are about the mean velocity *of the cell*, over all
/// samples. A flow that changes between samples, such as a roll that reverses, counts as temperature. If
/// `$n$` disks are seen in a cell, its temperatures are too small by a factor `$1 - 1/n$`, for independent
/// samples.
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
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "RawFields"))]
pub struct Fields {
    min: DVec2,
    max: DVec2,
    columns: usize,
    rows: usize,
    sample_times: SampleTimes,
    sums: Vec<Sums>,
    samples: u64,
}

impl Fields {
    /// Creates a grid of `columns` times `rows` cells over a region. Disks outside are left out.
    ///
    /// # Errors
    /// If an edge of the region is not finite, the region has no area, or the number of cells is not in
    /// `1..=2^22`.
    pub fn new(
        region: Region,
        columns: usize,
        rows: usize,
        times: SampleTimes,
    ) -> Result<Self, ParameterError> {
        let Region { min, max, .. } = region;
        let empty = Self { min, max, columns, rows, sample_times: times, sums: Vec::new(), samples: 0 };
        let cells = empty.checked_count()?;
        Ok(Self { sums: vec![Sums::default(); cells], ..empty })
    }

    /// Checks the shape of the grid, and returns the number of its cells.
    fn checked_count(&self) -> Result<usize, ParameterError> {
        let corners = [self.min.x, self.min.y, self.max.x, self.max.y];
        corners.into_iter().try_for_each(|edge| finite("edge of the grid", edge).map(|_| ()))?;
        let cells = self.columns.saturating_mul(self.rows);
        accept((1..=MOST_CELLS).contains(&cells), "number of cells", "in 1..=2^22", cells as f64)?;
        let cell = self.cell_size();
        let area = if cell.min_element() > 0.0 { cell.x * cell.y } else { 0.0 };
        accept(area.is_normal(), "area of a cell", "finite and positive", area)?;
        Ok(cells)
    }

    /// Returns how many samples were taken.
    pub const fn samples(&self) -> u64 {
        self.samples
    }

    /// Returns the number of columns and rows.
    pub const fn shape(&self) -> (usize, usize) {
        (self.columns, self.rows)
    }

    /// Returns the fields in a cell, or `None` outside the grid. Columns count from the left and rows from
    /// below.
    pub fn cell(&self, column: usize, row: usize) -> Option<FieldCell> {
        let inside = column < self.columns && row < self.rows;
        inside.then(|| self.averaged(column, row))
    }

    /// Iterates over the fields in all cells, row by row from below.
    pub fn iter(&self) -> impl Iterator<Item = FieldCell> {
        (0..self.sums.len()).map(|cell| self.averaged(cell % self.columns, cell / self.columns))
    }

    /// Forgets all samples so far.
    pub fn clear(&mut self) {
        self.sums.fill(Sums::default());
        self.samples = 0;
    }

    fn averaged(&self, column: usize, row: usize) -> FieldCell {
        let size = self.cell_size();
        let center = self.min + size * DVec2::new(column as f64 + 0.5, row as f64 + 0.5);
        let sums = &self.sums[row * self.columns + column];
        let area = size.x * size.y * self.samples.max(1) as f64;
        FieldCell { center, ..sums.averaged(area) }
    }

    /// Returns the cell that holds this position.
    fn index(&self, position: DVec2) -> Option<usize> {
        let scaled = (position - self.min) / self.cell_size();
        let inside = scaled.x >= 0.0
            && scaled.y >= 0.0
            && scaled.x < self.columns as f64
            && scaled.y < self.rows as f64;
        inside.then(|| scaled.y as usize * self.columns + scaled.x as usize)
    }

    fn cell_size(&self) -> DVec2 {
        (self.max - self.min) / DVec2::new(self.columns as f64, self.rows as f64)
    }
}

impl Observer for Fields {
    fn on_start(&mut self, moment: &Moment) {
        self.sample_times.start_at(moment.time());
    }

    fn next_sample(&self) -> f64 {
        self.sample_times.upcoming()
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

/// Sums over the disks seen in a cell.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
struct Sums {
    count: u64,
    area: f64,
    /// Components of the velocity, weighted by mass.
    velocity: [Moments; 2],
    /// Angular velocity, weighted by moment of inertia.
    angular_velocity: Moments,
}

impl Sums {
    fn add(&mut self, disk: &Disk) {
        self.count += 1;
        self.area += std::f64::consts::PI * disk.radius() * disk.radius();
        self.velocity[0].push(disk.velocity().x, disk.mass());
        self.velocity[1].push(disk.velocity().y, disk.mass());
        self.angular_velocity.push(disk.angular_velocity(), disk.moment_of_inertia());
    }

    fn averaged(&self, area: f64) -> FieldCell {
        let count = self.count.max(1) as f64;
        let [x, y] = self.velocity;
        FieldCell {
            center: DVec2::ZERO,
            count: self.count,
            number_density: self.count as f64 / area,
            packing_fraction: self.area / area,
            velocity: DVec2::new(x.mean, y.mean),
            angular_velocity: self.angular_velocity.mean,
            translational_temperature: 0.5 * (x.squares + y.squares) / count,
            rotational_temperature: self.angular_velocity.squares / count,
        }
    }

    /// Checks that sums from a file can be those of disks.
    #[cfg(feature = "serde")]
    fn check(&self) -> Result<(), ParameterError> {
        crate::quantity::non_negative("area of the disks in a cell", self.area)?;
        let weights =
            [self.area, self.velocity[0].weight, self.velocity[1].weight, self.angular_velocity.weight];
        let sound = weights.into_iter().all(|weight| (weight > 0.0) == (self.count > 0));
        accept(
            sound,
            "number of disks in a cell",
            "0 if and only if their area and mass are",
            self.count as f64,
        )?;
        Ok(())
    }
}

#[cfg(feature = "serde")]
#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields, rename = "Fields")]
struct RawFields {
    min: DVec2,
    max: DVec2,
    columns: usize,
    rows: usize,
    sample_times: SampleTimes,
    sums: Vec<Sums>,
    samples: u64,
}

#[cfg(feature = "serde")]
impl TryFrom<RawFields> for Fields {
    type Error = ParameterError;

    fn try_from(raw: RawFields) -> Result<Self, ParameterError> {
        let RawFields { min, max, columns, rows, sample_times, sums, samples } = raw;
        let fields = Self { min, max, columns, rows, sample_times, sums, samples };
        let (cells, given) = (fields.checked_count()?, fields.sums.len());
        accept(cells == given, "number of sums", "that of the cells", given as f64)?;
        fields.sums.iter().try_for_each(Sums::check)?;
        Ok(fields)
    }
}
