//! Placement of disks at random.

use glam::DVec2;
use rand_xoshiro::Xoshiro256PlusPlus;

use super::{PlacementError, check_periods, countable, cut, room};
use crate::Disk;
use crate::boundary::{Boundary, Domain, Probe, Squares};
use crate::quantity::positive;
use crate::random::{Stream, generator, uniform};

/// Number of trials for each disk.
const TRIALS: usize = 10_000;

/// Returns equal disks at rest at random positions that do not overlap, below the height `below` (or the lid,
/// if that is lower).
///
/// Positions are drawn in the interior of the boundary, and a position is accepted if the disk overlaps
/// neither another disk nor a wall there ([`Boundary::overlap`] at time 0). In a round drum, all disks lie
/// inside the circle.
///
/// Disks are placed one by one where there is room (random sequential addition). This method cannot reach
/// dense states, such as area fractions above 0.5. For these, start from a [`lattice`](super::lattice()) and
/// let it melt, or take [`packed_mix`](super::packed_mix).
///
/// # Errors
/// If the radius is not finite and positive, the height is not finite and above the bottom of the interior,
/// there are more than 2²⁸ disks, or a disk finds no position in ten thousand trials.
///
/// ```
/// use granular_edmd::boundary::Container;
/// use granular_edmd::initial;
/// let container = Container::closed(20.0, 20.0)?;
/// let disks = initial::scattered(&container, 100, 0.5, 20.0, 42)?;
/// assert_eq!(disks, initial::scattered(&container, 100, 0.5, 20.0, 42)?);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn scattered<B: Boundary + ?Sized>(
    boundary: &B,
    count: usize,
    radius: f64,
    below: f64,
    seed: u64,
) -> Result<Vec<Disk>, PlacementError> {
    positive("radius", radius)?;
    countable(count)?;
    scattered_mix(boundary, vec![Disk::new(DVec2::ZERO, radius)?; count], below, seed)
}

/// Returns these disks, of any mix of radii, at random positions that do not overlap, below the height
/// `below`.
///
/// The largest disks are placed first, since they find the least room. The returned disks have the order of
/// the given ones. In all other respects, the function works like [`scattered`].
///
/// # Errors
/// If the height is not finite and above the bottom of the interior, there are more than 2²⁸ disks, or a disk
/// finds no position in ten thousand trials.
///
/// ```
/// use granular_edmd::glam::DVec2;
/// use granular_edmd::boundary::Container;
/// use granular_edmd::{Disk, initial};
/// let mix = vec![Disk::new(DVec2::ZERO, 2.0)?, Disk::new(DVec2::ZERO, 0.5)?.with_mass(0.1)?];
/// let disks = initial::scattered_mix(&Container::closed(20.0, 20.0)?, mix, 20.0, 1)?;
/// assert_eq!(disks[0].radius(), 2.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn scattered_mix<B: Boundary + ?Sized>(
    boundary: &B,
    mut disks: Vec<Disk>,
    below: f64,
    seed: u64,
) -> Result<Vec<Disk>, PlacementError> {
    countable(disks.len())?;
    let interior = cut(boundary.interior(), below)?;
    check_periods(&boundary.domain(), disks.iter().map(Disk::radius).fold(0.0, f64::max))?;
    let mut generator = generator(seed, Stream::Places, 0);
    let mut squares = Squares::new(&boundary.domain(), disks.iter().map(Disk::radius));
    let mut order: Vec<usize> = (0..disks.len()).collect();
    order.sort_by(|&a, &b| disks[b].radius().total_cmp(&disks[a].radius()));
    let mut placed: Vec<Disk> = Vec::with_capacity(disks.len());
    for &index in &order {
        let (radius, probe) = (disks[index].radius(), Probe::of(&disks[index], 0.0));
        let [placed_alike, alike] =
            [&placed, &disks].map(|disks| disks.iter().filter(|disk| disk.radius() == radius));
        let Some(room) = room_for(&interior, radius) else {
            return Err(PlacementError::NoRoom { count: alike.count(), placed: 0, radius, interior });
        };
        let sites = (0..TRIALS).map(|_| random_site(&room, &mut generator));
        let mut free = sites.filter(|&site| boundary.overlap(&probe.with_position(site)).is_none());
        let Some(site) = free.find(|&site| squares.is_free(site, radius, &placed)) else {
            let (count, placed) = (alike.count(), placed_alike.count());
            return Err(PlacementError::NoPosition { count, placed, radius, interior });
        };
        squares.add(site, radius, placed.len());
        placed.push(disks[index].with_position(site)?);
    }
    for (index, disk) in order.into_iter().zip(placed) {
        disks[index] = disk;
    }
    Ok(disks)
}

/// Returns the rectangle for the center of a disk, or `None` if the disk is too large for the interior, or
/// would overlap its own image at periodic sides or ends.
fn room_for(interior: &Domain, radius: f64) -> Option<Domain> {
    let room = room(interior, radius);
    let fits = |period: f64| period == 0.0 || 2.0 * radius <= period;
    let DVec2 { x, y } = interior.periods();
    (room.width() >= 0.0 && room.height() >= 0.0 && fits(x) && fits(y)).then_some(room)
}

/// Returns a random position in a rectangle.
fn random_site(room: &Domain, generator: &mut Xoshiro256PlusPlus) -> DVec2 {
    DVec2::new(
        room.left + room.width() * uniform(generator),
        room.bottom + room.height() * uniform(generator),
    )
}
