//! The neighbors of disks, and the pair correlation function.

use std::f64::consts::PI;

use glam::DVec2;

use super::grid::{checked_region, holds, inside};
use super::table::table;
use super::{Accumulator, Snapshot};
use crate::boundary::{Domain, Region, Squares};
use crate::quantity::{accept, positive};
use crate::statistics::{Bins, BlockedMean, Estimate, RunningMean};
use crate::{Disk, Kind, ParameterError};

/// A search for disks near each other in a snapshot; made by [`Snapshot::neighbors`].
pub struct Neighbors<'a> {
    disks: &'a [Disk],
    domain: Domain,
    squares: Squares,
    range: f64,
    /// Half of each period; infinite where there is none. A vector with smaller components already leads to
    /// the nearest image.
    half: DVec2,
}

/// A neighbor of a disk.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Neighbor {
    /// Index of the neighbor among the disks of the snapshot.
    pub index: usize,
    /// Vector from the center of the disk to the center of the neighbor, across periodic sides where that is
    /// shorter.
    pub separation: DVec2,
}

impl<'a> Neighbors<'a> {
    /// Builds the search among the disks for which a condition holds. The range must be positive, and no more
    /// than half of a period.
    pub(super) fn among(
        disks: &'a [Disk],
        domain: Domain,
        range: f64,
        condition: impl Fn(&Disk) -> bool,
    ) -> Self {
        let mut squares = Squares::with_side(&domain, range);
        for (index, disk) in disks.iter().enumerate().filter(|(_, disk)| condition(disk)) {
            squares.add(disk.position(), 0.0, index);
        }
        let periods = domain.periods();
        let half = DVec2::select(periods.cmpgt(DVec2::ZERO), 0.5 * periods, DVec2::INFINITY);
        Self { disks, domain, squares, range, half }
    }

    /// Iterates over the neighbors of a disk, in an arbitrary but reproducible order. If no disk has this
    /// index, there are no neighbors.
    pub fn of(&self, disk: usize) -> impl Iterator<Item = Neighbor> {
        let from = self.disks.get(disk).map(Disk::position);
        let near = from.into_iter().flat_map(move |from| self.near(from));
        near.filter(move |neighbor| neighbor.index != disk)
    }

    /// Iterates over the disks within the range of a position.
    pub fn near(&self, place: DVec2) -> impl Iterator<Item = Neighbor> {
        self.squares.near(place, self.range).filter_map(move |index| {
            let straight = self.disks[index].position() - place;
            // Most disks are nearer than their images, and need no division.
            let is_near = straight.abs().cmple(self.half).all();
            let separation =
                if is_near { straight } else { self.domain.separation(place, self.disks[index].position()) };
            (separation.length_squared() <= self.range * self.range).then_some(Neighbor { index, separation })
        })
    }
}

/// Checks that a range never includes two images of a disk.
fn check_range(name: &'static str, range: f64, domain: &Domain) -> Result<(), ParameterError> {
    let periods = domain.periods();
    for period in [periods.x, periods.y].into_iter().filter(|&period| period > 0.0) {
        accept(2.0 * range <= period, name, "at most half of the period", range)?;
    }
    Ok(())
}

