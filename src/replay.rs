//! Playback of runs: the state before any collision, the last collisions of a disk, and the first differences
//! of two runs.
//!
//! Only states of the run are recorded, at intervals. Everything in between follows from these states, bit
//! for bit, so any collision can be examined as if the run had just reached it. The first state may come from
//! a [checkpoint](Simulation::resume), from a start file or from a plan and a seed.
//!
//! ```
//! use granular_edmd::prelude::*;
//! use granular_edmd::observable::on_collision;
//! use granular_edmd::replay::Replay;
//!
//! let container = Container::closed(12.0, 12.0)?;
//! let disks = initial::with_maxwellian_velocities(initial::lattice(&container, 40, 0.5)?, 1.0, 1)?;
//! let run = Simulation::builder(Elastic, container).disks(disks).build()?;
//!
//! let mut replay = Replay::new(run, 2.0)?;
//! replay.run_until(30.0)?;
//! // Something went wrong with disk 7 at the end: what has it met?
//! let last = replay.last_collisions_of(7, 30.0, 3)?;
//! assert_eq!(last.len(), 3);
//! // The state before the last of these collisions, which then comes next.
//! let mut before = replay.before_collision(last[2].number)?.unwrap();
//! let same = on_collision(|collision: &Collision| assert_eq!(*collision, last[2].collision));
//! before.step_until(30.0, &mut { same })?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use std::collections::{HashMap, VecDeque};

use crate::ParameterError;
use crate::boundary::Boundary;
use crate::collision::CollisionRule;
use crate::observable::{Collision, Partner, on_collision};
use crate::quantity::positive;
use crate::scheduler::EventScheduler;
use crate::simulation::{Limits, RunError, Simulation};

/// Limit on the number of states that are kept.
const MOST_STATES: usize = 64;

/// Largest difference of two times that counts as rounding, relative to the interval between states.
const SAME: f64 = 1e-9;

/// A run that can be played back; [the module](self) has an example.
///
/// It keeps copies of the run at equal intervals of time. When there are too many of them, it drops every
/// second one and doubles the interval.
#[derive(Debug, Clone)]
pub struct Replay<R, B, S> {
    /// States in the order of time; the first one is the start.
    states: Vec<Simulation<R, B, S>>,
    present: Simulation<R, B, S>,
    interval: f64,
    has_failed: bool,
}

impl<R: CollisionRule + Clone, B: Boundary + Clone, S: EventScheduler + Clone> Replay<R, B, S> {
    /// Creates a replay that starts with this state, and keeps a state at the end of each interval.
    ///
    /// # Errors
    /// If the interval is not finite and positive.
    pub fn new(start: Simulation<R, B, S>, interval: f64) -> Result<Self, ParameterError> {
        let interval = positive("interval between two states", interval)?;
        let present = start.clone();
        Ok(Self { states: vec![start], present, interval, has_failed: false })
    }

    /// Returns the run in its latest state.
    pub const fn present(&self) -> &Simulation<R, B, S> {
        &self.present
    }

    /// Continues the run until the absolute time `end`.
    ///
    /// # Errors
    /// The same as for [`Simulation::run_until`]. The run can be played back up to the error.
    pub fn run_until(&mut self, end: f64) -> Result<(), RunError> {
        if !(end.is_finite() && end >= self.present.time()) {
            return self.present.run_until(end, &mut ()).map(drop);
        }
        let start = self.states[0].time();
        loop {
            let next = start + self.states.len() as f64 * self.interval;
            let ended = self.present.run_until(end.min(next), &mut ());
            self.has_failed = ended.is_err();
            ended?;
            if next > end {
                return Ok(());
            }
            self.states.push(self.present.clone());
            if self.states.len() > MOST_STATES {
                let mut stays = false;
                self.states.retain(|_| {
                    stays = !stays;
                    stays
                });
                self.interval *= 2.0;
            }
        }
    }

