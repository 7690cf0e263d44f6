//! A scheduler.

use std::cmp::{Ordering, Reverse};
use std::collections::BinaryHeap;

use granular_edmd::scheduler::{EventScheduler, NOTHING_DUE};

/// A binary heap that forgets old entries when they come up.
#[derive(Debug, Clone, Default)]
pub struct LazyHeap {
    heap: BinaryHeap<Reverse<Entry>>,
    due: Vec<f64>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Entry {
    due: f64,
    disk: usize,
}

impl Eq for Entry {}

impl Ord for Entry {
    fn cmp(&self, other: &Self) -> Ordering {
        // The order of the contract has one zero, and no NaN.
        let due = (self.due + 0.0).total_cmp(&(other.due + 0.0));
        due.then(self.disk.cmp(&other.disk))
    }
}

impl PartialOrd for Entry {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl LazyHeap {
    /// Removes old entries from the top, because `earliest` only looks.
    fn drop_outdated(&mut self) {
        while let Some(Reverse(first)) = self.heap.peek() {
            if self.due[first.disk] == first.due {
                return;
            }
            self.heap.pop();
        }
    }
}

impl EventScheduler for LazyHeap {
    fn reset(&mut self, due: &[f64]) {
        self.due = due.to_vec();
        self.heap = due.iter().enumerate().map(|(disk, &due)| Reverse(Entry { due, disk })).collect();
    }

    fn set(&mut self, disk: usize, due: f64) {
        self.due[disk] = due;
        self.heap.push(Reverse(Entry { due, disk }));
        self.drop_outdated();
    }

    fn earliest(&self) -> (usize, f64) {
        self.heap.peek().map_or(NOTHING_DUE, |Reverse(first)| (first.disk, first.due))
    }
}

#[cfg(test)]
mod tests {
    use super::LazyHeap;
    use granular_edmd::scheduler::laws;

    #[test]
    fn it_keeps_the_laws() -> Result<(), granular_edmd::Violation> {
        laws::check(LazyHeap::default)
    }
}
