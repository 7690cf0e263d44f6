//! Bins for finding the disks near a place.

use std::collections::HashMap;

use glam::DVec2;

use crate::Disk;
use crate::boundary::Domain;

/// Bins for finding the disks near a place.
pub(super) struct Bins {
    domain: Domain,
    size: DVec2,
    columns: usize,
    /// Number of rows, after which periodic ends begin anew.
    rows: Option<i64>,
    disks: HashMap<(usize, i64), Vec<usize>>,
}

impl Bins {
    /// Makes empty bins that are at least as wide as this diameter, for so many disks.
    pub(super) fn new(domain: &Domain, diameter: f64, count: usize) -> Self {
        let finest = domain.width() / (4 * count + 4) as f64;
        let columns = (domain.width() / diameter.max(finest)).floor().max(1.0);
        let width = domain.width() / columns;
        let rows = domain.periodic_ends.then(|| (domain.height() / width).floor().max(1.0));
        let size = DVec2::new(width, rows.map_or(width, |rows| domain.height() / rows));
        let (columns, rows) = (columns as usize, rows.map(|rows| rows as i64));
        Self { domain: *domain, size, columns, rows, disks: HashMap::new() }
    }

    fn bin(&self, site: DVec2) -> (usize, i64) {
        let column = ((site.x - self.domain.left) / self.size.x).floor().max(0.0) as usize;
        let row = ((site.y - self.domain.bottom) / self.size.y).floor() as i64;
        (column.min(self.columns - 1), self.rows.map_or(row, |rows| row.rem_euclid(rows)))
    }

    /// Adds a disk of this index.
    pub(super) fn add(&mut self, site: DVec2, disk: usize) {
        self.disks.entry(self.bin(site)).or_default().push(disk);
    }

    /// Names the disks in the nine bins around a place, some of them twice in very narrow domains.
    pub(super) fn near(&self, site: DVec2) -> impl Iterator<Item = usize> {
        let (column, row) = self.bin(site);
        let columns = [column + self.columns - 1, column, column + 1].map(|c| c % self.columns);
        let rows = [row.saturating_sub(1), row, row.saturating_add(1)]
            .map(|row| self.rows.map_or(row, |rows| row.rem_euclid(rows)));
        let near = columns.into_iter().flat_map(move |c| rows.map(|r| (c, r)));
        near.filter_map(|bin| self.disks.get(&bin)).flatten().copied()
    }

    /// Tells whether a disk of this radius at this place overlaps none of those placed.
    pub(super) fn is_free(&self, site: DVec2, radius: f64, placed: &[Disk]) -> bool {
        self.near(site).all(|other| {
            let contact = radius + placed[other].radius();
            self.domain.separation(site, placed[other].position()).length_squared() > contact * contact
        })
    }
}
