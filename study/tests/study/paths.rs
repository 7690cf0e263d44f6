//! Paths of refined ramps among states that are known beforehand: each transition is bracketed, from its own
//! side.

use granular_edmd::boundary::Container;
use granular_edmd::glam::DVec2;
use granular_edmd::observable::Snapshot;
use granular_edmd::{Disk, Fingerprint};
use granular_edmd_study::{
    Bracket, Column, Control, Course, Experiment, ExperimentError, Leg, Plan, Protocol, Ramp, Record, Study,
    Width,
};
use serde::{Deserialize, Serialize};

use crate::mixture::Sticky;
use crate::support::{AnyError, Scratch};

/// A disk whose state is a letter, which follows from `x` alone: `a` below the first transition of the leg,
/// `b` from there on, and so on.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Known {
    x: f64,
    up: Vec<f64>,
    down: Vec<f64>,
    /// The ends of a range without a state.
    hidden: Vec<f64>,
}

impl Experiment for Known {
    type Rule = Sticky;
    type Boundary = Container;
    type Observer = ();
    type Sample = f64;

    fn revision() -> Fingerprint {
        Fingerprint::of("Known")
    }

    fn rule(&self) -> Result<Sticky, ExperimentError> {
        Ok(Sticky { loss: 0.0 })
    }

    fn boundary(&self) -> Result<Container, ExperimentError> {
        Ok(Container::closed(10.0, 10.0)?)
    }

    fn disks(&self, _: u64) -> Result<Vec<Disk>, ExperimentError> {
        Ok(vec![Disk::new(DVec2::splat(5.0), 0.5)?])
    }

    fn observer(&self) -> Result<(), ExperimentError> {
        Ok(())
    }

    fn sample(&self, snapshot: &Snapshot<'_>, (): &mut ()) -> f64 {
        snapshot.time()
    }

    fn columns() -> Vec<Column<Self>> {
        Vec::new()
    }

    fn state(record: &Record<Self>) -> Option<String> {
        let Self { x, up, down, hidden } = record.experiment();
        let places = if record.leg() == Some(Leg::Down) { down } else { up };
        let is_hidden = !hidden.is_empty() && hidden[0] <= *x && *x < hidden[1];
        let letter = ["a", "b", "c", "d"][places.iter().filter(|place| x >= place).count()];
        (!is_hidden).then(|| letter.to_owned())
    }
}

/// A ramp through transitions at these places on the way up and down.
struct Walk {
    ramp: Ramp,
    known: Known,
}

impl Walk {
    fn new<const N: usize>(values: [f64; N], course: Course, up: &[f64], down: &[f64]) -> Self {
        let known = Known { up: up.to_vec(), down: down.to_vec(), ..Known::default() };
        Self { ramp: Ramp::new("x", values, course).unwrap(), known }
    }

    fn refined(self, width: Width) -> Self {
        Self { ramp: self.ramp.with_refinement(width).unwrap(), ..self }
    }

    /// Walks the ramp in a study, and returns its records and brackets.
    fn walk(self, name: &str) -> Result<(Vec<Record<Known>>, Vec<Bracket>), AnyError> {
        let scratch = Scratch::new(&format!("path-{name}"));
        let plan = Plan::new(self.known, Protocol::new(0, 1, 1)?, 1)?.with_ramp(self.ramp)?;
        let study = Study::create(&scratch.0, &plan)?;
        assert!(study.run(&Control::default())?.is_complete());
        Ok((study.ramp_records(0).collect::<Result<_, _>>()?, study.transitions(0)?))
    }
}

fn told(brackets: &[Bracket]) -> Vec<(&str, &str)> {
    brackets.iter().map(|bracket| (bracket.from.as_str(), bracket.to.as_str())).collect()
}

#[test]
fn a_transition_is_bracketed_to_the_wanted_width() -> Result<(), AnyError> {
    let walk = Walk::new([0.0, 1.0, 2.0, 3.0], Course::Up, &[1.3], &[]);
    let (records, brackets) = walk.refined(Width::Absolute(0.01)).walk("width")?;
    let [bracket] = &brackets[..] else { panic!("{brackets:?}") };
    assert!(bracket.near < 1.3 && bracket.far >= 1.3 && bracket.far - bracket.near <= 0.01, "{bracket:?}");
    assert_eq!(records.len(), 4 + 7, "as many halves as it takes");
    assert_eq!(records[4].times(), [3.0], "from the end of the last value before the transition");
    assert_eq!(told(&brackets), [("a", "b")]);
    Ok(())
}

