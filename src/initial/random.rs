//! Disks at random places.

use std::collections::HashMap;

use glam::DVec2;
use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;

use super::{PlacementError, countable, room};
use crate::Disk;
use crate::boundary::{Boundary, Domain};
use crate::quantity::positive;
use crate::random::uniform;

/// Trials for each disk.
const TRIALS: usize = 10_000;

/// Returns equal disks at rest at random places that do not overlap, below the height `below` (the lid, if
/// that is lower).
///
/// Places are drawn in the interior of the boundary, and taken where a disk overlaps neither another disk nor
/// a wall ([`Boundary::overlap`] at time 0). In a round drum, all disks lie inside the circle.
///
/// Disks are placed one by one where there is room. Dense states (area fraction above 0.5, say) cannot be
/// reached in this way: start from a [`lattice`](super::lattice()) and let it melt.
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

/// Returns these disks, of any mix of radii, at random places that do not overlap, below the height `below`.
/// The rest is as for [`random`].
///
/// # Errors
/// If the height is not finite and positive, or a disk finds no place in ten thousand trials.
///
/// ```
/// use granular_edmd::glam::DVec2;
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

/// Returns a random place in the interior, such that the disk's edge is below the height `below`.
fn random_site(interior: &Domain, radius: f64, below: f64, generator: &mut Xoshiro256PlusPlus) -> DVec2 {
    let room = room(interior, radius);
    let top = room.top.min(below - radius);
    DVec2::new(
        room.left + room.width() * uniform(generator),
        room.bottom + (top - room.bottom).max(0.0) * uniform(generator),
    )
}

/// Square bins for finding the disks near a place.
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
