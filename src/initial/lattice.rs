//! Placement of disks on a lattice, or in rows if their sizes differ.

use glam::DVec2;

use super::{CLOSE, PlacementError, check_periods, countable, room, spacings};
use crate::boundary::{Boundary, Domain, Probe};
use crate::quantity::{accept, positive};
use crate::{Disk, ParameterError};

/// Number of consecutive rows without a free site after which the search ends. Walls may cover the floor, and
/// under an open top there is no last row.
const MOST_EMPTY_ROWS: usize = 1000;

/// Returns `count` equal disks at rest on a square lattice in the lower part of the boundary, row by row from
/// the floor up and from left to right.
///
/// Over a floor that moves only vertically, each column would bounce in a straight line forever, and the run
/// would give a [warning](crate::simulation::Warning::OneDirection). Give the disks small velocities
/// ([`with_maxwellian_velocities`](super::with_maxwellian_velocities)).
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
    from_floor_up(boundary, count, radius, false)
}

/// Returns `count` equal disks at rest on a triangular lattice in the lower part of the boundary, row by row
/// from the floor up and from left to right.
///
/// Each second row is shifted by half the distance between neighbors, and has one site less between walls. In
/// all other respects, the function works like [`lattice`].
///
/// # Errors
/// If the radius is not finite and positive, there are more than 2²⁸ disks, or there is no room.
///
/// ```
/// use granular_edmd::boundary::Container;
/// use granular_edmd::initial;
/// let disks = initial::triangular_lattice(&Container::open(3.0)?, 5, 0.5)?;
/// let columns: Vec<f64> = disks.iter().map(|disk| disk.position().x).collect();
/// assert_eq!(columns, [0.5, 2.5, 1.5, 0.5, 2.5]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn triangular_lattice<B: Boundary + ?Sized>(
    boundary: &B,
    count: usize,
    radius: f64,
) -> Result<Vec<Disk>, PlacementError> {
    from_floor_up(boundary, count, radius, true)
}

/// Fills a square or triangular lattice from the floor up, with the widest spacing that leaves room for all
/// disks.
fn from_floor_up<B: Boundary + ?Sized>(
    boundary: &B,
    count: usize,
    radius: f64,
    is_triangular: bool,
) -> Result<Vec<Disk>, PlacementError> {
    positive("radius", radius)?;
    countable(count)?;
    check_periods(&boundary.domain(), radius)?;
    let interior = boundary.interior();
    let room = room(&interior, radius);
    let mut most = 0;
    for spacing in spacings() {
        let spacing = 2.0 * radius * spacing;
        let disks = free_disks(boundary, &room, spacing, is_triangular, count, radius)?;
        if disks.len() == count {
            return Ok(disks);
        }
        most = most.max(disks.len());
    }
    Err(PlacementError::NoRoom { count, placed: most, radius, interior })
}

/// Returns `count` equal disks at rest on a square lattice over the whole interior of the boundary.
///
/// Columns and rows are about equally far apart. If the lattice has more sites than disks, the empty sites
/// lie evenly among the others. Sites that overlap a wall ([`Boundary::overlap`]) are left out. Without
/// gravity, such a gas is homogeneous from the start, unlike a gas on a [`lattice`], which fills only the
/// lower part.
///
/// # Errors
/// If the radius is not finite and positive, there are more than 2²⁸ disks, the interior has no top, or there
/// is no room.
///
/// ```
/// use granular_edmd::boundary::Container;
/// use granular_edmd::initial;
/// let disks = initial::even_lattice(&Container::periodic(100.0, 100.0)?, 1000, 0.5)?;
/// let upper = disks.iter().filter(|disk| disk.position().y > 49.0).count();
/// assert!(upper.abs_diff(500) < 20);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn even_lattice<B: Boundary + ?Sized>(
    boundary: &B,
    count: usize,
    radius: f64,
) -> Result<Vec<Disk>, PlacementError> {
    positive("radius", radius)?;
    countable(count)?;
    check_periods(&boundary.domain(), radius)?;
    let interior = boundary.interior();
    accept(interior.top.is_finite(), "top of the interior", "finite", interior.top)?;
    if count == 0 {
        return Ok(Vec::new());
    }
    let room = room(&interior, radius);
    let closest = 2.0 * radius * CLOSE;
    // The first spacing is too wide by 10 %, even if no site overlaps a wall; each attempt is a little
    // closer.
    let mut spacing = 1.1 * (interior.width() * interior.height() / count as f64).sqrt();
    loop {
        let sites = free_sites(boundary, &room, spacing.max(closest), radius);
        if sites.len() >= count {
            let chosen = (0..count).map(|disk| sites[disk * sites.len() / count]);
            return Ok(chosen.map(|site| Disk::new(site, radius)).collect::<Result<_, _>>()?);
        }
        if spacing <= closest {
            return Err(PlacementError::NoRoom { count, placed: sites.len(), radius, interior });
        }
        spacing *= 0.99;
    }
}