#[test]
fn all_transitions_between_two_neighbors_are_found() -> Result<(), AnyError> {
    let places = [0.3, 0.6, 0.61];
    for (course, expected) in [
        (Course::Up, [("a", "b"), ("b", "c"), ("c", "d")]),
        (Course::Down, [("d", "c"), ("c", "b"), ("b", "a")]),
    ] {
        let walk = Walk::new([0.0, 1.0], course, &places, &places).refined(Width::Absolute(0.002));
        let (records, brackets) = walk.walk(&format!("neighbors-{course:?}"))?;
        assert_eq!(told(&brackets), expected);
        assert!(brackets.iter().all(|bracket| (bracket.far - bracket.near).abs() <= 0.002));
        assert!(records.len() < 2 + 3 * 9, "bisections share their values");
    }
    Ok(())
}

#[test]
fn a_relative_width_is_finer_at_smaller_values() -> Result<(), AnyError> {
    let places = [0.033, 4.4];
    let walk = Walk::new([0.01, 0.1, 1.0, 10.0], Course::Up, &places, &[]);
    let (_, brackets) = walk.refined(Width::Relative(0.01)).walk("relative")?;
    assert_eq!(told(&brackets), [("a", "b"), ("b", "c")]);
    for (bracket, at) in brackets.iter().zip(places) {
        assert!(bracket.near < at && at <= bracket.far && bracket.far - bracket.near <= 0.01 * bracket.far);
        assert!(bracket.far - bracket.near > 0.004 * at, "{bracket:?}");
    }
    Ok(())
}

/// A value that shows no state, such as a stalled one, is beyond the transition, and nothing is searched
/// beyond it.
#[test]
fn a_value_without_a_state_ends_a_search() -> Result<(), AnyError> {
    let hidden = |from, to| {
        let mut walk = Walk::new([0.0, 1.0, 2.0], Course::Up, &[0.9], &[]).refined(Width::Absolute(0.1));
        walk.known.hidden = vec![from, to];
        walk
    };
    assert_eq!(told(&hidden(0.4, 0.9).walk("hidden-between")?.1), [("a", "")]);
    let (records, brackets) = hidden(1.0, 1.5).walk("hidden-at")?;
    assert_eq!((records.len(), brackets), (3, Vec::new()));
    Ok(())
}

#[test]
fn the_widest_ramp_has_a_middle() -> Result<(), AnyError> {
    let walk = Walk::new([-1.7e308, 1.7e308], Course::Up, &[1e308], &[]).refined(Width::Absolute(1e307));
    let (_, brackets) = walk.walk("widest")?;
    let [bracket] = &brackets[..] else { panic!("{brackets:?}") };
    assert!(bracket.near < 1e308 && bracket.far >= 1e308 && bracket.far - bracket.near <= 1e307);
    Ok(())
}

#[test]
fn hysteresis_is_bracketed_from_both_sides() -> Result<(), AnyError> {
    let walk = Walk::new([0.0, 1.0, 2.0, 3.0], Course::UpAndDown, &[1.3], &[0.7]);
    let (_, brackets) = walk.refined(Width::Absolute(0.05)).walk("hysteresis")?;
    let [up, down] = &brackets[..] else { panic!("{brackets:?}") };
    assert!((up.near..=up.far).contains(&1.3) && up.leg == Some(Leg::Up));
    assert!((down.far..=down.near).contains(&0.7) && down.leg == Some(Leg::Down));
    assert_eq!((down.from.as_str(), down.to.as_str()), ("b", "a"));
    Ok(())
}

#[test]
fn without_transitions_or_refinement_a_ramp_is_its_own_values() -> Result<(), AnyError> {
    assert_eq!(Walk::new([0.0, 1.0], Course::Up, &[0.5], &[]).walk("plain")?.0.len(), 2);
    let walk = Walk::new([0.0, 1.0], Course::Up, &[9.0], &[]).refined(Width::Absolute(0.1));
    assert_eq!(walk.walk("none")?.0.len(), 2);
    let next = 1.0 + f64::EPSILON;
    let narrow = Walk::new([1.0, next], Course::Up, &[next], &[]).refined(Width::Absolute(1e-300));
    assert_eq!(narrow.walk("narrow")?.0.len(), 2);
    Ok(())
}
