//! The ramps that are left for the threads of a process.

use std::collections::VecDeque;
use std::hash::{BuildHasher, Hasher, RandomState};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Ramps that are free as far as is known, and ramps of other processes.
///
/// Processes begin at random places and go on in order from there. So they seldom meet, and each runs the
/// ramps ahead of it. One that meets another goes to a new place.
#[derive(Debug)]
pub(super) struct Queue {
    left: Mutex<VecDeque<usize>>,
    elsewhere: Mutex<Vec<usize>>,
}

impl Queue {
    pub(super) fn new(ramps: Vec<usize>) -> Self {
        Self { left: Mutex::new(from_anywhere(ramps)), elsewhere: Mutex::default() }
    }

    /// Takes the next ramp.
    pub(super) fn next(&self) -> Option<usize> {
        self.left().pop_front()
    }

    /// Notes a ramp that another process does.
    pub(super) fn leave(&self, ramp: usize) {
        self.elsewhere.lock().unwrap_or_else(PoisonError::into_inner).push(ramp);
    }

    /// Takes all ramps that are left.
    pub(super) fn rest(&self) -> Vec<usize> {
        self.left().drain(..).collect()
    }

    /// Puts back ramps, to go on at another place.
    pub(super) fn put_back(&self, ramps: Vec<usize>) {
        self.left().extend(from_anywhere(ramps));
    }

    /// Takes the ramps that other processes do.
    pub(super) fn elsewhere(&self) -> Vec<usize> {
        std::mem::take(&mut *self.elsewhere.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// Puts back ramps of other processes: some to try, the others to wait for.
    pub(super) fn refill(&self, ramps: Vec<usize>, tried: usize) {
        let mut ramps = from_anywhere(ramps);
        let others = ramps.split_off(tried.min(ramps.len()));
        self.left().extend(ramps);
        for ramp in others {
            self.leave(ramp);
        }
    }

    fn left(&self) -> MutexGuard<'_, VecDeque<usize>> {
        self.left.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Returns ramps in the same order around a ring, from a random place on. The order has no influence on
/// results.
fn from_anywhere(ramps: Vec<usize>) -> VecDeque<usize> {
    // The standard library seeds its hash tables from the system: a random number that needs no dependency.
    let random = RandomState::new().build_hasher().finish();
    let start = random.checked_rem(ramps.len() as u64).unwrap_or(0);
    let mut ring = VecDeque::from(ramps);
    ring.rotate_left(start as usize);
    ring
}