/// Returns the sites of a square lattice with at least this spacing that overlap no wall.
fn free_sites<B: Boundary + ?Sized>(boundary: &B, room: &Domain, spacing: f64, radius: f64) -> Vec<DVec2> {
    let (columns, pitch) = columns(room, spacing);
    let rows = rows(room, spacing);
    let intervals = if room.periodic_ends { rows } else { rows.saturating_sub(1) };
    let rise = (room.top - room.bottom) / intervals.max(1) as f64;
    // A single row or column between walls is in the middle.
    let low = if rows == 1 && !room.periodic_ends { 0.5 * (room.bottom + room.top) } else { room.bottom };
    let left = if columns == 1 && !room.periodic_sides { 0.5 * (room.left + room.right) } else { room.left };
    let row = |row: u64| {
        let height = low + row as f64 * rise;
        (0..columns).map(move |column| DVec2::new(left + column as f64 * pitch, height))
    };
    (0..rows)
        .flat_map(row)
        .filter(|&site| boundary.overlap(&Probe::new(site, radius, 0.0)).is_none())
        .collect()
}

/// Returns up to `count` disks on a square or triangular lattice with at least this spacing, where they
/// overlap no wall.
fn free_disks<B: Boundary + ?Sized>(
    boundary: &B,
    room: &Domain,
    spacing: f64,
    is_triangular: bool,
    count: usize,
    radius: f64,
) -> Result<Vec<Disk>, ParameterError> {
    let (columns, pitch) = columns(room, spacing);
    let rise = if is_triangular { 0.75_f64.sqrt() * spacing } else { spacing };
    let rows = rows(room, rise);
    // Across periodic ends, a row has a shifted neighbor only if the number of rows is even.
    let rows = if is_triangular && room.periodic_ends { rows - rows % 2 } else { rows };
    let (mut disks, mut empty) = (Vec::new(), 0);
    for row in 0..rows {
        let height = room.bottom + row as f64 * rise;
        let is_shifted = is_triangular && row % 2 == 1;
        let left = if is_shifted { room.left + 0.5 * pitch } else { room.left };
        let columns = if is_shifted && !room.periodic_sides { columns.saturating_sub(1) } else { columns };
        let sites = (0..columns).map(|column| DVec2::new(left + column as f64 * pitch, height));
        let free = sites.filter(|&site| boundary.overlap(&Probe::new(site, radius, 0.0)).is_none());
        let before = disks.len();
        for site in free.take(count - before) {
            disks.push(Disk::new(site, radius)?);
        }
        empty = if disks.len() > before { 0 } else { empty + 1 };
        if disks.len() == count || empty == MOST_EMPTY_ROWS {
            break;
        }
    }
    Ok(disks)
}

/// Returns the number of columns of a square lattice with at least this spacing, and the distance between two
/// columns.
fn columns(room: &Domain, spacing: f64) -> (u64, f64) {
    let intervals = (room.width() / spacing).floor().max(0.0);
    let columns = if room.periodic_sides { intervals } else { intervals + 1.0 };
    let columns = if room.width() < 0.0 { 0.0 } else { columns };
    (columns as u64, if intervals > 0.0 { room.width() / intervals } else { 0.0 })
}

/// Returns the number of rows, which is huge under an open top.
fn rows(room: &Domain, spacing: f64) -> u64 {
    let intervals = ((room.top - room.bottom) / spacing).floor();
    // If top and bottom are periodic, a row at the top would coincide with the first row.
    if room.periodic_ends { intervals as u64 } else { (intervals + 1.0) as u64 }
}

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
