//! Early requests to the memory for the data that the next events will need.

use super::cells::Cells;
use super::state::Bodies;
use crate::instructions::prefetch;
use crate::scheduler::EventScheduler;

/// Number of disks that are named as upcoming between two steps of a request: first the disk is requested,
/// then the cells that its event needs, then its neighbors in these cells.
const LATER: usize = 12;

/// The disks that were last named as upcoming. For each, the disk itself is requested from memory first, then
/// the cells that its event needs, and then its neighbors there.
#[derive(Debug, Clone, Default)]
pub(super) struct Lookahead {
    /// Index at which the next disk is written.
    next: usize,
    disks: [u32; 2 * LATER],
    /// Buffer for the disks that are newly named as upcoming.
    fresh: Vec<usize>,
}

impl Lookahead {
    /// Prefetches the data of the next events. The slice `found` is a buffer for the neighbors of a disk.
    ///
    /// Prefetching is worthwhile only for systems too large for the caches, since it takes many instructions.
    #[inline(never)]
    pub(super) fn look<S: EventScheduler + ?Sized>(
        &mut self,
        scheduler: &mut S,
        bodies: &Bodies,
        cells: &Cells,
        found: &mut [u32],
    ) {
        let mut fresh = std::mem::take(&mut self.fresh);
        scheduler.upcoming(&mut fresh);
        // A scheduler may name disks that do not exist.
        for disk in fresh.drain(..).filter(|&disk| disk < bodies.len()) {
            let (second, third) = self.note(disk);
            prefetch_disk(bodies, cells, disk);
            prefetch_cells(bodies, cells, second);
            prefetch_neighbors(bodies, cells, third, found);
        }
        self.fresh = fresh;
    }

    /// Forgets all disks, since one of them has left.
    pub(super) fn forget(&mut self) {
        self.disks = [0; 2 * LATER];
    }

    /// Notes a disk. Returns the disks that were named [`LATER`] and 2·[`LATER`] calls ago.
    #[inline]
    fn note(&mut self, disk: usize) -> (usize, usize) {
        let there = self.next % (2 * LATER);
        let second = self.disks[(there + LATER) % (2 * LATER)] as usize;
        let third = std::mem::replace(&mut self.disks[there], disk as u32) as usize;
        self.next = there + 1;
        (second, third)
    }
}

/// Prefetches the next event of a disk, and its place in the cells.
#[inline]
fn prefetch_disk(bodies: &Bodies, cells: &Cells, disk: usize) {
    prefetch(&bodies.particles, disk);
    cells.prefetch_place(disk);
}

/// Prefetches the partner of a disk, or the cells ahead of the disk.
#[inline]
fn prefetch_cells(bodies: &Bodies, cells: &Cells, disk: usize) {
    let forecast = bodies.particles[disk].forecast;
    if !forecast.is_collision() {
        // The cells ahead of a large disk are not prefetched, since such a disk crosses few cells.
        if !cells.is_large(disk) {
            cells.prefetch_ahead(disk, forecast.exit);
        }
        return;
    }
    let partner = forecast.partner as usize;
    prefetch_disk(bodies, cells, partner);
    prefetch(&bodies.spins, partner);
    prefetch(&bodies.spins, disk);
    cells.prefetch_around(disk);
}

/// Prefetches the trajectories of the disks with which a disk may collide.
#[inline]
fn prefetch_neighbors(bodies: &Bodies, cells: &Cells, disk: usize, found: &mut [u32]) {
    let forecast = bodies.particles[disk].forecast;
    let count = if forecast.is_collision() {
        if (forecast.partner as usize) < bodies.len() {
            cells.prefetch_around(forecast.partner as usize);
        }
        cells.around(disk, found)
    } else {
        if !forecast.exit.is_passage() | cells.is_large(disk) {
            return;
        }
        cells.ahead_of_next(disk, forecast.exit, found)
    };
    for &neighbor in &found[..count] {
        prefetch(&bodies.particles, neighbor as usize);
    }
}
