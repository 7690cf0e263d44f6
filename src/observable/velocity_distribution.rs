//! Distributions of velocities, and their cumulants.

use glam::DVec2;

use super::grid::CellSums;
use super::table::{Table, histogram_headings, histogram_rows};
use super::{Accumulator, Grid, Heading, Snapshot};
use crate::disk::LEAST_THERMAL;
use crate::statistics::{BlockedMean, Estimate, Histogram};
use crate::{Disk, ParameterError};

/// The distribution of velocities: histograms of both components and of the speed, and cumulants.
///
/// Velocities are in units of the thermal speed of their sample, $`\vec c = \vec v/\sqrt{2T/m}`$, so that the
/// gas may cool or heat. For a Maxwellian gas, the histograms show $`p(c_x) = e^{-c_x^2}/\sqrt\pi`$ and
/// $`p(c) = 2c\,e^{-c^2}`$. The cumulants are the coefficients of the Sonine expansion in two dimensions,
///
/// ```math
/// a_2 = \tfrac12\langle c^4\rangle - 1,\qquad a_3 = 1 + 3a_2 - \tfrac16\langle c^6\rangle .
/// ```
///
/// Moments of a few disks are smaller than the moments of their distribution, since the sample itself defines
/// $`T`$ and the mean. The moments are therefore divided by the moments of a Maxwellian gas with the same
/// number of disks. All cumulants of a Maxwellian gas are then 0, for any number of disks. Errors come from
/// blocks of samples. A sample is left out if its disks all move alike, up to rounding.
///
/// Velocities are taken in the frame of the container, unless [`about_mean`](Self::about_mean) or
/// [`about_flow`](Self::about_flow) subtracts a mean velocity. For each mean velocity
/// that is subtracted, the temperature in the unit of velocity counts one disk fewer. A gas of few disks
/// whose total momentum is zero, such as a gas at rest in a periodic box, needs one of them: the momentum
/// leaves one disk fewer free, and the cumulants in the frame of the container would differ from 0.
///
/// ```
/// use granular_edmd::boundary::Container;
/// use granular_edmd::collision::Elastic;
/// use granular_edmd::observable::{SampleTimes, Sampled, VelocityDistribution};
/// use granular_edmd::{Simulation, initial};
///
/// let container = Container::periodic(20.0, 20.0)?;
/// let disks = initial::scattered(&container, 100, 0.5, 20.0, 1)?;
/// let disks = initial::with_maxwellian_velocities(disks, 1.0, 2)?;
/// let velocities = VelocityDistribution::new(4.0, 20)?.about_mean();
/// let mut velocities = Sampled::new(velocities, SampleTimes::every(2.0)?);
/// Simulation::builder(Elastic, container).disks(disks).build()?.run_until(400.0, &mut velocities)?;
/// assert!(velocities.second_cumulant().mean().abs() < 0.05);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct VelocityDistribution {
    frame: Frame,
    components: [Histogram; 2],
    speed: Histogram,
    cumulants: [BlockedMean; 2],
}

/// The velocity that is subtracted from the velocity of each disk.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
enum Frame {
    Container,
    Mean,
    Flow(Grid),
}

impl VelocityDistribution {
    /// Creates histograms of `bins` bins each: of the components from `-largest` to `largest`, and of the
    /// speed from 0 to `largest`, in units of the thermal speed.
    ///
    /// # Errors
    /// If `largest` is not finite and positive, or the number of bins is not in `1..=2^20`.
    pub fn new(largest: f64, bins: usize) -> Result<Self, ParameterError> {
        let speed = Histogram::new(0.0, largest, bins)?;
        let component = Histogram::new(-largest, largest, bins)?;
        Ok(Self {
            frame: Frame::Container,
            components: [component.clone(), component],
            speed,
            cumulants: Default::default(),
        })
    }

    /// Returns the same distribution about the mean velocity of all disks, weighted by mass, in each sample.
    ///
    /// Together with [`about_flow`](Self::about_flow), in either order, this method changes nothing, since
    /// the flow includes the mean.
    pub fn about_mean(self) -> Self {
        let frame = if let Frame::Container = self.frame { Frame::Mean } else { self.frame };
        Self { frame, ..self }
    }

    /// Returns the same distribution about the mean velocity in each cell of a grid, weighted by mass, in
    /// each sample.
    ///
    /// Disks outside the grid are left out. A run ends with an error if the whole grid is outside the domain.
    pub fn about_flow(self, grid: Grid) -> Self {
        Self { frame: Frame::Flow(grid), ..self }
    }

    /// Returns the histogram of the horizontal component.
    pub const fn horizontal(&self) -> &Histogram {
        &self.components[0]
    }

    /// Returns the histogram of the vertical component.
    pub const fn vertical(&self) -> &Histogram {
        &self.components[1]
    }

    /// Returns the histogram of the speed.
    pub const fn speed(&self) -> &Histogram {
        &self.speed
    }

    /// Returns the second cumulant, a₂, which is 0 for a Maxwellian gas.
    pub fn second_cumulant(&self) -> Estimate {
        self.cumulants[0].estimate()
    }

