//! The neighbors of disks.

use glam::DVec2;

use super::Snapshot;
use crate::boundary::{Domain, Squares};
use crate::quantity::{accept, positive};
use crate::{Disk, ParameterError};

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

    /// Returns the range.
    pub const fn range(&self) -> f64 {
        self.range
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
pub(super) fn check_range(name: &'static str, range: f64, domain: &Domain) -> Result<(), ParameterError> {
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
