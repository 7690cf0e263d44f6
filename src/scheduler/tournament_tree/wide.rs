//! A tournament in matches of 32, for processors that compare several times at once.

use std::hint::select_unpredictable;

use super::earliest::{NO_SEAT, PLAYERS, Times, earliest_without};
#[cfg(target_arch = "x86_64")]
use super::earliest::{avx2, avx512};
use crate::instructions::compiled_for_each;
use crate::scheduler::NOTHING_DUE;

/// A function like [`earliest_without`].
trait Earliest: Fn(&Times, usize, usize) -> (f64, usize) + Copy {}

impl<F: Fn(&Times, usize, usize) -> (f64, usize) + Copy> Earliest for F {}

/// A disk that plays, and its time.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Player {
    due: f64,
    disk: usize,
}

impl Player {
    const NOBODY: Self = Self { disk: NOTHING_DUE.0, due: NOTHING_DUE.1 };

    /// Returns whether this player comes first. Of equal times, the smaller disk does.
    #[inline(always)]
    fn is_before(self, other: Self) -> bool {
        select_unpredictable(self.disk < other.disk, self.due <= other.due, self.due < other.due)
    }

    /// Returns the earlier of two players.
    #[inline(always)]
    fn or(self, other: Self) -> Self {
        let disk = select_unpredictable(other.is_before(self), other.disk, self.disk);
        Self { due: if other.due < self.due { other.due } else { self.due }, disk }
    }
}

#[derive(Debug, Clone, Copy)]
#[repr(align(64))]
struct Match {
    times: Times,
    disks: [u32; PLAYERS],
}

impl Match {
    const EMPTY: Self = Self { times: Times([f64::INFINITY; PLAYERS]), disks: [0; PLAYERS] };

    #[inline(always)]
    fn seat(&mut self, seat: usize, player: Player) {
        self.times.0[seat % PLAYERS] = player.due;
        self.disks[seat % PLAYERS] = player.disk as u32;
    }

    /// Returns the earliest player but those in two seats.
    #[inline(always)]
    fn earliest_without(
        &self,
        seat: usize,
        other: usize,
        earliest: impl Earliest,
    ) -> Player {
        let (due, seat) = earliest(&self.times, seat, other);
        Player { due, disk: self.disks[seat % PLAYERS] as usize }
    }
}

/// A tournament of this number of rounds.
#[derive(Debug, Clone)]
pub(super) struct Wide<const ROUNDS: usize> {
    /// The matches of each round. The last round has one.
    rounds: [Vec<Match>; ROUNDS],
    winner: Player,
    /// The earliest of the others in the winner's match of each round.
    beside: [Player; ROUNDS],
    /// The earliest of all others.
    next: Player,
}

impl<const ROUNDS: usize> Wide<ROUNDS> {
    pub(super) const MOST_DISKS: usize = PLAYERS.pow(ROUNDS as u32);

    /// Creates a tournament of at least one disk.
    pub(super) fn new(disks: usize) -> Self {
        let matches = |round: usize| vec![Match::EMPTY; disks.div_ceil(PLAYERS.pow(round as u32 + 1))];
        let nobody = Player::NOBODY;
        Self { rounds: std::array::from_fn(matches), winner: nobody, beside: [nobody; ROUNDS], next: nobody }
    }

    #[inline(always)]
    pub(super) fn earliest(&self) -> (usize, f64) {
        (self.winner.disk, self.winner.due)
    }

    #[inline(always)]
    fn reset(&mut self, due: &[f64], earliest: impl Earliest) {
        for (disk, &due) in due.iter().enumerate() {
            self.rounds[0][disk / PLAYERS].seat(disk, Player { due: due + 0.0, disk });
        }
        for round in 1..ROUNDS {
            for index in 0..self.rounds[round - 1].len() {
                let first = self.rounds[round - 1][index].earliest_without(NO_SEAT, NO_SEAT, earliest);
                self.rounds[round][index / PLAYERS].seat(index, first);
            }
        }
        self.winner = self.rounds[ROUNDS - 1][0].earliest_without(NO_SEAT, NO_SEAT, earliest);
        self.find_beside(earliest);
    }

    /// Finds those beside the winner.
    #[inline(always)]
    fn find_beside(&mut self, earliest: impl Earliest) {
        let mut index = self.winner.disk;
        self.next = Player::NOBODY;
        for round in 0..ROUNDS {
            let seat = index % PLAYERS;
            index /= PLAYERS;
            self.beside[round] = self.rounds[round][index].earliest_without(seat, NO_SEAT, earliest);
            self.next = self.next.or(self.beside[round]);
        }
    }