impl Snapshot<'_> {
    /// Finds the disks whose centers are within `range` of each other.
    ///
    /// Disks in a dense layer touch at a distance of their diameter, so 1.2 to 1.5 diameters are usual. The
    /// cost is proportional to the number of disks and of neighbors.
    ///
    /// # Errors
    /// If the range is not finite and positive, or above half of a period of the domain, where a disk could
    /// be a neighbor twice.
    ///
    /// ```
    /// use granular_edmd::prelude::*;
    ///
    /// let disk = |x: f64, y: f64| Disk::new(DVec2::new(x, y), 0.5);
    /// let disks = [disk(1.0, 1.0)?, disk(2.1, 1.0)?, disk(9.8, 1.0)?];
    /// let container = Container::periodic(10.0, 10.0)?;
    /// let run = Simulation::builder(Elastic, container).disks(disks).build()?;
    /// let (snapshot, gap) = (run.snapshot(), 0.25);
    /// let neighbors = snapshot.neighbors(1.25)?;
    ///
    /// // Coordination numbers, the direction of a neighbor, and the gap to it.
    /// assert_eq!([0, 1, 2].map(|disk| neighbors.of(disk).count()), [2, 1, 1]);
    /// let across = neighbors.of(2).next().ok_or("a neighbor")?;
    /// assert!(across.index == 0 && (across.separation.x - 1.2).abs() < 1e-12);
    /// assert!(neighbors.of(0).all(|other| other.separation.length() - 1.0 < gap));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn neighbors(&self, range: f64) -> Result<Neighbors<'_>, ParameterError> {
        positive("range of the neighbors", range)?;
        check_range("range of the neighbors", range, &self.domain())?;
        Ok(Neighbors::among(self.disks(), self.domain(), range, |_| true))
    }
}

/// Fraction of the range by which walls may be nearer than the range, to allow for rounding.
const ROUNDING: f64 = 1e-9;

/// The pair correlation function g(r), also called radial distribution function.
///
/// It is the number of disks at a distance $`r`$ from a disk, divided by the same number in a gas without
/// correlations,
///
/// ```math
/// g(r) = \frac{A\,\langle N_{ij}(r)\rangle}
/// {\langle N_i\rangle\langle N_j\,(1 - \delta_{ij}/M_j)\rangle\; 2\pi r\,\Delta r} .
/// ```
///
/// If the number of disks in the box varies, its mean square enters, too: the denominator has the factor
/// $`\langle M_i(M_j - \delta_{ij})\rangle/\langle M_i\rangle\langle M_j - \delta_{ij}\rangle`$ with the
/// numbers $`M`$ of disks in the whole box. Without disks, $`M_j - \delta_{ij}`$ is 0.
///
/// $`N_{ij}(r)`$ counts the pairs of a disk $`i`$ in a region and a partner $`j`$ anywhere, by the distance
/// between their centers, to the nearest image. $`N_i`$ and $`N_j`$ count the disks in the region, whose area
/// is $`A`$. A disk is not its own partner: if $`i`$ and $`j`$ are of one kind, it has $`M_j - 1`$
/// partners in the box. Shells have their exact areas. In a periodic box, the
/// region is the whole domain. At walls, the region ends at a distance of `range` from the sides and ends of
/// the domain, so that all shells lie inside. In a vessel with walls inside, give a region by
/// [`within`](Self::within) that keeps the same distance from all walls. Where the density varies, under
/// gravity for example, choose a thin layer.
///
/// The errors come from the numbers of pairs in blocks of samples. The numbers of disks in the region are
/// taken as exact, which is nearly true if the region holds many disks. If it holds only a few, take the
/// error from the scatter of several runs. The cost of a sample is proportional to the number of disks.
///
/// A run ends with an error if the range is more than half of a period, if no finite region is left between
/// the walls, or if a wall can enter the region enlarged by the range on all sides.
///
/// ```
/// use granular_edmd::boundary::Container;
/// use granular_edmd::collision::Elastic;
/// use granular_edmd::observable::{PairCorrelation, SampleTimes, Sampled};
/// use granular_edmd::{Simulation, initial};
///
/// let container = Container::periodic(30.0, 30.0)?;
/// let disks = initial::scattered(&container, 200, 0.5, 30.0, 1)?;
/// let disks = initial::with_maxwellian_velocities(disks, 1.0, 2)?;
/// let mut correlation = Sampled::new(PairCorrelation::new(3.0, 30)?, SampleTimes::every(1.0)?);
/// Simulation::builder(Elastic, container).disks(disks).build()?.run_until(50.0, &mut correlation)?;
/// let values: Vec<f64> = correlation.iter().map(|(_, value)| value.mean()).collect();
/// // Disks of diameter 1 do not overlap; at contact there are more than in a gas without correlations.
/// assert!(values[..10].iter().all(|&value| value == 0.0));
/// assert!(values[10] > 1.2 && (values[29] - 1.0).abs() < 0.1);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct PairCorrelation {
    bins: Bins,
    kinds: Option<[Kind; 2]>,
    region: Option<Region>,
    /// Numbers of pairs divided by the area of the shell, for each bin.
    pairs: Vec<BlockedMean>,
    /// Number of disks in the region, around which pairs are counted.
    centers: RunningMean,
    /// Number of partners in the region, divided by its area.
    partner_density: RunningMean,
    /// Numbers of possible centers in the box, of possible partners of each center, and of pairs, each times
    /// the region's share of the box, divided by the area of the box, and both.
    numbers: [RunningMean; 3],
}

