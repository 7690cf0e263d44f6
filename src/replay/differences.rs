//! The first differences of two runs.

use std::collections::{HashMap, VecDeque};

use super::Replay;
use super::{Replayed, Steps};
use crate::boundary::Boundary;
use crate::collision::CollisionRule;
use crate::observable::Partner;
use crate::scheduler::EventScheduler;
use crate::simulation::{RunError, Simulation};

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
    pub(super) fn other_partners(
        pair: Pair<'_, R, B, S>,
        end: f64,
        failed: [bool; 2],
    ) -> Result<Option<OtherPartner>, RunError> {
        let mut runs = [Steps::new(pair.0.clone()), Steps::new(pair.1.clone())];
        // For each disk, the collisions of the run that is ahead, and the number of this run.
        let mut ahead: HashMap<u64, (usize, VecDeque<Replayed>)> = HashMap::new();
        let mut are_over = [false; 2];
        while are_over != [true; 2] {
            for (which, run) in runs.iter_mut().enumerate() {
                if are_over[which] {
                    continue;
                }
                let next = match run.next(end) {
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
    pub(super) fn first_apart(
        pairs: &[Pair<'_, R, B, S>],
        tolerance: f64,
    ) -> Result<Option<TooFarApart>, RunError> {
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
