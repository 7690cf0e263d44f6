//! The pair correlation function.

use std::f64::consts::PI;

use glam::DVec2;

use super::grid::{checked_region, inside};
use super::table::{Table, headings, row};
use super::{Accumulator, Heading, Snapshot};
use crate::boundary::{Domain, Region, Squares};
use crate::quantity::{accept, positive};
use crate::statistics::{Bins, BlockedMean, Estimate, RunningMean};
use crate::{Disk, Kind, ParameterError};

/// Number of walls that a domain can have at its sides and ends.
const SIDES: usize = 4;

/// The pair correlation function g(r), also called radial distribution function.
///
/// It is the number of disks at a distance $`r`$ from a disk, divided by that number in a gas without
/// correlations,
///
/// ```math
/// g(r) = \frac{A\,\langle N_{ij}(r)\rangle}
/// {\langle N_i\rangle\langle N_j\rangle\,(1 - \delta_{ij}/N)\; 2\pi r\,\Delta r} .
/// ```
///
/// $`N_{ij}(r)`$ counts the pairs of a disk $`i`$ in a region and a partner $`j`$ anywhere, by the distance
/// of their centers, to the nearest image. $`N_i`$ and $`N_j`$ count the disks in the region, whose area is
/// $`A`$. A disk is not its own partner: if $`i`$ and $`j`$ are of one kind, it has $`N - 1`$ partners among
/// the $`N`$ disks of that kind in the box. Shells have their exact areas. In a periodic box, the region is
/// the whole domain. The region keeps a distance of the range from the sides and ends of the domain, so that
/// all shells lie inside. It knows of no walls between them: if there are parts, give a region by
/// [`within`](Self::within) that keeps that distance from all walls. Where the density varies, under gravity
/// for example, choose a thin layer.
///
/// The errors are those of the numbers of pairs, from blocks of samples. The numbers of disks in the region
/// are taken as exact, which is nearly true if the region holds many disks. If it holds only a few, take the
/// error from the scatter of several runs. The cost of a sample is proportional to the number of disks.
///
/// A run ends with an error if the range is more than half of a period, if no finite region is left between
/// the walls, if there are more walls than four and no region is given, or if the region is not inside the
/// domain.
///
/// ```
/// use granular_edmd::boundary::Container;
/// use granular_edmd::collision::Elastic;
/// use granular_edmd::observable::{PairCorrelation, SampleTimes, Sampled};
/// use granular_edmd::{Simulation, initial};
///
/// let container = Container::periodic(30.0, 30.0)?;
/// let disks = initial::random(&container, 200, 0.5, 30.0, 1)?;
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
    /// Numbers of pairs over the area of the shell, for each bin.
    pairs: Vec<BlockedMean>,
    /// Number of disks in the region, around which pairs are counted.
    centers: RunningMean,
    /// Number of partners in the region, over its area.
    partner_density: RunningMean,
}

