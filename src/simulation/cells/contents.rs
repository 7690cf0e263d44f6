//! The disks of each cell.

use super::block::{Block, CROWDED, SLOTS};
use crate::prefetch::prefetch;

/// Number of disks that may lie outside the blocks of their cells before all cells get more blocks. One more
/// is allowed for each [`CELLS`] cells.
const FEW: usize = 16;

/// Number of cells in a group. Each group allows for one more disk outside the blocks.
const CELLS: usize = 1024;

/// The disks of each cell, by the index of the cell.
///
/// Every cell has the same number of blocks, filled from the first on. A disk for which its cell has no room
/// goes to a list. The list is searched from end to end, but it is short, and the search is only for cells
/// that are marked as having disks there.
#[derive(Debug, Clone)]
pub(super) struct Contents {
    blocks: Vec<Block>,
    /// Number of blocks of each cell.
    depth: usize,
    /// Disks that do not fit into the blocks of their cell, in no order.
    outside: Vec<Outside>,
}

/// A disk for which its cell has no room.
#[derive(Debug, Clone, Copy)]
struct Outside {
    cell: u32,
    disk: u32,
}

impl Contents {
    /// Creates this many empty cells of this many blocks.
    pub(super) fn empty(cells: usize, depth: usize) -> Self {
        let outside = Vec::with_capacity(FEW + cells / CELLS);
        Self { blocks: vec![Block::EMPTY; cells * depth], depth, outside }
    }

    /// Returns the number of cells.
    fn cells(&self) -> usize {
        self.blocks.len() / self.depth
    }

    pub(super) fn mark_wall(&mut self, cell: usize) {
        self.blocks[cell * self.depth].mark_wall();
    }

    /// Tells whether disks in this cell can touch a wall.
    #[inline]
    pub(super) fn is_at_wall(&self, cell: usize) -> bool {
        self.blocks[cell * self.depth].is_at_wall()
    }

    fn blocks_of(&mut self, cell: usize) -> &mut [Block] {
        &mut self.blocks[cell * self.depth..(cell + 1) * self.depth]
    }

    #[inline]
    pub(super) fn push(&mut self, cell: usize, disk: usize) {
        match &mut self.blocks[cell * self.depth] {
            first if first.count() < SLOTS => first.push(disk),
            _ => self.push_behind_first(cell, disk),
        }
    }

    #[cold]
    fn push_behind_first(&mut self, cell: usize, disk: usize) {
        let blocks = self.blocks_of(cell);
        if let Some(block) = blocks.iter_mut().find(|block| block.count() < SLOTS) {
            return block.push(disk);
        }
        if self.outside.len() == FEW + self.cells() / CELLS {
            self.grow();
            return self.push(cell, disk);
        }
        self.outside.push(Outside { cell: cell as u32, disk: disk as u32 });
        self.mark_crowded(cell);
    }

    /// Removes a disk. The last disk of the cell takes its place.
    #[inline]
    pub(super) fn remove(&mut self, cell: usize, disk: usize) {
        match &mut self.blocks[cell * self.depth] {
            first if first.count() < SLOTS => first.remove(disk),
            _ => self.remove_from_full(cell, disk),
        }
    }

    #[cold]
    fn remove_from_full(&mut self, cell: usize, disk: usize) {
        if let Some(last) = self.pop_outside(cell) {
            return self.replace(cell, disk, last);
        }
        let blocks = self.blocks_of(cell);
        let filled = blocks.iter().rposition(|block| block.count() > 0).unwrap_or(0);
        let last = blocks[filled].last();
        blocks[filled].remove(last as usize);
        self.replace(cell, disk, last);
    }

    /// Removes a disk from the list of those for which their cells have no room, if one belongs to this cell.
    fn pop_outside(&mut self, cell: usize) -> Option<u32> {
        let there = self.outside.iter().rposition(|outside| outside.cell as usize == cell)?;
        let Outside { disk, .. } = self.outside.swap_remove(there);
        self.mark_crowded(cell);
        Some(disk)
    }

    /// Notes in the last block of a full cell whether disks of the cell are outside.
    fn mark_crowded(&mut self, cell: usize) {
        let crowded = self.outside.iter().any(|outside| outside.cell as usize == cell);
        if let Some(last) = self.blocks_of(cell).last_mut() {
            last.set_crowded(crowded);
        }
    }

    fn replace(&mut self, cell: usize, disk: usize, by: u32) {
        for block in self.blocks_of(cell) {
            block.replace(disk, by);
        }
        let here = |outside: &&mut Outside| outside.cell as usize == cell && outside.disk as usize == disk;
        if let Some(outside) = self.outside.iter_mut().find(here) {
            outside.disk = by;
        }
    }

