//! The default scheduler: a binary tournament of times.

use super::EventScheduler;

/// A complete binary tree whose leaves are the disks and whose inner nodes hold the earlier of their two children.
///
/// A change replays the matches from its leaf to the root. Each match is a selection, not a branch: mispredicted
/// branches, not arithmetic, are what a tournament costs.
#[derive(Debug, Clone, Default)]
pub struct TournamentTree {
    /// Node `k` has the children `2k` and `2k + 1`; the leaves start at `leaves`.
    nodes: Vec<Entry>,
    leaves: usize,
}

#[derive(Debug, Clone, Copy)]
struct Entry {
    due: f64,
    disk: u32,
}

/// What stands where no disk is.
const EMPTY: Entry = Entry { due: f64::INFINITY, disk: u32::MAX };

/// The winner of a match; the left one, with the smaller indices, wins ties.
#[inline]
fn earlier(left: Entry, right: Entry) -> Entry {
    let left_wins = left.due <= right.due;
    Entry {
        due: if left_wins { left.due } else { right.due },
        disk: if left_wins { left.disk } else { right.disk },
    }
}

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
        self.nodes.resize(2 * self.leaves, EMPTY);
        for ((disk, &due), leaf) in (0u32..).zip(due).zip(&mut self.nodes[self.leaves..]) {
            *leaf = Entry { due, disk };
        }
        for node in (1..self.leaves).rev() {
            self.nodes[node] = earlier(self.nodes[2 * node], self.nodes[2 * node + 1]);
        }
    }

    #[inline]
    fn set(&mut self, disk: usize, due: f64) {
        let mut node = self.leaves + disk;
        self.nodes[node].due = due;
        while node > 1 {
            let left = node & !1;
            let winner = earlier(self.nodes[left], self.nodes[left | 1]);
            node >>= 1;
            self.nodes[node] = winner;
        }
    }

    #[inline]
    fn earliest(&self) -> (usize, f64) {
        match self.nodes.get(1) {
            Some(winner) if winner.disk != u32::MAX => (winner.disk as usize, winner.due),
            _ => (usize::MAX, f64::INFINITY),
        }
    }
}
