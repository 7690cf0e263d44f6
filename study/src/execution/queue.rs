//! The remaining blocks of ramps for the threads of a process.

use std::hash::{BuildHasher, Hasher, RandomState};
use std::ops::Range;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// The known state of a block.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Block {
    Free,
    /// Another process is running the block, or has finished it.
    Elsewhere,
    /// The block was taken from the queue, or is finished.
    Gone,
}

/// A ring of blocks.
///
/// Processes begin at random positions and continue in order from there, so they seldom meet, and each runs
/// the blocks ahead of it. One that meets another goes to a new place.
#[derive(Debug)]
pub(super) struct Queue {
    blocks: Vec<Range<usize>>,
    ring: Mutex<Ring>,
}

#[derive(Debug)]
struct Ring {
    blocks: Vec<Block>,
    /// The index from which the search for the next block starts.
    place: usize,
}

impl Queue {
    pub(super) fn new(blocks: Vec<Range<usize>>) -> Self {
        let (all, place) = (vec![Block::Free; blocks.len()], anywhere(blocks.len()));
        Self { blocks, ring: Mutex::new(Ring { blocks: all, place }) }
    }

    /// Takes the next free block, with its index.
    pub(super) fn next(&self) -> Option<(usize, Range<usize>)> {
        let index = self.ring().turn(Block::Free, Block::Gone)?;
        Some((index, self.blocks[index].clone()))
    }

    /// Notes that another process has a block, and moves to a new position in the ring.
    pub(super) fn leave(&self, index: usize) {
        let mut ring = self.ring();
        ring.blocks[index] = Block::Elsewhere;
        ring.place = anywhere(ring.blocks.len());
    }

    /// Marks the finished blocks as taken, and returns the number of their ramps.
    pub(super) fn strike(&self, is_done: impl Fn(&Range<usize>) -> bool) -> usize {
        let mut ring = self.ring();
        let all = self.blocks.iter().zip(&mut ring.blocks).filter(|(_, block)| **block != Block::Gone);
        let done = all.filter(|(ramps, _)| is_done(ramps));
        done.map(|(ramps, block)| {
            *block = Block::Gone;
            ramps.len()
        })
        .sum()
    }

    /// Returns the blocks of other processes.
    pub(super) fn elsewhere(&self) -> Vec<Range<usize>> {
        let ring = self.ring();
        let all = self.blocks.iter().zip(&ring.blocks);
        all.filter(|(_, state)| **state == Block::Elsewhere).map(|(ramps, _)| ramps.clone()).collect()
    }

    /// Frees a number of other processes' blocks for another attempt.
    pub(super) fn retry(&self, count: usize) {
        let mut ring = self.ring();
        ring.place = anywhere(ring.blocks.len());
        for _ in 0..count {
            ring.turn(Block::Elsewhere, Block::Free);
        }
    }

    fn ring(&self) -> MutexGuard<'_, Ring> {
        self.ring.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Ring {
    /// Finds the next block of a kind, changes its kind, and returns its index.
    fn turn(&mut self, from: Block, to: Block) -> Option<usize> {
        let mut ring = (self.place..self.blocks.len()).chain(0..self.place);
        let found = ring.find(|index| self.blocks[*index] == from)?;
        self.blocks[found] = to;
        self.place = found + 1;
        Some(found)
    }
}

/// Returns a random index below this number. It has no influence on results.
fn anywhere(count: usize) -> usize {
    // The standard library seeds its hash tables from the system: a random number that needs no dependency.
    let random = RandomState::new().build_hasher().finish();
    random.checked_rem(count as u64).unwrap_or(0) as usize
}
