//! Walls that react to blows in a wrong way.

use granular_edmd::boundary::{Boundary, Impact, Reaction};

use super::Boundaries;
use super::altered::Altered;
use super::bases::{Rotor, Sprung};
use crate::faults::{one_in, tenth};

fn sprung() -> Altered {
    Altered::new(Sprung::new())
}

fn rotor() -> Altered {
    Altered::new(Rotor::new())
}

/// Returns the same blow with an impulse and a couple that are larger by a factor each.
fn scaled(impact: &Impact, impulse: f64, couple: f64) -> Impact {
    let same = Impact::new(impact.wall, impulse * impact.impulse, impact.point, impact.time);
    same.with_couple(couple * impact.couple)
}

pub(super) fn plant(boundaries: &mut Boundaries) {
    blows(boundaries);
    lost_blows(boundaries);
    answers(boundaries);
    states(boundaries);
}

/// "Receives the blow of a disk": the wall takes the opposite impulse.
fn blows(boundaries: &mut Boundaries) {
    type React = fn(&mut dyn Boundary, &Impact) -> Reaction;
    boundaries.family = "reaction";
    for n in [1, 3, 6] {
        let (size, name) = (tenth(n), format!("the floor takes an impulse that is too large by 1e-{n}"));
        boundaries.add(
            name,
            Altered {
                react: Box::new(move |honest, impact| honest.react(&scaled(impact, 1.0 + size, 1.0))),
                ..sprung()
            },
        );
    }
    let reactions: [(&str, React, fn() -> Altered); 8] = [
        ("the floor takes no blow", |_, _| Reaction::None, sprung),
        ("the floor says that it moves, and takes no blow", |_, _| Reaction::Moved, sprung),
        (
            "the floor takes each blow with the wrong sign",
            |honest, impact| honest.react(&scaled(impact, -1.0, 1.0)),
            sprung,
        ),
        (
            "the floor forgets weak blows",
            |honest, impact| {
                if impact.impulse.length() < 0.5 { Reaction::None } else { honest.react(impact) }
            },
            sprung,
        ),
        (
            "the floor does not say that it moves",
            |honest, impact| {
                let _ = honest.react(impact);
                Reaction::None
            },
            sprung,
        ),
        (
            "the floor takes each blow as if at the origin of time",
            |honest, impact| honest.react(&Impact::new(impact.wall, impact.impulse, impact.point, 0.0)),
            sprung,
        ),
        ("the drum forgets the couple", |honest, impact| honest.react(&scaled(impact, 1.0, 0.0)), rotor),
        (
            "the drum takes the couple with the wrong sign",
            |honest, impact| honest.react(&scaled(impact, 1.0, -1.0)),
            rotor,
        ),
    ];
    for (name, react, honest) in reactions {
        boundaries.add(name, Altered { react: Box::new(react), ..honest() });
    }
}

/// Blows that are forgotten now and then.
fn lost_blows(boundaries: &mut Boundaries) {
    boundaries.family = "reaction";
    for calls in [2, 20] {
        let (is_due, name) = (one_in(calls), format!("the drum forgets one blow in {calls}"));
        boundaries.add(
            name,
            Altered {
                react: Box::new(
                    move |honest, impact| if is_due() { Reaction::None } else { honest.react(impact) },
                ),
                ..rotor()
            },
        );
    }
}

/// The mass by which a wall resists, and the disks that it may meet afterwards.
fn answers(boundaries: &mut Boundaries) {
    boundaries.family = "mass";
    boundaries.add_surface(
        "the floor reacts, but its surface has an infinite mass",
        sprung(),
        |surface, _, _| {
            surface.mass = f64::INFINITY;
        },
    );
    boundaries.add_surface(
        "the surface of the floor is heavier than the floor by a hundredth",
        sprung(),
        |surface, _, _| {
            surface.mass *= 1.01;
        },
    );
    boundaries.add_surface("the drum gives its moment of inertia as its mass", rotor(), |surface, _, _| {
        surface.tangential_mass *= 36.0;
    });
    boundaries.add_surface("the drum gives no mass along its surface", rotor(), |surface, _, _| {
        surface.tangential_mass = f64::INFINITY;
    });
    boundaries.family = "may meet";
    boundaries
        .add("the floor meets nobody after a blow", Altered { may_meet: Box::new(|_, _| false), ..sprung() });
    boundaries.add(
        "the floor meets only centers below its place at rest",
        Altered { may_meet: Box::new(|_, asked| asked.answer && asked.region.min.y < 2.0), ..sprung() },
    );
    boundaries.add(
        "the floor meets only what is in the left half",
        Altered { may_meet: Box::new(|_, asked| asked.answer && asked.region.max.x < 5.0), ..sprung() },
    );
}

/// "The numbers of the walls that react", and the way back.
fn states(boundaries: &mut Boundaries) {
    type Kept = fn(Vec<f64>) -> Vec<f64>;
    type Restored = fn(&[f64]) -> Option<Vec<f64>>;
    let kept: [(&str, Kept); 4] = [
        ("the state is empty", |_| Vec::new()),
        ("the state has no sine", |state| vec![state[0], 0.0]),
        ("the state is rounded to six digits", |state| {
            state.iter().map(|number| (number * 1e6).round() / 1e6).collect()
        }),
        ("the state is in single precision", |state| {
            state.iter().map(|&number| f64::from(number as f32)).collect()
        }),
    ];
    boundaries.family = "state";
    for (name, state) in kept {
        boundaries.add(name, Altered { state: Box::new(state), ..sprung() });
    }
    let restored: [(&str, Restored); 4] = [
        ("the state is accepted and not set", |_| None),
        ("the numbers of the state are set in the wrong order", |state| {
            Some(state.iter().rev().copied().collect())
        }),
        ("the floor is at rest after its state is set", |state| Some(vec![0.0; state.len()])),
        ("a state that is too long is accepted", |state| Some(state.iter().take(2).copied().collect())),
    ];
    for (name, restored) in restored {
        boundaries.add(name, Altered { restored: Box::new(restored), ..sprung() });
    }
}