    /// Returns the state at an absolute time, after all events up to and including that time; `None` if the
    /// run does not cover the time.
    ///
    /// # Errors
    /// If the replay fails where the run did not: a part then returns other results than in the run.
    pub fn at(&self, time: f64) -> Result<Option<Simulation<R, B, S>>, RunError> {
        let Some(state) = self.states.iter().rfind(|state| state.time() <= time) else { return Ok(None) };
        if time >= self.present.time() {
            // The run may have ended with an error at this time. Running on from here would end with the same
            // error.
            return Ok((time == self.present.time()).then(|| self.present.clone()));
        }
        let mut run = state.clone();
        run.run_until(time, &mut ())?;
        Ok(Some(run))
    }

    /// Returns the state just before the collision with this number, or `None` if the run had no such
    /// collision.
    ///
    /// Collisions with disks and walls are counted together, starting with 1, as the
    /// [counters](Simulation::counters) do.
    ///
    /// # Errors
    /// If the replay fails where the run did not: a part then returns other results than in the run.
    pub fn before_collision(&self, number: u64) -> Result<Option<Simulation<R, B, S>>, RunError> {
        if number > self.present.counters().collisions() + u64::from(self.has_failed) {
            return Ok(None);
        }
        let Some(state) = self.states.iter().rfind(|state| state.counters().collisions() < number) else {
            return Ok(None);
        };
        let mut run = state.clone();
        let left = number - 1 - state.counters().collisions();
        run.run(&Limits::until(self.present.time()).with_most_collisions(left), &mut ())?;
        Ok(Some(run))
    }

    /// Returns the collisions after the absolute time `from`, up to and including `to`.
    ///
    /// # Errors
    /// If the replay fails where the run did not: a part then returns other results than in the run.
    pub fn collisions(&self, from: f64, to: f64) -> Result<Vec<Replayed>, RunError> {
        let start = &self.states[0];
        // Disks that touch at the start collide immediately.
        let run = if from < start.time() { Some(start.clone()) } else { self.at(from)? };
        run.filter(|run| run.time() <= to).map_or(Ok(Vec::new()), |run| self.played(run, to))
    }

    /// Returns a disk's last collisions up to and including an absolute time, at most `count` of them, in
    /// order. The disk is identified by its [id](crate::Disk::id).
    ///
    /// # Errors
    /// If the replay fails where the run did not: a part then returns other results than in the run.
    pub fn last_collisions_of(&self, id: u64, until: f64, count: usize) -> Result<Vec<Replayed>, RunError> {
        let (mut last, mut end) = (Vec::new(), until);
        // The collisions at the time of the first state may still lie ahead: disks may touch at the start.
        for state in self.states.iter().rev().filter(|state| state.time() <= until) {
            let mut own = self.played(state.clone(), end)?;
            own.retain(|replayed| replayed.id == id || replayed.partner_id == Some(id));
            last.splice(0..0, own);
            end = state.time();
            if last.len() >= count {
                break;
            }
        }
        Ok(last.split_off(last.len().saturating_sub(count)))
    }

    /// Continues the run from a state up to `until`, and returns its collisions.
    fn played(&self, mut run: Simulation<R, B, S>, until: f64) -> Result<Vec<Replayed>, RunError> {
        let (mut all, end) = (Vec::new(), until.min(self.present.time()));
        loop {
            match Replayed::next(&mut run, end) {
                Ok(Some(replayed)) => all.push(replayed),
                Ok(None) => return Ok(all),
                // The run ended with this error.
                Err(_) if self.has_failed => return Ok(all),
                Err(error) => return Err(error),
            }
        }
    }

    /// Returns the state at this time, or the last state if the run ends earlier.
    fn last_before(&self, time: f64) -> Result<Simulation<R, B, S>, RunError> {
        let before = if time < self.present.time() { self.at(time)? } else { None };
        Ok(before.unwrap_or_else(|| self.present.clone()))
    }

