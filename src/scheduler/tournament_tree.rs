//! The scheduler for few disks: a tournament of their times.

mod earliest;
mod wide;

use std::hint::select_unpredictable;

use wide::Wide;

use super::EventScheduler;
use crate::instructions::{Instructions, Level};
use crate::scheduler::Entry;

/// A tournament: the earliest disk of each match enters the next round, until one disk is left.
///
/// Processors with vector instructions, which compare the times of four or eight disks together, play matches
/// of 32 disks. Other processors play matches of four, and with more than 32 768 disks, all do. The results
/// are the same.
#[derive(Debug, Clone, Default)]
pub struct TournamentTree {
    instructions: Instructions,
    form: Form,
}

#[derive(Debug, Clone)]
enum Form {
    Fours(Fours),
    Two(Wide<2>),
    Three(Wide<3>),
}

impl Default for Form {
    fn default() -> Self {
        Self::Fours(Fours::new())
    }
}

impl TournamentTree {
    /// Creates a scheduler without disks.
    pub const fn new() -> Self {
        Self { instructions: Instructions::BUILT, form: Form::Fours(Fours::new()) }
    }
}

impl EventScheduler for TournamentTree {
    fn reset(&mut self, due: &[f64]) {
        self.instructions = Instructions::detected();
        let rounds = match due.len() {
            0 => 0,
            _ if self.instructions.level() == Level::Built => 0,
            disks if disks <= Wide::<2>::MOST_DISKS => 2,
            disks if disks <= Wide::<3>::MOST_DISKS => 3,
            _ => 0,
        };
        // A tree of the suitable form is kept, with its memory.
        match (&self.form, rounds) {
            (Form::Fours(_), 0) | (Form::Two(_), 2) | (Form::Three(_), 3) => {}
            (_, 2) => self.form = Form::Two(Wide::new()),
            (_, 3) => self.form = Form::Three(Wide::new()),
            _ => self.form = Form::default(),
        }
        match &mut self.form {
            Form::Fours(fours) => fours.reset(due),
            Form::Two(wide) => wide.reset(self.instructions, due),
            Form::Three(wide) => wide.reset(self.instructions, due),
        }
    }

    // The method is inlined, so that each event makes only one call: to the code for this processor.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn set(&mut self, disk: usize, due: f64) {
        match &mut self.form {
            Form::Fours(fours) => fours.set(disk, due),
            Form::Two(wide) => wide.set(self.instructions, disk, due),
            Form::Three(wide) => wide.set(self.instructions, disk, due),
        }
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn earliest(&self) -> (usize, f64) {
        match &self.form {
            Form::Fours(fours) => fours.earliest(),
            Form::Two(wide) => wide.earliest(),
            Form::Three(wide) => wide.earliest(),
        }
    }
}

/// Number of players of a match.
const PLAYERS: usize = 4;

/// A tournament in matches of four: the earliest of four disks enters the next round, until one disk is left.
///
/// After a change of one disk, its matches are replayed, round by round. Each replay selects and does not
/// branch: no processor can predict the winner of a match, and a mispredicted branch costs more than the
/// whole match. Matches of four need half as many rounds as matches of two, and the best of the three others
/// is found while the round below is still being played.
#[derive(Debug, Clone)]
struct Fours {
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
    const fn new() -> Self {
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
