//! Checks of walls that react to impacts: where the gaps are afterward.

use glam::DVec2;

use super::meeting::Meeting;
use super::trial::{PART, Trial};
use crate::Violation;
use crate::boundary::{Boundary, Impact, Reaction, Region, Surface, Touch};
use crate::error::require;

/// Speeds that the tested impacts give to a wall, in units of the typical speed.
const BLOWS: [f64; 4] = [1e-6, 1e-3, 5e-2, 2.0];

/// Speed that a wall gains, in either direction, before it meets disks at rest, in the same units; the times
/// of these meetings after the blow, in units of the time that a disk takes to cross the domain; and the
/// distances of disks from the wall, relative to the radius.
const BLOW: f64 = 0.5;
const LATER: [f64; 3] = [0.02, 0.1, 1.0];
const NEAR: [f64; 3] = [0.05, 0.5, 2.0];

/// Largest error of a velocity after an impact, relative to the change and to the typical speed.
const EXACT: f64 = 1e-8;
const ROUNDING: f64 = 1e-12;

/// Checks that a wall with a mass reacts to impacts as its mass requires, that a wall without one does not
/// react, and that setting the state of the walls restores them.
pub(super) fn check_reaction(trial: &mut Trial<'_>, meeting: &Meeting) -> Result<(), Violation> {
    let (state, before) = (trial.boundary.state(), gaps(trial, meeting));
    let (Surface { mass, normal, velocity, .. }, touch) = (meeting.surface, meeting.touch);
    if mass == f64::INFINITY {
        strike(trial, meeting, trial.speed * trial.length() * (normal.perp() - normal));
        let moved = moved(&before, &gaps(trial, meeting)).max_element();
        require!(PART, "reaction", moved <= trial.rounding();
            "a blow on {touch:?}, whose mass is infinite, moves walls by {moved:?}");
        return restores(trial, meeting, &state, &before);
    }
    check_meetings(trial, meeting, BLOW)?;
    check_meetings(trial, meeting, -BLOW)?;
    // One of the blows leaves the wall almost at rest: its motion must not stick.
    let stop = -1e-5 - velocity.dot(normal) / trial.speed;
    for share in BLOWS.map(|share| -share).into_iter().chain([stop]) {
        check_blow(trial, meeting, share)?;
        let (changed, after) = (trial.boundary.state(), gaps(trial, meeting));
        let longer = [&changed[..], &[0.0]].concat();
        require!(PART, "state", trial.boundary.set_state(&longer).is_err();
            "{} numbers are accepted as a state of {}", longer.len(), changed.len());
        for (state, expected) in [(&state, &before), (&changed, &after), (&state, &before)] {
            restores(trial, meeting, state, expected)?;
        }
    }
    Ok(())
}

/// Returns the gaps to the nearest walls all over the domain and at a touch, each at the time of the touch
/// and later.
fn gaps(trial: &Trial<'_>, Meeting { touch, place, .. }: &Meeting) -> Vec<DVec2> {
    // Without a state, only the wall itself may be moved by a blow.
    let has_state = !trial.boundary.state().is_empty();
    let places = trial.places().filter(|_| has_state).chain([*place]);
    let gap = |place, later| trial.gap().at(place, trial.length(), touch.time + later);
    places.map(|place| DVec2::new(gap(place, 0.0), gap(place, 0.1 * trial.crossing()))).collect()
}

/// Returns by how much gaps have changed at most, at the time of the touch and later.
fn moved(before: &[DVec2], after: &[DVec2]) -> DVec2 {
    let pairs = before.iter().zip(after);
    pairs.map(|(one, other)| (one - other).abs()).fold(DVec2::ZERO, DVec2::max)
}

/// Checks that the walls are where they were when their state is set.
fn restores(
    trial: &mut Trial<'_>,
    meeting: &Meeting,
    state: &[f64],
    expected: &[DVec2],
) -> Result<(), Violation> {
    trial.take_state(state)?;
    let (found, touch) = (gaps(trial, meeting), meeting.touch);
    require!(PART, "state", found == expected;
        "when the state {state:?} is set, the gaps to walls are {found:?}, and were {expected:?}, at {touch:?}");
    Ok(())
}

fn strike(trial: &mut Trial<'_>, meeting: &Meeting, impulse: DVec2) -> Reaction {
    let Meeting { touch: Touch { wall, time, .. }, place, surface, .. } = meeting;
    trial.boundary.react(&Impact::new(*wall, impulse, place - trial.radius * surface.normal, *time))
}

/// Checks an impact that adds this speed along the normal. If disks feel friction, it also pushes along the
/// surface, where the wall is guided.
fn check_blow(trial: &mut Trial<'_>, meeting: &Meeting, share: f64) -> Result<(), Violation> {
    let Meeting { touch: Touch { wall, time, .. }, place, surface, .. } = *meeting;
    let Surface { normal, velocity, mass, .. } = surface;
    let response = trial.boundary.surface(wall, place, time).response;
    let friction = if response.has_friction() { 1.0 } else { 0.0 };
    let impulse = share * trial.speed * mass * (normal + friction * normal.perp());
    let before = gaps(trial, meeting);
    let reaction = strike(trial, meeting, impulse);
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
    let moved = moved(&before, &gaps(trial, meeting)).x;
    require!(PART, "reaction", moved <= trial.rounding();
        "a blow on wall {wall} at {time:?} moves walls at once, by {moved:?}");
    Ok(())
}

/// Checks that `may_meet` names the places at which a wall that a blow sets in motion reaches a disk at rest,
/// and that `may_touch` named these places before the blow, too: without the blow, they stay free.
fn check_meetings(trial: &mut Trial<'_>, meeting: &Meeting, share: f64) -> Result<(), Violation> {
    let (touch, Surface { normal, mass, .. }) = (meeting.touch, meeting.surface);
    let is_free = |trial: &Trial<'_>, place, time| {
        trial.domain.contains(place, 0.0) && !trial.gap().is_below(trial.rounding(), place, time)
    };
    let mut spots = Vec::new();
    let near = NEAR.map(|distance| meeting.place + distance * trial.radius * normal);
    for place in trial.places().chain(near).filter(|&place| is_free(trial, place, touch.time)) {
        // Cells ask once, whatever the walls do later.
        let may_touch = trial.boundary.may_touch(&Region::new(place, place), trial.radius);
        spots.extend(LATER.map(|wait| (place, touch.time + wait * trial.crossing(), may_touch)));
    }
    spots.retain(|&(place, then, _)| is_free(trial, place, then));
    let state = trial.boundary.state();
    strike(trial, meeting, share * trial.speed * mass * normal);
    for (place, then, may_touch) in spots {
        let is_met = trial.gap().is_below(-trial.rounding(), place, then);
        let may_meet = trial.boundary.may_meet(touch.wall, &Region::new(place, place), trial.radius, then);
        require!(PART, "may_touch", may_touch || !is_met;
            "after a blow on {touch:?}, a wall meets a disk at {place:?}, time {then:?}, where `may_touch` denied it");
        require!(PART, "may_meet", may_meet || !is_met;
            "after a blow on {touch:?}, a wall meets a disk at {place:?}, time {then:?}, where `may_meet` denies it");
    }
    trial.take_state(&state)
}