    /// Compares two runs, state by state and collision by collision.
    ///
    /// A bisection finds the last state that is the same in both, and the collisions are compared from there
    /// on, disk by disk. Two runs that differ only by rounding therefore have the same partners for a while,
    /// although their times differ. A run that ended with an error is compared up to the error. The result is
    /// `None` if the two runs keep no states at the same times.
    ///
    /// # Errors
    /// If the replay fails where the run did not: a part then returns other results than in the run.
    ///
    /// ```
    /// use granular_edmd::prelude::*;
    /// use granular_edmd::replay::Replay;
    ///
    /// let container = Container::closed(12.0, 12.0)?;
    /// let disks = initial::with_maxwellian_velocities(initial::lattice(&container, 40, 0.5)?, 1.0, 1)?;
    /// let replay = |disks: Vec<Disk>| -> Result<_, Box<dyn std::error::Error>> {
    ///     let run = Simulation::builder(Elastic, container.clone()).disks(disks).build()?;
    ///     let mut replay = Replay::new(run, 1.0)?;
    ///     replay.run_until(80.0)?;
    ///     Ok(replay)
    /// };
    /// // In the other run, a disk begins 1e-12 farther to the side.
    /// let mut others = disks.clone();
    /// others[0] = disks[0].with_position(disks[0].position() + DVec2::splat(1e-12))?;
    /// let found = replay(disks)?.differences(&replay(others)?, 1e-6)?.unwrap();
    /// let (apart, other) = (found.apart.unwrap(), found.partners.unwrap());
    /// assert!(0.0 < apart.time && apart.time < other.collisions[0].collision.time);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn differences(&self, other: &Self, tolerance: f64) -> Result<Option<Differences>, RunError> {
        let end = self.present.time().min(other.present.time());
        let ends = [self.last_before(end)?, other.last_before(end)?];
        // Times may differ by rounding, since a run counts them from its own epochs.
        let is_same = |first: f64, second: f64| (first - second).abs() <= SAME * self.interval;
        let at = |time| other.states.iter().find(|state| is_same(state.time(), time));
        let pairs = self.states.iter().filter_map(|state| Some((state, at(state.time())?)));
        let mut pairs: Vec<_> = pairs.collect();
        if pairs.is_empty() {
            return Ok(None);
        }
        pairs.push((&ends[0], &ends[1]));
        let differ = pairs.partition_point(|(first, second)| first.disks() == second.disks());
        let pairs = &pairs[differ.saturating_sub(1)..];
        let failed = [self, other].map(|replay| replay.has_failed);
        let partners = Self::other_partners(pairs[0], end, failed)?;
        let apart = Self::first_apart(pairs, tolerance)?;
        Ok(Some(Differences { partners, apart }))
    }
}

/// A collision that was played back.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Replayed {
    /// Number of the collision, counted from 1.
    pub number: u64,
    /// Id of the disk whose event it was.
    pub id: u64,
    /// Id of the other disk; `None` if the partner is a wall.
    pub partner_id: Option<u64>,
    /// The collision. Its indices are the indices at that time.
    pub collision: Collision,
}

impl Replayed {
    /// Advances a run to its next collision, or to the absolute time `end` if no collision happens up to and
    /// including that time; the result is then `None`.
    fn next<R: CollisionRule, B: Boundary, S: EventScheduler>(
        run: &mut Simulation<R, B, S>,
        end: f64,
    ) -> Result<Option<Self>, RunError> {
        let mut last = None;
        run.step_until(end, &mut on_collision(|collision: &Collision| last = Some(*collision)))?;
        Ok(last.map(|collision| {
            let [id, partner] = collision.ids;
            let partner_id = matches!(collision.partner, Partner::Disk(_)).then_some(partner);
            Self { number: run.counters().collisions(), id, partner_id, collision }
        }))
    }
}

/// Number of halvings of the interval in which two runs diverge.
const HALVINGS: u32 = 40;

/// The first differences of two runs.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Differences {
    /// The first collision in which a disk meets different partners in the two runs; `None` if all partners
    /// are the same.
    pub partners: Option<OtherPartner>,
    /// The first time at which a disk is farther from its position in the other run than the tolerance;
    /// `None` if no disk is farther away than that at the end of any interval.
    pub apart: Option<TooFarApart>,
}

/// The n-th collision of a disk in one run, and its n-th collision in the other.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct OtherPartner {
    /// Id of the disk.
    pub id: u64,
    /// The collisions.
    pub collisions: [Replayed; 2],
}

