//! The check that a wall names the regions in which a blow changes the flights of other disks.

use glam::DVec2;

use super::seen::in_words;
use super::trial::{PART, Trial};
use crate::boundary::{Boundary, Impact, Overlap, Region, Touch};
use crate::violation::require;
use crate::{Flight, Violation};

/// Speed that the blow gives to the wall, in units of the typical speed.
const BLOW: f64 = 0.5;

/// Largest speed of a surface after such a blow that other disks find, in the same units.
const FASTEST: f64 = 3.0;

/// Part of the radius by which a disk is enlarged in order to find the wall near it.
const NEAR: f64 = 0.5;

/// A touch of another disk, and what the boundary answers after the blow.
struct Meeting {
    flight: Flight,
    touch: Touch,
    around: Region,
    may_meet: bool,
    nearest: Option<Overlap>,
}

/// Checks that `may_meet` names the regions in which other disks touch walls that a blow sets in motion: the
/// wall that is hit, and the other walls of its body. `may_touch` names these regions before the blow, too.
pub(super) fn check_meetings(trial: &mut Trial<'_>, touch: Touch, place: DVec2) -> Result<(), Violation> {
    let Touch { wall, time, .. } = touch;
    let state = trial.boundary.state();
    trial.blows += 1;
    let flights = flights_about(trial, time, place);
    strike(trial, touch, place);
    let touches = touches(trial, &flights)?;
    // A blow near an axle may make other places too fast for the other checks.
    let is_slow = |(flight, touch): &(Flight, Touch)| {
        let surface = trial.boundary.surface(touch.wall, flight.position(touch.time), touch.time);
        surface.velocity.length() <= FASTEST * trial.speed
    };
    if !trial.is_struck && touches.iter().all(is_slow) {
        (trial.states[1], trial.struck_at) = (trial.boundary.state(), time);
    }
    let met: Vec<_> =
        touches.into_iter().map(|(flight, touch)| meeting(trial, wall, flight, touch)).collect();
    trial.take_state(&state)?;
    for Meeting { flight, touch: Touch { wall: other, time: then, .. }, around, may_meet, nearest } in met {
        // Cells ask once, whatever the walls do later.
        let may_touch = trial.boundary.may_touch(&around, trial.radius);
        require!(PART, "may_touch", may_touch;
            "after a blow on wall {wall} at {time:?}, a disk touches wall {other} in {around:?}, where it was denied \
             before the blow, on {flight:?}");
        let without = near(trial, &flight, then);
        let is_named = may_meet || !is_another(trial, other, without, nearest);
        require!(PART, "may_meet", is_named;
            "a blow on wall {wall} at {time:?} moves wall {other}, and a disk touches it at {then:?} in a region \
             where `may_meet` of wall {wall} denies it, on {flight:?}");
    }
    Ok(())
}

/// Returns flights from places all over the domain, half of them toward a point and half of them away from
/// it: disks meet the wall behind this point, and the other walls of its body.
fn flights_about(trial: &Trial<'_>, time: f64, point: DVec2) -> Vec<Flight> {
    let is_free = |place: &DVec2| trial.depth(*place, 0.0, time).is_none();
    let flight = |(number, place): (usize, DVec2)| {
        let sign = if (number + trial.blows).is_multiple_of(2) { 1.0 } else { -1.0 };
        let velocity = sign * trial.speed * (point - place).normalize_or(DVec2::X);
        Flight::new(time, place, velocity, DVec2::ZERO, trial.radius).with_kind(trial.kind)
    };
    trial.places().filter(is_free).enumerate().map(flight).collect()
}

/// Returns the touches of disks all over the domain, with the surfaces there.
pub(super) fn touches_about(
    trial: &Trial<'_>,
    touch: Touch,
    place: DVec2,
) -> Result<Vec<(Touch, String)>, Violation> {
    let found = touches(trial, &flights_about(trial, touch.time, place))?;
    let seen = |(flight, touch): (Flight, Touch)| {
        let surface = trial.boundary.surface(touch.wall, flight.position(touch.time), touch.time);
        (touch, in_words(&surface, 1))
    };
    Ok(found.into_iter().map(seen).collect())
}

/// Returns the flights that end at a touch, with this touch.
fn touches(trial: &Trial<'_>, flights: &[Flight]) -> Result<Vec<(Flight, Touch)>, Violation> {
    let touched = |flight: &Flight| {
        let found = trial.first_touch(flight, flight.time() + trial.longest(flight));
        found.map(|touch| touch.map(|touch| (*flight, touch))).transpose()
    };
    flights.iter().filter_map(touched).collect()
}

/// Gives a wall a blow along its normal and along its surface, in turns into the wall and out of it.
fn strike(trial: &mut Trial<'_>, Touch { wall, time, .. }: Touch, place: DVec2) {
    let surface = trial.boundary.surface(wall, place, time);
    let (normal, masses) = (surface.normal, [surface.mass, surface.tangential_mass]);
    let [mass, tangential] = masses.map(|mass| if mass.is_finite() { mass } else { 0.0 });
    let speed = if trial.blows.is_multiple_of(2) { BLOW * trial.speed } else { -BLOW * trial.speed };
    let impulse = speed * (mass * normal + tangential * normal.perp());
    trial.boundary.react(&Impact::new(wall, impulse, place - trial.radius * normal, time));
}

fn meeting(trial: &Trial<'_>, wall: usize, flight: Flight, touch: Touch) -> Meeting {
    let (place, margin) = (flight.position(touch.time), DVec2::splat(trial.rounding()));
    let around = Region::new(place - margin, place + margin);
    let may_meet = trial.boundary.may_meet(wall, &around, trial.radius, touch.time);
    Meeting { flight, touch, around, may_meet, nearest: near(trial, &flight, touch.time) }
}

fn near(trial: &Trial<'_>, flight: &Flight, time: f64) -> Option<Overlap> {
    trial.depth(flight.position(time), NEAR * trial.radius, time)
}

/// Returns whether two overlaps of the same disk show a wall at different places. If the disk is nearer to
/// another wall, they do not show it.
fn is_another(trial: &Trial<'_>, wall: usize, one: Option<Overlap>, other: Option<Overlap>) -> bool {
    let is_other_wall = |found: &Option<Overlap>| found.is_some_and(|found| found.with != wall);
    let [one_depth, other_depth] = [one, other].map(|found| found.map_or(0.0, |found| found.depth));
    let is_seen = ![one, other].iter().any(is_other_wall);
    is_seen && (one_depth - other_depth).abs() > 2.0 * trial.rounding()
}
