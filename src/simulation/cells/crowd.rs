//! The disks for which the blocks of their cells have no room.

use crate::disk::MOST_DISKS;

/// Largest number of disks in one part of a crowd. With six disks, a part is as large as two blocks.
const SEATS: usize = 6;

/// Number of parts for which there is room from the start.
const FEW: usize = 16;

/// Number of cells per part for which memory is reserved at the start.
const CELLS: usize = 1024;

/// No part: the end of a chain.
const NONE: u32 = u32::MAX;

const _: () = assert!(MOST_DISKS < NONE as usize);

/// A few disks of a crowded cell, filled from the first slot on, and a link to the next part.
#[derive(Debug, Clone, Copy)]
struct Part {
    seats: [u32; SEATS],
    count: u32,
    next: u32,
}

/// The crowds of all cells, each a chain of parts from a common pool.
///
/// A crowd is identified by the number of its first part, the only one that may have free slots. The memory
/// grows with the number of disks in crowds, and never shrinks.
#[derive(Debug, Clone, Default)]
pub(super) struct Crowds {
    parts: Vec<Part>,
    /// The first of the free parts, which belong to no crowd.
    free: u32,
}

impl Crowds {
    /// Creates room for the few crowds that are usual in this number of cells.
    pub(super) fn with_room(cells: usize) -> Self {
        Self { parts: Vec::with_capacity(FEW + cells / CELLS), free: NONE }
    }

    /// Begins a crowd with this disk. Returns the number of the crowd.
    pub(super) fn begin(&mut self, disk: u32) -> u32 {
        self.put_before(NONE, disk)
    }

    /// Adds a disk to a crowd. Returns the new number of the crowd.
    pub(super) fn push(&mut self, crowd: u32, disk: u32) -> u32 {
        let first = &mut self.parts[crowd as usize];
        if first.count as usize == SEATS {
            return self.put_before(crowd, disk);
        }
        first.seats[first.count as usize] = disk;
        first.count += 1;
        crowd
    }

    /// Removes any disk from a crowd. Returns the disk, and the new number of the crowd if disks are left in
    /// it.
    pub(super) fn pop(&mut self, crowd: u32) -> (u32, Option<u32>) {
        let first = &mut self.parts[crowd as usize];
        first.count -= 1;
        let disk = first.seats[first.count as usize];
        if first.count > 0 {
            return (disk, Some(crowd));
        }
        let next = std::mem::replace(&mut first.next, self.free);
        self.free = crowd;
        (disk, (next != NONE).then_some(next))
    }

    /// Replaces `disk` with `by` if `disk` is in this crowd.
    pub(super) fn replace(&mut self, mut crowd: u32, disk: u32, by: u32) {
        while let Some(part) = self.parts.get_mut(crowd as usize) {
            if let Some(seat) = part.seats[..part.count as usize].iter_mut().find(|seat| **seat == disk) {
                *seat = by;
                return;
            }
            crowd = part.next;
        }
    }

    /// Appends a crowd to the first `count` disks in `found`, and returns the new count. Free slots are
    /// copied, too.
    pub(super) fn gather(&self, mut crowd: u32, found: &mut [u32], mut count: usize) -> usize {
        while let Some(part) = self.parts.get(crowd as usize) {
            found[count..count + SEATS].copy_from_slice(&part.seats);
            count += part.count as usize;
            crowd = part.next;
        }
        count
    }

    /// Returns the largest number of disks that all crowds together can hold without more memory.
    #[inline]
    pub(super) fn room(&self) -> usize {
        SEATS * self.parts.capacity()
    }

    /// Returns the number of all parts, in crowds and free.
    #[cfg(test)]
    pub(super) fn parts(&self) -> usize {
        self.parts.len()
    }

    fn put_before(&mut self, next: u32, disk: u32) -> u32 {
        let mut part = Part { seats: [0; SEATS], count: 1, next };
        part.seats[0] = disk;
        let Some(free) = self.parts.get_mut(self.free as usize) else {
            self.parts.push(part);
            return self.parts.len() as u32 - 1;
        };
        let taken = std::mem::replace(&mut self.free, free.next);
        *free = part;
        taken
    }
}
