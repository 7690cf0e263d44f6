//! A calendar that is turned page by page: for many disks.

mod arrivals;

use arrivals::Arrivals;

use super::EventScheduler;
use crate::prefetch::prefetch;

/// Buckets of a page for each disk; with [`BUCKETS_PER_EVENT`] a page lasts two events of each disk, so that turning it
/// costs little.
const BUCKETS_PER_DISK: usize = 4;

/// Buckets for each event that is due in their time: so many that few hold two.
const BUCKETS_PER_EVENT: f64 = 2.0;

/// Least number of buckets.
const LEAST_BUCKETS: usize = 64;

/// Disks by which the density of events is judged at first, and the part of them that are due soon.
const SAMPLE: usize = 256;
const SOON: usize = 8;

/// Events, and steps past others, for each bucket after which a page is turned at the latest: its buckets are too wide.
const LONGEST_PAGE: usize = 2;

/// Buckets from the present one to those that come into sight: some dozens of events.
const SIGHT: usize = 96;

/// Buckets that share a word of flags.
const WORD: usize = u64::BITS as usize;

/// A page of equally wide buckets of time, each with the disks that are due in it, in order.
///
/// A disk goes into the bucket of its time, where it seldom meets another, or into the last one if it is off the page; a flag
/// for each bucket that is not empty leads to the next event. That is a few loads and stores, however many disks there
/// are. When the page is used up, all events are dealt out anew, to buckets as wide as the events of the last page want.
#[derive(Debug, Clone)]
pub struct BucketQueue {
    /// All that concerns a disk, together in memory.
    nodes: Vec<Node>,
    /// The first disk of each bucket.
    heads: Vec<u32>,
    /// A bit for each bucket that is not empty.
    flags: Vec<u64>,
    buckets: usize,
    /// The first bucket that is not empty.
    current: usize,
    /// Buckets before this one have come into sight.
    sighted: usize,
    /// Disks that are not in their buckets yet.
    arrivals: Arrivals,
    /// Time at which the page starts, and buckets per time.
    start: f64,
    rate: f64,
    /// Events set since the page was turned.
    set: usize,
    /// Steps past disks that come first in their bucket, since the page was turned.
    steps: usize,
}

/// A disk in its bucket.
#[derive(Debug, Clone, Copy)]
struct Node {
    due: f64,
    /// The disk behind it, or [`NOBODY`].
    next: u32,
    /// The disk before it, or [`NOBODY`] if it is the first.
    previous: u32,
}

const NOBODY: u32 = u32::MAX;

/// In place of [`Node::previous`]: the disk is on its way.
const ON_THE_WAY: u32 = u32::MAX - 1;

impl Default for BucketQueue {
    fn default() -> Self {
        Self::new()
    }
}

impl BucketQueue {
    /// A scheduler of no disks.
    pub const fn new() -> Self {
        Self {
            nodes: Vec::new(),
            heads: Vec::new(),
            flags: Vec::new(),
            buckets: 0,
            current: 0,
            sighted: 0,
            arrivals: Arrivals::NONE,
            start: 0.0,
            rate: 0.0,
            set: 0,
            steps: 0,
        }
    }

    /// The bucket of a time: they are in the order of their times, and the last one holds whatever is off the page.
    #[inline]
    fn bucket(&self, due: f64) -> usize {
        // The cast saturates: what is early goes to the first bucket.
        (((due - self.start) * self.rate) as usize).min(self.buckets - 1)
    }

    #[inline]
    fn unlink(&mut self, disk: usize) {
        let Node { due, next, previous } = self.nodes[disk];
        if previous == ON_THE_WAY {
            return self.arrivals.call_off(disk);
        }
        if previous == NOBODY {
            let bucket = self.bucket(due);
            self.heads[bucket] = next;
            self.flags[bucket / WORD] &= !(u64::from(next == NOBODY) << (bucket % WORD));
        } else {
            self.nodes[previous as usize].next = next;
        }
        if next != NOBODY {
            self.nodes[next as usize].previous = previous;
        }
    }

    /// Puts a disk into the bucket of its time, behind those that come first.
    #[inline]
    fn link(&mut self, disk: usize, due: f64) {
        let bucket = self.bucket(due);
        let (mut before, mut after) = (NOBODY, self.heads[bucket]);
        // Off the page there is no order.
        while after != NOBODY && bucket != self.buckets - 1 && self.precedes(after, due, disk) {
            (before, after) = (after, self.nodes[after as usize].next);
            self.steps += 1;
        }
        self.nodes[disk] = Node { due, next: after, previous: before };
        if before == NOBODY {
            self.heads[bucket] = disk as u32;
            self.flags[bucket / WORD] |= 1 << (bucket % WORD);
        } else {
            self.nodes[before as usize].next = disk as u32;
        }
        if after != NOBODY {
            self.nodes[after as usize].previous = disk as u32;
        }
        if bucket < self.current {
            self.go_back_to(bucket);
        }
    }

    /// A branch that is hardly ever taken, not a minimum: so the processor begins with the next event before it knows when
    /// the disk of the last one is due again.
    #[cold]
    #[inline(never)]
    fn go_back_to(&mut self, bucket: usize) {
        self.current = bucket;
    }

