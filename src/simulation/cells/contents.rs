//! Which disks are in which cell.

use std::collections::HashMap;

use super::block::{Block, CROWDED, SLOTS};
use crate::prefetch::prefetch;

/// Disks without room in their cell, and one for so many cells, from which on every cell gets more room.
const FEW: usize = 4;
const CELLS: usize = 256;

/// The disks of each cell, by the index of the cell.
///
/// Every cell has the same number of blocks, filled from the first on. The few disks for which their cell has no room are kept
/// elsewhere.
#[derive(Debug, Clone)]
pub(super) struct Contents {
    blocks: Vec<Block>,
    /// How many blocks there are in each cell.
    depth: usize,
    /// What does not fit into the blocks of a cell.
    crowds: HashMap<usize, Vec<u32>>,
    /// How many disks that is.
    outside: usize,
}

impl Contents {
    /// So many empty cells with room for so many disks each.
    pub(super) fn empty(cells: usize, slots: usize) -> Self {
        let depth = slots.div_ceil(SLOTS);
        Self { blocks: vec![Block::EMPTY; cells * depth], depth, crowds: HashMap::new(), outside: 0 }
    }

    pub(super) fn mark_wall(&mut self, cell: usize) {
        self.blocks[cell * self.depth].mark_wall();
    }

    /// Whether disks in this cell can touch a wall.
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
        if let Some(last) = blocks.last_mut() {
            last.set_crowded(true);
        }
        self.crowds.entry(cell).or_default().push(disk as u32);
        self.outside += 1;
        if self.outside > FEW + self.blocks.len() / (self.depth * CELLS) {
            self.grow();
        }
    }

    /// The last disk of the cell takes the place of the one that leaves.
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

    /// Takes a disk for which its cell had no room.
    fn pop_outside(&mut self, cell: usize) -> Option<u32> {
        let crowd = self.crowds.get_mut(&cell)?;
        let last = crowd.pop()?;
        self.outside -= 1;
        if crowd.is_empty() {
            self.crowds.remove(&cell);
            self.blocks_of(cell).last_mut()?.set_crowded(false);
        }
        Some(last)
    }

    fn replace(&mut self, cell: usize, disk: usize, by: u32) {
        self.blocks_of(cell).iter_mut().for_each(|block| block.replace(disk, by));
        let crowd = self.crowds.get_mut(&cell).into_iter().flatten();
        crowd.filter(|there| **there as usize == disk).for_each(|there| *there = by);
    }

    /// Twice as many blocks in every cell.
    fn grow(&mut self) {
        let mut grown = Self::empty(self.blocks.len() / self.depth, 2 * self.depth * SLOTS);
        for (old, new) in self.blocks.chunks_exact(self.depth).zip(grown.blocks.chunks_exact_mut(grown.depth)) {
            new[..self.depth].copy_from_slice(old);
        }
        for (cell, crowd) in std::mem::take(&mut self.crowds) {
            grown.blocks[cell * grown.depth + self.depth - 1].set_crowded(false);
            crowd.into_iter().for_each(|disk| grown.push(cell, disk as usize));
        }
        *self = grown;
    }

    /// Room that so many cells need at most.
    #[inline]
    pub(super) fn room(&self, cells: usize) -> usize {
        cells * self.depth * SLOTS + self.outside
    }

    /// Appends the disks of three cells, `step` apart, to the first `count` of those found.
    #[inline(always)]
    pub(super) fn gather(&self, first: usize, step: usize, found: &mut [u32], count: usize) -> usize {
        // Loops of a length that the compiler knows are unrolled.
        match self.depth {
            1 => self.gather_blocks(1, first, step, found, count),
            2 => self.gather_blocks(2, first, step, found, count),
            depth => self.gather_blocks(depth, first, step, found, count),
        }
    }

    /// All slots of a block are copied; the next goes on behind the last that is taken, without a branch on how many those are.
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

    #[cold]
    #[inline(never)]
    fn gather_outside(&self, cell: usize, found: &mut [u32], count: usize) -> usize {
        let crowd = self.crowds.get(&cell).map_or(&[][..], Vec::as_slice);
        found[count..count + crowd.len()].copy_from_slice(crowd);
        count + crowd.len()
    }

    /// Asks for these cells, which are not more than two cache lines.
    #[inline]
    pub(super) fn prefetch(&self, first: usize, last: usize) {
        prefetch(&self.blocks, first * self.depth);
        prefetch(&self.blocks, (last + 1) * self.depth - 1);
    }
}
