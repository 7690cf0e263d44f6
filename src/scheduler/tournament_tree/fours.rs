//! A tournament in matches of four, for any processor.

use std::hint::select_unpredictable;

use crate::scheduler::EventScheduler;
use crate::scheduler::entry::Entry;

/// Number of players of a match.
const PLAYERS: usize = 4;

/// A tournament in matches of four: the earliest of four disks enters the next round, until one disk is left.
///
/// After a change of one disk, its matches are replayed, round by round. Each replay selects and does not
/// branch: no processor can predict the winner of a match, and a mispredicted branch costs more than the
/// whole match. Matches of four need half as many rounds as matches of two, and the best of the three others
/// is found while the round below is still being played.
#[derive(Debug, Clone, Default)]
pub(super) struct Fours {
    /// The matches of all rounds, one round after the other.
    matches: Vec<[Entry; PLAYERS]>,
    /// Index of the first match of each round.
    rounds: Vec<usize>,
    winner: Entry,
}

impl Entry {
    /// Returns the earlier of two entries. At equal times, the smaller disk wins.
    #[inline]
    fn earlier(self, other: Self) -> Self {
        // A comparison of the two as pairs would become a branch on some processors. The sum cannot overflow,
        // since no time has the largest order; for this reason, `EMPTY` has the order just below it.
        let wins = other.order < self.order + u64::from(other.disk < self.disk);
        Self {
            order: select_unpredictable(wins, other.order, self.order),
            disk: select_unpredictable(wins, other.disk, self.disk),
        }
    }
}

impl Fours {
    /// Creates a scheduler without disks.
    pub(super) const fn new() -> Self {
        Self { matches: Vec::new(), rounds: Vec::new(), winner: Entry::EMPTY }
    }

    /// Makes room for the matches of `players` players, of their winners, and so on. All seats are empty.
    fn seat(&mut self, mut players: usize) {
        self.rounds.clear();
        let mut count = 0;
        while players > 1 || self.rounds.is_empty() {
            self.rounds.push(count);
            players = players.div_ceil(PLAYERS);
            count += players;
        }
        self.matches.clear();
        self.matches.resize(count, [Entry::EMPTY; PLAYERS]);
    }
}

impl EventScheduler for Fours {
    fn reset(&mut self, due: &[f64]) {
        self.seat(due.len());
        for (disk, &due) in due.iter().enumerate() {
            self.matches[disk / PLAYERS][disk % PLAYERS] = Entry::new(disk, due);
        }
        let winner = |players: [Entry; PLAYERS]| players.into_iter().fold(Entry::EMPTY, Entry::earlier);
        for round in self.rounds.windows(2) {
            for (number, from) in (round[0]..round[1]).enumerate() {
                self.matches[round[1] + number / PLAYERS][number % PLAYERS] = winner(self.matches[from]);
            }
        }
        self.winner = self.matches.last().map_or(Entry::EMPTY, |&last| winner(last));
    }

    #[inline(never)]
    fn set(&mut self, disk: usize, due: f64) {
        let mut player = disk;
        let mut winner = Entry::new(disk, due);
        for &round in &self.rounds {
            let seat = player % PLAYERS;
            player /= PLAYERS;
            let players = &mut self.matches[round + player];
            players[seat] = winner;
            let others = players[seat ^ 1].earlier(players[seat ^ 2]).earlier(players[seat ^ 3]);
            winner = winner.earlier(others);
        }
        self.winner = winner;
    }

    #[inline]
    fn earliest(&self) -> (usize, f64) {
        self.winner.answer()
    }
}
