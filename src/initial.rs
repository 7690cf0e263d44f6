//! Initial states: where the disks start, and how fast.

use std::collections::HashMap;

use glam::DVec2;
use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;
use thiserror::Error;

use crate::boundary::{Boundary, Domain};
use crate::disk::MOST_DISKS;
use crate::quantity::{accept, non_negative, positive};
use crate::random::{normal, uniform};
use crate::{Disk, ParameterError};

/// Least distance of neighbours in a [`lattice`], in diameters.
const CLOSE: f64 = 1.000_1;

/// Largest distance of neighbours in a [`lattice`], in diameters.
const LOOSE: f64 = 1.4;

/// Trials for each disk of a random placement.
const TRIALS: usize = 10_000;

/// The disks do not fit, or cannot be placed.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum PlacementError {
    /// A parameter is out of range.
    #[error(transparent)]
    Parameter(#[from] ParameterError),
    /// There is no room for so many disks.
    #[error("there is room for {placed} of {count} disks of radius {radius}")]
    NoRoom {
        /// How many disks were wanted.
        count: usize,
        /// How many could be placed.
        placed: usize,
        /// Their radius.
        radius: f64,
    },
}

/// `count` equal disks at rest on a square lattice in the lower part of the boundary, from the left to the right in rows
/// from the floor up.
///
/// Neighbours are up to 1.4 diameters apart, closer if the boundary is not high enough for that.
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
    let spacings = (0..=40).map(|k| LOOSE + (CLOSE - LOOSE) * f64::from(k) / 40.0);
    let mut most = 0;
    for spacing in spacings {
        let sites = sites(&room, 2.0 * radius * spacing, count);
        let disks = free_disks(boundary, sites, radius, count)?;
        if disks.len() == count {
            return Ok(disks);
        }
        most = most.max(disks.len());
    }
    Err(PlacementError::NoRoom { count, placed: most, radius })
}

/// An open container has room for any number: a slip of the pen must not cost all memory.
fn countable(count: usize) -> Result<(), ParameterError> {
    accept(count <= MOST_DISKS, "number of disks", "at most 2^28", count as f64).map(|_| ())
}

/// Where a centre may be; an open top stays open.
fn room(interior: &Domain, radius: f64) -> Domain {
    let side = if interior.periodic { 0.0 } else { radius };
    Domain {
        left: interior.left + side,
        right: interior.right - side,
        bottom: interior.bottom + radius,
        top: interior.top - radius,
        periodic: interior.periodic,
    }
}

/// The sites of a square lattice with at least this spacing, row by row from the bottom.
fn sites(room: &Domain, spacing: f64, count: usize) -> impl Iterator<Item = DVec2> {
    let intervals = (room.width() / spacing).floor().max(0.0);
    let columns = if room.periodic { intervals } else { intervals + 1.0 };
    let columns = if room.width() < 0.0 { 0.0 } else { columns };
    let pitch = if intervals > 0.0 { room.width() / intervals } else { 0.0 };
    let rows = ((room.top - room.bottom) / spacing).floor() + 1.0;
    let rows = rows.clamp(0.0, (count as f64 / columns.max(1.0)).ceil() + 8.0);
    let (left, bottom) = (room.left, room.bottom);
    let spots = (0..rows as u64).flat_map(move |row| (0..columns as u64).map(move |column| (row, column)));
    spots.map(move |(row, column)| DVec2::new(left + column as f64 * pitch, bottom + row as f64 * spacing))
}

fn free_disks<B: Boundary + ?Sized>(
    boundary: &B,
    sites: impl Iterator<Item = DVec2>,
    radius: f64,
    count: usize,
) -> Result<Vec<Disk>, ParameterError> {
    let free = sites.filter(|&site| boundary.overlap(site, radius, 0.0).is_none());
    free.take(count).map(|site| Disk::new(site, radius)).collect()
}

/// Equal disks at rest at random places that do not overlap, below the height `below` (the lid, if that is lower).
///
/// Disks are placed one by one where there is room: dense states (area fraction above 0.5, say) do not come about this
/// way; start from a [`lattice`] and let it melt.
///
/// # Errors
/// If the radius or the height is not finite and positive, or a disk finds no place in ten thousand trials.
///
/// ```
/// use granular_edmd::boundary::Container;
/// use granular_edmd::initial;
/// let container = Container::closed(20.0, 20.0)?;
/// let disks = initial::random(&container, 100, 0.5, 20.0, 42)?;
/// assert_eq!(disks, initial::random(&container, 100, 0.5, 20.0, 42)?);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn random<B: Boundary + ?Sized>(
    boundary: &B,
    count: usize,
    radius: f64,
    below: f64,
    seed: u64,
) -> Result<Vec<Disk>, PlacementError> {
    positive("radius", radius)?;
    positive("height", below)?;
    countable(count)?;
    let radii = std::iter::repeat_n(radius, count);
    let disks = radii.map(|radius| Disk::new(DVec2::ZERO, radius)).collect::<Result<Vec<_>, _>>()?;
    placed_at_random(boundary, disks, below, seed)
}

