//! A binary tournament of times.

use std::hint::select_unpredictable;

use super::EventScheduler;

/// A complete binary tree whose leaves are the disks and whose inner nodes hold the earlier of their two children.
///
/// A change replays the matches from its leaf to the root, by selections and not by branches: mispredicted branches, not
/// arithmetic, are what a tournament costs (branches take 3.5 times as long).
#[derive(Debug, Clone, Default)]
pub struct TournamentTree {
    /// Node `k` has the children `2k` and `2k + 1`; the leaves start at `leaves`.
    nodes: Vec<Entry>,
    leaves: usize,
}

/// A disk and its time, as a number in the order of times.
#[derive(Debug, Clone, Copy)]
struct Entry {
    order: u64,
    disk: usize,
}

impl Entry {
    /// What stands where no disk is: later than any time.
    const EMPTY: Self = Self { order: u64::MAX, disk: usize::MAX };

    #[inline]
    fn new(disk: usize, due: f64) -> Self {
        // Adding 0 makes the two zeros equal. Negative floats are in the reverse order of their bits.
        let bits = (due + 0.0).to_bits();
        Self { order: if bits & SIGN == 0 { bits | SIGN } else { !bits }, disk }
    }

    #[inline]
    fn due(self) -> f64 {
        f64::from_bits(if self.order & SIGN == 0 { !self.order } else { self.order & !SIGN })
    }

    /// The winner of the match at `node` against its sibling. On the left are the smaller indices: the left wins a tie.
    #[inline]
    fn against(self, other: Self, node: usize) -> Self {
        let loses = other.order < self.order + (node & 1) as u64;
        Self {
            order: select_unpredictable(loses, other.order, self.order),
            disk: select_unpredictable(loses, other.disk, self.disk),
        }
    }
}

const SIGN: u64 = 1 << 63;

impl TournamentTree {
    /// A scheduler of no disks.
    pub const fn new() -> Self {
        Self { nodes: Vec::new(), leaves: 0 }
    }
}

impl EventScheduler for TournamentTree {
    fn reset(&mut self, due: &[f64]) {
        self.leaves = due.len().next_power_of_two().max(2);
        self.nodes.clear();
        self.nodes.resize(2 * self.leaves, Entry::EMPTY);
        for ((disk, &due), leaf) in due.iter().enumerate().zip(&mut self.nodes[self.leaves..]) {
            *leaf = Entry::new(disk, due);
        }
        for node in (1..self.leaves).rev() {
            self.nodes[node] = self.nodes[2 * node].against(self.nodes[2 * node + 1], 0);
        }
    }

    #[inline]
    fn set(&mut self, disk: usize, due: f64) {
        let mut node = self.leaves + disk;
        let mut winner = Entry::new(disk, due);
        self.nodes[node] = winner;
        while node > 1 {
            winner = winner.against(self.nodes[node ^ 1], node);
            node >>= 1;
            self.nodes[node] = winner;
        }
    }

    #[inline]
    fn earliest(&self) -> (usize, f64) {
        match self.nodes.get(1) {
            Some(&winner) if winner.order != u64::MAX => (winner.disk, winner.due()),
            _ => (usize::MAX, f64::INFINITY),
        }
    }
}
