//! Ramps: the successive values of a parameter in one run, and the additional values that bracket transitions
//! between states.

use std::ops::Range;

use granular_edmd::quantity::positive;
use serde::{Deserialize, Serialize};

use super::values::{Values, from_file};
use crate::parameters::Scalar;
use crate::{Experiment, Leg, Plan, PlanError, Record};

/// The order in which a [`Ramp`] goes through its values.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Course {
    /// From the smallest value to the largest.
    #[default]
    Up,
    /// From the largest to the smallest.
    Down,
    /// Up, then down again: the largest value comes once, and all other values twice.
    UpAndDown,
}

/// A parameter that changes step by step. Each value starts from the last state of the previous value, so
/// that hysteresis shows.
///
/// ```
/// use granular_edmd_study::{Course, Leg, Ramp};
/// let ramp = Ramp::new("friction", [0.1, 0.2, 0.3], Course::UpAndDown)?;
/// let path: Vec<(Leg, f64)> = ramp.path().collect();
/// assert_eq!(path[1..4], [(Leg::Up, 0.2), (Leg::Up, 0.3), (Leg::Down, 0.2)]);
/// assert!(Ramp::new("friction", [0.2, 0.1], Course::Up).is_err());
/// # Ok::<(), granular_edmd_study::PlanError>(())
/// ```
#[doc(alias("hysteresis", "annealing"))]
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Ramp {
    parameter: String,
    values: Values,
    course: Course,
    /// The width to which transitions are bisected, or `None` without bisection.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) refine: Option<Width>,
}

from_file! {
    Ramp {
        parameter: String,
        values: Values,
        #[serde(default)]
        course: Course,
        refine: Option<Width>
    } => {
        let ramp = Self { parameter, values, course, refine: None }.checked()?;
        match refine {
            Some(width) => ramp.with_refinement(width),
            None => Ok(ramp),
        }
    }, PlanError
}

/// The width to which transitions are bisected. In a plan: `refine = { relative = 0.01 }`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Width {
    /// A width in the unit of the parameter.
    Absolute(f64),
    /// A fraction of the parameter's value, for parameters that span orders of magnitude.
    ///
    /// All values must be positive.
    Relative(f64),
}

impl Ramp {
    /// Creates a ramp that takes the parameter with this name through the given values, which must increase.
    ///
    /// # Errors
    /// If there are no values, a value is not finite, or the values do not increase.
    pub fn new(
        parameter: impl Into<String>,
        values: impl IntoIterator<Item = f64>,
        course: Course,
    ) -> Result<Self, PlanError> {
        let values = Values::list(values);
        Self { parameter: parameter.into(), values, course, refine: None }.checked()
    }

    fn checked(mut self) -> Result<Self, PlanError> {
        self.values.check(&self.parameter)?;
        self.values.set_kind(&Scalar::Number(0.0));
        let Values::List(values) = &self.values else { return Ok(self) };
        if let Some(word) = values.iter().find(|value| value.number().is_none()) {
            return Err(PlanError::varied(
                &self.parameter,
                format!("has the value {word}, which is no number"),
            ));
        }
        let falls = |pair: &&[Scalar]| pair[0].number() >= pair[1].number();
        let Some([before, value]) = values.windows(2).find(falls) else { return Ok(self) };
        let reason = format!(
            "has {value} after {before}: the values of a ramp must increase; say `course` for the way"
        );
        Err(PlanError::varied(&self.parameter, reason))
    }

    /// Returns the same ramp with bisection of each transition between two of its values, down to this width.
    ///
    /// A transition is a change of [`Experiment::state`](super::Experiment::state). The search covers only
    /// neighboring values with different states. A ramp up brackets transitions from below, a ramp down from
    /// above. The values of a bisection are run after the values of the ramp. Each of them starts from the
    /// end state of the closest value on the near side of the transition.
    ///
    /// # Errors
    /// If the width is not positive, or is relative and a value of the ramp is not positive.
    pub fn with_refinement(self, width: Width) -> Result<Self, PlanError> {
        let (Width::Absolute(number) | Width::Relative(number)) = width;
        positive("width of a transition", number)?;
        if let Width::Relative(_) = width {
            positive("value of a ramp with a relative width", self.value(0))?;
        }
        Ok(Self { refine: Some(width), ..self })
    }

    /// Returns the name of the parameter.
    pub fn parameter(&self) -> &str {
        &self.parameter
    }

    /// Returns the values in the order in which the ramp comes to them, with the directions.
    pub fn path(&self) -> impl Iterator<Item = (Leg, f64)> {
        (0..self.len()).filter_map(|index| self.at(index))
    }

    fn value(&self, index: usize) -> f64 {
        // The values were checked to be numbers when the ramp was made.
        self.values.at(index).and_then(|value| value.number()).unwrap_or(f64::NAN)
    }

    /// Returns the number of values that the ramp comes to.
    pub(super) fn len(&self) -> usize {
        match self.course {
            Course::Up | Course::Down => self.values.len(),
            Course::UpAndDown => (2 * self.values.len()).saturating_sub(1),
        }
    }

    /// Returns the value with this index, and the direction from which the ramp comes to the value.
    pub(super) fn at(&self, index: usize) -> Option<(Leg, f64)> {
        if self.course != Course::Down && index < self.values.len() {
            return Some((Leg::Up, self.value(index)));
        }
        let from_below = self.len().checked_sub(index + 1)?;
        Some((Leg::Down, self.value(from_below)))
    }
}

/// The part of a finished value's record that determines the next values of the ramp.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Seen {
    pub(crate) leg: Option<Leg>,
    pub(crate) at: Option<f64>,
    pub(crate) state: Option<String>,
}

impl<E: Experiment> Plan<E> {
    /// Returns the part of a record that determines the next values of the ramp. The name of the state is
    /// left out unless the ramp is refined, since finding the name may take long.
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

    /// Returns the brackets of all transitions. The list is empty until all brackets have the requested
    /// width.
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
    /// The state on the near side.
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
        let Some(width) = self.refine else { return Ok(Vec::new()) };
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
    /// Each value starts from the end state of the closest value on the near side of the transition, so that
    /// a bracket belongs to the direction from which the ramp came. Of several transitions, the first one on
    /// the path is narrowed first: every state that differs from the near state counts as beyond the
    /// transition.
    fn between(&mut self, mut near: usize, far: usize) -> Result<(), Step> {
        if self.seen[far].state.is_none() {
            return Ok(());
        }
        // The indices of the values beyond the transition, the closest last.
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
                let [near, far] = [near, far].map(|index| &self.seen[index]);
                let [at, beyond] = [near, far].map(|seen| seen.at.unwrap_or(f64::NAN));
                let [from, to] = [near, far].map(|seen| seen.state.clone().unwrap_or_default());
                self.brackets.push(Bracket { leg: far.leg, near: at, far: beyond, from, to });
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
        // The sum of the halves would round differently, so it is used only where the width overflows.
        let at = if width.is_finite() { near + 0.5 * width } else { 0.5 * near + 0.5 * far };
        // There is no number between two neighboring doubles.
        let is_between = (near < at && at < far) || (far < at && at < near);
        (is_between && !self.width.holds(near, far)).then_some(at)
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