/// A disk that is far from its position in the other run.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct TooFarApart {
    /// Id of the disk.
    pub id: u64,
    /// Absolute time.
    pub time: f64,
    /// Distance between the two positions.
    pub distance: f64,
}

/// A pair of states at the same time.
type Pair<'a, R, B, S> = (&'a Simulation<R, B, S>, &'a Simulation<R, B, S>);

impl<R: CollisionRule + Clone, B: Boundary + Clone, S: EventScheduler + Clone> Replay<R, B, S> {
    /// Compares the partners of each disk, taking collisions from both runs alternately. A run that `failed`
    /// ends at its error.
    fn other_partners(
        pair: Pair<'_, R, B, S>,
        end: f64,
        failed: [bool; 2],
    ) -> Result<Option<OtherPartner>, RunError> {
        let mut runs = [pair.0.clone(), pair.1.clone()];
        // For each disk, the collisions of the run that is ahead, and the number of this run.
        let mut ahead: HashMap<u64, (usize, VecDeque<Replayed>)> = HashMap::new();
        let mut are_over = [false; 2];
        while are_over != [true; 2] {
            for (which, run) in runs.iter_mut().enumerate() {
                if are_over[which] {
                    continue;
                }
                let next = match Replayed::next(run, end) {
                    Err(_) if failed[which] => None,
                    next => next?,
                };
                let Some(collision) = next else {
                    are_over[which] = true;
                    continue;
                };
                for id in [Some(collision.id), collision.partner_id].into_iter().flatten() {
                    let (leader, waiting) = ahead.entry(id).or_default();
                    if waiting.is_empty() || *leader == which {
                        *leader = which;
                        waiting.push_back(collision.clone());
                    } else if let Some(other) = waiting.pop_front()
                        && partner_of(&other, id) != partner_of(&collision, id)
                    {
                        let mut collisions = [other, collision];
                        collisions.rotate_left(1 - which);
                        return Ok(Some(OtherPartner { id, collisions }));
                    }
                }
            }
        }
        Ok(None)
    }

    /// Finds the first interval at whose end a disk is too far away, and halves it again and again.
    fn first_apart(pairs: &[Pair<'_, R, B, S>], tolerance: f64) -> Result<Option<TooFarApart>, RunError> {
        if let Some(apart) = pairs.first().and_then(|&start| Self::farthest(start, tolerance)) {
            return Ok(Some(apart));
        }
        let found =
            pairs.windows(2).find_map(|window| Some((window[0], Self::farthest(window[1], tolerance)?)));
        let Some((start, mut apart)) = found else { return Ok(None) };
        let mut near = (start.0.clone(), start.1.clone());
        for _ in 0..HALVINGS {
            let time = near.0.time() + 0.5 * (apart.time - near.0.time());
            let mut middle = near.clone();
            middle.0.run_until(time, &mut ())?;
            middle.1.run_until(time, &mut ())?;
            match Self::farthest((&middle.0, &middle.1), tolerance) {
                Some(earlier) => apart = earlier,
                None => near = middle,
            }
        }
        Ok(Some(apart))
    }

    /// Returns the disk that is farthest from its position in the other run, if the distance exceeds the
    /// tolerance.
    fn farthest((first, second): Pair<'_, R, B, S>, tolerance: f64) -> Option<TooFarApart> {
        let domain = first.boundary().domain();
        let others: HashMap<u64, _> =
            second.disks().iter().map(|disk| (disk.id(), disk.position())).collect();
        let apart = |disk: &crate::Disk| {
            let distance = domain.separation(disk.position(), *others.get(&disk.id())?).length();
            Some(TooFarApart { id: disk.id(), time: first.time(), distance })
        };
        let all = first.disks();
        let far = all.iter().filter_map(apart).filter(|apart| apart.distance > tolerance);
        far.max_by(|a, b| a.distance.total_cmp(&b.distance))
    }
}

/// Returns the partner with which this disk collided: the id of a disk, or else a wall.
fn partner_of(replayed: &Replayed, id: u64) -> (Option<u64>, Option<Partner>) {
    match replayed.partner_id {
        Some(partner) => (Some(if partner == id { replayed.id } else { partner }), None),
        None => (None, Some(replayed.collision.partner)),
    }
}
