//! The stress in a gas, from the momentum that disks carry and the momentum that collisions transfer.

use glam::DVec2;

use super::grid::{FreeShares, check_area, checked_region, holds, inside};
use super::sample_times::Stretch;
use super::table::{STRESS, Table, headings, row};
use super::{Collision, Heading, Observer, ObserverError, SampleTimes, Snapshot, Verdict, contract};
use crate::boundary::{Domain, Region};
use crate::quantity::accept;
use crate::statistics::{BlockedMean, Estimate};
use crate::{Disk, ParameterError};

/// A stress tensor with the sign of a pressure, positive where the disks push; made by [`Stress`].
///
/// The first letter is the direction of the momentum. The second letter is the normal of the line through
/// which the momentum passes.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct StressTensor {
    /// Normal stress on vertical lines, P_xx.
    pub xx: Estimate,
    /// Shear stress on horizontal lines, P_xy.
    pub xy: Estimate,
    /// Shear stress on vertical lines, P_yx.
    pub yx: Estimate,
    /// Normal stress on horizontal lines, P_yy.
    pub yy: Estimate,
    /// Pressure, (P_xx + P_yy)/2.
    pub pressure: Estimate,
}

/// An observer of the stress of all disks, or of the disks in a region (Irving and Kirkwood 1950).
///
/// ```math
/// P_{ab} = \frac1A\Big\langle\sum_i m_i v_{i,a} v_{i,b}\Big\rangle
/// + \frac1{A\,t}\sum_{\rm collisions} \Delta_a\, r_b ,
/// ```
///
/// in units of energy per area. The kinetic part is sampled, with velocities in the frame of the container.
/// The collisional part is exact. Each collision adds the impulse $`\vec\Delta`$ on a disk, normal and
/// tangential, times the vector $`\vec r`$, which points to the center of the disk from the center of its
/// partner, or from the point where it touches a wall. In a region, only the fraction of $`\vec r`$ inside
/// the region counts. Each interval between two samples gives one value of the stress, and the errors come
/// from blocks of these values.
///
/// In a box without gravity, the normal stress is the pressure on the walls. Under a wall with a mass that
/// moves along y under the force $`F`$, at the distance $`h`$ from the floor, the virial has a term of the
/// wall: $`\langle P_{yy}A\rangle = F\langle h\rangle - T`$, so the stress is lower than the pressure
/// $`F/L`$ on it by about one disk in all.
///
/// In a periodic box at rest, the $`2N - 2`$ degrees of freedom have the temperature $`T' = E/(N-1)`$, and
/// [`Temperatures`](super::Temperatures) divides by $`N`$: the kinetic part is $`NT/A`$ with $`T = E/N`$, but
/// collisions happen at $`T'`$. The compressibility factor of $`N`$ disks is therefore
/// $`Z = 1 + P_{\rm coll}A/NT'`$; with $`T`$ in place of $`T'`$, it would be too large by $`(Z-1)/(N-1)`$.
///
/// The area $`A`$ is the area that
/// walls leave free for matter in the region, or in the whole domain, at the time of the sample
/// ([`Boundary::area`](crate::boundary::Boundary::area)). A run ends with an error if the area is infinite,
/// or if the boundary does not know the area. Where a driving changes the number of disks or their
/// velocities, the kinetic part comes from the samples, and the collisional part from the collisions between
/// the samples.
///
/// Inside an [`OfKind`](super::OfKind), the kinetic part counts the disks of the kind, and the collisional
/// part counts all collisions in which such a disk takes part.
///
/// ```
/// use granular_edmd::boundary::Container;
/// use granular_edmd::collision::Elastic;
/// use granular_edmd::observable::{SampleTimes, Stress, Temperatures};
/// use granular_edmd::{Simulation, initial};
///
/// // A gas of packing fraction 0.1 in a periodic box, whose pressure is 1.236 times an ideal gas's.
/// let container = Container::periodic(40.0, 40.0)?;
/// let disks = initial::scattered(&container, 204, 0.5, 40.0, 1)?;
/// let disks = initial::with_maxwellian_velocities(disks, 1.0, 2)?;
/// let mut stress = Stress::new(SampleTimes::every(1.0)?);
/// let mut run = Simulation::builder(Elastic, container).disks(disks).build()?;
/// run.run_until(200.0, &mut stress)?;
/// let ideal = 204.0 / 1600.0 * run.measure(&Temperatures).translational();
/// assert!((stress.tensor().pressure.mean() / ideal - 1.236).abs() < 0.03);
/// assert!((stress.kinetic().pressure.mean() / ideal - 1.0).abs() < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Stress {
    stretch: Stretch,
    #[cfg_attr(feature = "serde", serde(deserialize_with = "super::grid::region_from_file"))]
    region: Option<Region>,
    /// The domain of the run.
    domain: Option<Domain>,
    #[cfg_attr(feature = "serde", serde(skip))]
    shares: FreeShares,
    /// Sum of impulse times distance over the collisions since the latest sample.
    transferred: [f64; 4],
    kinetic: Tensor,
    collisional: Tensor,
    total: Tensor,
    /// The reason why the stress cannot be measured in this run.
    #[cfg_attr(feature = "serde", serde(skip))]
    fault: Option<ParameterError>,
}

