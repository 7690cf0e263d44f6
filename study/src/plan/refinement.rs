//! The path of a ramp: first its own values, then further values that bracket transitions between states.

use std::ops::Range;

use crate::{Experiment, Leg, Plan, Ramp, Record, Width};

/// The data of a finished value on which the path depends.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Seen {
    pub(crate) leg: Option<Leg>,
    pub(crate) at: Option<f64>,
    pub(crate) state: Option<String>,
}

impl<E: Experiment> Plan<E> {
    /// Returns the parts of a record on which the path depends. Finding the name of a state may take long,
    /// and only a refined ramp needs the name.
    pub(crate) fn seen(&self, record: &Record<E>) -> Seen {
        let state = if self.is_refined() { E::state(record) } else { None };
        Seen { leg: record.leg(), at: record.ramped_value(), state }
    }

    /// Returns the next value of a ramp after the finished values, or `None` if the ramp is complete.
    pub(crate) fn next(&self, seen: &[Seen]) -> Option<Step> {
        match self.ramp() {
            Some(ramp) => ramp.search(seen).err(),
            None => seen.is_empty().then_some(Step { leg: None, at: None, before: None }),
        }
    }

    /// Returns the brackets of all transitions; empty until all of them have the requested width.
    pub(crate) fn brackets(&self, seen: &[Seen]) -> Vec<Bracket> {
        self.ramp().and_then(|ramp| ramp.search(seen).ok()).unwrap_or_default()
    }
}

/// The next value on a path, and the index of the value from which it starts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Step {
    pub(crate) leg: Option<Leg>,
    pub(crate) at: Option<f64>,
    pub(crate) before: Option<usize>,
}

/// Two values of a ramped parameter between which the state changes.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Bracket {
    /// The direction from which the ramp came to the transition: from below or from above.
    pub leg: Option<Leg>,
    /// The value on the near side of the transition, from which the ramp came.
    pub near: f64,
    /// The value on the far side.
    pub far: f64,
    /// The state on the side from which the ramp came.
    pub from: String,
    /// The state on the far side; empty if the far side's record shows no state.
    pub to: String,
}

impl Ramp {
    /// Returns the brackets of all transitions among the finished values. The error is the next value that
    /// the ramp or a bracket needs.
    fn search(&self, seen: &[Seen]) -> Result<Vec<Bracket>, Step> {
        let own = self.len();
        if let Some((leg, at)) = self.at(seen.len()) {
            return Err(Step { leg: Some(leg), at: Some(at), before: seen.len().checked_sub(1) });
        }
        let Some(width) = self.refinement() else { return Ok(Vec::new()) };
        let mut search = Search { seen, width, halves: own..seen.len(), brackets: Vec::new() };
        for (near, far) in (0..own).zip(1..own) {
            search.between(near, far)?;
        }
        Ok(search.brackets)
    }
}

/// A search for transitions among the finished values.
struct Search<'a> {
    seen: &'a [Seen],
    width: Width,
    /// The indices of the bisections' values that the search has not used yet.
    halves: Range<usize>,
    brackets: Vec<Bracket>,
}

impl Search<'_> {
    /// Narrows the transitions between two neighbors of the ramp, in the order of the path. The error is the
    /// next value that they need.
    ///
    /// Each value starts from the last state on the near side of its transition, so that a bracket belongs to
    /// the direction from which the ramp came. The first of several transitions is narrowed first: every
    /// state but the near one counts as beyond the transition.
    fn between(&mut self, mut near: usize, far: usize) -> Result<(), Step> {
        if self.seen[far].state.is_none() {
            return Ok(());
        }
        // The values beyond the transition, the closest value last.
        let mut beyond = vec![far];
        while let Some(&far) = beyond.last() {
            let [from, to] = [near, far].map(|index| &self.seen[index].state);
            let is_transition = from.is_some() && from != to;
            if let Some(at) = self.middle(near, far).filter(|_| is_transition) {
                let half = Step { leg: self.seen[far].leg, at: Some(at), before: Some(near) };
                let index = self.halves.next().ok_or(half)?;
                if self.seen[index].state == *from {
                    near = index;
                } else {
                    beyond.push(index);
                }
                continue;
            }
            if is_transition {
                self.brackets.push(Bracket::of(&self.seen[near], &self.seen[far]));
            }
            near = far;
            beyond.pop();
        }
        Ok(())
    }

    /// Returns the middle of two values, or `None` if the values are close enough.
    fn middle(&self, near: usize, far: usize) -> Option<f64> {
        let [near, far] = [near, far].map(|index| self.seen[index].at.unwrap_or(f64::NAN));
        let width = far - near;
        // Where both forms are possible, the sum of the halves would round differently. It therefore serves
        // only where the width overflows.
        let at = if width.is_finite() { near + 0.5 * width } else { 0.5 * near + 0.5 * far };
        // There is no number between two neighboring doubles.
        let is_between = (near < at && at < far) || (far < at && at < near);
        (is_between && !self.width.holds(near, far)).then_some(at)
    }
}

impl Bracket {
    fn of(near: &Seen, far: &Seen) -> Self {
        let at = |seen: &Seen| seen.at.unwrap_or(f64::NAN);
        let state = |seen: &Seen| seen.state.clone().unwrap_or_default();
        Self { leg: far.leg, near: at(near), far: at(far), from: state(near), to: state(far) }
    }
}

impl Width {
    /// Returns whether two values are within this width of each other.
    fn holds(self, near: f64, far: f64) -> bool {
        (far - near).abs()
            <= match self {
                Self::Absolute(width) => width,
                Self::Relative(share) => share * near.abs().max(far.abs()),
            }
    }
}
