//! The ramps that are left for the threads of a process.

use std::hash::{BuildHasher, Hasher, RandomState};
use std::ops::Range;
use std::sync::{Mutex, MutexGuard, PoisonError};

use crate::folder::Mark;

/// A ramp, as far as is known.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Ramp {
    Free,
    /// Another process does it, or has done it.
    Elsewhere,
    /// It was taken from the queue, or is done.
    Gone,
}

/// A ring of ramps.
///
/// Processes begin at random places and go on in order from there. So they seldom meet, and each runs the
/// ramps ahead of it. One that meets another goes to a new place.
#[derive(Debug)]
pub(super) struct Queue {
    pub(super) ramps: Range<usize>,
    ring: Mutex<Ring>,
}

#[derive(Debug)]
struct Ring {
    ramps: Vec<Ramp>,
    /// The place from which the next ramp is looked for.
    place: usize,
}

impl Queue {
    pub(super) fn new(ramps: Range<usize>) -> Self {
        let (all, place) = (vec![Ramp::Free; ramps.len()], anywhere(ramps.len()));
        Self { ramps, ring: Mutex::new(Ring { ramps: all, place }) }
    }

    /// Takes the next free ramp.
    pub(super) fn next(&self) -> Option<usize> {
        self.ring().turn(Ramp::Free, Ramp::Gone).map(|index| self.ramps.start + index)
    }

    /// Notes that a ramp is elsewhere, and goes to a new place.
    pub(super) fn leave(&self, ramp: usize) {
        let mut ring = self.ring();
        ring.ramps[ramp - self.ramps.start] = Ramp::Elsewhere;
        ring.place = anywhere(ring.ramps.len());
    }

    /// Strikes out ramps that are done, and returns the number of those that were free or elsewhere.
    pub(super) fn strike(&self, marks: &[Mark]) -> usize {
        let mut ring = self.ring();
        let all = ring.ramps.iter_mut().zip(marks);
        let done = all.filter(|(ramp, mark)| **ramp != Ramp::Gone && **mark != Mark::Open);
        done.map(|(ramp, _)| *ramp = Ramp::Gone).count()
    }

    /// Returns the ramps that are elsewhere.
    pub(super) fn elsewhere(&self) -> Vec<usize> {
        let ring = self.ring();
        let all = self.ramps.clone().zip(&ring.ramps);
        all.filter(|(_, state)| **state == Ramp::Elsewhere).map(|(ramp, _)| ramp).collect()
    }

    /// Lets this many ramps that are elsewhere be tried.
    pub(super) fn retry(&self, count: usize) {
        let mut ring = self.ring();
        ring.place = anywhere(ring.ramps.len());
        for _ in 0..count {
            ring.turn(Ramp::Elsewhere, Ramp::Free);
        }
    }

    fn ring(&self) -> MutexGuard<'_, Ring> {
        self.ring.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Ring {
    /// Finds the next ramp of a kind, changes its kind, and returns its index.
    fn turn(&mut self, from: Ramp, to: Ramp) -> Option<usize> {
        let mut ring = (self.place..self.ramps.len()).chain(0..self.place);
        let found = ring.find(|index| self.ramps[*index] == from)?;
        self.ramps[found] = to;
        self.place = found + 1;
        Some(found)
    }
}

/// Returns a random place among this many. It has no influence on results.
fn anywhere(count: usize) -> usize {
    // The standard library seeds its hash tables from the system: a random number that needs no dependency.
    let random = RandomState::new().build_hasher().finish();
    random.checked_rem(count as u64).unwrap_or(0) as usize
}