impl Stress {
    /// Creates an observer of the stress of all disks, with a value for each interval of the sample times.
    pub fn new(times: SampleTimes) -> Self {
        Self {
            stretch: Stretch::new(times),
            region: None,
            domain: None,
            shares: FreeShares::default(),
            transferred: [0.0; 4],
            kinetic: Tensor::default(),
            collisional: Tensor::default(),
            total: Tensor::default(),
            fault: None,
        }
    }

    /// Returns the same observer for the stress in a region inside the domain.
    ///
    /// # Errors
    /// If an edge of the region is not finite, or the region has no area.
    pub fn within(self, region: Region) -> Result<Self, ParameterError> {
        Ok(Self { region: Some(checked_region(region)?), ..self })
    }

    /// Returns the stress.
    pub fn tensor(&self) -> StressTensor {
        self.total.estimate()
    }

    /// Returns the kinetic part of the stress, from the momentum that disks carry.
    ///
    /// It is $`\langle\sum m v_a v_b\rangle/A`$.
    pub fn kinetic(&self) -> StressTensor {
        self.kinetic.estimate()
    }

    /// Returns the collisional part of the stress, from the momentum that collisions transfer.
    pub fn collisional(&self) -> StressTensor {
        self.collisional.estimate()
    }

    /// Returns the fraction of the segment between two positions that lies in the region, summed over the
    /// images of the segment in a periodic box.
    fn share_inside(&self, from: DVec2, to: DVec2) -> f64 {
        let Some(region) = self.region else { return 1.0 };
        let share = |image| share_in(&region, from + image, to + image);
        self.domain.map_or_else(|| share(DVec2::ZERO), |domain| domain.images().map(share).sum())
    }

    /// Returns the free area at the time of a snapshot.
    fn area(&mut self, snapshot: &Snapshot<'_>) -> Result<f64, ParameterError> {
        let region = self.region.unwrap_or(snapshot.domain().region());
        Ok(region.area() * self.shares.of(snapshot, std::iter::once(region))?[0])
    }

    /// Checks that the area of a run's domain is finite and known.
    fn check(&self, start: &Snapshot<'_>) -> Result<(), ParameterError> {
        let domain = start.domain();
        let region = self.region.map_or(Ok(domain.region()), |region| inside(region, &domain))?;
        let (area, requirement) = (region.area(), "finite: choose a region");
        accept(area.is_finite(), "area of the domain", requirement, area)?;
        check_area(&region, [region], start)
    }
}

/// Returns the fraction of a segment that lies in a rectangle (Liang and Barsky 1984).
fn share_in(region: &Region, from: DVec2, to: DVec2) -> f64 {
    let way = to - from;
    let (mut enters, mut leaves) = (0.0_f64, 1.0_f64);
    for (start, step, low, high) in
        [(from.x, way.x, region.min.x, region.max.x), (from.y, way.y, region.min.y, region.max.y)]
    {
        if step == 0.0 {
            if start < low || start >= high {
                return 0.0;
            }
            continue;
        }
        let (first, second) = ((low - start) / step, (high - start) / step);
        enters = enters.max(first.min(second));
        leaves = leaves.min(first.max(second));
    }
    (leaves - enters).max(0.0)
}

