//! The default scheduler: a binary tournament of times.

use super::EventScheduler;

/// A complete binary tree whose leaves are the disks and whose inner nodes hold the earlier of their two children.
///
/// A change replays the matches from its leaf to the root. Time and disk are packed into one integer in the order of
/// both, so that a match is a minimum and not a branch: mispredicted branches, not arithmetic, are what a tournament
/// costs.
#[derive(Debug, Clone, Default)]
pub struct TournamentTree {
    /// Node `k` has the children `2k` and `2k + 1`; the leaves start at `leaves`.
    nodes: Vec<u128>,
    leaves: usize,
}

/// What stands where no disk is: later than any time.
const EMPTY: u128 = u128::MAX;

const SIGN: u64 = 1 << 63;

/// Time and disk as one number, in the order of both.
#[inline]
fn pack(due: f64, disk: u32) -> u128 {
    // Adding 0 makes the two zeros equal. Negative floats are in the reverse order of their bits.
    let bits = (due + 0.0).to_bits();
    let ordered = if bits & SIGN == 0 { bits | SIGN } else { !bits };
    (u128::from(ordered) << 32) | u128::from(disk)
}

#[inline]
fn unpack(entry: u128) -> (usize, f64) {
    let ordered = (entry >> 32) as u64;
    let bits = if ordered & SIGN == 0 { !ordered } else { ordered & !SIGN };
    ((entry as u32) as usize, f64::from_bits(bits))
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
            *leaf = pack(due, disk);
        }
        for node in (1..self.leaves).rev() {
            self.nodes[node] = self.nodes[2 * node].min(self.nodes[2 * node + 1]);
        }
    }

    #[inline]
    fn set(&mut self, disk: usize, due: f64) {
        let mut node = self.leaves + disk;
        let mut winner = pack(due, disk as u32);
        self.nodes[node] = winner;
        while node > 1 {
            winner = winner.min(self.nodes[node ^ 1]);
            node >>= 1;
            self.nodes[node] = winner;
        }
    }

    #[inline]
    fn earliest(&self) -> (usize, f64) {
        match self.nodes.get(1) {
            Some(&winner) if winner != EMPTY => unpack(winner),
            _ => (usize::MAX, f64::INFINITY),
        }
    }
}
