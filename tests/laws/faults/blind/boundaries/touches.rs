//! Touches that are missed, early, late, or of the wrong wall.

use granular_edmd::boundary::{Boundary, FirstTouch, Probe, Touch};
use granular_edmd::glam::DVec2;
use granular_edmd::{Flight, Kind};

use super::Boundaries;
use super::altered::Altered;
use super::bases::{GHOST, board, dish, resting, shaken, sieve};
use crate::faults::{one_in, tenth};

type Search = Box<dyn Fn(&dyn Boundary, &Flight, f64) -> FirstTouch<Touch>>;

/// Returns a search that misses the touches for which the condition holds: the flight and the touch, and the
/// velocity of the disk as seen from the surface, along its normal and across.
fn missing(is_missed: impl Fn(&Flight, &Touch, DVec2) -> bool + 'static) -> Search {
    Box::new(move |honest, flight, until| {
        let found = honest.first_touch(flight, until);
        match found {
            FirstTouch::At(touch) if is_missed(flight, &touch, approach(honest, flight, &touch)) => {
                FirstTouch::NONE
            }
            _ => found,
        }
    })
}

/// Returns the velocity of the disk at a touch along the normal (x) and along the surface (y).
fn approach(honest: &dyn Boundary, flight: &Flight, touch: &Touch) -> DVec2 {
    let surface = honest.surface(touch.wall, flight.position(touch.time), touch.time);
    let velocity = flight.velocity(touch.time) - surface.velocity;
    DVec2::new(velocity.dot(surface.normal), velocity.perp_dot(surface.normal))
}

/// Returns a search whose touches are late by this share of the radius, or early if it is negative.
fn late(share: f64) -> Search {
    Box::new(move |honest, flight, until| {
        let found = honest.first_touch(flight, until);
        let FirstTouch::At(touch) = found else { return found };
        let wait = share * flight.radius() / approach(honest, flight, &touch).x.abs().max(1e-3);
        found.map(|touch| Touch::new((touch.time + wait).clamp(flight.time(), until), touch.wall))
    })
}

pub(super) fn plant(boundaries: &mut Boundaries) {
    missed(boundaries);
    missed_at_times(boundaries);
    timed(boundaries);
    named(boundaries);
}

/// "It misses no touch."
fn missed(boundaries: &mut Boundaries) {
    boundaries.family = "missed touch";
    for (low, high) in [(0.9, 1.2), (0.011, 0.019), (3.3, 3.4), (1e-9, 1e-3)] {
        let name = format!("flights that begin at a speed of {low:?} to {high:?} touch nothing");
        let touch =
            missing(move |flight, _, _| (low..high).contains(&flight.velocity(flight.time()).length()));
        boundaries.add(name, Altered { touch, ..shaken() });
    }
    for (low, high) in [(0.7, 0.75), (-1.6, -1.55), (2.9, 3.0)] {
        let name = format!("flights that begin in a direction of {low} to {high} radians touch nothing");
        let touch =
            missing(move |flight, _, _| (low..high).contains(&flight.velocity(flight.time()).to_angle()));
        boundaries.add(name, Altered { touch, ..dish() });
    }
    for n in [1, 2, 4] {
        let (size, name) =
            (tenth(n), format!("touches with less than 1e-{n} of the speed along the normal are missed"));
        let touch = missing(move |_, _, speed| -speed.x < size * speed.y.abs());
        boundaries.add(name, Altered { touch, ..dish() });
        let name = format!("touches within 1e-{n} of the end of the search are missed");
        let touch: Search = Box::new(move |honest, flight, until| {
            honest.first_touch(flight, until - size * (until - flight.time()))
        });
        boundaries.add(name, Altered { touch, ..Altered::new(resting()) });
    }
}

/// Touches that are missed by a condition, or now and then.
fn missed_at_times(boundaries: &mut Boundaries) {
    type Condition = fn(&Flight, &Touch, DVec2) -> bool;
    boundaries.family = "missed touch";
    let conditions: [(&str, Condition, fn() -> Altered); 5] = [
        (
            "a disk that rises never comes back to the floor",
            |flight, touch, _| {
                flight.velocity(flight.time()).y > 0.0 && touch.wall == 0 && flight.acceleration().y < 0.0
            },
            shaken,
        ),
        (
            "touches sooner than 0.01 after the start are missed",
            |flight, touch, _| touch.time - flight.time() < 0.01,
            shaken,
        ),
        (
            "touches later than 5 after the start are missed",
            |flight, touch, _| touch.time - flight.time() > 5.0,
            shaken,
        ),
        (
            "the peg is missed by disks smaller than 0.4",
            |flight, touch, _| flight.radius() < 0.4 && touch.wall >= 4,
            || Altered::new(board()),
        ),
        (
            "the peg is missed from below",
            |flight, touch, _| touch.wall >= 4 && flight.position(touch.time).y < 5.0,
            || Altered::new(board()),
        ),
    ];
    for (name, condition, honest) in conditions {
        boundaries.add(name, Altered { touch: missing(condition), ..honest() });
    }
    boundaries.family = "hidden state";
    for calls in [5, 200] {
        let (is_due, name) = (one_in(calls), format!("one touch in {calls} is missed"));
        boundaries.add(name, Altered { touch: missing(move |_, _, _| is_due()), ..shaken() });
    }
    let is_due = one_in(3);
    let touch = missing(move |_, touch, _| touch.wall == 1 && is_due());
    boundaries.add("one touch in three of one wall is missed", Altered { touch, ..shaken() });
}