impl Observer for Stress {
    fn on_start(&mut self, start: &Snapshot<'_>) -> Result<(), ObserverError> {
        if self.domain.replace(start.domain()) != Some(start.domain()) {
            self.stretch.forget();
        }
        self.check(start)?;
        if self.stretch.begin(start)? {
            self.transferred = [0.0; 4];
        }
        Ok(())
    }

    fn on_collision(&mut self, collision: &Collision) {
        let (normal, impulse) = (collision.normal, collision.impulse);
        let share = self.share_inside(collision.partner_position(), collision.position);
        let kick = normal * impulse.normal() + normal.perp() * impulse.tangential();
        let way = normal * (collision.distance * share);
        for (sum, part) in self.transferred.iter_mut().zip(products(kick, way)) {
            *sum += part;
        }
    }

    fn next_sample(&self) -> f64 {
        self.stretch.sample_times.upcoming()
    }

    fn on_sample(&mut self, snapshot: &Snapshot<'_>) {
        let transferred = std::mem::take(&mut self.transferred);
        let Some(duration) = self.stretch.finish(snapshot.time()) else { return };
        let area = self.area(snapshot);
        let Ok(area) = area.map_err(|fault| self.fault = Some(fault)) else { return };
        let collisional = transferred.map(|sum| sum / (area * duration));
        let mut kinetic = [0.0; 4];
        let domain = snapshot.domain();
        let is_inside = |disk: &&Disk| self.region.is_none_or(|region| holds(&region, &domain, disk));
        for disk in snapshot.disks().iter().filter(is_inside) {
            let parts = products(disk.velocity() * (disk.mass() / area), disk.velocity());
            for (sum, part) in kinetic.iter_mut().zip(parts) {
                *sum += part;
            }
        }
        self.kinetic.push(kinetic);
        self.collisional.push(collisional);
        self.total.push([0, 1, 2, 3].map(|entry| kinetic[entry] + collisional[entry]));
    }

    fn on_end(&mut self, end: &Snapshot<'_>) {
        self.stretch.pause(end.time());
    }

    fn verdict(&mut self) -> Verdict {
        contract::verdict(&mut self.fault)
    }
}

/// Returns the products of components, in the order xx, xy, yx, yy.
fn products(first: DVec2, second: DVec2) -> [f64; 4] {
    [first.x * second.x, first.x * second.y, first.y * second.x, first.y * second.y]
}

/// Means of the components, and of the pressure.
#[derive(Debug, Clone, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
struct Tensor {
    components: [BlockedMean; 4],
    pressure: BlockedMean,
}

impl Tensor {
    fn push(&mut self, values: [f64; 4]) {
        for (mean, value) in self.components.iter_mut().zip(values) {
            mean.push(value);
        }
        self.pressure.push(0.5 * (values[0] + values[3]));
    }

    fn estimate(&self) -> StressTensor {
        let [xx, xy, yx, yy] = [0, 1, 2, 3].map(|entry: usize| self.components[entry].estimate());
        StressTensor { xx, xy, yx, yy, pressure: self.pressure.estimate() }
    }
}

impl Table for Stress {
    fn headings(&self) -> Vec<Heading> {
        let parts = ["", "kinetic_", "collisional_"]
            .map(|part| ["pressure", "xx", "xy", "yx", "yy"].map(|name| format!("{part}{name}")));
        let names: Vec<_> = parts.iter().flatten().map(|name| (name.as_str(), STRESS)).collect();
        headings(&[], &names)
    }

    fn rows(&self) -> Box<dyn Iterator<Item = Vec<f64>> + '_> {
        let parts = [self.tensor(), self.kinetic(), self.collisional()];
        let numbers = parts.map(|StressTensor { xx, xy, yx, yy, pressure }| [pressure, xx, xy, yx, yy]);
        Box::new(std::iter::once(row(&[], numbers.as_flattened())))
    }
}
