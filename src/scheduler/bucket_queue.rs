//! A calendar that is turned page by page.

use super::EventScheduler;

/// Buckets of a page for each disk; with [`BUCKETS_PER_EVENT`] a page lasts two events of each disk, so that turning it
/// costs little.
const BUCKETS_PER_DISK: usize = 4;

/// Buckets for each event that is due in their time: so many that few hold two.
const BUCKETS_PER_EVENT: f64 = 2.0;

/// Least number of buckets.
const LEAST_BUCKETS: usize = 64;

/// The density of events is first judged by the earliest of the disks: one in so many. Some may have long to wait.
const SOON: usize = 8;

/// Events set for each bucket after which a page is turned at the latest: its buckets were too wide.
const LONGEST_PAGE: usize = 1;

/// Buckets that share a word of flags.
const WORD: usize = u64::BITS as usize;

/// A page of equally wide buckets of time, each with the disks that are due in it, in order.
///
/// A disk goes into the bucket of its time, where it seldom meets another, or into the last one if it is off the page; a flag
/// for each bucket that is not empty leads to the next event. That is a few loads and stores, however many disks there
/// are. When the page is used up, all events are dealt out anew, to buckets as wide as the events of the last page want.
#[derive(Debug, Clone, Default)]
pub struct BucketQueue {
    due: Vec<f64>,
    /// What follows each disk in its bucket and, behind all disks, what each bucket begins with.
    next: Vec<u32>,
    /// What comes before each disk; the last entry is written to for `NOBODY`, and never read.
    previous: Vec<u32>,
    /// A bit for each bucket that is not empty.
    flags: Vec<u64>,
    buckets: usize,
    /// The first bucket that is not empty.
    current: usize,
    /// Time at which the page starts, and buckets per time.
    start: f64,
    rate: f64,
    /// Events set since the page was turned.
    set: usize,
    /// Room for the waits of all disks.
    waits: Vec<f64>,
}

impl BucketQueue {
    /// A scheduler of no disks.
    pub const fn new() -> Self {
        Self {
            due: Vec::new(),
            next: Vec::new(),
            previous: Vec::new(),
            flags: Vec::new(),
            buckets: 0,
            current: 0,
            start: 0.0,
            rate: 0.0,
            set: 0,
            waits: Vec::new(),
        }
    }

    /// What stands at the end of a bucket.
    #[inline]
    fn nobody(&self) -> usize {
        self.due.len()
    }

    /// The bucket of a time: they are in the order of their times, and the last one holds whatever is off the page.
    #[inline]
    fn bucket(&self, due: f64) -> usize {
        // The cast saturates: what is early goes to the first bucket.
        (((due - self.start) * self.rate) as usize).min(self.buckets - 1)
    }

    #[inline]
    fn unlink(&mut self, disk: usize) {
        let (next, previous) = (self.next[disk], self.previous[disk]);
        self.next[previous as usize] = next;
        self.previous[next as usize] = previous;
        // By arithmetic: whether a disk was alone in its bucket is a toss of a coin.
        let bucket = (previous as usize).saturating_sub(self.nobody());
        let alone = (next as usize == self.nobody()) & (previous as usize >= self.nobody());
        self.flags[bucket / WORD] &= !(u64::from(alone) << (bucket % WORD));
    }

    /// Puts a disk into the bucket of its time.
    #[inline]
    fn link(&mut self, disk: usize) {
        let due = self.due[disk];
        let bucket = self.bucket(due);
        let mut before = self.nobody() + bucket;
        let mut after = self.next[before] as usize;
        // Off the page there is no order.
        while after != self.nobody() && bucket != self.buckets - 1 && self.precedes(after, due, disk) {
            before = after;
            after = self.next[after] as usize;
        }
        self.next[before] = disk as u32;
        self.next[disk] = after as u32;
        self.previous[disk] = before as u32;
        self.previous[after] = disk as u32;
        self.flags[bucket / WORD] |= 1 << (bucket % WORD);
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
    fn precedes(&self, other: usize, due: f64, disk: usize) -> bool {
        let others = self.due[other];
        others < due || (others == due && other < disk)
    }

    /// Finds the first bucket that is not empty; turns the page if that is the last, or the page does not end.
    #[inline]
    fn find_current(&mut self) {
        let mut word = self.current / WORD;
        while self.flags[word] == 0 {
            word += 1;
        }
        self.current = word * WORD + self.flags[word].trailing_zeros() as usize;
        if self.current == self.buckets - 1 || self.set > LONGEST_PAGE * self.buckets {
            self.turn_page();
        }
    }

    /// Deals all events out to a new page.
    #[cold]
    #[inline(never)]
    fn turn_page(&mut self) {
        let first = self.due.iter().copied().fold(f64::INFINITY, f64::min);
        self.rate = BUCKETS_PER_EVENT * self.events_per_time(first);
        self.start = first;
        self.set = 0;
        self.current = self.buckets - 1;
        self.flags.fill(0);
        self.next[self.due.len()..].fill(self.due.len() as u32);
        // From the last to the first: of equal times each goes to the front of its bucket at once.
        for disk in (0..self.due.len()).rev() {
            self.link(disk);
        }
    }

    /// How dense events are: as on the last page, or else as the first of all disks' events will be.
    fn events_per_time(&mut self, first: f64) -> f64 {
        let past = self.set as f64 / (first - self.start);
        if self.set >= self.due.len() && past.is_normal() && past > 0.0 {
            return past;
        }
        self.waits.clear();
        self.waits.extend(self.due.iter().map(|due| due - first));
        let soon = self.due.len() / SOON;
        let rate = match self.waits.get(soon) {
            Some(_) => soon.max(1) as f64 / *self.waits.select_nth_unstable_by(soon, f64::total_cmp).1,
            None => 1.0,
        };
        if rate.is_normal() { rate } else { 1.0 }
    }
}

impl EventScheduler for BucketQueue {
    fn reset(&mut self, due: &[f64]) {
        self.due.clear();
        self.due.extend_from_slice(due);
        self.buckets = (BUCKETS_PER_DISK * due.len()).max(LEAST_BUCKETS);
        self.next.resize(due.len() + self.buckets, 0);
        self.previous.resize(due.len() + 1, 0);
        self.flags.resize(self.buckets.div_ceil(WORD), 0);
        self.set = 0;
        self.turn_page();
    }

    #[inline]
    fn set(&mut self, disk: usize, due: f64) {
        self.unlink(disk);
        self.due[disk] = due;
        self.set += 1;
        self.link(disk);
        self.find_current();
    }

    #[inline]
    fn earliest(&self) -> (usize, f64) {
        let first =
            self.next.get(self.nobody() + self.current).map_or(self.nobody(), |&first| first as usize);
        self.due.get(first).map_or((usize::MAX, f64::INFINITY), |&due| (first, due))
    }
}