/// "It finds none where a gap is open", and misses none: touches at the wrong time.
fn timed(boundaries: &mut Boundaries) {
    type Find = fn(&dyn Boundary, &Flight, f64) -> FirstTouch<Touch>;
    boundaries.family = "early touch";
    for n in [1, 3, 5, 7] {
        let name = format!("touches are early by 1e-{n} of the radius");
        boundaries.add(name, Altered { touch: late(-tenth(n)), ..shaken() });
    }
    boundaries.family = "late touch";
    for n in [1, 3, 5, 7] {
        let name = format!("touches are late by 1e-{n} of the radius");
        boundaries.add(name, Altered { touch: late(tenth(n)), ..dish() });
    }
    let finds: [(&str, Find); 7] = [
        ("a touch after the end of the search is reported", |honest, flight, until| {
            honest.first_touch(flight, until + 1.0)
        }),
        ("a disk that overlaps and leaves touches at once", |honest, flight, until| {
            let probe = Probe::new(flight.position(flight.time()), flight.radius(), flight.time());
            let overlap = honest.overlap(&probe.with_kind(flight.kind()));
            overlap.map_or_else(
                || honest.first_touch(flight, until),
                |found| FirstTouch::At(Touch::new(flight.time(), found.with)),
            )
        }),
        ("a touch at the start is looked for a little later", |honest, flight, until| {
            let start = flight.time() + 1e-6;
            let (position, velocity) = (flight.position(start), flight.velocity(start));
            let later = Flight::new(start, position, velocity, flight.acceleration(), flight.radius());
            honest.first_touch(&later.with_kind(flight.kind()), until)
        }),
        ("a search answers only how far it has come: to its start", |_, flight, _| {
            FirstTouch::NotBefore(flight.time())
        }),
        ("the time of a touch counts from the start of the flight", |honest, flight, until| {
            honest.first_touch(flight, until).map(|touch| Touch::new(touch.time - flight.time(), touch.wall))
        }),
        ("the way is said to be free beyond the touch", |honest, flight, until| {
            match honest.first_touch(flight, until) {
                FirstTouch::At(touch) if touch.time > flight.time() + 0.5 => {
                    FirstTouch::NotBefore(touch.time + 0.1)
                }
                other => other,
            }
        }),
        ("the time of a touch is in single precision", |honest, flight, until| {
            honest
                .first_touch(flight, until)
                .map(|touch| Touch::new(f64::from(touch.time as f32), touch.wall))
        }),
    ];
    boundaries.family = "touch time";
    for (name, find) in finds {
        boundaries.add_touch(name, shaken(), find);
    }
}

/// Touches of the wrong wall.
fn named(boundaries: &mut Boundaries) {
    let renames: [(&str, fn(usize) -> usize); 4] = [
        ("walls are counted from 1", |wall| wall + 1),
        ("all touches are of the floor", |_| 0),
        ("the two sides are exchanged", |wall| [0, 2, 1, 3][wall.min(3)]),
        (
            "an unknown wall is touched where there is the last one",
            |wall| if wall == 3 { usize::MAX } else { wall },
        ),
    ];
    boundaries.family = "touched wall";
    for (name, rename) in renames {
        let touch: Search = Box::new(move |honest, flight, until| {
            honest.first_touch(flight, until).map(|touch| Touch::new(touch.time, rename(touch.wall)))
        });
        boundaries.add(name, Altered { touch, ..shaken() });
    }
}

/// A peg that one kind passes: "a wall that does not concern disks of the probe's kind is not overlapped".
pub(super) fn plant_kinds(boundaries: &mut Boundaries) {
    boundaries.family = "kinds";
    for (kind, passes) in [("kind 1", GHOST), ("the default kind", Kind::DEFAULT)] {
        boundaries.add_overlap(
            format!("{kind} passes the peg, but overlaps it"),
            sieve(passes),
            |honest, probe| honest.overlap(probe),
        );
        boundaries.add_touch(
            format!("{kind} touches the peg, but does not overlap it"),
            sieve(passes),
            |honest, flight, until| honest.first_touch(flight, until),
        );
    }
    boundaries.add(
        "kinds above 255 pass the peg that they overlap",
        Altered {
            touch: missing(|flight, touch, _| flight.kind().number() > 255 && touch.wall >= 4),
            ..Altered::new(board())
        },
    );
}
