//! A tournament in matches of 32, for processors that compare the times of several disks together.
//!
//! The runner-up is known before the winner's event is carried out. The next event can therefore begin while
//! the processor is still busy with the winner's new time, which is known last. Only the branch on whether
//! the winner stays first depends on that time, and this branch is nearly always predicted correctly. A
//! tournament without the runner-up has to wait for the new time, and is slower than the tournament in
//! matches of four.

use std::hint::select_unpredictable;

use super::earliest::{NO_SEAT, PLAYERS, Times, earliest_without};
#[cfg(target_arch = "x86_64")]
use super::earliest::{avx2, avx512};
use crate::instructions::{Instructions, compiled_for_each};
use crate::scheduler::NOTHING_DUE;

/// A function like [`earliest_without`].
trait Earliest: Fn(&Times, usize, usize) -> (f64, usize) + Copy {}

impl<F: Fn(&Times, usize, usize) -> (f64, usize) + Copy> Earliest for F {}

/// A disk, and the time at which it is due.
#[derive(Debug, Clone, Copy)]
struct Player {
    due: f64,
    disk: usize,
}

impl Player {
    const NOBODY: Self = Self { disk: NOTHING_DUE.0, due: NOTHING_DUE.1 };

    /// Returns whether this player comes first. At equal times, the smaller disk comes first.
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

    /// Puts a player into a seat.
    // One number is written, after all have been read. If a whole vector were written back, the compiler
    // would make it a write by a mask, and the next read of the vector would wait for this write.
    #[inline(always)]
    fn seat(&mut self, seat: usize, player: Player) {
        self.times.0[seat % PLAYERS] = player.due;
        self.disks[seat % PLAYERS] = player.disk as u32;
    }

    /// Returns the earliest player, except the players in two seats.
    #[inline(always)]
    fn earliest_without(&self, one: usize, other: usize, earliest: impl Earliest) -> Player {
        let (due, seat) = earliest(&self.times, one, other);
        Player { due, disk: self.disks[seat % PLAYERS] as usize }
    }
}

/// A tournament of two or more rounds, for at least one disk.
///
/// The seats on the winner's way through the rounds are out of date: they are not read before the winner has
/// left them.
#[derive(Debug, Clone)]
pub(super) struct Wide<const ROUNDS: usize> {
    /// The matches of each round. The last round has one.
    rounds: [Vec<Match>; ROUNDS],
    winner: Player,
    /// The earliest of the winner's opponents in each round but the last.
    beside: [Player; ROUNDS],
    /// The earliest player except the winner.
    runner_up: Player,
}

impl<const ROUNDS: usize> Wide<ROUNDS> {
    pub(super) const MOST_DISKS: usize = PLAYERS.pow(ROUNDS as u32);

    /// Creates a tournament without players.
    pub(super) fn new() -> Self {
        let (rounds, beside) = (std::array::from_fn(|_| Vec::new()), [Player::NOBODY; ROUNDS]);
        let [winner, runner_up] = [Player::NOBODY; 2];
        Self { rounds, winner, beside, runner_up }
    }

    /// Creates all matches for this number of disks, and empties them. The memory is kept, since a run resets
    /// its scheduler whenever its epoch moves.
    fn empty(&mut self, disks: usize) {
        for (round, matches) in self.rounds.iter_mut().enumerate() {
            matches.clear();
            matches.resize(disks.div_ceil(PLAYERS.pow(round as u32 + 1)), Match::EMPTY);
        }
        self.beside = [Player::NOBODY; ROUNDS];
    }

    #[inline(always)]
    pub(super) fn earliest(&self) -> (usize, f64) {
        (self.winner.disk, self.winner.due)
    }

    pub(super) fn reset(&mut self, instructions: Instructions, due: &[f64]) {
        self.empty(due.len());
        for (disk, &due) in due.iter().enumerate() {
            self.rounds[0][disk / PLAYERS].seat(disk, Player { due: due + 0.0, disk });
        }
        for round in 1..ROUNDS {
            for index in 0..self.rounds[round - 1].len() {
                let first =
                    self.rounds[round - 1][index].earliest_without(NO_SEAT, NO_SEAT, earliest_without);
                self.rounds[round][index / PLAYERS].seat(index, first);
            }
        }
        self.winner = self.rounds[ROUNDS - 1][0].earliest_without(NO_SEAT, NO_SEAT, earliest_without);
        self.decide(instructions);
    }

    #[inline(always)]
    pub(super) fn set(&mut self, instructions: Instructions, disk: usize, due: f64) {
        // Adding 0 turns -0 into 0, so that both zeros are the same time.
        if set(instructions, self, Player { due: due + 0.0, disk }) {
            self.decide(instructions);
        }
    }

    #[cold]
    #[inline(never)]
    fn decide(&mut self, instructions: Instructions) {
        decide(instructions, self);
    }

    /// Sets a player's time. Returns whether winner and runner-up must be found by [`Self::find_first`],
    /// which is rare.
    #[inline(always)]
    fn play(&mut self, player: Player, earliest: impl Earliest) -> bool {
        if player.disk != self.winner.disk {
            return self.replace_other(player, earliest);
        }
        if player.due > self.runner_up.due {
            self.replace_winner(player, earliest);
            return false;
        }
        self.stay(player)
    }

    #[cold]
    #[inline(never)]
    fn stay(&mut self, player: Player) -> bool {
        self.winner = player;
        !player.is_before(self.runner_up)
    }

