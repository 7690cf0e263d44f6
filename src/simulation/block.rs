//! A few disks of a cell.

use crate::disk::MOST_DISKS;

/// Disks that a block has room for.
pub(super) const SLOTS: usize = 4;

/// In the first slot, above the number of the disk: how many slots are taken, and whether the disks can touch a wall.
const DISK: u32 = (1 << 28) - 1;
const ONE: u32 = DISK + 1;
const AT_WALL: u32 = 1 << 31;

const _: () = assert!(MOST_DISKS <= DISK as usize + 1);

/// Up to four disks, filled from the first slot on; in all one load or store.
///
/// What a cell is, is on one cache line: with the counts elsewhere a run of a million disks takes longer.
#[derive(Debug, Clone, Copy)]
#[repr(align(16))]
pub(super) struct Block([u32; SLOTS]);

impl Block {
    pub(super) const EMPTY: Self = Self([0; SLOTS]);

    #[inline]
    pub(super) fn len(&self) -> usize {
        ((self.0[0] & !AT_WALL) / ONE) as usize
    }

    #[inline]
    pub(super) fn is_at_wall(&self) -> bool {
        self.0[0] & AT_WALL != 0
    }

    pub(super) fn mark_wall(&mut self) {
        self.0[0] |= AT_WALL;
    }

    /// The disks, and behind them anything.
    #[inline]
    pub(super) fn slots(&self) -> [u32; SLOTS] {
        let [first, rest @ ..] = self.0;
        let [second, third, fourth] = rest;
        [first & DISK, second, third, fourth]
    }

    /// Replaces the slots, not what is above the first.
    #[inline]
    fn write(&mut self, slots: [u32; SLOTS], above: u32) {
        self.0 = slots;
        self.0[0] |= above;
    }

    /// Adds a disk to a block that has room.
    #[inline]
    pub(super) fn push(&mut self, disk: usize) {
        let (count, mut slots, above) = (self.len(), self.slots(), self.0[0] & !DISK);
        for (slot, there) in slots.iter_mut().enumerate() {
            *there = if slot == count { disk as u32 } else { *there };
        }
        self.write(slots, above + ONE);
    }

    /// The last disk of a block that is not empty.
    #[inline]
    pub(super) fn last(&self) -> u32 {
        self.0[self.len().wrapping_sub(1) % SLOTS] & DISK
    }

    /// Puts another disk in the place of one, if that is here.
    #[inline]
    pub(super) fn replace(&mut self, disk: usize, by: u32) {
        self.0 = self.with(disk, by);
    }

    /// The last disk takes the place of the one that leaves.
    #[inline]
    pub(super) fn remove(&mut self, disk: usize) {
        let slots = self.with(disk, self.last());
        self.0 = slots;
        self.0[0] -= ONE;
    }

    #[inline]
    fn with(&self, disk: usize, by: u32) -> [u32; SLOTS] {
        let mut slots = self.slots().map(|slot| if slot == disk as u32 { by } else { slot });
        slots[0] |= self.0[0] & !DISK;
        slots
    }
}
