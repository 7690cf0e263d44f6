//! The scheduler for many disks: a calendar that is turned page by page, of piles of disks.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::Entry;
use super::EventScheduler;
use crate::instructions::prefetch;

/// Number of events that are due within the time of one bucket. At this number, there are few buckets, and
/// the last entries of all of them stay in the caches.
const EVENTS_PER_BUCKET: usize = 512;

/// Number of events per disk in a page. These events share the cost of entering the disk into the next page.
const EVENTS_PER_DISK: usize = 2;

/// Largest number of events per disk in a page. A page is meant for half of this number, so the buckets of a
/// page that lasts longer are too wide.
const LONGEST_PAGE: usize = 2 * EVENTS_PER_DISK;

/// Number of disks in the sample from which the density of events is first estimated.
const SAMPLE: usize = 256;

/// Inverse of the fraction of the sample that counts in the estimate: the disks that are due soonest.
const SOON: usize = 8;

/// Number of events that are known in order ahead of the present one, and are named as upcoming.
const SIGHT: usize = 48;

/// A calendar: a page of equally wide buckets of time.
///
/// Each bucket holds, in no particular order, the disks that are due in it.
///
/// - A disk that gets a new time is written to the end of the bucket of that time. Its old entry stays where
///   it is.
/// - A bucket is opened just before its time comes. Old entries are dropped, and the others are sorted.
/// - A disk that becomes due within an open bucket waits in a heap.
/// - A disk that is due after the end of the page is not written into it. When the page is used up, all disks
///   are distributed over a new page, whose buckets are as wide as the events of the last page suggest.
///
/// An event thus writes only to locations that are in the caches, however many disks there are. The one
/// exception is the time of its disk.
#[derive(Debug, Clone)]
pub struct BucketQueue {
    /// The time of each disk.
    due: Vec<f64>,
    /// The disks of each bucket of the page.
    buckets: Piles,
    /// Number of buckets opened so far; these are the first ones of the page.
    opened: usize,
    /// The events of the open buckets, in order.
    open: Vec<Entry>,
    /// Number of open events that have passed.
    over: usize,
    /// Number of open events that have been named as upcoming.
    named: usize,
    /// Events that were set within the time of the open buckets, after these had been opened.
    late: BinaryHeap<Reverse<Entry>>,
    /// The result of `earliest`.
    first: Entry,
    page: Page,
    /// Number of events set since the page was turned.
    set: usize,
}

/// The times of a page: its start, and the width of its buckets.
#[derive(Debug, Clone, Copy)]
struct Page {
    start: f64,
    /// Number of buckets per time.
    rate: f64,
}

impl Page {
    /// Returns the bucket of a time. The numbers of buckets go on beyond the page.
    #[inline]
    fn bucket(self, due: f64) -> usize {
        // The cast saturates: times before the page belong to its first bucket, and infinite times to the
        // bucket with the largest number.
        ((due - self.start) * self.rate) as usize
    }
}

impl Default for BucketQueue {
    fn default() -> Self {
        Self::new()
    }
}

impl BucketQueue {
    /// Creates a scheduler without disks.
    pub const fn new() -> Self {
        Self {
            due: Vec::new(),
            buckets: Piles::NONE,
            opened: 0,
            open: Vec::new(),
            over: 0,
            named: 0,
            late: BinaryHeap::new(),
            first: Entry::EMPTY,
            page: Page { start: 0.0, rate: 0.0 },
            set: 0,
        }
    }

    #[inline]
    fn is_up_to_date(&self, entry: Entry) -> bool {
        self.due[entry.disk] == entry.due()
    }

    /// Adds a disk to the bucket of its time, or to the heap if the bucket is open already. A disk that is
    /// due after the end of the page is not added.
    #[inline]
    fn place(&mut self, disk: usize, due: f64) {
        let bucket = self.page.bucket(due);
        if bucket < self.opened {
            self.late.push(Reverse(Entry::new(disk, due)));
        } else if bucket < self.buckets.len() {
            self.buckets.push(bucket, disk);
        }
    }

    /// Finds the first event that is up to date.
    #[inline]
    fn find_first(&mut self) {
        loop {
            if self.open.len() - self.over < SIGHT {
                self.open_buckets();
            }
            let next = self.open.get(self.over).copied().unwrap_or(Entry::EMPTY);
            let late = self.late.peek().map_or(Entry::EMPTY, |&Reverse(late)| late);
            self.first = next.min(late);
            if self.first == Entry::EMPTY {
                return self.turn_page();
            }
            if self.is_up_to_date(self.first) {
                return;
            }
            if late < next {
                self.late.pop();
            } else {
                self.over += 1;
            }
        }
    }

