//! Boundaries that break their contract when disks act on walls: reactions, sinks, seams and responses.

use std::cell::Cell;
use std::rc::Rc;

use granular_edmd::boundary::{
    Boundary, Container, FirstTouch, Impact, Obstacles, Part, Probe, Reaction, Region, Response, Surface,
    Vessel,
};
use granular_edmd::collision::{CollisionRule, Contact, Impulse};
use granular_edmd::glam::DVec2;
use granular_edmd::{Disk, Flight, Kind};

use super::{Boundaries, belt, rotor, sprung};
use crate::faults::blind::boundaries::altered::{Altered, Asked};
use crate::faults::blind::boundaries::bases::{Sprung, resting, shaken};

pub(super) fn plant(boundaries: &mut Boundaries) {
    for plant in [meetings, reactions, states, sinks, seams, responses] {
        plant(boundaries);
    }
}

/// The disks that a wall may meet after a blow.
fn meetings(boundaries: &mut Boundaries) {
    let may_meet = Box::new(|_: &dyn Boundary, asked: &Asked<'_>| asked.answer && asked.region.max.y < 3.5);
    boundaries.part(
        "meets below",
        "the floor meets only what is below 3.5",
        Altered { may_meet, ..sprung() },
    );
    let may_meet = Box::new(|honest: &dyn Boundary, asked: &Asked<'_>| {
        let place = honest.wall_point(asked.wall, asked.until);
        place.map_or(asked.answer, |place| asked.region.min.y - asked.radius <= place.y)
    });
    boundaries.part(
        "meets at the end",
        "the floor meets only what it touches in the end",
        Altered { may_meet, ..sprung() },
    );
    let may_touch = Box::new(|honest: &dyn Boundary, region: &Region, radius| {
        let amplitude = honest.state().iter().map(|part| part * part).sum::<f64>().sqrt();
        let is_beyond = region.min.y - radius > 2.0 + amplitude + 0.1;
        let is_free = is_beyond && region.min.x > 1.0 && region.max.x < 9.0 && region.max.y < 11.0;
        honest.may_touch(region, radius) && !is_free
    });
    boundaries.part(
        "present swing",
        "cells ask only about the present swing of the floor",
        Altered { may_touch, ..sprung() },
    );
    let carriage = || Altered::new(Sprung::with_ceiling());
    let may_meet = Box::new(|_: &dyn Boundary, asked: &Asked<'_>| {
        asked.answer && (asked.wall == 5 || asked.region.min.y < 5.5)
    });
    boundaries.part("body", "the floor of a body forgets its ceiling", Altered { may_meet, ..carriage() });
    let may_meet = Box::new(|_: &dyn Boundary, asked: &Asked<'_>| {
        asked.answer && (asked.wall == 4 || asked.region.max.y > 5.5)
    });
    boundaries.part("body", "the ceiling of a body forgets its floor", Altered { may_meet, ..carriage() });
}