    /// Finds the winner and those beside it anew.
    #[inline(always)]
    fn decide(&mut self, earliest: impl Earliest) {
        let mut index = self.winner.disk;
        for round in 0..ROUNDS {
            let seat = index % PLAYERS;
            index /= PLAYERS;
            let there = &mut self.rounds[round][index];
            let others = there.earliest_without(seat, NO_SEAT, earliest);
            there.seat(seat, self.winner);
            self.winner = self.winner.or(others);
        }
        self.find_beside(earliest);
    }

    /// Sets the time of a disk. Returns whether the winner is to be found anew by `decide`.
    #[inline(always)]
    fn set(&mut self, player: Player, earliest: impl Earliest) -> bool {
        if player.disk != self.winner.disk {
            return self.set_other(player, earliest);
        }
        if player.due > self.next.due {
            self.replace_winner(player, earliest);
            return false;
        }
        self.stay(player)
    }

    #[cold]
    #[inline(never)]
    fn stay(&mut self, player: Player) -> bool {
        self.winner = player;
        !player.is_before(self.next)
    }

    #[inline(always)]
    fn replace_winner(&mut self, player: Player, earliest: impl Earliest) {
        let winner = self.next;
        let (mut from, mut to) = (player.disk, winner.disk);
        let mut climber = player;
        for round in 0..ROUNDS {
            let (seat, hidden) = (from % PLAYERS, to % PLAYERS);
            (from, to) = (from / PLAYERS, to / PLAYERS);
            let matches = &mut self.rounds[round];
            if round + 1 < ROUNDS {
                matches[from].seat(seat, climber);
                climber = climber.or(self.beside[round]);
                let beside = matches[to].earliest_without(hidden, NO_SEAT, earliest);
                self.beside[round] = beside;
                self.next = if round == 0 { beside } else { self.next.or(beside) };
            } else {
                let last = &mut matches[0];
                let known = last.earliest_without(hidden, seat, earliest);
                last.seat(seat, climber);
                let late = Player { due: if seat == hidden { f64::INFINITY } else { climber.due }, ..climber };
                let known = if round == 0 { known } else { self.next.or(known) };
                self.next = known.or(late);
            }
        }
        self.winner = winner;
    }

    #[inline(always)]
    fn set_other(&mut self, player: Player, earliest: impl Earliest) -> bool {
        let (mut index, mut winner) = (player.disk, self.winner.disk);
        let mut climber = player;
        for round in 0..ROUNDS {
            let seat = index % PLAYERS;
            (index, winner) = (index / PLAYERS, winner / PLAYERS);
            let there = &mut self.rounds[round][index];
            if index == winner {
                there.seat(seat, climber);
                let beside = if round + 1 < ROUNDS { self.beside[round] } else { self.next };
                return climber.is_before(beside) | (player.disk == beside.disk);
            }
            let others = there.earliest_without(seat, NO_SEAT, earliest);
            there.seat(seat, climber);
            climber = climber.or(others);
        }
        true
    }
}

compiled_for_each! {
    /// Sets the time of a disk.
    #[inline(never)]
    set<const ROUNDS: usize>(wide: &mut Wide<ROUNDS>, disk: usize, due: f64) -> ()
        = set_built, set_avx2, set_avx512
}

compiled_for_each! {
    /// Sets the times of all disks.
    reset<const ROUNDS: usize>(wide: &mut Wide<ROUNDS>, due: &[f64]) -> ()
        = reset_built, reset_avx2, reset_avx512
}

macro_rules! forms {
    ($(#[$attribute:meta])* $set:ident $reset:ident $decide:ident $earliest:path) => {
        $(#[$attribute])*
        #[inline]
        fn $set<const ROUNDS: usize>(wide: &mut Wide<ROUNDS>, disk: usize, due: f64) {
            if wide.set(Player { due: due + 0.0, disk }, |times, seat, other| $earliest(times, seat, other)) {
                $decide(wide);
            }
        }

        $(#[$attribute])*
        #[cold]
        #[inline(never)]
        fn $decide<const ROUNDS: usize>(wide: &mut Wide<ROUNDS>) {
            wide.decide(|times, seat, other| $earliest(times, seat, other));
        }

        $(#[$attribute])*
        fn $reset<const ROUNDS: usize>(wide: &mut Wide<ROUNDS>, due: &[f64]) {
            wide.reset(due, |times, seat, other| $earliest(times, seat, other));
        }
    };
}

forms!(set_built reset_built decide_built earliest_without);
#[cfg(target_arch = "x86_64")]
forms! {
    #[target_feature(enable = "avx2,bmi1,bmi2,lzcnt,popcnt")]
    set_avx2 reset_avx2 decide_avx2 avx2::earliest_without
}
#[cfg(target_arch = "x86_64")]
forms! {
    #[target_feature(enable = "avx512f,avx512dq,avx512vl,avx512bw,avx512cd,avx2,bmi1,bmi2,lzcnt,popcnt")]
    set_avx512 reset_avx512 decide_avx512 avx512::earliest_without
}