    /// Makes the runner-up the winner. The `player` who was the winner is due later than the runner-up.
    #[inline(always)]
    fn replace_winner(&mut self, player: Player, earliest: impl Earliest) {
        let winner = self.runner_up;
        let (mut from, mut to) = (player.disk, winner.disk);
        let mut climber = player;
        for round in 0..ROUNDS {
            let (seat, winners_seat) = (from % PLAYERS, to % PLAYERS);
            (from, to) = (from / PLAYERS, to / PLAYERS);
            let matches = &mut self.rounds[round];
            if round + 1 < ROUNDS {
                matches[from].seat(seat, climber);
                climber = climber.or(self.beside[round]);
                self.beside[round] = matches[to].earliest_without(winners_seat, NO_SEAT, earliest);
                let beside = self.beside[round];
                self.runner_up = if round == 0 { beside } else { self.runner_up.or(beside) };
                continue;
            }
            // Both play in the last match. The `climber` is compared last of all, since its time is known
            // last.
            let others = matches[0].earliest_without(winners_seat, seat, earliest);
            matches[0].seat(seat, climber);
            // If both came from the same match of the round before, the `climber` was compared there, in
            // `beside`.
            let is_beside = seat == winners_seat;
            let late = Player { due: if is_beside { f64::INFINITY } else { climber.due }, ..climber };
            self.runner_up = self.runner_up.or(others).or(late);
        }
        self.winner = winner;
    }

    /// Sets the time of a player who is not the winner. Returns whether that changes the winner or the
    /// runner-up.
    #[inline(always)]
    fn replace_other(&mut self, player: Player, earliest: impl Earliest) -> bool {
        let (mut index, mut winner) = (player.disk, self.winner.disk);
        let mut climber = player;
        for round in 0..ROUNDS {
            let seat = index % PLAYERS;
            (index, winner) = (index / PLAYERS, winner / PLAYERS);
            let there = &mut self.rounds[round][index];
            if index == winner {
                there.seat(seat, climber);
                let beside = if round + 1 < ROUNDS { self.beside[round] } else { self.runner_up };
                return climber.is_before(beside) | (player.disk == beside.disk);
            }
            let others = there.earliest_without(seat, NO_SEAT, earliest);
            there.seat(seat, climber);
            climber = climber.or(others);
        }
        true
    }

    /// Finds the winner and the runner-up among all players, along the present winner's path upward.
    #[inline(always)]
    fn find_first(&mut self, earliest: impl Earliest) {
        let mut index = self.winner.disk;
        for round in 0..ROUNDS {
            let seat = index % PLAYERS;
            index /= PLAYERS;
            let there = &mut self.rounds[round][index];
            let others = there.earliest_without(seat, NO_SEAT, earliest);
            there.seat(seat, self.winner);
            self.winner = self.winner.or(others);
        }
        let mut index = self.winner.disk;
        self.runner_up = Player::NOBODY;
        for round in 0..ROUNDS {
            let seat = index % PLAYERS;
            index /= PLAYERS;
            self.beside[round] = self.rounds[round][index].earliest_without(seat, NO_SEAT, earliest);
            self.runner_up = self.runner_up.or(self.beside[round]);
        }
    }
}

compiled_for_each! {
    #[inline(never)]
    set<const ROUNDS: usize>(wide: &mut Wide<ROUNDS>, player: Player) -> bool
        = |wide, player| Wide::play(wide, player, earliest_without),
        |wide, player| Wide::play(wide, player, |times, one, other| avx2::earliest_without(times, one, other)),
        |wide, player| Wide::play(wide, player, |times, one, other| avx512::earliest_without(times, one, other))
}

compiled_for_each! {
    #[cold]
    #[inline(never)]
    decide<const ROUNDS: usize>(wide: &mut Wide<ROUNDS>) -> ()
        = |wide| Wide::find_first(wide, earliest_without),
        |wide| Wide::find_first(wide, |times, one, other| avx2::earliest_without(times, one, other)),
        |wide| Wide::find_first(wide, |times, one, other| avx512::earliest_without(times, one, other))
}

#[cfg(test)]
mod tests {
    use super::Wide;
    use crate::instructions::Instructions;
    use crate::scheduler::{EventScheduler, NOTHING_DUE, laws};

    /// A tournament of this number of rounds, or of four if there are more disks.
    struct Tournament<const ROUNDS: usize>(Instructions, Option<Wide<ROUNDS>>, Option<Wide<4>>);

    impl<const ROUNDS: usize> EventScheduler for Tournament<ROUNDS> {
        fn reset(&mut self, due: &[f64]) {
            (self.1, self.2) = (None, None);
            match due.len() {
                0 => {}
                disks if disks <= Wide::<ROUNDS>::MOST_DISKS => {
                    self.1.insert(Wide::new()).reset(self.0, due);
                }
                _ => self.2.insert(Wide::new()).reset(self.0, due),
            }
        }

        fn set(&mut self, disk: usize, due: f64) {
            match (&mut self.1, &mut self.2) {
                (Some(wide), _) => wide.set(self.0, disk, due),
                (_, Some(wide)) => wide.set(self.0, disk, due),
                _ => {}
            }
        }

        fn earliest(&self) -> (usize, f64) {
            let few = self.1.as_ref().map(Wide::earliest);
            few.or(self.2.as_ref().map(Wide::earliest)).unwrap_or(NOTHING_DUE)
        }
    }

    #[test]
    fn all_levels_keep_the_laws_in_any_number_of_rounds() {
        for level in Instructions::all() {
            assert_eq!(laws::check(|| Tournament::<2>(level, None, None)), Ok(()));
            assert_eq!(laws::check(|| Tournament::<3>(level, None, None)), Ok(()));
        }
    }
}
