//! The way through the values of a ramp: its own, then those that bracket transitions between states.

use super::{Leg, Ramp};

/// A value that is done, as far as the way depends on it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Seen {
    pub(super) leg: Option<Leg>,
    pub(super) at: Option<f64>,
    pub(super) state: Option<String>,
}

/// The next value: where it is, and after which one it comes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Step {
    pub(super) leg: Option<Leg>,
    pub(super) at: Option<f64>,
    pub(super) before: Option<usize>,
}

/// Two values of a ramped parameter between which the state changes.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Bracket {
    /// The way on which the transition was come to: from below or from above.
    pub leg: Option<Leg>,
    /// The value on the side that was come from.
    pub near: f64,
    /// The value on the other side.
    pub far: f64,
    /// The state on the side that was come from.
    pub from: String,
    /// The state on the other side.
    pub to: String,
}

impl Ramp {
    /// Returns the next value after those that are done; `None` if there is none.
    pub(super) fn next(&self, seen: &[Seen]) -> Option<Step> {
        self.search(seen).err()
    }

    /// Returns the transitions between the values that are done, as far as they are bracketed to the wanted width.
    pub(super) fn brackets(&self, seen: &[Seen]) -> Vec<Bracket> {
        self.search(seen).unwrap_or_default()
    }

    /// Returns all brackets, or the next value that they need.
    ///
    /// Each bisection starts from the last state on the near side, so that a bracket is that of the way on which it was come to.
    fn search(&self, seen: &[Seen]) -> Result<Vec<Bracket>, Step> {
        let own = self.len();
        if let Some((leg, at)) = self.at(seen.len()) {
            return Err(Step { leg: Some(leg), at: Some(at), before: seen.len().checked_sub(1) });
        }
        let mut brackets = Vec::new();
        let Some(width) = self.refine() else { return Ok(brackets) };
        let mut rest = own..;
        for (near, far) in (0..own).zip(1..own) {
            if let (Some(from), Some(to)) = (&seen[near].state, &seen[far].state)
                && from != to
            {
                brackets.push(bisect(seen, near, far, width, &mut rest)?);
            }
        }
        Ok(brackets)
    }
}

/// Narrows a bracket with the values that were done for it, which `rest` counts; the next one, if it takes more.
fn bisect(
    seen: &[Seen],
    mut near: usize,
    mut far: usize,
    width: f64,
    rest: &mut std::ops::RangeFrom<usize>,
) -> Result<Bracket, Step> {
    let leg = seen[far].leg;
    let from = seen[near].state.clone();
    loop {
        let [low, high] = [near, far].map(|index| seen[index].at.unwrap_or(f64::NAN));
        let at = low + 0.5 * (high - low);
        // Below the spacing of doubles there is nothing between.
        if (high - low).abs() <= width || at == low || at == high || at.is_nan() {
            let told = |state: Option<String>| state.unwrap_or_default();
            let to = told(seen[far].state.clone());
            return Ok(Bracket { leg, near: low, far: high, from: told(from), to });
        }
        let index = rest.start;
        let Some(found) = seen.get(index) else { return Err(Step { leg, at: Some(at), before: Some(near) }) };
        rest.start += 1;
        // A third state, or none, is beyond the first transition.
        if found.state == from { near = index } else { far = index }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::Course;

    /// Walks a ramp through states that change at these places on the way up and down.
    fn walk(ramp: &Ramp, up: f64, down: f64) -> (Vec<Seen>, Vec<Option<usize>>) {
        let (mut seen, mut before) = (Vec::new(), Vec::new());
        while let Some(step) = ramp.next(&seen) {
            let is_beyond = step.at.unwrap() >= if step.leg == Some(Leg::Up) { up } else { down };
            let state = Some(if is_beyond { "beyond" } else { "before" }.to_owned());
            before.push(step.before);
            seen.push(Seen { leg: step.leg, at: step.at, state });
            assert!(seen.len() < 100);
        }
        (seen, before)
    }

    #[test]
    fn a_transition_is_bracketed_to_the_wanted_width() {
        let ramp = Ramp::new("x", [0.0, 1.0, 2.0, 3.0], Course::Up).with_refinement(0.01);
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
    fn hysteresis_is_bracketed_from_both_sides() {
        let ramp = Ramp::new("x", [0.0, 1.0, 2.0, 3.0], Course::UpAndDown).with_refinement(0.05);
        let (seen, _) = walk(&ramp, 1.3, 0.7);
        let [up, down] = &ramp.brackets(&seen)[..] else { panic!("{seen:?}") };
        assert!((up.near..=up.far).contains(&1.3) && up.leg == Some(Leg::Up));
        assert!((down.far..=down.near).contains(&0.7) && down.leg == Some(Leg::Down));
        assert_eq!((down.from.as_str(), down.to.as_str()), ("beyond", "before"));
    }

    #[test]
    fn without_states_or_refinement_a_ramp_is_its_own_values() {
        let ramp = Ramp::new("x", [0.0, 1.0], Course::Up);
        assert_eq!(walk(&ramp, 0.5, 0.5).0.len(), 2);
        let refined = ramp.with_refinement(0.1);
        assert_eq!(walk(&refined, 9.0, 9.0).0.len(), 2);
        let narrow = Ramp::new("x", [1.0, 1.0 + f64::EPSILON], Course::Up).with_refinement(1e-300);
        assert_eq!(walk(&narrow, 1.0 + f64::EPSILON, 0.0).0.len(), 2);
    }
}
