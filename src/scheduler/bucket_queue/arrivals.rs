//! Disks on their way to buckets that are not in the caches.

/// How many are on their way.
const MOST: usize = 16;

const NOBODY: u32 = u32::MAX;

/// A disk and where it goes.
#[derive(Debug, Clone, Copy)]
struct Arrival {
    disk: u32,
    bucket: u32,
}

impl Arrival {
    const NONE: Self = Self { disk: NOBODY, bucket: 0 };

    fn disk(self) -> Option<usize> {
        (self.disk != NOBODY).then_some(self.disk as usize)
    }
}

/// The disks that were sent last; one arrives when so many others have been sent after it, which is when its bucket has come
/// from memory: 10⁶ disks gain 15 % by it.
#[derive(Debug, Clone)]
pub(super) struct Arrivals {
    sent: [Arrival; MOST],
    /// The one that arrives next.
    oldest: usize,
    /// No bucket that is waited for comes before this one.
    first_bucket: usize,
}

impl Arrivals {
    pub(super) const NONE: Self = Self { sent: [Arrival::NONE; MOST], oldest: 0, first_bucket: usize::MAX };

    #[inline]
    pub(super) fn first_bucket(&self) -> usize {
        self.first_bucket
    }

    /// Sends a disk; returns the disk that arrives.
    #[inline]
    pub(super) fn send(&mut self, disk: usize, bucket: usize) -> Option<usize> {
        self.first_bucket = self.first_bucket.min(bucket);
        let arrival = Arrival { disk: disk as u32, bucket: bucket as u32 };
        let arrived = std::mem::replace(&mut self.sent[self.oldest], arrival);
        self.oldest = (self.oldest + 1) % MOST;
        arrived.disk()
    }

    /// The bucket of the disk that has come half of the way.
    #[inline]
    pub(super) fn halfway(&self) -> usize {
        self.sent[(self.oldest + MOST / 2) % MOST].bucket as usize
    }

    /// All disks arrive.
    pub(super) fn hurry(&mut self) -> impl Iterator<Item = usize> + use<> {
        std::mem::replace(self, Self::NONE).sent.into_iter().filter_map(Arrival::disk)
    }

    /// A disk goes elsewhere.
    #[cold]
    pub(super) fn call_off(&mut self, disk: usize) {
        for arrival in self.sent.iter_mut().filter(|arrival| arrival.disk as usize == disk) {
            *arrival = Arrival::NONE;
        }
    }
}
