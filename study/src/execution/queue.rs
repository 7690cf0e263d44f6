//! The remaining blocks of ramps for the threads of a process.

use std::collections::VecDeque;
use std::ops::Range;
use std::sync::{Mutex, MutexGuard, PoisonError};

use crate::seed::anywhere;

/// Blocks that wait, and blocks of other processes.
///
/// Processes begin at random blocks and continue in order from there, so they seldom meet, and each runs
/// the blocks ahead of it. A process that meets another moves to a new random block.
#[derive(Debug)]
pub(super) struct Queue(Mutex<Blocks>);

#[derive(Debug)]
struct Blocks {
    waiting: VecDeque<Range<usize>>,
    elsewhere: VecDeque<Range<usize>>,
}

impl Queue {
    pub(super) fn new(blocks: impl Iterator<Item = Range<usize>>) -> Self {
        let (waiting, elsewhere) = (begun_anywhere(blocks.collect()), VecDeque::new());
        Self(Mutex::new(Blocks { waiting, elsewhere }))
    }

    /// Takes the next block.
    pub(super) fn next(&self) -> Option<Range<usize>> {
        self.blocks().waiting.pop_front()
    }

    /// Notes that another process has a block, and moves to another block of the queue.
    pub(super) fn leave(&self, ramps: Range<usize>) {
        let mut blocks = self.blocks();
        blocks.elsewhere.push_back(ramps);
        blocks.waiting = begun_anywhere(std::mem::take(&mut blocks.waiting));
    }

    /// Removes the finished blocks.
    pub(super) fn strike(&self, is_done: impl Fn(&Range<usize>) -> bool) {
        let Blocks { waiting, elsewhere } = &mut *self.blocks();
        for blocks in [waiting, elsewhere] {
            blocks.retain(|ramps| !is_done(ramps));
        }
    }

    /// Returns the ramps of other processes.
    pub(super) fn elsewhere(&self) -> Vec<usize> {
        self.blocks().elsewhere.iter().cloned().flatten().collect()
    }

    /// Lets a number of other processes' blocks wait for another attempt.
    pub(super) fn retry(&self, count: usize) {
        let mut blocks = self.blocks();
        let mut tried = begun_anywhere(std::mem::take(&mut blocks.elsewhere));
        blocks.elsewhere = tried.split_off(count.min(tried.len()));
        blocks.waiting.append(&mut tried);
    }

    fn blocks(&self) -> MutexGuard<'_, Blocks> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Returns the same ring of blocks from a random one on.
fn begun_anywhere(mut blocks: VecDeque<Range<usize>>) -> VecDeque<Range<usize>> {
    blocks.rotate_left(anywhere(blocks.len()));
    blocks
}