fn reactions(boundaries: &mut Boundaries) {
    type React = fn(&mut dyn Boundary, &Impact) -> Reaction;
    let all: [(&'static str, &str, React, fn() -> Altered); 7] = [
        (
            "sticking",
            "a floor slower than 1e-3 after a blow gets nothing of it",
            |honest, impact| {
                let state = honest.state();
                let reaction = honest.react(impact);
                let velocity = honest.surface(impact.wall, impact.point, impact.time).velocity;
                if velocity.y.abs() < 1e-3 {
                    honest.set_state(&state).expect("its own state");
                }
                reaction
            },
            sprung,
        ),
        (
            "second blow",
            "the floor takes less of all blows but the first",
            |honest, impact| {
                let share = if honest.state() == Sprung::new().state() { 1.0 } else { 0.9 };
                honest.react(&Impact::new(impact.wall, share * impact.impulse, impact.point, impact.time))
            },
            sprung,
        ),
        (
            "second blow",
            "the floor takes no blow while it falls fast",
            |honest, impact| {
                let velocity = honest.surface(impact.wall, impact.point, impact.time).velocity;
                if velocity.y < -0.2 { Reaction::None } else { honest.react(impact) }
            },
            sprung,
        ),
        (
            "oblique blow",
            "the floor takes a blow along its surface, too",
            |honest, impact| {
                let impulse = impact.impulse + DVec2::new(0.0, 1e-3 * impact.impulse.x);
                honest.react(&Impact::new(impact.wall, impulse, impact.point, impact.time))
            },
            sprung,
        ),
        (
            "late blow",
            "the floor takes each blow 1e-6 later",
            |honest, impact| {
                let time = impact.time + 1e-6;
                honest.react(&Impact::new(impact.wall, impact.impulse, impact.point, time))
            },
            sprung,
        ),
        (
            "point of a blow",
            "the drum takes each blow at the same point",
            |honest, impact| {
                let point = DVec2::new(0.0, -6.0);
                honest.react(
                    &Impact::new(impact.wall, impact.impulse, point, impact.time).with_couple(impact.couple),
                )
            },
            rotor,
        ),
        (
            "weak couple",
            "the drum forgets couples below a thousandth",
            |honest, impact| {
                let couple = if impact.couple.abs() < 1e-3 { 0.0 } else { impact.couple };
                honest.react(
                    &Impact::new(impact.wall, impact.impulse, impact.point, impact.time).with_couple(couple),
                )
            },
            rotor,
        ),
    ];
    for (family, name, react, honest) in all {
        boundaries.part(family, name, Altered { react: Box::new(react), ..honest() });
    }
    // A belt in motion whose disks set it to another speed, by its velocity and by its angular velocity.
    let was_hit = Rc::new(Cell::new(false));
    let hits = Rc::clone(&was_hit);
    let react = Box::new(move |honest: &mut dyn Boundary, impact: &Impact| {
        hits.set(hits.get() || impact.wall > 3);
        honest.react(impact)
    });
    let surface = Box::new(move |surface: &mut Surface<'_>, _, _| {
        let factor = if was_hit.get() { 1.001 } else { 1.0 };
        surface.velocity *= factor;
        surface.angular_velocity *= factor;
    });
    let changed = Altered { surface, react, ..belt() };
    boundaries.part(
        "blow on a belt",
        "blows make a belt faster by 1e-3, and nothing keeps its state",
        changed,
    );
}

