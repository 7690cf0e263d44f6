//! Blocks: a few disks of a cell.

use crate::disk::MOST_DISKS;

/// Number of disks for which a block has room.
pub(super) const SLOTS: usize = 4;

/// Bits of the number of a disk. In the first slot, the bits above these hold the number of slots taken, or
/// [`CROWDED`] if the last slot links to more disks. The highest bit is set if the disks of the cell can
/// touch a wall.
const DISK: u32 = (1 << 28) - 1;
const ONE: u32 = DISK + 1;
const AT_WALL: u32 = 1 << 31;

/// Stored in place of the number of slots taken, when the last slot links to more disks.
pub(super) const CROWDED: usize = SLOTS + 1;

const _: () = assert!(MOST_DISKS <= DISK as usize + 1);

/// Up to four disks, which are read or written together. The slots are filled from the first one on.
///
/// All data of a cell come from one cache line. Large systems would be slower if the counts were elsewhere.
#[derive(Debug, Clone, Copy)]
#[repr(align(16))]
pub(super) struct Block([u32; SLOTS]);

impl Block {
    pub(super) const EMPTY: Self = Self([0; SLOTS]);

    /// Returns the number of slots taken, or [`CROWDED`].
    #[inline(always)]
    pub(super) fn count(&self) -> usize {
        ((self.0[0] & !AT_WALL) / ONE) as usize
    }

    #[inline]
    pub(super) fn is_at_wall(&self) -> bool {
        self.0[0] & AT_WALL != 0
    }

    pub(super) fn mark_wall(&mut self) {
        self.0[0] |= AT_WALL;
    }

    /// Returns the crowd that holds the cell's other disks, or `None` if all disks of the cell fit into the
    /// block. The number of the crowd is in the last slot.
    pub(super) fn crowd(&self) -> Option<u32> {
        (self.count() == CROWDED).then_some(self.0[SLOTS - 1])
    }

    /// Links to this crowd in place of the last disk, or of another crowd.
    pub(super) fn set_crowd(&mut self, crowd: u32) {
        self.0[SLOTS - 1] = crowd;
        self.set_count(CROWDED);
    }

    /// Ends the link to a crowd. The disks in the other slots stay.
    pub(super) fn end_crowd(&mut self) {
        self.set_count(SLOTS - 1);
    }

    fn set_count(&mut self, count: usize) {
        self.0[0] = (self.0[0] & (DISK | AT_WALL)) + count as u32 * ONE;
    }

    /// Returns the slots: the disks, followed by arbitrary numbers.
    #[inline(always)]
    pub(super) fn slots(&self) -> [u32; SLOTS] {
        let [first, second, third, fourth] = self.0;
        [first & DISK, second, third, fourth]
    }

    /// Adds a disk to a block that has room.
    #[inline(always)]
    pub(super) fn push(&mut self, disk: usize) {
        let (count, above) = (self.count(), self.above());
        let mut slots = self.slots();
        for (slot, there) in slots.iter_mut().enumerate() {
            let here = u32::from(slot == count).wrapping_neg();
            *there = (*there & !here) | (disk as u32 & here);
        }
        slots[0] |= above + ONE;
        self.0 = slots;
    }

    /// Removes a disk. The last disk of the block takes its place.
    #[inline(always)]
    pub(super) fn remove(&mut self, disk: usize) {
        let mut slots = self.with(disk, self.last());
        slots[0] -= ONE;
        self.0 = slots;
    }

    /// Replaces `disk` with `by` if `disk` is in the block and not in the crowd. Returns whether the disk was
    /// in the block.
    pub(super) fn replace(&mut self, disk: u32, by: u32) -> bool {
        let is_here = self.slots()[..SLOTS - 1].contains(&disk);
        if is_here {
            let crowd = self.0[SLOTS - 1];
            self.0 = self.with(disk as usize, by);
            self.0[SLOTS - 1] = crowd;
        }
        is_here
    }

    /// Returns the last disk of a block that is not empty.
    #[inline(always)]
    pub(super) fn last(&self) -> u32 {
        self.0[self.count().wrapping_sub(1) % SLOTS] & DISK
    }

    /// Returns the bits above the disk in the first slot.
    #[inline]
    fn above(&self) -> u32 {
        self.0[0] & !DISK
    }

    #[inline(always)]
    fn with(&self, disk: usize, by: u32) -> [u32; SLOTS] {
        let mut slots = self.slots().map(|slot| if slot == disk as u32 { by } else { slot });
        slots[0] |= self.above();
        slots
    }
}
