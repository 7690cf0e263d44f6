//! The ramps that are left for the threads of a process.

use std::hash::{BuildHasher, Hasher, RandomState};
use std::ops::Range;
use std::sync::{Mutex, MutexGuard, PoisonError};

use crate::study::folder::Mark;

/// Ramps that are free as far as is known, and ramps of other processes.
///
/// Processes begin at random places and go on in order from there. So they seldom meet, and each runs the
/// ramps ahead of it. One that meets another goes to a new place.
#[derive(Debug)]
pub(super) struct Queue {
    ramps: Range<usize>,
    left: Mutex<Left>,
}

#[derive(Debug)]
struct Left {
    free: Vec<bool>,
    /// The place from which the next free ramp is looked for.
    place: usize,
    elsewhere: Vec<usize>,
}

impl Queue {
    pub(super) fn new(ramps: Range<usize>) -> Self {
        let (free, place) = (vec![true; ramps.len()], anywhere(ramps.len()));
        Self { ramps, left: Mutex::new(Left { free, place, elsewhere: Vec::new() }) }
    }

    pub(super) fn ramps(&self) -> Range<usize> {
        self.ramps.clone()
    }

    /// Takes the next free ramp around the ring of all.
    pub(super) fn next(&self) -> Option<usize> {
        let mut left = self.left();
        let (before, after) = left.free.split_at(left.place);
        let first = |part: &[bool]| part.iter().position(|is_free| *is_free);
        let found = first(after).map(|index| left.place + index).or_else(|| first(before))?;
        left.free[found] = false;
        left.place = found + 1;
        Some(self.ramps.start + found)
    }

    /// Notes a ramp that another process does or has done, and goes to a new place.
    pub(super) fn leave(&self, ramp: usize) {
        let mut left = self.left();
        left.elsewhere.push(ramp);
        left.place = anywhere(left.free.len());
    }

    /// Strikes out ramps that are done, and returns their number.
    pub(super) fn strike(&self, marks: &[Mark]) -> usize {
        let Left { free, elsewhere, .. } = &mut *self.left();
        let mut struck = elsewhere.len();
        elsewhere.retain(|ramp| marks[ramp - self.ramps.start] == Mark::Open);
        struck -= elsewhere.len();
        for (is_free, mark) in free.iter_mut().zip(marks) {
            if *is_free && *mark != Mark::Open {
                *is_free = false;
                struck += 1;
            }
        }
        struck
    }

    /// Takes the ramps that other processes do.
    pub(super) fn elsewhere(&self) -> Vec<usize> {
        std::mem::take(&mut self.left().elsewhere)
    }

    /// Puts back ramps of other processes: some to try, the others to wait for.
    pub(super) fn refill(&self, mut ramps: Vec<usize>, tried: usize) {
        let start = anywhere(ramps.len());
        ramps.rotate_left(start);
        let mut left = self.left();
        left.elsewhere = ramps.split_off(tried.min(ramps.len()));
        for ramp in ramps {
            left.free[ramp - self.ramps.start] = true;
        }
    }

    fn left(&self) -> MutexGuard<'_, Left> {
        self.left.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Returns a random place among this many. It has no influence on results.
fn anywhere(count: usize) -> usize {
    // The standard library seeds its hash tables from the system: a random number that needs no dependency.
    let random = RandomState::new().build_hasher().finish();
    random.checked_rem(count as u64).unwrap_or(0) as usize
}