impl PairCorrelation {
    /// Creates the correlation function of all disks, up to the distance `range` between two centers, in
    /// `bins` bins.
    ///
    /// # Errors
    /// If the range is not finite and positive, or the number of bins is not in `1..=2^20`.
    pub fn new(range: f64, bins: usize) -> Result<Self, ParameterError> {
        positive("range of the correlation", range)?;
        Ok(Self {
            bins: Bins::new(0.0, range, bins)?,
            kinds: None,
            region: None,
            pairs: vec![BlockedMean::new(); bins],
            centers: RunningMean::default(),
            partner_density: RunningMean::default(),
            numbers: [RunningMean::default(); 3],
        })
    }

    /// Returns the same observer for disks of the second kind around disks of the first kind, which may be
    /// the same kind.
    pub fn between(self, first: Kind, second: Kind) -> Self {
        Self { kinds: Some([first, second]), ..self }
    }

    /// Returns the same observer for pairs around the disks in a region.
    ///
    /// # Errors
    /// If an edge of the region is not finite, or the region has no area.
    pub fn within(self, region: Region) -> Result<Self, ParameterError> {
        Ok(Self { region: Some(checked_region(region)?), ..self })
    }

    /// Returns the largest distance.
    fn range(&self) -> f64 {
        self.bins.edge(self.bins.count())
    }

    /// Iterates over the distances of the middles of the bins, with g(r) there, which is NaN as long as there
    /// are no disks.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = (f64, Estimate)> {
        let [centers, partners, pairs] = self.numbers.map(|number| number.mean());
        let excess = pairs / (centers * partners);
        let scale = 1.0 / (self.centers.mean() * self.partner_density.mean() * excess);
        self.pairs
            .iter()
            .enumerate()
            .map(move |(bin, pairs)| (self.bins.middle(bin), pairs.estimate().scaled(scale)))
    }

    /// Returns the region of the disks around which partners are counted.
    fn counted(&self, snapshot: &Snapshot<'_>) -> Result<Region, ParameterError> {
        let domain = snapshot.domain();
        check_range("range of the correlation", self.range(), &domain)?;
        let room = snapshot.interior();
        let region = match self.region {
            Some(region) => inside(region, &domain)?,
            None => grown(room.region(), -self.range(), &domain),
        };
        let (is_left, requirement) = (
            region.min.cmplt(region.max).all() && region.max.is_finite(),
            "less than half of the distance between walls, unless a region is given",
        );
        accept(is_left, "range of the correlation", requirement, self.range())?;
        let shells = grown(region, self.range() * (1.0 - ROUNDING), &domain);
        let is_inside = inside(shells, &room).is_ok() && snapshot.is_clear(&shells);
        let requirement = "less than the distance of the region from all walls: choose another region";
        accept(is_inside, "range of the correlation", requirement, self.range())?;
        Ok(region)
    }

    fn is_of(&self, which: usize, disk: &Disk) -> bool {
        self.kinds.is_none_or(|kinds| kinds[which] == disk.kind())
    }

    /// Counts the ordered pairs at the distances of each bin.
    fn count(&self, snapshot: &Snapshot<'_>, region: &Region) -> Vec<u64> {
        let (mut counts, disks) = (vec![0; self.bins.count()], snapshot.disks());
        let is_partner = |disk: &Disk| self.is_of(1, disk);
        let neighbors = Neighbors::among(disks, snapshot.domain(), self.range(), is_partner);
        let domain = snapshot.domain();
        let around = |(_, disk): &(usize, &Disk)| self.is_of(0, disk) && holds(region, &domain, disk);
        for (index, _) in disks.iter().enumerate().filter(around) {
            for neighbor in neighbors.of(index) {
                if let Some(bin) = self.bins.find(neighbor.separation.length()) {
                    counts[bin] += 1;
                }
            }
        }
        counts
    }
}

