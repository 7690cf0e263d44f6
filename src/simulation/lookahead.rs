//! Asking the memory for what the next events will need.

use super::engine::Simulation;
use super::event::Exit;
use crate::boundary::Boundary;
use crate::collision::CollisionRule;
use crate::prefetch::prefetch;
use crate::scheduler::{EventScheduler, LARGE_SYSTEM};

/// How many disks later what a disk leads to is asked for, and again what that leads to.
const LATER: usize = 12;

/// The disks that last came into sight: each is asked for, then the cells that its event needs, then its neighbours there.
#[derive(Debug, Clone, Default)]
pub(super) struct Lookahead {
    /// Where the next disk is written.
    next: usize,
    disks: [u32; 2 * LATER],
    /// Room for the disks that come into sight.
    fresh: Vec<usize>,
}

impl Lookahead {
    /// Takes note of a disk; returns those that came into sight once and twice so many disks before.
    #[inline]
    fn note(&mut self, disk: usize) -> (usize, usize) {
        let there = self.next % (2 * LATER);
        let second = self.disks[(there + LATER) % (2 * LATER)] as usize;
        let third = std::mem::replace(&mut self.disks[there], disk as u32) as usize;
        self.next = there + 1;
        (second, third)
    }
}

impl<R: CollisionRule, B: Boundary, S: EventScheduler> Simulation<R, B, S> {
    /// Asks for what the next events will need, where the caches do not hold the system anyway.
    #[inline]
    pub(super) fn look_ahead(&mut self) {
        if self.bodies.len() >= LARGE_SYSTEM {
            self.look_far();
        }
    }

    #[inline(never)]
    fn look_far(&mut self) {
        let mut fresh = std::mem::take(&mut self.lookahead.fresh);
        self.scheduler.upcoming(&mut fresh);
        let count = self.bodies.len();
        for disk in fresh.drain(..).filter(|&disk| disk < count) {
            let (second, third) = self.lookahead.note(disk);
            self.prefetch_disk(disk);
            self.prefetch_cells(second);
            self.prefetch_neighbours(third);
        }
        self.lookahead.fresh = fresh;
    }

    /// What its event is, and where.
    #[inline]
    fn prefetch_disk(&self, disk: usize) {
        prefetch(&self.bodies.particles, disk);
        self.cells.prefetch_place(disk);
    }

    /// The partner or the cells ahead.
    #[inline]
    fn prefetch_cells(&self, disk: usize) {
        let slot = *self.slot(disk);
        if slot.exit_due < slot.collision_due {
            return self.cells.prefetch_ahead(disk, slot.exit);
        }
        let partner = slot.partner as usize;
        self.prefetch_disk(partner);
        prefetch(&self.bodies.spins, partner);
        prefetch(&self.bodies.spins, disk);
        self.cells.prefetch_around(disk);
    }

    /// The trajectories of those that it may meet.
    #[inline]
    fn prefetch_neighbours(&mut self, disk: usize) {
        let slot = *self.slot(disk);
        let count = if slot.exit_due < slot.collision_due {
            if matches!(slot.exit, Exit::Wall | Exit::Stay) {
                return;
            }
            self.make_room();
            self.cells.ahead(self.cells.next_place(disk, slot.exit), slot.exit, &mut self.found)
        } else {
            if (slot.partner as usize) < self.bodies.len() {
                self.cells.prefetch_around(slot.partner as usize);
            }
            self.find_neighbours(disk)
        };
        for &neighbour in &self.found[..count] {
            prefetch(&self.bodies.particles, neighbour as usize);
        }
    }
}