    #[inline]
    fn precedes(&self, other: u32, due: f64, disk: usize) -> bool {
        let others = self.nodes[other as usize].due;
        others < due || (others == due && (other as usize) < disk)
    }

    /// Puts a disk into the bucket of its time: at once if that is in sight, else when it has come from memory.
    #[inline]
    fn place(&mut self, disk: usize, due: f64) {
        let bucket = self.bucket(due);
        if bucket < self.current + SIGHT {
            return self.link(disk, due);
        }
        prefetch(&self.heads, bucket);
        self.nodes[disk] = Node { due, next: NOBODY, previous: ON_THE_WAY };
        let arrived = self.arrivals.send(disk, bucket);
        prefetch(&self.nodes, self.heads[self.arrivals.halfway()] as usize);
        if let Some(disk) = arrived {
            self.link(disk, self.nodes[disk].due);
        }
    }

    #[cold]
    fn hurry(&mut self) {
        for disk in self.arrivals.hurry() {
            self.link(disk, self.nodes[disk].due);
        }
    }

    /// The first bucket from the present one on that is not empty, or the end.
    #[inline]
    fn first_bucket(&self) -> usize {
        let mut word = self.current / WORD;
        while word < self.flags.len() && self.flags[word] == 0 {
            word += 1;
        }
        self.flags.get(word).map_or(self.buckets, |flags| word * WORD + flags.trailing_zeros() as usize)
    }

    /// Finds the first bucket that is not empty; turns the page if that is the last, or the page does not end.
    #[inline]
    fn find_current(&mut self) {
        let mut first = self.first_bucket();
        if first >= self.arrivals.first_bucket() {
            self.hurry();
            first = self.first_bucket();
        }
        self.current = first;
        if self.current == self.buckets - 1 || self.set + self.steps > LONGEST_PAGE * self.buckets {
            self.turn_page();
        }
    }

    /// Deals all events out to a new page.
    #[cold]
    #[inline(never)]
    fn turn_page(&mut self) {
        let first = self.nodes.iter().map(|node| node.due).fold(f64::INFINITY, f64::min);
        self.rate = BUCKETS_PER_EVENT * self.events_per_time(first);
        self.start = first;
        (self.set, self.steps, self.sighted) = (0, 0, 0);
        self.current = self.buckets - 1;
        self.arrivals = Arrivals::NONE;
        self.flags.fill(0);
        self.heads.fill(NOBODY);
        // From the last to the first: of equal times each goes to the front of its bucket at once.
        for disk in (0..self.nodes.len()).rev() {
            self.link(disk, self.nodes[disk].due);
        }
    }

    /// How dense events are: as on the last page, or else as a sample of the disks has it.
    fn events_per_time(&self, first: f64) -> f64 {
        let past = self.set as f64 / (first - self.start);
        if self.set >= self.nodes.len() && past.is_normal() && past > 0.0 {
            return past;
        }
        let mut waits = [f64::INFINITY; SAMPLE];
        let stride = self.nodes.len().div_ceil(SAMPLE).max(1);
        let mut count = 0;
        for (wait, node) in waits.iter_mut().zip(self.nodes.iter().step_by(stride)) {
            *wait = node.due - first;
            count += 1;
        }
        // The earliest of them only: some may have long to wait.
        let (_, &mut wait, _) = waits.select_nth_unstable_by(count / SOON, f64::total_cmp);
        let rate = (stride * (count / SOON + 1)) as f64 / wait;
        if rate.is_normal() { rate } else { 1.0 }
    }
}

impl EventScheduler for BucketQueue {
    fn reset(&mut self, due: &[f64]) {
        self.nodes.clear();
        self.nodes.extend(due.iter().map(|&due| Node { due, next: NOBODY, previous: NOBODY }));
        self.buckets = (BUCKETS_PER_DISK * due.len()).max(LEAST_BUCKETS);
        self.heads.resize(self.buckets, NOBODY);
        self.flags.resize(self.buckets.div_ceil(WORD), 0);
        self.set = 0;
        self.turn_page();
    }

    #[inline]
    fn set(&mut self, disk: usize, due: f64) {
        self.unlink(disk);
        self.set += 1;
        self.place(disk, due);
        self.find_current();
    }

    #[inline]
    fn earliest(&self) -> (usize, f64) {
        let first = self.heads.get(self.current).map_or(NOBODY, |&first| first);
        self.nodes.get(first as usize).map_or((usize::MAX, f64::INFINITY), |node| (first as usize, node.due))
    }

    fn come_into_sight(&mut self, disks: &mut Vec<usize>) {
        let end = (self.current + SIGHT).min(self.buckets.saturating_sub(1));
        for bucket in self.sighted.max(self.current)..end {
            if let Some(&first) = self.heads.get(bucket + SIGHT) {
                prefetch(&self.nodes, first as usize);
            }
            if let Some(first) = self.nodes.get(self.heads[bucket] as usize) {
                disks.push(self.heads[bucket] as usize);
                // Three in a bucket are rare.
                if first.next != NOBODY {
                    disks.push(first.next as usize);
                    prefetch(&self.nodes, first.next as usize);
                }
            }
        }
        self.sighted = end;
    }
}