    /// Opens buckets until enough events are known in order, or the page ends.
    #[cold]
    #[inline(never)]
    fn open_buckets(&mut self) {
        if self.opened == self.buckets.len() {
            return;
        }
        self.open.drain(..self.over);
        self.named = self.named.saturating_sub(self.over);
        self.over = 0;
        while self.opened < self.buckets.len() && self.open.len() < SIGHT {
            self.open_bucket();
        }
    }

    fn open_bucket(&mut self) {
        let Self { due, open, page, .. } = self;
        let (from, bucket) = (open.len(), self.opened);
        self.buckets.take(bucket, |disks| {
            // The times of these disks are scattered in memory. Requests for all of them together take hardly
            // longer than requests for a few.
            for &disk in disks {
                prefetch(due, disk as usize);
            }
            for &disk in disks {
                let (disk, due) = (disk as usize, due[disk as usize]);
                // An entry is out of date if the time of its disk has moved to another bucket. A disk that
                // got a new time within this bucket has two entries here, with the same time, which is
                // harmless.
                if page.bucket(due) == bucket {
                    open.push(Entry::new(disk, due));
                }
            }
        });
        open[from..].sort_unstable();
        self.opened += 1;
    }

    /// Distributes all events over a new page.
    #[cold]
    #[inline(never)]
    fn turn_page(&mut self) {
        let first = self.due.iter().enumerate().map(|(disk, &due)| Entry::new(disk, due)).min();
        self.first = first.unwrap_or(Entry::EMPTY);
        let first = self.first.due();
        self.page = Page { start: first, rate: self.events_per_time(first) / EVENTS_PER_BUCKET as f64 };
        (self.set, self.opened, self.over, self.named) = (0, 0, 0, 0);
        self.buckets.clear((EVENTS_PER_DISK * self.due.len()).div_ceil(EVENTS_PER_BUCKET) + 1);
        self.open.clear();
        self.late.clear();
        for disk in 0..self.due.len() {
            self.place(disk, self.due[disk]);
        }
        self.open_buckets();
    }

    /// Estimates the number of events per time: from the last page, or from a sample of the disks if that
    /// page was short.
    fn events_per_time(&self, first: f64) -> f64 {
        let past = self.set as f64 / (first - self.page.start);
        let sampled = self.sampled_events_per_time(first);
        let choice = if self.set >= self.due.len() { [past, sampled] } else { [sampled, past] };
        choice.into_iter().find(|rate| rate.is_normal() && *rate > 0.0).unwrap_or(1.0)
    }

    fn sampled_events_per_time(&self, first: f64) -> f64 {
        let mut waits = [f64::INFINITY; SAMPLE];
        let stride = self.due.len().div_ceil(SAMPLE).max(1);
        let mut count = 0;
        for (wait, due) in waits.iter_mut().zip(self.due.iter().step_by(stride)) {
            *wait = due - first;
            count += 1;
        }
        // Only the earliest times of the sample show how dense the events are. A disk at rest may wait almost
        // forever.
        let (_, &mut wait, _) = waits.select_nth_unstable_by(count / SOON, f64::total_cmp);
        (stride * (count / SOON + 1)) as f64 / wait
    }
}

impl EventScheduler for BucketQueue {
    fn reset(&mut self, due: &[f64]) {
        self.due.clear();
        self.due.extend_from_slice(due);
        self.set = 0;
        self.turn_page();
    }

    #[inline]
    fn set(&mut self, disk: usize, due: f64) {
        self.due[disk] = due;
        self.set += 1;
        self.place(disk, due);
        if self.set > LONGEST_PAGE * self.due.len() {
            self.turn_page();
        } else {
            self.find_first();
        }
    }

    #[inline]
    fn earliest(&self) -> (usize, f64) {
        self.first.answer()
    }

    fn upcoming(&mut self, disks: &mut Vec<usize>) {
        let end = (self.over + SIGHT).min(self.open.len());
        let from = self.named.max(self.over);
        if from < end {
            disks.extend(self.open[from..end].iter().map(|entry| entry.disk));
        }
        self.named = end;
    }
}

/// Number of disks in a block. The disks and the link to another block fill four cache lines.
const ROOM: usize = 63;

/// The link of a block without a successor.
const NOWHERE: u32 = u32::MAX;

/// Piles of disks, in blocks from a common store. A block that has been read serves another pile.
#[derive(Debug, Clone)]
struct Piles {
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
    const NONE: Self = Self { ends: Vec::new(), blocks: Vec::new(), free: NOWHERE };

    /// Empties everything, and makes this number of empty piles.
    fn clear(&mut self, piles: usize) {
        self.ends.clear();
        self.ends.resize(piles, Pile::EMPTY);
        self.blocks.clear();
        self.free = NOWHERE;
    }

    /// Returns the number of piles.
    #[inline]
    fn len(&self) -> usize {
        self.ends.len()
    }

    #[inline]
    fn push(&mut self, pile: usize, disk: usize) {
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
    fn take(&mut self, pile: usize, mut show: impl FnMut(&[u32])) {
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
