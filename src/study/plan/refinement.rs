//! The path of a ramp: first its own values, then those that bracket transitions between states.

use std::ops::Range;

use super::ramp::{Ramp, Width};
use crate::study::experiment::Experiment;
use crate::study::experiment::record::Record;
use crate::study::leg::Leg;

/// The data of a finished value on which the path depends.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::study) struct Seen {
    pub(in crate::study) leg: Option<Leg>,
    pub(in crate::study) at: Option<f64>,
    pub(in crate::study) state: Option<String>,
}

impl Seen {
    /// Returns the parts of a record on which the path depends.
    pub(in crate::study) fn of<E: Experiment>(record: &Record<E>) -> Self {
        Self { leg: record.leg(), at: record.ramped_value(), state: E::state(record) }
    }
}

/// The next value on a path, and the index of the value from which it starts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::study) struct Step {
    pub(in crate::study) leg: Option<Leg>,
    pub(in crate::study) at: Option<f64>,
    pub(in crate::study) before: Option<usize>,
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
    /// The state on the far side; empty if the record there shows none.
    pub to: String,
}

impl Ramp {
    /// Returns the next value after the finished ones; `None` if there is none.
    pub(in crate::study) fn next(&self, seen: &[Seen]) -> Option<Step> {
        self.search(seen).err()
    }

    /// Returns the brackets of all transitions; empty before all of them have the wanted width.
    pub(in crate::study) fn brackets(&self, seen: &[Seen]) -> Vec<Bracket> {
        self.search(seen).unwrap_or_default()
    }

