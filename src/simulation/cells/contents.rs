//! The disks of each cell, in blocks of a few disks.

use super::crowd::Crowds;
use crate::disk::MOST_DISKS;
use crate::instructions::prefetch;

/// Number of disks for which a block has room.
const SLOTS: usize = 4;

/// Bits of the number of a disk. In the first slot, the bits above these hold the number of slots taken, or
/// [`CROWDED`] if the last slot links to more disks. The highest bit is set if the disks of the cell can
/// touch a wall.
const DISK: u32 = (1 << 28) - 1;
const ONE: u32 = DISK + 1;
const AT_WALL: u32 = 1 << 31;

/// Stored in place of the number of slots taken, when the last slot links to more disks.
const CROWDED: usize = SLOTS + 1;

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
    fn set_crowd(&mut self, crowd: u32) {
        self.0[SLOTS - 1] = crowd;
        self.set_count(CROWDED);
    }

    /// Ends the link to a crowd. The disks in the other slots stay.
    fn end_crowd(&mut self) {
        self.set_count(SLOTS - 1);
    }

    fn set_count(&mut self, count: usize) {
        self.0[0] = (self.0[0] & (DISK | AT_WALL)) + count as u32 * ONE;
    }

    /// Returns the slots: the disks, followed by arbitrary numbers.
    #[inline(always)]
    fn slots(&self) -> [u32; SLOTS] {
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

/// Size of the slice to which three blocks are written. The count of a block has three bits, so the compiler
/// knows only that it is at most 7: two blocks fill at most 14 slots, and the third block still fits.
const WINDOW: usize = 16 + SLOTS;

/// The disks of each cell, by the index of the cell.
///
/// Every cell has a block. If a cell has more disks than fit into its block, the last slot is a link to a
/// crowd that holds the others. The memory therefore grows with the numbers of cells and disks, however
/// unevenly the disks lie.
#[derive(Debug, Clone, Default)]
pub(super) struct Contents {
    blocks: Vec<Block>,
    crowds: Crowds,
}

impl Contents {
    /// Creates empty cells.
    pub(super) fn empty(cells: usize) -> Self {
        Self { blocks: vec![Block::EMPTY; cells], crowds: Crowds::with_room(cells) }
    }

    pub(super) fn mark_wall(&mut self, cell: usize) {
        self.blocks[cell].mark_wall();
    }

    /// Returns whether disks in this cell can touch a wall.
    #[inline]
    pub(super) fn is_at_wall(&self, cell: usize) -> bool {
        self.blocks[cell].is_at_wall()
    }

    #[inline(always)]
    pub(super) fn push(&mut self, cell: usize, disk: usize) {
        match &mut self.blocks[cell] {
            block if block.count() < SLOTS => block.push(disk),
            _ => self.push_to_crowd(cell, disk as u32),
        }
    }

    #[cold]
    #[inline(never)]
    fn push_to_crowd(&mut self, cell: usize, disk: u32) {
        let block = &mut self.blocks[cell];
        let crowd = match block.crowd() {
            Some(crowd) => crowd,
            // The link takes the place of the last disk.
            None => self.crowds.begin(block.last()),
        };
        block.set_crowd(self.crowds.push(crowd, disk));
    }

    /// Removes a disk. Another disk of the cell takes its place.
    #[inline(always)]
    pub(super) fn remove(&mut self, cell: usize, disk: usize) {
        match &mut self.blocks[cell] {
            block if block.count() < CROWDED => block.remove(disk),
            _ => self.remove_from_crowded(cell, disk as u32),
        }
    }

    #[cold]
    #[inline(never)]
    fn remove_from_crowded(&mut self, cell: usize, disk: u32) {
        let block = &mut self.blocks[cell];
        let Some(crowd) = block.crowd() else { return };
        // The last disk of the crowd fills the gap, whether the gap is in the block or in the crowd.
        let (last, left) = self.crowds.pop(crowd);
        match left {
            Some(crowd) => block.set_crowd(crowd),
            None => block.end_crowd(),
        }
        if last != disk && !block.replace(disk, last) {
            self.crowds.replace(left.unwrap_or(crowd), disk, last);
        }
    }

    /// Returns the room that the disks of `cells` cells need. There is room for the rest of a window even
    /// after the largest possible number of disks.
    #[inline]
    pub(super) fn room(&self, cells: usize) -> usize {
        cells * SLOTS + self.crowds.room() + WINDOW
    }

    /// Appends the disks of three cells, `step` apart, to the first `count` disks in `found`.
    #[inline(always)]
    pub(super) fn gather(&self, first: usize, step: usize, found: &mut [u32], count: usize) -> usize {
        // One bounds check covers the reads of all three cells, and one covers all writes: the compiler knows
        // that the counts of two blocks leave room for a third block in the window.
        let blocks = &self.blocks[first..][..=2 * step];
        let window = &mut found[count..count + WINDOW];
        let mut taken = 0;
        for cell in [0, step, 2 * step] {
            let block = &blocks[cell];
            window[taken..taken + SLOTS].copy_from_slice(&block.slots());
            if block.count() == CROWDED {
                return self.gather_crowded(first, step, found, count);
            }
            taken += block.count();
        }
        count + taken
    }

    /// Appends the disks of the same three cells if one of the cells is crowded.
    #[cold]
    #[inline(never)]
    fn gather_crowded(&self, first: usize, step: usize, found: &mut [u32], count: usize) -> usize {
        [0, step, 2 * step].iter().fold(count, |count, cell| self.gather_cell(first + cell, found, count))
    }

    /// Appends the disks of consecutive cells to `found`, after its first `count` entries. Returns the new
    /// count.
    #[inline]
    pub(super) fn gather_run(&self, first: usize, cells: usize, found: &mut [u32], count: usize) -> usize {
        let blocks = &self.blocks[first..first + cells];
        blocks.iter().fold(count, |count, block| self.gather_block(block, found, count))
    }

    /// Appends the disks of one cell to `found`, after its first `count` entries. Returns the new count.
    #[inline(always)]
    pub(super) fn gather_cell(&self, cell: usize, found: &mut [u32], count: usize) -> usize {
        self.gather_block(&self.blocks[cell], found, count)
    }

    /// Appends the disks of a cell. All slots are copied, and the next block overwrites the slots behind the
    /// last disk. The code branches on whether the cell is crowded, which is rare, but not on how many slots
    /// are taken.
    #[inline(always)]
    fn gather_block(&self, block: &Block, found: &mut [u32], count: usize) -> usize {
        found[count..count + SLOTS].copy_from_slice(&block.slots());
        if block.count() == CROWDED {
            return self.gather_crowd(block, found, count + SLOTS - 1);
        }
        count + block.count()
    }

    #[cold]
    #[inline(never)]
    fn gather_crowd(&self, block: &Block, found: &mut [u32], count: usize) -> usize {
        block.crowd().map_or(count, |crowd| self.crowds.gather(crowd, found, count))
    }

    /// Prefetches the block of a cell.
    #[inline]
    pub(super) fn prefetch(&self, cell: usize) {
        prefetch(&self.blocks, cell);
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use proptest::test_runner::RngSeed;

    use super::Contents;

    const DISKS: usize = 80;

    /// The configuration of the property tests, which is the same on every run and machine.
    fn config() -> ProptestConfig {
        let rng_seed = RngSeed::Fixed(72_011_305);
        ProptestConfig { cases: 50, rng_seed, failure_persistence: None, ..ProptestConfig::default() }
    }

    /// Returns the disks of the three cells between the first and the last, in order.
    fn found(contents: &Contents) -> Vec<u32> {
        let mut found = vec![0; contents.room(3)];
        let count = contents.gather(1, 1, &mut found, 0);
        found.truncate(count);
        found.sort_unstable();
        found
    }

    fn present(homes: &[Option<usize>]) -> Vec<u32> {
        (0..DISKS as u32).filter(|&disk| homes[disk as usize].is_some()).collect()
    }

    proptest! {
        #![proptest_config(config())]

        /// The test covers all degrees of crowding: cells with room, full ones, crowds of one part and of
        /// many, and empty cells again. The crowds take no more memory than their disks.
        #[test]
        fn cells_hold_the_disks_that_entered_and_did_not_leave(
            moves in prop::collection::vec((0..DISKS, 1..4usize), 0..400),
        ) {
            let (mut contents, mut homes) = (Contents::empty(5), [None; DISKS]);
            contents.mark_wall(2);
            let drain = (0..DISKS).map(|disk| (disk, 0));
            for (step, (disk, cell)) in moves.iter().copied().chain(drain).enumerate() {
                if let Some(home) = homes[disk].take() {
                    contents.remove(home, disk);
                } else if step < moves.len() {
                    contents.push(cell, disk);
                    homes[disk] = Some(cell);
                }
                prop_assert_eq!(found(&contents), present(&homes));
            }
            prop_assert!(contents.crowds.parts() <= DISKS / 6 + 3, "{}", contents.crowds.parts());
            prop_assert_eq!([1, 2, 3].map(|cell| contents.is_at_wall(cell)), [false, true, false]);
        }
    }
}
