//! Disks on a lattice.

use glam::DVec2;

use super::{PlacementError, countable, room, spacings};
use crate::boundary::{Boundary, Domain};
use crate::quantity::positive;
use crate::{Disk, ParameterError};

/// Returns `count` equal disks at rest on a square lattice in the lower part of the boundary, row by row from
/// the floor up and from left to right.
///
/// Neighbors are up to 1.4 diameters apart, and closer if the boundary is not high enough for that. Sites
/// that overlap a wall ([`Boundary::overlap`]) are left out.
///
/// # Errors
/// If the radius is not finite and positive, there are more than 2²⁸ disks, or there is no room.
///
/// ```
/// use granular_edmd::boundary::Container;
/// use granular_edmd::initial;
/// let disks = initial::lattice(&Container::closed(60.0, 150.0)?, 1000, 0.5)?;
/// assert_eq!(disks.len(), 1000);
/// assert!(initial::lattice(&Container::closed(60.0, 10.0)?, 1000, 0.5).is_err());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn lattice<B: Boundary + ?Sized>(
    boundary: &B,
    count: usize,
    radius: f64,
) -> Result<Vec<Disk>, PlacementError> {
    positive("radius", radius)?;
    countable(count)?;
    let room = room(&boundary.interior(), radius);
    let mut most = 0;
    for spacing in spacings() {
        let sites = sites(&room, 2.0 * radius * spacing, count);
        let disks = free_disks(boundary, sites, radius, count)?;
        if disks.len() == count {
            return Ok(disks);
        }
        most = most.max(disks.len());
    }
    Err(PlacementError::NoRoom { count, placed: most, radius })
}

/// Returns the sites of a square lattice with at least this spacing, row by row from the bottom.
fn sites(room: &Domain, spacing: f64, count: usize) -> impl Iterator<Item = DVec2> {
    let intervals = (room.width() / spacing).floor().max(0.0);
    let columns = if room.periodic_sides { intervals } else { intervals + 1.0 };
    let columns = if room.width() < 0.0 { 0.0 } else { columns };
    let pitch = if intervals > 0.0 { room.width() / intervals } else { 0.0 };
    let rows = ((room.top - room.bottom) / spacing).floor();
    // At periodic ends, a row at the top would be the first one again.
    let rows = if room.periodic_ends { rows } else { rows + 1.0 };
    // Under an open top the rows must end somewhere; obstacles may take many of them.
    let rows = rows.clamp(0.0, 4.0 * (count as f64 / columns.max(1.0)).ceil() + 100.0);
    let (left, bottom) = (room.left, room.bottom);
    let spots = (0..rows as u64).flat_map(move |row| (0..columns as u64).map(move |column| (row, column)));
    spots.map(move |(row, column)| DVec2::new(left + column as f64 * pitch, bottom + row as f64 * spacing))
}

/// Returns disks on the first `count` sites that overlap no wall.
fn free_disks<B: Boundary + ?Sized>(
    boundary: &B,
    sites: impl Iterator<Item = DVec2>,
    radius: f64,
    count: usize,
) -> Result<Vec<Disk>, ParameterError> {
    let free = sites.filter(|&site| boundary.overlap(site, radius, 0.0).is_none());
    free.take(count).map(|site| Disk::new(site, radius)).collect()
}
