//! Asking the memory for what the next events will need.

use super::engine::Simulation;
use crate::boundary::Boundary;
use crate::collision::CollisionRule;
use crate::prefetch::prefetch;
use crate::scheduler::EventScheduler;

/// Disks from which on the caches do not hold all of a system.
const LARGE: usize = 20_000;

/// How far ahead data are asked for, and what they lead to, in buckets of the bucket queue; and how many buckets an event takes.
const FAR: usize = 48;
const NEAR: usize = 32;
const NEXT: usize = 16;
const STRIDE: usize = 4;

impl<R: CollisionRule, B: Boundary, S: EventScheduler> Simulation<R, B, S> {
    /// Asks for what the next events will need, where the caches do not hold the system anyway.
    ///
    /// What is far ahead is asked for first, and what that leads to when it has come.
    #[inline]
    pub(super) fn fetch_ahead(&mut self) {
        if self.slots.len() < LARGE {
            return;
        }
        for ahead in 0..STRIDE {
            if let Some(disk) = self.scheduler.soon(FAR + ahead) {
                prefetch(&self.slots, disk);
                prefetch(&self.bodies.trajectories, disk);
                self.cells.prefetch_place(disk);
            }
            if let Some(disk) = self.scheduler.soon(NEAR + ahead) {
                let partner = self.slots[disk].partner as usize;
                prefetch(&self.slots, partner);
                prefetch(&self.bodies.trajectories, partner);
                prefetch(&self.bodies.spins, partner);
                prefetch(&self.bodies.spins, disk);
                self.cells.prefetch_around(disk);
            }
            if let Some(disk) = self.scheduler.soon(NEXT + ahead) {
                let count = self.find_neighbours(disk);
                for &neighbour in &self.found[..count] {
                    prefetch(&self.bodies.trajectories, neighbour as usize);
                }
            }
        }
    }
}