    /// Returns all brackets. The error is the next value that they need.
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

/// A search for transitions among the values that are done.
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
    /// the direction from which the ramp came. The first of several transitions is narrowed first: all states
    /// but the near one count as beyond it.
    fn between(&mut self, mut near: usize, far: usize) -> Result<(), Step> {
        if self.seen[far].state.is_none() {
            return Ok(());
        }
        // The values beyond the transition, the closest last.
        let mut beyond = vec![far];
        while let Some(&far) = beyond.last() {
            let [from, to] = [near, far].map(|index| &self.seen[index].state);
            let is_transition = from.is_some() && from != to;
            if let Some(at) = self.middle(near, far).filter(|_| is_transition) {
                let index = self.half(Step { leg: self.seen[far].leg, at: Some(at), before: Some(near) })?;
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

    /// Returns the middle of two values; `None` if they are close enough.
    fn middle(&self, near: usize, far: usize) -> Option<f64> {
        let [near, far] = [near, far].map(|index| self.seen[index].at.unwrap_or(f64::NAN));
        let width = far - near;
        // The sum of the halves would round otherwise where both are possible, so it is for widths beyond all
        // numbers alone.
        let at = if width.is_finite() { near + 0.5 * width } else { 0.5 * near + 0.5 * far };
        // There is no number between two neighboring doubles.
        let is_between = (near < at && at < far) || (far < at && at < near);
        (is_between && !self.width.holds(near, far)).then_some(at)
    }

    /// Returns the index of the next value of a bisection. The error is the step to it, if it is not
    /// finished.
    fn half(&mut self, step: Step) -> Result<usize, Step> {
        self.halves.next().ok_or(step)
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::plan::ramp::Course;

    fn refined<const N: usize>(values: [f64; N], course: Course, width: Width) -> Ramp {
        Ramp::new("x", values, course).unwrap().with_refinement(width).unwrap()
    }

    /// Walks a ramp through states that are a function of the value and the direction.
    fn walk_through<'a>(
        ramp: &Ramp,
        state: impl Fn(f64, Leg) -> Option<&'a str>,
    ) -> (Vec<Seen>, Vec<Option<usize>>) {
        let (mut seen, mut before) = (Vec::new(), Vec::new());
        while let Some(step) = ramp.next(&seen) {
            let state = state(step.at.unwrap(), step.leg.unwrap()).map(str::to_owned);
            before.push(step.before);
            seen.push(Seen { leg: step.leg, at: step.at, state });
            assert!(seen.len() < 100);
        }
        (seen, before)
    }

    /// Walks a ramp through two states that change at these places on the way up and down.
    fn walk(ramp: &Ramp, up: f64, down: f64) -> (Vec<Seen>, Vec<Option<usize>>) {
        walk_through(ramp, |at, leg| {
            Some(if at >= if leg == Leg::Up { up } else { down } { "beyond" } else { "before" })
        })
    }

    fn told(brackets: &[Bracket]) -> Vec<(&str, &str)> {
        brackets.iter().map(|bracket| (bracket.from.as_str(), bracket.to.as_str())).collect()
    }

    #[test]
    fn a_transition_is_bracketed_to_the_wanted_width() {
        let ramp = refined([0.0, 1.0, 2.0, 3.0], Course::Up, Width::Absolute(0.01));
        let (seen, before) = walk(&ramp, 1.3, 1.3);
        let [bracket] = &ramp.brackets(&seen)[..] else { panic!("{seen:?}") };
        assert!(
            bracket.near < 1.3 && bracket.far >= 1.3 && bracket.far - bracket.near <= 0.01,
            "{bracket:?}"
        );
        assert_eq!(seen.len(), 4 + 7, "as many halves as it takes");
        assert_eq!(before[4], Some(1), "from the last state before the transition");
        assert_eq!((bracket.from.as_str(), bracket.to.as_str()), ("before", "beyond"));
    }

    #[test]
    fn all_transitions_between_two_neighbors_are_found() {
        let states = |at: f64, _| {
            Some(["a", "b", "c", "d"][[0.3, 0.6, 0.61].iter().filter(|place| at > **place).count()])
        };
        for (course, expected) in [
            (Course::Up, [("a", "b"), ("b", "c"), ("c", "d")]),
            (Course::Down, [("d", "c"), ("c", "b"), ("b", "a")]),
        ] {
            let ramp = refined([0.0, 1.0], course, Width::Absolute(0.002));
            let (seen, _) = walk_through(&ramp, states);
            let brackets = ramp.brackets(&seen);
            assert_eq!(told(&brackets), expected);
            assert!(brackets.iter().all(|bracket| (bracket.far - bracket.near).abs() <= 0.002));
            assert!(seen.len() < 2 + 3 * 9, "bisections share their values");
        }
    }

    #[test]
    fn a_relative_width_is_finer_at_smaller_values() {
        let ramp = refined([0.01, 0.1, 1.0, 10.0], Course::Up, Width::Relative(0.01));
        let states =
            |at: f64, _| Some(["a", "b", "c"][[0.033, 4.4].iter().filter(|place| at > **place).count()]);
        let brackets = ramp.brackets(&walk_through(&ramp, states).0);
        assert_eq!(told(&brackets), [("a", "b"), ("b", "c")]);
        for (bracket, at) in brackets.iter().zip([0.033, 4.4]) {
            assert!(
                bracket.near <= at && at < bracket.far && bracket.far - bracket.near <= 0.01 * bracket.far
            );
            assert!(bracket.far - bracket.near > 0.004 * at, "{bracket:?}");
        }
    }

    /// A value that shows no state, such as a stalled one, is beyond the transition, and nothing is searched
    /// beyond it.
    #[test]
    fn a_value_without_a_state_ends_a_search() {
        let ramp = refined([0.0, 1.0, 2.0], Course::Up, Width::Absolute(0.1));
        let states = |at: f64, _| (!(0.4..0.9).contains(&at)).then_some(if at < 0.4 { "a" } else { "b" });
        assert_eq!(told(&ramp.brackets(&walk_through(&ramp, states).0)), [("a", "")]);
        let (seen, _) = walk_through(&ramp, |at, _| (at != 1.0).then_some(if at < 1.0 { "a" } else { "b" }));
        assert_eq!((seen.len(), ramp.brackets(&seen)), (3, Vec::new()));
    }

    #[test]
    fn the_widest_ramp_has_a_middle() {
        let ramp = refined([-1.7e308, 1.7e308], Course::Up, Width::Absolute(1e307));
        let (seen, _) = walk(&ramp, 1e308, 1e308);
        let [bracket] = &ramp.brackets(&seen)[..] else { panic!("{seen:?}") };
        assert!(bracket.near < 1e308 && bracket.far >= 1e308 && bracket.far - bracket.near <= 1e307);
    }

    #[test]
    fn hysteresis_is_bracketed_from_both_sides() {
        let ramp = refined([0.0, 1.0, 2.0, 3.0], Course::UpAndDown, Width::Absolute(0.05));
        let (seen, _) = walk(&ramp, 1.3, 0.7);
        let [up, down] = &ramp.brackets(&seen)[..] else { panic!("{seen:?}") };
        assert!((up.near..=up.far).contains(&1.3) && up.leg == Some(Leg::Up));
        assert!((down.far..=down.near).contains(&0.7) && down.leg == Some(Leg::Down));
        assert_eq!((down.from.as_str(), down.to.as_str()), ("beyond", "before"));
    }

    #[test]
    fn without_states_or_refinement_a_ramp_is_its_own_values() {
        let ramp = Ramp::new("x", [0.0, 1.0], Course::Up).unwrap();
        assert_eq!(walk(&ramp, 0.5, 0.5).0.len(), 2);
        let ramp = ramp.with_refinement(Width::Absolute(0.1)).unwrap();
        assert_eq!(walk(&ramp, 9.0, 9.0).0.len(), 2);
        let narrow = refined([1.0, 1.0 + f64::EPSILON], Course::Up, Width::Absolute(1e-300));
        assert_eq!(walk(&narrow, 1.0 + f64::EPSILON, 0.0).0.len(), 2);
    }
}