/// Returns a region enlarged by a length on each side. In a periodic direction, the result extends over the
/// whole domain if it would otherwise cross the edge.
fn grown(region: Region, by: f64, domain: &Domain) -> Region {
    let (whole, mut grown) = (domain.region(), Region::new(region.min - by, region.max + by));
    for (axis, is_periodic) in [domain.periodic_sides, domain.periodic_ends].into_iter().enumerate() {
        let is_within = grown.min[axis] >= whole.min[axis] && grown.max[axis] <= whole.max[axis];
        if is_periodic && (by < 0.0 || !is_within) {
            (grown.min[axis], grown.max[axis]) = (whole.min[axis], whole.max[axis]);
        }
    }
    grown
}

impl Accumulator for PairCorrelation {
    fn check(&self, start: &Snapshot<'_>) -> Result<(), ParameterError> {
        self.counted(start).map(drop)
    }

    fn add(&mut self, snapshot: &Snapshot<'_>) -> Result<(), ParameterError> {
        let region = self.counted(snapshot)?;
        let disks = snapshot.disks();
        let count = |which, is_counted: &dyn Fn(&Disk) -> bool| {
            disks.iter().filter(|disk| self.is_of(which, disk) && is_counted(disk)).count() as f64
        };
        let domain = snapshot.domain();
        let is_inside = |disk: &Disk| holds(&region, &domain, disk);
        let (centers, partners) = (count(0, &is_inside), count(1, &is_inside));
        let (possible, all) = (count(0, &|_| true), count(1, &|_| true));
        // A disk is not its own partner.
        let itself = if self.kinds.is_none_or(|[first, second]| first == second) { 1.0 } else { 0.0 };
        let others = if all > 0.0 { 1.0 - itself / all } else { 0.0 };
        self.centers.push(centers);
        self.partner_density.push(partners * others / region.area());
        // The box may be another in a later run. A box without an upper end counts as the region alone.
        let (area, whole) = (region.area(), domain.region().area());
        let whole = if whole.is_finite() { whole } else { area };
        // In an empty box, a center has no partners, and not -1.
        let [centers, partners] = [possible * (area / whole), (all - itself).max(0.0) / whole];
        let numbers = [centers, partners, centers * partners];
        self.numbers.iter_mut().zip(numbers).for_each(|(mean, number)| mean.push(number));
        for (bin, count) in self.count(snapshot, &region).into_iter().enumerate() {
            let (low, high) = (self.bins.edge(bin), self.bins.edge(bin + 1));
            self.pairs[bin].push(count as f64 / (PI * (high - low) * (high + low)));
        }
        Ok(())
    }
}

table! { PairCorrelation, this: for (distance, value) in this.iter();
    "distance" ["length"]: distance;
    "pair_correlation" ["1"]: value
}

crate::gate::from_file! {
    PairCorrelation {
        bins: Bins, kinds: Option<[Kind; 2]>,
        #[serde(deserialize_with = "super::grid::region_from_file")] region: Option<Region>,
        pairs: Vec<BlockedMean>, centers: RunningMean, partner_density: RunningMean, numbers: [RunningMean; 3]
     } => {
        bins.check_count(pairs.len())?;
        Ok(Self { bins, kinds, region, pairs, centers, partner_density, numbers })
    }
}
