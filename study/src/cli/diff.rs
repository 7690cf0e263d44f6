//! The command `diff`: finds where two runs first differ.

use std::collections::HashSet;

use granular_edmd::Disk;
use granular_edmd::quantity::non_negative;
use granular_edmd::replay::{Differences, Replay};

use super::arguments::Diff;
use super::source::{HEADINGS, Source, row, tell_end};
use super::terminal::{end_at_once, say, tell};
use super::{End, Failure, PlanError};
use crate::execution::value::Value;
use crate::execution::value::play::{Found, Pause, Player};
use crate::{Experiment, Run};

/// Number of parts of a compared interval, after each of which the progress is shown.
const PARTS: u32 = 32;

/// Largest difference of two positions that counts as rounding.
const SAME: f64 = 1e-9;

/// Compares two runs over longer and longer times, until both differences are found or a run ends.
pub(super) fn diff<E: Experiment<Rule: Clone, Boundary: Clone>>(wishes: &Diff) -> Result<End, Failure> {
    let tolerance = non_negative("tolerance", wishes.tolerance).map_err(PlanError::from)?;
    let second = wishes.second.as_ref().unwrap_or(&wishes.first);
    let mut one = Source::<E>::open(&wishes.first, &wishes.place, wishes.place.start.as_deref())?;
    let mut two = Source::<E>::open(second, &wishes.place, wishes.other_start.as_deref())?;
    let values = [&one.found, &two.found].map(|found| found.as_ref().map(Found::value));
    check_disks(&one.run.disks(), &two.run.disks())?;
    let mut players =
        [Played::new(values[0].as_ref(), &one.run)?, Played::new(values[1].as_ref(), &two.run)?];
    end_at_once(None)?;
    let (begin, end, cycle) = (one.run.time().max(two.run.time()), one.end.min(two.end), one.cycle);
    let show = one.clock();
    // The start file of one run may hold a later time than the start of the other run.
    one.run.run_until(begin, &mut ())?;
    two.run.run_until(begin, &mut ())?;
    let mut replays = [Replay::new(one.run, cycle)?, Replay::new(two.run, cycle)?];
    let (mut length, mut is_over) = (cycle, false);
    let found = loop {
        length *= 2.0;
        let until = end.min(begin + length);
        for (replay, played) in replays.iter_mut().zip(&mut players) {
            let until = played.reach(until);
            is_over |= played.is_over();
            let before = replay.present().time();
            if until < before {
                return Err("the runs have no time in common".into());
            }
            let ended = (1..=PARTS).try_for_each(|part| {
                let time = before + (until - before) * f64::from(part) / f64::from(PARTS);
                show(time);
                replay.run_until(time)
            });
            if let Err(error) = ended {
                tell_end(replay.present(), &error);
                is_over = true;
            }
            played.check(replay.present())?;
        }
        let found = replays[0].differences(&replays[1], tolerance)?;
        let found = found.ok_or("the runs have no time in common")?;
        if is_over || until >= end || (found.partners.is_some() && found.apart.is_some()) {
            break found;
        }
    };
    say_found::<E>(&found, replays.each_ref().map(Replay::present), tolerance)?;
    let are_same = found.partners.is_none() && found.apart.is_none();
    Ok(if are_same { End::Done } else { End::Different })
}

/// The player of a value that is compared; `None` for a run that starts from a file.
struct Played<'a, E: Experiment>(Option<Player<'a, E>>);

impl<'a, E: Experiment<Rule: Clone, Boundary: Clone>> Played<'a, E> {
    fn new(value: Option<&'a Value<'a, E>>, run: &Run<E>) -> Result<Self, Failure> {
        let Some(value) = value else { return Ok(Self(None)) };
        let player = Player::new(Some(value), run.clone(), Box::new(()))?;
        if player.is_driven() {
            return Err("the experiment has a driving, and driven runs cannot be compared".into());
        }
        Ok(Self(Some(player)))
    }

    fn is_over(&self) -> bool {
        self.0.as_ref().is_some_and(Player::is_over)
    }

    /// Plays until a time or the end of the value, and returns the time to which the replay must run. The
    /// replay has the same errors, and reports them.
    fn reach(&mut self, until: f64) -> f64 {
        let Some(player) = &mut self.0 else { return until };
        loop {
            match player.play(until, u64::MAX) {
                Ok(Pause::Prepared | Pause::Slice) => {}
                Ok(Pause::Over) => return until.min(player.run().time()),
                Ok(Pause::Reached) | Err(_) => return until,
            }
        }
    }

    /// Returns an error if the replay, in which no step is prepared, is not as the value was.
    fn check(&self, replayed: &Run<E>) -> Result<(), Failure> {
        let Some(player) = &self.0 else { return Ok(()) };
        let (disks, others) = (player.run().disks(), replayed.disks());
        let is_same = |(one, other): (&Disk, &Disk)| {
            let place = one.position();
            one.id() == other.id() && place.distance(other.position()) <= SAME * (1.0 + place.length())
        };
        if disks.len() == others.len() && disks.iter().zip(&others).all(is_same) {
            return Ok(());
        }
        Err("the experiment prepares the steps of its values, and such runs cannot be compared".into())
    }
}

/// Returns an error if the runs have no disk in common. Reports the number of disks that only one run has.
fn check_disks(one: &[Disk], two: &[Disk]) -> Result<(), Failure> {
    let ids: HashSet<u64> = one.iter().map(Disk::id).collect();
    let common = two.iter().filter(|disk| ids.contains(&disk.id())).count();
    if common == 0 {
        return Err("the runs have no disk in common: no id of one is in the other".into());
    }
    let alone = one.len() + two.len() - 2 * common;
    if alone > 0 {
        tell(&format!("the number of disks in one of the runs alone, which are not compared, is {alone}"));
    }
    Ok(())
}

/// Prints the differences.
fn say_found<E: Experiment>(found: &Differences, runs: [&Run<E>; 2], tolerance: f64) -> Result<(), Failure> {
    let until = runs[0].time().min(runs[1].time());
    match &found.partners {
        None => say(&format!("until {until}, all disks meet the same partners"))?,
        Some(other) => {
            let of = |run: usize| {
                let it = &other.collisions[run];
                row(it.number, &it.collision, runs[run].boundary())
            };
            let [one, two] = [of(0), of(1)];
            say(&format!("disk {} meets other partners:\n{HEADINGS}\n{one}\n{two}", other.id))?;
        }
    }
    let apart = match &found.apart {
        None => format!("until {until}, no disk is farther than {tolerance} from its place in the other run"),
        Some(it) => {
            format!("disk {} is {} away from its place in the other run at {}", it.id, it.distance, it.time)
        }
    };
    say(&apart)
}
