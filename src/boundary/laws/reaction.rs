//! Checks of walls that react to impacts.

use glam::DVec2;

use super::surface::in_words;
use super::trial::{PART, Trial};
use crate::boundary::{Boundary, Impact, Reaction, Region, Surface, Touch};
use crate::error::require;
use crate::{Flight, Violation};

/// Speeds that the tested impacts give to a wall, in units of the typical speed.
const BLOWS: [f64; 4] = [1e-6, 1e-3, 5e-2, 2.0];

/// Speed that a wall gains before other disks fly to it, in the same units.
const BLOW: f64 = 0.5;

/// Part of the radius by which a disk is enlarged in order to find the wall near it.
const NEAR: f64 = 0.5;

/// Largest error of a velocity after an impact, relative to the change and to the typical speed.
const EXACT: f64 = 1e-8;
const ROUNDING: f64 = 1e-12;

/// Checks that a wall with a mass reacts to impacts as its mass requires, that a wall without one does not
/// react, and that setting the state of the walls restores them.
pub(super) fn check_reaction(trial: &mut Trial<'_>, touch: Touch, place: DVec2) -> Result<(), Violation> {
    let (state, before) = (trial.boundary.state(), View::of(trial, touch, place));
    let Surface { mass, normal, velocity, .. } = trial.boundary.surface(touch.wall, place, touch.time);
    if mass == f64::INFINITY {
        let push = trial.speed * trial.length();
        strike(trial, touch, place, push * (normal.perp() - normal));
        let after = View::of(trial, touch, place);
        let moved = before.moved(&after, 0).max(before.moved(&after, 1));
        let is_same = after.surface == before.surface && moved <= trial.rounding();
        require!(PART, "reaction", is_same;
            "a blow on {touch:?}, whose mass is infinite, moves walls by {moved:?}, and makes its surface {} of {}",
            after.surface, before.surface);
        return restores(trial, touch, place, &state, &before);
    }
    check_meetings(trial, touch, place)?;
    // One of the blows leaves the wall almost at rest: its motion must not stick.
    let stop = -1e-5 - velocity.dot(normal) / trial.speed;
    for share in BLOWS.map(|share| -share).into_iter().chain([stop]) {
        check_blow(trial, touch, place, share)?;
        let (changed, after) = (trial.boundary.state(), View::of(trial, touch, place));
        let longer = [&changed[..], &[0.0]].concat();
        require!(PART, "state", trial.boundary.set_state(&longer).is_err();
            "{} numbers are accepted as a state of {}", longer.len(), changed.len());
        for (state, expected) in [(&state, &before), (&changed, &after), (&state, &before)] {
            restores(trial, touch, place, state, expected)?;
        }
    }
    Ok(())
}

/// The present and the later walls: the surface at a touch, and the gaps to the nearest walls all over the
/// domain.
#[derive(Debug, PartialEq)]
struct View {
    surface: String,
    gaps: [Vec<f64>; 2],
}

impl View {
    fn of(trial: &Trial<'_>, Touch { wall, time, .. }: Touch, place: DVec2) -> Self {
        let surface = in_words(&trial.boundary.surface(wall, place, time), 1);
        // Without a state, only the wall itself may be worn by a blow.
        let has_state = !trial.boundary.state().is_empty();
        let places = || trial.places().filter(|_| has_state).chain([place]);
        let gap = |place, time| trial.gap().at(place, trial.length(), time);
        let later = time + 0.1 * trial.crossing();
        Self { surface, gaps: [time, later].map(|time| places().map(|place| gap(place, time)).collect()) }
    }

    /// Returns how far walls are from where they are in another view, at the present or the later time.
    fn moved(&self, other: &Self, later: usize) -> f64 {
        let pairs = self.gaps[later].iter().zip(&other.gaps[later]);
        pairs.map(|(one, other)| (one - other).abs()).fold(0.0, f64::max)
    }
}

/// Checks that the walls are as in an earlier view when its state is set.
fn restores(
    trial: &mut Trial<'_>,
    touch: Touch,
    place: DVec2,
    state: &[f64],
    expected: &View,
) -> Result<(), Violation> {
    trial.take_state(state)?;
    let found = View::of(trial, touch, place);
    require!(PART, "state", found == *expected;
        "when the state {state:?} is set, walls are {found:?}, and were {expected:?}, at {touch:?}");
    Ok(())
}

fn strike(trial: &mut Trial<'_>, Touch { wall, time, .. }: Touch, place: DVec2, impulse: DVec2) -> Reaction {
    let normal = trial.boundary.surface(wall, place, time).normal;
    trial.boundary.react(&Impact::new(wall, impulse, place - trial.radius * normal, time))
}

