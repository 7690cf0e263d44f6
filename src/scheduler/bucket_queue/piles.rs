//! Piles of disks, which grow at one end and are read as a whole.

/// Number of disks in a block. The disks and the link to another block fill four cache lines.
const ROOM: usize = 63;

/// The link of a block without a successor.
const NOWHERE: u32 = u32::MAX;

/// Piles of disks, in blocks from a common store. A block that has been read serves another pile.
#[derive(Debug, Clone)]
pub(super) struct Piles {
    ends: Vec<Pile>,
    blocks: Vec<Block>,
    /// The first of the free blocks, which are in no pile.
    free: u32,
}

/// The last block of a pile, and the number of disks in that block.
#[derive(Debug, Clone, Copy)]
struct Pile {
    last: u32,
    count: u32,
}

impl Pile {
    /// An empty pile. It has the form of a pile whose last block is full, so that the first disk asks for a
    /// block.
    const EMPTY: Self = Self { last: NOWHERE, count: ROOM as u32 };
}

#[derive(Debug, Clone)]
#[repr(align(64))]
struct Block {
    disks: [u32; ROOM],
    /// The previous block of the pile or, for a free block, the next free block.
    previous: u32,
}

impl Piles {
    pub(super) const NONE: Self = Self { ends: Vec::new(), blocks: Vec::new(), free: NOWHERE };

    /// Empties everything, and makes this number of empty piles.
    pub(super) fn clear(&mut self, piles: usize) {
        self.ends.clear();
        self.ends.resize(piles, Pile::EMPTY);
        self.blocks.clear();
        self.free = NOWHERE;
    }

    /// Returns the number of piles.
    #[inline]
    pub(super) fn len(&self) -> usize {
        self.ends.len()
    }

    #[inline]
    pub(super) fn push(&mut self, pile: usize, disk: usize) {
        if self.ends[pile].count == ROOM as u32 {
            self.add_block(pile);
        }
        let Pile { last, count } = &mut self.ends[pile];
        self.blocks[*last as usize].disks[*count as usize] = disk as u32;
        *count += 1;
    }

    #[cold]
    fn add_block(&mut self, pile: usize) {
        let previous = self.ends[pile].last;
        let block = self.free;
        if let Some(reused) = self.blocks.get_mut(block as usize) {
            self.free = std::mem::replace(&mut reused.previous, previous);
            self.ends[pile] = Pile { last: block, count: 0 };
        } else {
            self.ends[pile] = Pile { last: self.blocks.len() as u32, count: 0 };
            self.blocks.push(Block { disks: [0; ROOM], previous });
        }
    }

    /// Passes all disks of a pile, block by block, to a closure, and empties the pile.
    pub(super) fn take(&mut self, pile: usize, mut show: impl FnMut(&[u32])) {
        let Pile { mut last, count } = std::mem::replace(&mut self.ends[pile], Pile::EMPTY);
        let mut count = count as usize;
        while let Some(block) = self.blocks.get_mut(last as usize) {
            show(&block.disks[..count]);
            let previous = std::mem::replace(&mut block.previous, self.free);
            self.free = last;
            (last, count) = (previous, ROOM);
        }
    }
}