    /// Returns the third cumulant, a₃, which is 0 for a Maxwellian gas.
    pub fn third_cumulant(&self) -> Estimate {
        self.cumulants[1].estimate()
    }
}

impl Frame {
    /// Returns the scaled velocities √m (v − u) of the disks, and the degrees of freedom of each component.
    /// Each velocity comes with the fraction of its variance that remains when the mean is subtracted.
    fn peculiar(&self, snapshot: &Snapshot<'_>) -> (Vec<(DVec2, f64)>, f64) {
        let disks = snapshot.disks();
        match self {
            Self::Container => {
                let scaled = disks.iter().map(|disk| (disk.velocity() * disk.mass().sqrt(), 1.0));
                (scaled.collect(), disks.len() as f64)
            }
            Self::Mean => {
                let mut all = CellSums::default();
                for disk in disks {
                    all.add(disk);
                }
                about(&[all], disks, |_| Some(0))
            }
            Self::Flow(grid) => {
                about(&grid.sums(snapshot), disks, |disk| grid.cell_of(disk, &snapshot.domain()))
            }
        }
    }
}

/// Returns the result of [`Frame::peculiar`] about the mean velocity in each cell.
fn about(
    cells: &[CellSums],
    disks: &[Disk],
    cell_of: impl Fn(&Disk) -> Option<usize>,
) -> (Vec<(DVec2, f64)>, f64) {
    let scaled = |disk: &Disk| {
        let cell = &cells[cell_of(disk)?];
        let left = 1.0 - disk.mass() / cell.velocity[0].weight;
        Some(((disk.velocity() - cell.flow()) * disk.mass().sqrt(), left))
    };
    let peculiar: Vec<_> = disks.iter().filter_map(scaled).collect();
    let taken = cells.iter().filter(|cell| cell.count > 0).count();
    let freedom = peculiar.len() as f64 - taken as f64;
    (peculiar, freedom)
}

/// Returns a moment of several numbers, divided by its mean for normal numbers of the same count and sum of
/// squares.
///
/// `moment` is the sum of the numbers to the power `order`, and `squares` the sum of their squares. Each
/// number has kept a fraction of its variance; `shares` is the sum of these fractions to the power `order`/2.
/// `freedom` counts the degrees of freedom of the squares, and `normal` is the moment of this order of one
/// normal number.
fn relative_moment(moment: f64, squares: f64, order: i32, shares: f64, freedom: f64, normal: f64) -> f64 {
    // The direction of a normal vector is independent of its length, so the mean of the quotient is the
    // quotient of the means.
    let powers = |value: f64, step: f64| (0..order / 2).map(|k| value + f64::from(k) * step).product::<f64>();
    moment / powers(squares, 0.0) * powers(freedom, 2.0) / (normal * shares)
}

impl Accumulator for VelocityDistribution {
    fn add(&mut self, snapshot: &Snapshot<'_>) -> Result<(), ParameterError> {
        let (peculiar, freedom) = self.frame.peculiar(snapshot);
        let sum = |term: &dyn Fn(DVec2, f64) -> f64| peculiar.iter().map(|&(v, left)| term(v, left)).sum();
        let squares: f64 = sum(&|v, _| v.length_squared());
        let whole: f64 =
            snapshot.disks().iter().map(|disk| disk.mass() * disk.velocity().length_squared()).sum();
        if freedom < 1.0 || squares <= LEAST_THERMAL * LEAST_THERMAL * whole {
            return Ok(());
        }
        let thermal = (squares / freedom).sqrt();
        for (velocity, _) in &peculiar {
            self.components[0].push(velocity.x / thermal);
            self.components[1].push(velocity.y / thermal);
            self.speed.push(velocity.length() / thermal);
        }
        let (second, third) = (sum(&|_, left| left * left), sum(&|_, left| left * left * left));
        let fourth = sum(&|v, _| v.length_squared() * v.length_squared());
        let sixth = sum(&|v, _| v.length_squared() * v.length_squared() * v.length_squared());
        let a2 = relative_moment(fourth, squares, 4, second, 2.0 * freedom, 8.0) - 1.0;
        let a3 = 1.0 + 3.0 * a2 - relative_moment(sixth, squares, 6, third, 2.0 * freedom, 48.0);
        self.cumulants[0].push(a2);
        self.cumulants[1].push(a3);
        Ok(())
    }

    fn check(&self, start: &Snapshot<'_>) -> Result<(), ParameterError> {
        if let Frame::Flow(grid) = &self.frame { grid.check_against(&start.domain()) } else { Ok(()) }
    }
}

impl Table for VelocityDistribution {
    fn headings(&self) -> Vec<Heading> {
        histogram_headings(["horizontal", "vertical", "speed"].map(|name| (name, "1")))
    }

    fn rows(&self) -> Box<dyn Iterator<Item = Vec<f64>> + '_> {
        histogram_rows([self.horizontal(), self.vertical(), self.speed()])
    }
}