/// Checks an impact that adds this speed along the normal. If disks feel friction, it also pushes along the
/// surface, where the wall is guided.
fn check_blow(trial: &mut Trial<'_>, touch: Touch, place: DVec2, share: f64) -> Result<(), Violation> {
    let Touch { wall, time, .. } = touch;
    let surface = trial.boundary.surface(wall, place, time);
    let Surface { normal, velocity, mass, .. } = surface;
    let friction = if surface.response.has_friction() { 1.0 } else { 0.0 };
    let impulse = share * trial.speed * mass * (normal + friction * normal.perp());
    let before = View::of(trial, touch, place);
    let reaction = strike(trial, touch, place, impulse);
    let gained = trial.boundary.surface(wall, place, time).velocity - velocity;
    let expected = DVec2::new(share * trial.speed, 0.0);
    // A guide at a slant moves a wall along its surface, too, which only friction would feel.
    let found = DVec2::new(gained.dot(normal), friction * gained.dot(normal.perp()));
    let slack = EXACT * expected.length() + ROUNDING * (velocity.length() + trial.speed);
    require!(PART, "reaction", (found - expected).length() <= slack;
        "a blow {impulse:?} at {time:?} gives wall {wall}, of the mass {mass:?}, the velocity {found:?} along normal and tangent, \
         not {expected:?}; a wall that moves along its surface must have a response without friction");
    require!(PART, "reaction", reaction == Reaction::Moved || gained.length() <= slack;
        "wall {wall} answers {reaction:?} to a blow, and gains {gained:?}");
    let moved = View::of(trial, touch, place).moved(&before, 0);
    require!(PART, "reaction", moved <= trial.rounding();
        "a blow on wall {wall} at {time:?} moves walls at once, by {moved:?}");
    Ok(())
}

/// Checks that `may_meet` names the regions in which other disks touch walls that a blow sets in motion, and
/// that `may_touch` named these regions before the blow, too.
fn check_meetings(trial: &mut Trial<'_>, touch: Touch, place: DVec2) -> Result<(), Violation> {
    let Touch { wall, time, .. } = touch;
    let (state, surface) = (trial.boundary.state(), trial.boundary.surface(wall, place, time));
    let sign = if trial.touches.is_multiple_of(2) { BLOW } else { -BLOW };
    let (normal, mass) = (surface.normal, surface.mass);
    let flights = flights_about(trial, time, place);
    strike(trial, touch, place, sign * trial.speed * mass * normal);
    let near = |trial: &Trial<'_>, place, time| trial.gap().nearest(place, NEAR * trial.radius, time);
    let mut met = Vec::new();
    for flight in flights {
        let found = trial.first_touch(&flight, flight.time() + trial.longest(&flight))?;
        let Some(Touch { wall: other, time, .. }) = found else { continue };
        let (place, margin) = (flight.position(time), DVec2::splat(trial.rounding()));
        let around = Region::new(place - margin, place + margin);
        let is_named = trial.boundary.may_meet(wall, &around, trial.radius, time);
        met.push((flight, other, time, around, is_named, near(trial, place, time)));
    }
    trial.take_state(&state)?;
    for (flight, other, then, around, is_named, after) in met {
        // Cells ask once, whatever the walls do later.
        require!(PART, "may_touch", trial.boundary.may_touch(&around, trial.radius);
            "after a blow on wall {wall} at {time:?}, a disk touches wall {other} in {around:?}, where it was denied \
             before the blow, on {flight:?}");
        let (nearest, gap) = near(trial, flight.position(then), then).unwrap_or((other, NEAR * trial.radius));
        // If the disk is nearer to another wall, gaps do not show whether this one has moved.
        let is_moved = after.is_some_and(|(wall, later)| {
            [nearest, wall] == [other; 2] && (gap - later).abs() > 2.0 * trial.rounding()
        });
        require!(PART, "may_meet", is_named || !is_moved;
            "a blow on wall {wall} at {time:?} moves wall {other}, and a disk touches it at {then:?} in a region \
             where `may_meet` of wall {wall} denies it, on {flight:?}");
    }
    Ok(())
}

/// Returns flights from places all over the domain, half of them toward a point and half of them away from
/// it: disks meet the wall behind this point, and the other walls of its body.
fn flights_about(trial: &Trial<'_>, time: f64, point: DVec2) -> Vec<Flight> {
    let is_free = |place: &DVec2| !trial.gap().is_below(0.0, *place, time);
    let flight = |(number, place): (usize, DVec2)| {
        let sign = if (number + trial.touches).is_multiple_of(2) { 1.0 } else { -1.0 };
        let velocity = sign * trial.speed * (point - place).normalize_or(DVec2::X);
        Flight::new(time, place, velocity, DVec2::ZERO, trial.radius).with_kind(trial.kind)
    };
    trial.places().filter(is_free).enumerate().map(flight).collect()
}