impl PairCorrelation {
    /// Creates the correlation function of all disks, up to the distance `range` of their centers, in this
    /// many bins.
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
        })
    }

    /// Returns the same observer for disks of the second kind around disks of the first kind, which may be
    /// the same kind.
    pub fn between(self, first: Kind, second: Kind) -> Self {
        Self { kinds: Some([first, second]), ..self }
    }

    /// Returns the same observer, which counts pairs around the disks in a region.
    ///
    /// # Errors
    /// If an edge of the region is not finite, or the region has no area.
    pub fn within(self, region: Region) -> Result<Self, ParameterError> {
        Ok(Self { region: Some(checked_region(region)?), ..self })
    }

    /// Returns the largest distance.
    pub fn range(&self) -> f64 {
        self.bins.edge(self.bins.count())
    }

    /// Returns the number of samples that were taken.
    pub const fn samples(&self) -> u64 {
        self.centers.count()
    }

    /// Iterates over the distances of the middles of the bins, with g(r) there, which is NaN as long as there
    /// are no disks.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = (f64, Estimate)> {
        let scale = 1.0 / (self.centers.mean() * self.partner_density.mean());
        self.pairs
            .iter()
            .enumerate()
            .map(move |(bin, pairs)| (self.bins.middle(bin), pairs.estimate().scaled(scale)))
    }

    /// Forgets all samples so far.
    pub fn clear(&mut self) {
        self.pairs.fill(BlockedMean::new());
        (self.centers, self.partner_density) = (RunningMean::default(), RunningMean::default());
    }

    /// Returns the region of the disks around which partners are counted.
    fn counted(&self, domain: &Domain) -> Result<Region, ParameterError> {
        let periods = domain.periods();
        for period in [periods.x, periods.y].into_iter().filter(|&period| period > 0.0) {
            let fits = 2.0 * self.range() <= period;
            accept(fits, "range of the correlation", "at most half of the period", self.range())?;
        }
        if let Some(region) = self.region {
            return inside(region, domain);
        }
        let inset = |periodic: bool| if periodic { 0.0 } else { self.range() };
        let inset = DVec2::new(inset(domain.periodic_sides), inset(domain.periodic_ends));
        let min = DVec2::new(domain.left, domain.bottom) + inset;
        let max = DVec2::new(domain.right, domain.top) - inset;
        let (is_left, requirement) =
            (min.cmplt(max).all(), "less than half of the distance between walls, or have a region");
        accept(is_left && max.is_finite(), "range of the correlation", requirement, self.range())?;
        Ok(Region::new(min, max))
    }

    fn is_of(&self, which: usize, disk: &Disk) -> bool {
        self.kinds.is_none_or(|kinds| kinds[which] == disk.kind())
    }

    /// Counts the ordered pairs at the distances of each bin.
    fn count(&self, disks: &[Disk], domain: &Domain, region: &Region) -> Vec<u64> {
        let mut counts = vec![0; self.bins.count()];
        let range = self.range();
        let mut squares = Squares::with_side(domain, range);
        for (index, disk) in disks.iter().enumerate().filter(|(_, disk)| self.is_of(1, disk)) {
            squares.add(disk.position(), 0.0, index);
        }
        let periods = domain.periods();
        let half = DVec2::select(periods.cmpgt(DVec2::ZERO), 0.5 * periods, DVec2::INFINITY);
        let around = |(_, disk): &(usize, &Disk)| self.is_of(0, disk) && region.contains(disk.position());
        for (index, disk) in disks.iter().enumerate().filter(around) {
            for other in squares.near(disk.position(), range).filter(|&other| other != index) {
                let (from, to) = (disk.position(), disks[other].position());
                // Most partners are nearer than their images, and need no division.
                let is_near = (to - from).abs().cmple(half).all();
                let separation = if is_near { to - from } else { domain.separation(from, to) };
                let squared = separation.length_squared();
                // Two pairs of three are too far apart, and need no root.
                if squared > range * range {
                    continue;
                }
                if let Some(bin) = self.bins.find(squared.sqrt()) {
                    counts[bin] += 1;
                }
            }
        }
        counts
    }
}

impl Accumulator for PairCorrelation {
    fn check(&self, start: &Snapshot<'_>) -> Result<(), ParameterError> {
        let (has_room, walls) = (self.region.is_some() || start.wall_count() <= SIDES, start.wall_count());
        let requirement = "at most 4, or the correlation within a region away from them";
        accept(has_room, "number of walls", requirement, walls as f64)?;
        self.counted(&start.domain()).map(|_| ())
    }

    fn add(&mut self, snapshot: &Snapshot<'_>) {
        let (disks, domain) = (snapshot.disks(), snapshot.domain());
        let Ok(region) = self.counted(&domain) else { return };
        let count = |which, is_counted: &dyn Fn(&Disk) -> bool| {
            disks.iter().filter(|disk| self.is_of(which, disk) && is_counted(disk)).count() as f64
        };
        let is_inside = |disk: &Disk| region.contains(disk.position());
        let (centers, partners, all) = (count(0, &is_inside), count(1, &is_inside), count(1, &|_| true));
        // A disk is not its own partner.
        let itself = if self.kinds.is_none_or(|[first, second]| first == second) { 1.0 } else { 0.0 };
        let others = if all > 0.0 { 1.0 - itself / all } else { 0.0 };
        self.centers.push(centers);
        self.partner_density.push(partners * others / region.area());
        for (bin, count) in self.count(disks, &domain, &region).into_iter().enumerate() {
            let (low, high) = (self.bins.edge(bin), self.bins.edge(bin + 1));
            self.pairs[bin].push(count as f64 / (PI * (high - low) * (high + low)));
        }
    }
}

impl Table for PairCorrelation {
    fn headings(&self) -> Vec<Heading> {
        headings(&[("distance", "length")], &[("pair_correlation", "1")])
    }

    fn rows(&self) -> Box<dyn Iterator<Item = Vec<f64>> + '_> {
        Box::new(self.iter().map(|(distance, value)| row(&[distance], &[value])))
    }
}

crate::gate::from_file! {
    PairCorrelation {
        bins: Bins, kinds: Option<[Kind; 2]>,
        #[serde(deserialize_with = "super::grid::region_from_file")] region: Option<Region>,
        pairs: Vec<BlockedMean>, centers: RunningMean, partner_density: RunningMean
     } => {
        bins.check_count(pairs.len())?;
        let starts_at_zero = bins.edge(0) == 0.0;
        accept(starts_at_zero, "least distance of the correlation", "0", bins.edge(0))?;
        for count in pairs.iter().map(BlockedMean::count).chain([partner_density.count()]) {
            let fits = count == centers.count();
            accept(fits, "number of samples of a bin", "that of the correlation", count as f64)?;
        }
        Ok(Self { bins, kinds, region, pairs, centers, partner_density })
    }
}