fn states(boundaries: &mut Boundaries) {
    let state = Box::new(|state: Vec<f64>| vec![state[0], state[1] * (1.0 + 1e-12)]);
    boundaries.part(
        "rounded state",
        "a number of the state is wrong by 1e-12",
        Altered { state, ..sprung() },
    );
    let restored =
        Box::new(|state: &[f64]| Some(if state.is_empty() { vec![0.0; 2] } else { state.to_vec() }));
    boundaries.part("empty state", "an empty state sets the floor at rest", Altered { restored, ..sprung() });
    let restored = Box::new(|state: &[f64]| Some(state.iter().map(|number| number.abs()).collect()));
    boundaries.part("sign of a state", "a state is set without signs", Altered { restored, ..rotor() });
    let worn: [(&str, Wear, fn() -> Altered); 3] = [
        (
            "the floor grows heavier with each blow",
            |floor, blows| floor.mass *= 1.01_f64.powf(f64::from(blows)),
            sprung,
        ),
        (
            "the kind of the floor changes with each blow",
            |floor, blows| floor.kind = Kind::new(blows as u16),
            sprung,
        ),
        (
            "the kind of a fixed floor changes with each blow",
            |floor, blows| floor.kind = Kind::new(blows as u16),
            resting_floor,
        ),
    ];
    for (name, change, honest) in worn {
        let blows = Rc::new(Cell::new(0));
        let hits = Rc::clone(&blows);
        let react = Box::new(move |honest: &mut dyn Boundary, impact: &Impact| {
            hits.set(hits.get() + 1);
            honest.react(impact)
        });
        let surface = Box::new(move |surface: &mut Surface<'_>, _, _| change(surface, blows.get()));
        boundaries.part(
            "wear",
            format!("{name}, and the state does not say so"),
            Altered { surface, react, ..honest() },
        );
    }
}

/// A change of a surface by a number of blows.
type Wear = fn(&mut Surface<'_>, u32);

fn resting_floor() -> Altered {
    Altered::new(resting())
}

fn sinks(boundaries: &mut Boundaries) {
    let bar = Part::polyline([DVec2::new(3.0, 6.0), DVec2::new(7.0, 6.0)]).expect("a bar").absorbing();
    let sink = || Altered::new(Vessel::new(resting()).with("sink", bar.clone()).expect("a vessel"));
    let may_touch = Box::new(|honest: &dyn Boundary, region: &Region, radius| {
        let is_forgotten =
            region.min.x > 5.0 && region.max.x < 8.0 && region.min.y > 4.0 && region.max.y < 8.0;
        honest.may_touch(region, radius) && !is_forgotten
    });
    boundaries.part("sink", "half of a sink is not seen in cells", Altered { may_touch, ..sink() });
    let surface = Box::new(|surface: &mut Surface<'_>, _, _| {
        if matches!(surface.response, Response::Absorbing) {
            surface.normal *= -1.0;
        }
    });
    boundaries.part("sink", "a sink has its normals reversed", Altered { surface, ..sink() });
}

/// A peg near a side of a periodic box whose image at the other side is forgotten.
fn seams(boundaries: &mut Boundaries) {
    let walls = Container::open(10.0).expect("a box").with_periodic_sides().expect("periodic sides");
    let pegs = Obstacles::new(walls, [Disk::new(DVec2::new(0.4, 6.0), 1.5).expect("a radius")]);
    let touch =
        Box::new(|honest: &dyn Boundary, flight: &Flight, until| match honest.first_touch(flight, until) {
            FirstTouch::At(touch) if flight.position(touch.time).x > 5.0 && touch.wall > 0 => {
                FirstTouch::NONE
            }
            other => other,
        });
    let overlap = Box::new(|honest: &dyn Boundary, probe: &Probe| {
        honest.overlap(probe).filter(|found| probe.position().x < 5.0 || found.with == 0)
    });
    boundaries.part("seam", "a peg has no image", Altered { touch, overlap, ..Altered::new(pegs) });
    let walls = resting().with_periodic_sides().expect("periodic sides");
    let surface = Box::new(|surface: &mut Surface<'_>, position: DVec2, _| {
        surface.velocity.x = 0.1 * position.x;
    });
    boundaries.part("seam", "a belt stretches up to a seam", Altered { surface, ..Altered::new(walls) });
    let walls = Container::open(10.0).expect("a box").with_periodic_sides().expect("periodic sides");
    let pegs = Obstacles::new(walls, [Disk::new(DVec2::new(0.0, 6.0), 1.5).expect("a radius")]);
    let surface = Box::new(|surface: &mut Surface<'_>, position: DVec2, _| {
        if surface.radius.is_finite() {
            surface.velocity = if position.x < 5.0 { 0.2 } else { -0.2 } * surface.normal.perp();
        }
    });
    boundaries.part("seam", "a peg turns backward at its image", Altered { surface, ..Altered::new(pegs) });
}

fn responses(boundaries: &mut Boundaries) {
    type Change = fn(&mut Surface<'_>, f64, u32);
    let all: [(&'static str, &str, Change); 3] = [
        ("rule", "walls lose energy at offsets above 3", |surface, time, _| {
            if time > 3.0 {
                surface.response = Response::Rule(&LOSSY);
            }
        }),
        ("rule", "walls lose energy in every second call", |surface, _, calls| {
            if calls % 2 == 0 {
                surface.response = Response::Rule(&LOSSY);
            }
        }),
        ("kind", "the kind of walls alternates", |surface, _, calls| {
            surface.kind = Kind::new((calls % 2) as u16);
        }),
    ];
    for (family, name, change) in all {
        let calls = Cell::new(0);
        let surface = Box::new(move |surface: &mut Surface<'_>, _, time| {
            calls.set(calls.get() + 1);
            change(surface, time, calls.get());
        });
        boundaries.part(family, name, Altered { surface, ..shaken() });
    }
    let react = Box::new(|honest: &mut dyn Boundary, impact: &Impact| {
        let lowest = honest.wall_count() - 1;
        honest.react(&Impact::new(lowest, impact.impulse, impact.point, impact.time))
    });
    boundaries.part("wrong wall", "the floor reacts to blows on all walls", Altered { react, ..sprung() });
}

/// A rule without restitution.
static LOSSY: Lossy = Lossy;

struct Lossy;

impl CollisionRule for Lossy {
    fn impulse(&self, contact: &Contact) -> Impulse {
        Impulse::new(contact.normal_impulse(0.0), 0.0)
    }
}