    /// Doubles the number of blocks in every cell.
    fn grow(&mut self) {
        let mut grown = Self::empty(self.cells(), 2 * self.depth);
        for (old, new) in self.blocks.chunks_exact(self.depth).zip(grown.blocks.chunks_exact_mut(grown.depth))
        {
            new[..self.depth].copy_from_slice(old);
        }
        for Outside { cell, .. } in &self.outside {
            grown.blocks[*cell as usize * grown.depth + self.depth - 1].set_crowded(false);
        }
        for Outside { cell, disk } in std::mem::take(&mut self.outside) {
            grown.push(cell as usize, disk as usize);
        }
        *self = grown;
    }

    /// Returns the largest number of disks in so many cells, which is the room that they need.
    #[inline]
    pub(super) fn room(&self, cells: usize) -> usize {
        cells * self.depth * SLOTS + self.outside.len()
    }

    /// Appends the disks of three cells, `step` apart, to the first `count` disks in `found`.
    #[inline(always)]
    pub(super) fn gather(&self, first: usize, step: usize, found: &mut [u32], count: usize) -> usize {
        // The compiler unrolls loops whose length it knows.
        match self.depth {
            1 => self.gather_blocks(1, first, step, found, count),
            2 => self.gather_blocks(2, first, step, found, count),
            depth => self.gather_blocks(depth, first, step, found, count),
        }
    }

    /// Appends the disks of three cells with this number of blocks. All slots of a block are copied, and the
    /// next block is written behind the last slot that is taken. The code branches on whether a block is
    /// full, which is rare, but not on how many slots are taken.
    #[inline(always)]
    fn gather_blocks(
        &self,
        depth: usize,
        first: usize,
        step: usize,
        found: &mut [u32],
        mut count: usize,
    ) -> usize {
        let blocks = &self.blocks[first * depth..(first + 2 * step + 1) * depth];
        for cell in [0, step, 2 * step] {
            for block in &blocks[cell * depth..(cell + 1) * depth] {
                found[count..count + SLOTS].copy_from_slice(&block.slots());
                count += block.count();
                if block.count() < SLOTS {
                    break;
                }
                if block.count() == CROWDED {
                    count = self.gather_outside(first + cell, found, count - 1);
                }
            }
        }
        count
    }

    /// Appends the disks of cells that follow each other to the first `count` of those found.
    #[inline]
    pub(super) fn gather_run(
        &self,
        first: usize,
        cells: usize,
        found: &mut [u32],
        mut count: usize,
    ) -> usize {
        for (k, blocks) in
            self.blocks[first * self.depth..(first + cells) * self.depth].chunks_exact(self.depth).enumerate()
        {
            for block in blocks {
                found[count..count + SLOTS].copy_from_slice(&block.slots());
                count += block.count();
                if block.count() < SLOTS {
                    break;
                }
                if block.count() == CROWDED {
                    count = self.gather_outside(first + k, found, count - 1);
                }
            }
        }
        count
    }

    #[cold]
    #[inline(never)]
    fn gather_outside(&self, cell: usize, found: &mut [u32], mut count: usize) -> usize {
        for outside in self.outside.iter().filter(|outside| outside.cell as usize == cell) {
            found[count] = outside.disk;
            count += 1;
        }
        count
    }

    /// Requests a cell from memory.
    #[inline]
    pub(super) fn prefetch(&self, cell: usize) {
        prefetch(&self.blocks, cell * self.depth);
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use proptest::test_runner::RngSeed;

    use super::{Contents, SLOTS};

    const DISKS: usize = 80;

    /// The configuration of the property tests, which is the same on every run and machine.
    fn config() -> ProptestConfig {
        let rng_seed = RngSeed::Fixed(72_011_305);
        ProptestConfig { cases: 50, rng_seed, failure_persistence: None, ..ProptestConfig::default() }
    }

    /// Returns the disks of the three cells between the first and the last, in order.
    fn found(contents: &Contents) -> Vec<u32> {
        let mut found = vec![0; contents.room(3) + SLOTS];
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

        /// The test covers all degrees of crowding: cells with room, cells whose disks are outside, all cells
        /// with more blocks, and empty cells again.
        #[test]
        fn cells_hold_the_disks_that_entered_and_did_not_leave(
            moves in prop::collection::vec((0..DISKS, 1..4usize), 0..400),
        ) {
            let (mut contents, mut homes) = (Contents::empty(5, 1), [None; DISKS]);
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
            prop_assert_eq!([1, 2, 3].map(|cell| contents.is_at_wall(cell)), [false, true, false]);
        }
    }
}
