//! A calendar that is turned page by page: for many disks.

mod piles;

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::EventScheduler;
use super::entry::Entry;
use crate::prefetch::prefetch;
use piles::Piles;

/// Events that are due in the time of a bucket, so many that what concerns the buckets stays in the caches.
const EVENTS_PER_BUCKET: usize = 512;

/// Events of a page for each disk: turning it costs little then.
const EVENTS_PER_DISK: usize = 2;

/// Events for each disk after which a page is turned at the latest: its buckets are too wide.
const LONGEST_PAGE: usize = 2 * EVENTS_PER_DISK;

/// Disks by which the density of events is judged at first, and the part of them that are due soon.
const SAMPLE: usize = 256;
const SOON: usize = 8;

/// Events from the present one to those that come into sight.
const SIGHT: usize = 48;

/// A page of equally wide buckets of time; in each, in no order, the disks that are due in it.
///
/// A disk is written to the end of the bucket of its time, and nothing is taken out of the one where it was: what is out of
/// date is left out when the bucket is opened, just before its time, and its disks are put in order. Disks that become due in
/// a time that is open already wait in a heap, and those off the page are not written down at all: when the page is used up,
/// all disks are dealt out anew, to buckets as wide as the events of the last page want. So whatever an event writes is in the
/// caches, however many disks there are, but for the time of its disk.
#[derive(Debug, Clone)]
pub struct BucketQueue {
    /// When each disk is due.
    due: Vec<f64>,
    /// The disks of each bucket of the page.
    buckets: Piles,
    /// Buckets before this one have been opened.
    opened: usize,
    /// The events of the open buckets in order, and how many of them are over.
    open: Vec<Entry>,
    over: usize,
    /// How many of them have come into sight.
    sighted: usize,
    /// Events that were set later, in the time of the open buckets.
    late: BinaryHeap<Reverse<Entry>>,
    first: Entry,
    page: Page,
    /// Events set since the page was turned.
    set: usize,
}

/// Which time belongs to which bucket.
#[derive(Debug, Clone, Copy)]
struct Page {
    start: f64,
    /// Buckets per time.
    rate: f64,
}

impl Page {
    /// The bucket of a time: they are in the order of their times, without end.
    #[inline]
    fn bucket(self, due: f64) -> usize {
        // The cast saturates: what is early goes to the first bucket.
        ((due - self.start) * self.rate) as usize
    }
}

impl Default for BucketQueue {
    fn default() -> Self {
        Self::new()
    }
}

impl BucketQueue {
    /// A scheduler of no disks.
    pub const fn new() -> Self {
        Self {
            due: Vec::new(),
            buckets: Piles::NONE,
            opened: 0,
            open: Vec::new(),
            over: 0,
            sighted: 0,
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

    /// Writes down when a disk is due.
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
            let next = self.open.get(self.over).copied().unwrap_or_default();
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

    /// Opens buckets until enough events are in sight, or the page ends.
    #[cold]
    #[inline(never)]
    fn open_buckets(&mut self) {
        if self.opened == self.buckets.len() {
            return;
        }
        self.open.drain(..self.over);
        self.sighted = self.sighted.saturating_sub(self.over);
        self.over = 0;
        while self.opened < self.buckets.len() && self.open.len() < SIGHT {
            self.open_bucket();
        }
    }

    fn open_bucket(&mut self) {
        let Self { due, open, page, .. } = self;
        let (from, bucket) = (open.len(), self.opened);
        self.buckets.take(bucket, |disks| {
            // All at once: 3 % of the time of 10⁶ disks.
            for &disk in disks {
                prefetch(due, disk as usize);
            }
            for &disk in disks {
                let (disk, due) = (disk as usize, due[disk as usize]);
                // Another bucket: it is out of date.
                if page.bucket(due) == bucket {
                    open.push(Entry::new(disk, due));
                }
            }
        });
        open[from..].sort_unstable();
        self.opened += 1;
    }

    /// Deals all events out to a new page.
    #[cold]
    #[inline(never)]
    fn turn_page(&mut self) {
        let first = self.due.iter().enumerate().map(|(disk, &due)| Entry::new(disk, due)).min();
        self.first = first.unwrap_or_default();
        let first = self.first.due();
        self.page = Page { start: first, rate: self.events_per_time(first) / EVENTS_PER_BUCKET as f64 };
        (self.set, self.opened, self.over, self.sighted) = (0, 0, 0, 0);
        self.buckets.clear((EVENTS_PER_DISK * self.due.len()).div_ceil(EVENTS_PER_BUCKET) + 1);
        self.open.clear();
        self.late.clear();
        for disk in 0..self.due.len() {
            self.place(disk, self.due[disk]);
        }
        self.open_buckets();
    }

    /// How dense events are: as on the last page if it was long enough, or else as a sample of the disks has it.
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
        // The earliest of them only: some may have long to wait.
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

    fn come_into_sight(&mut self, disks: &mut Vec<usize>) {
        let end = (self.over + SIGHT).min(self.open.len());
        let from = self.sighted.max(self.over);
        if from < end {
            disks.extend(self.open[from..end].iter().map(|entry| entry.disk));
        }
        self.sighted = end;
    }
}
