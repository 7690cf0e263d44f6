//! Placement of disks of any sizes in rows.

use glam::DVec2;

use super::{PlacementError, check_periods, countable, spacings};
use crate::Disk;
use crate::boundary::{Boundary, Domain, Probe};

/// Number of positions tried for each disk.
const TRIALS: usize = 100_000;

/// Returns these disks, of any mix of radii, in rows from the floor up and from left to right, in the order
/// given.
///
/// A row is as high as the largest disk is wide. Where several disks fit on top of each other, they stand in
/// one column. Neighbors are up to 1.4 diameters apart, and closer if the boundary is not high enough for
/// that. Equal disks stand on a square lattice. Positions that overlap a wall ([`Boundary::overlap`]) are
/// left out.
///
/// # Errors
/// If there are more than 2²⁸ disks, or there is no room.
///
/// ```
/// use granular_edmd::boundary::Container;
/// use granular_edmd::initial::{self, Radii};
/// let disks = initial::disks_from_radii(Radii::two_sizes(0.5, 2.0, 0.1)?.draw(1000, 1), 1.0)?;
/// let placed = initial::placed_in_rows(&Container::closed(60.0, 150.0)?, disks.clone())?;
/// assert_eq!(placed[7].radius(), disks[7].radius());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn placed_in_rows<B: Boundary + ?Sized>(
    boundary: &B,
    disks: Vec<Disk>,
) -> Result<Vec<Disk>, PlacementError> {
    countable(disks.len())?;
    check_periods(&boundary.domain(), disks.iter().map(Disk::radius).fold(0.0, f64::max))?;
    let mut most = 0;
    for spacing in spacings() {
        let mut rows = Rows::new(boundary, &disks, spacing);
        let sites: Vec<DVec2> = disks.iter().map_while(|disk| rows.site(disk)).collect();
        if sites.len() == disks.len() {
            let placed = disks.into_iter().zip(sites).map(|(disk, site)| disk.with_position(site));
            return Ok(placed.collect::<Result<_, _>>()?);
        }
        most = most.max(sites.len());
    }
    let radius = disks.get(most).map_or(0.0, Disk::radius);
    Err(PlacementError::NoRoom { count: disks.len(), placed: most, radius, interior: boundary.interior() })
}

/// The rows that are being filled.
struct Rows<'a, B: ?Sized> {
    boundary: &'a B,
    interior: Domain,
    /// Distance between neighbors, in diameters.
    spacing: f64,
    /// Height of each row.
    height: f64,
    /// Lower left corner of the present column.
    corner: DVec2,
    /// Width and height of the present column.
    column: DVec2,
}

impl<'a, B: Boundary + ?Sized> Rows<'a, B> {
    fn new(boundary: &'a B, disks: &[Disk], spacing: f64) -> Self {
        let interior = boundary.interior();
        let largest = disks.iter().map(Disk::radius).fold(0.0, f64::max);
        let corner = DVec2::new(interior.left, interior.bottom);
        Self { boundary, interior, spacing, height: 2.0 * largest * spacing, corner, column: DVec2::ZERO }
    }

    /// Returns the next free position for a disk of this radius and kind.
    fn site(&mut self, disk: &Disk) -> Option<DVec2> {
        let radius = disk.radius();
        let size = 2.0 * radius * self.spacing;
        for _ in 0..TRIALS {
            if !self.make_room(radius, size) {
                return None;
            }
            let site = self.corner + DVec2::new(0.5 * size, self.column.y + 0.5 * size);
            let is_free =
                self.boundary.overlap(&Probe::new(site, radius, 0.0).with_kind(disk.kind())).is_none();
            // Next to an obstacle, the search advances in steps of about a radius.
            self.column =
                DVec2::new(self.column.x.max(size), self.column.y + if is_free { size } else { 0.5 * size });
            if is_free {
                return Some(site);
            }
        }
        None
    }

    /// Begins a new column if the present column is full, and a new row if the present row is full. Returns
    /// whether the disk fits below the lid.
    fn make_room(&mut self, radius: f64, size: f64) -> bool {
        if self.column.y + size > self.height {
            self.corner.x += self.column.x;
            self.column = DVec2::ZERO;
        }
        if self.corner.x + size > self.interior.right && self.corner.x > self.interior.left {
            self.corner = DVec2::new(self.interior.left, self.corner.y + self.height);
            self.column = DVec2::ZERO;
        }
        // Under a lid, no gap is needed. If top and bottom are periodic, the first row is the next neighbor,
        // so the gap stays.
        let end = if self.interior.periodic_ends { size } else { 0.5 * size + radius };
        self.corner.y + self.column.y + end <= self.interior.top
    }
}