/// These disks, of any mix of radii, at random places that do not overlap, below the height `below`; else as
/// [`random`].
///
/// # Errors
/// If the height is not finite and positive, or a disk finds no place in ten thousand trials.
///
/// ```
/// use glam::DVec2;
/// use granular_edmd::boundary::Container;
/// use granular_edmd::{Disk, initial};
/// let mix = vec![Disk::new(DVec2::ZERO, 2.0)?, Disk::new(DVec2::ZERO, 0.5)?.with_mass(0.1)?];
/// let disks = initial::placed_at_random(&Container::closed(20.0, 20.0)?, mix, 20.0, 1)?;
/// assert_eq!(disks[0].radius(), 2.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn placed_at_random<B: Boundary + ?Sized>(
    boundary: &B,
    disks: Vec<Disk>,
    below: f64,
    seed: u64,
) -> Result<Vec<Disk>, PlacementError> {
    positive("height", below)?;
    let mut generator = Xoshiro256PlusPlus::seed_from_u64(seed);
    let largest = disks.iter().map(Disk::radius).fold(0.0, f64::max);
    let mut bins = Bins::new(&boundary.domain(), 2.0 * largest, disks.len());
    let (count, mut placed) = (disks.len(), Vec::with_capacity(disks.len()));
    for disk in disks {
        let trial = (0..TRIALS).find_map(|_| {
            let site = random_site(&boundary.interior(), disk.radius(), below, &mut generator);
            let inside = boundary.overlap(site, disk.radius(), 0.0).is_none();
            (inside && bins.is_free(site, disk.radius(), &placed)).then_some(site)
        });
        let Some(site) = trial else {
            return Err(PlacementError::NoRoom { count, placed: placed.len(), radius: disk.radius() });
        };
        bins.add(site, placed.len());
        placed.push(disk.with_position(site)?);
    }
    Ok(placed)
}

/// A place inside.
fn random_site(interior: &Domain, radius: f64, below: f64, generator: &mut Xoshiro256PlusPlus) -> DVec2 {
    let room = room(interior, radius);
    let top = room.top.min(below - radius);
    DVec2::new(
        room.left + room.width() * uniform(generator),
        room.bottom + (top - room.bottom).max(0.0) * uniform(generator),
    )
}

/// Square bins that find the disks near a place.
struct Bins {
    domain: Domain,
    size: f64,
    columns: usize,
    disks: HashMap<(usize, i64), Vec<usize>>,
}

impl Bins {
    fn new(domain: &Domain, diameter: f64, count: usize) -> Self {
        let finest = domain.width() / (4 * count + 4) as f64;
        let columns = (domain.width() / diameter.max(finest)).floor().max(1.0);
        let size = domain.width() / columns;
        Self { domain: *domain, size, columns: columns as usize, disks: HashMap::new() }
    }

    fn bin(&self, site: DVec2) -> (usize, i64) {
        let column = ((site.x - self.domain.left) / self.size).floor().max(0.0) as usize;
        (column.min(self.columns - 1), ((site.y - self.domain.bottom) / self.size).floor() as i64)
    }

    fn add(&mut self, site: DVec2, disk: usize) {
        self.disks.entry(self.bin(site)).or_default().push(disk);
    }

    fn is_free(&self, site: DVec2, radius: f64, placed: &[Disk]) -> bool {
        let (column, row) = self.bin(site);
        let columns = [column + self.columns - 1, column, column + 1].map(|c| c % self.columns);
        let rows = [row.saturating_sub(1), row, row.saturating_add(1)];
        let near = columns.into_iter().flat_map(|c| rows.map(|r| (c, r)));
        near.filter_map(|bin| self.disks.get(&bin)).flatten().all(|&other| {
            let contact = radius + placed[other].radius();
            self.domain.separation(site, placed[other].position()).length_squared() > contact * contact
        })
    }
}

/// The same disks with Maxwellian velocities of this temperature, about a centre of mass at rest, and not rotating.
///
/// Each component is normal with variance `$T/m$`; then the momentum is taken out in proportion to the masses.
///
/// # Errors
/// If the temperature is negative or not finite.
///
/// ```
/// use granular_edmd::boundary::Container;
/// use granular_edmd::initial;
/// let disks = initial::lattice(&Container::closed(60.0, 150.0)?, 1000, 0.5)?;
/// let disks = initial::with_maxwellian_velocities(disks, 2.0, 1)?;
/// let energy: f64 = disks.iter().map(|disk| disk.translational_energy()).sum();
/// assert!((energy / 1000.0 - 2.0).abs() < 0.3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn with_maxwellian_velocities(
    disks: Vec<Disk>,
    temperature: f64,
    seed: u64,
) -> Result<Vec<Disk>, ParameterError> {
    non_negative("temperature", temperature)?;
    let mut generator = Xoshiro256PlusPlus::seed_from_u64(seed);
    let draw = |disk: &Disk| {
        let speed = (temperature / disk.mass()).sqrt();
        DVec2::new(speed * normal(&mut generator), speed * normal(&mut generator))
    };
    let velocities: Vec<DVec2> = disks.iter().map(draw).collect();
    let mass: f64 = disks.iter().map(Disk::mass).sum();
    let momentum: DVec2 = disks.iter().zip(&velocities).map(|(disk, &velocity)| disk.mass() * velocity).sum();
    let drift = if disks.len() > 1 { momentum / mass } else { DVec2::ZERO };
    disks.into_iter().zip(velocities).map(|(disk, velocity)| disk.with_velocity(velocity - drift)).collect()
}
