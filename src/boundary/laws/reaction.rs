//! Checks of walls that react to impacts.

use glam::DVec2;

use super::body::{check_body, has_friction};
use super::meetings::{check_meetings, touches_about};
use super::seen::in_words;
use super::trial::{PART, Trial};
use crate::Violation;
use crate::boundary::{Boundary, Impact, Reaction, Surface, Touch};
use crate::violation::require;

/// Speeds that the tested impacts give to a wall, in units of the typical speed. After an earlier impact,
/// they are less by a quarter, so that the wall is never faster than after the strongest of these.
const BLOWS: [f64; 5] = [1e-6, 1e-3, 5e-2, 2.0, 2.0];

/// Speed of a wall after a blow that almost stops it, in the same units.
const SLOW: f64 = 1e-5;

/// Largest error of a velocity after an impact, relative to the change and to the typical speed.
const EXACT: f64 = 1e-8;
const ROUNDING: f64 = 1e-12;

/// Where the walls are at a time.
type View = (Vec<(usize, f64)>, Vec<Option<DVec2>>);

/// Checks that the wall reacts to an impact according to its masses, and that setting its state restores it.
pub(super) fn check_reaction(trial: &mut Trial<'_>, touch: Touch, place: DVec2) -> Result<(), Violation> {
    let Touch { wall, time, .. } = touch;
    let (state, before) = (trial.boundary.state(), answers(trial, touch, place));
    let surface = trial.boundary.surface(wall, place, time);
    if surface.mass == f64::INFINITY && surface.tangential_mass == f64::INFINITY {
        return check_fixed(trial, touch, place, surface.normal);
    }
    check_meetings(trial, touch, place)?;
    let original = touches_about(trial, touch, place)?;
    check_stop(trial, touch, place)?;
    for (number, share) in BLOWS.into_iter().enumerate() {
        let sign = if number % 2 == 0 { 1.0 } else { -1.0 };
        let share = if trial.is_struck { 0.75 * share } else { share };
        check_blow(trial, touch, place, [-share, sign * share, 0.0])?;
        check_blow(trial, touch, place, [0.5 * share, 0.0, sign * share])?;
        let (changed, after) = (trial.boundary.state(), answers(trial, touch, place));
        let seen = touches_about(trial, touch, place)?;
        check_state(trial, &state)?;
        for (state, expected) in [(&state, before), (&changed, after), (&state, before)] {
            trial.take_state(state)?;
            let found = answers(trial, touch, place);
            require!(PART, "state", found == expected;
                "wall {wall} is {found:?} at {time:?} when its state {state:?} is set, and was {expected:?}");
        }
        for (state, expected) in [(&changed, &seen), (&state, &original)] {
            trial.take_state(state)?;
            let found = touches_about(trial, touch, place)?;
            require!(PART, "state", found == *expected;
                "when the state {state:?} of wall {wall} is set at {time:?}, disks touch {found:?}, and touched {expected:?} before");
        }
    }
    check_body(trial, touch, place)
}

/// Checks a blow that leaves a wall almost at rest: its motion must not stick.
fn check_stop(trial: &mut Trial<'_>, touch: Touch, place: DVec2) -> Result<(), Violation> {
    let state = trial.boundary.state();
    let surface = trial.boundary.surface(touch.wall, place, touch.time);
    // Into the wall, as impacts push: at the other stop of a piston, it would rest.
    let stop = |direction: DVec2| -SLOW - surface.velocity.dot(direction) / trial.speed;
    let blow = [stop(surface.normal), stop(surface.normal.perp()), 0.0];
    check_blow(trial, touch, place, blow)?;
    trial.take_state(&state)
}

/// Checks that a blow on a wall that does not react changes the motion of no wall.
fn check_fixed(trial: &mut Trial<'_>, touch: Touch, place: DVec2, normal: DVec2) -> Result<(), Violation> {
    let Touch { wall, time, .. } = touch;
    let (state, before) = (trial.boundary.state(), answers(trial, touch, place));
    let has_others = !state.is_empty();
    let times = if has_others { &[time, time + 0.1 * trial.length() / trial.speed][..] } else { &[] };
    let views: Vec<_> = times.iter().map(|&time| view(trial, time)).collect();
    // Without a state, only the wall itself may be worn by the blow.
    let seen = |trial: &Trial<'_>| {
        let alone = || vec![(touch, in_words(&trial.boundary.surface(wall, place, time), 1))];
        if has_others { touches_about(trial, touch, place) } else { Ok(alone()) }
    };
    let original = seen(trial)?;
    let impulse = trial.speed * (trial.length() * normal.perp() - trial.length() * normal);
    let blow = Impact::new(wall, impulse, place - trial.radius * normal, time);
    trial.boundary.react(&blow.with_couple(trial.speed * trial.length()));
    let found = answers(trial, touch, place);
    let scale = trial.speed * (1.0 + 1.0 / trial.radius);
    let is_same = before
        .iter()
        .zip(found)
        .all(|(before, now)| (now - before).abs() <= ROUNDING * (before.abs() + scale) + trial.rounding());
    require!(PART, "reaction", is_same;
        "a blow on wall {wall} at {time:?}, whose masses are infinite, changes its velocity, angular velocity and depths \
         from {before:?} to {found:?}");
    let moved = times.iter().zip(&views).map(|(&time, before)| moved(before, &view(trial, time)));
    let moved = moved.fold(0.0, f64::max);
    require!(PART, "reaction", moved <= trial.rounding();
        "a blow on wall {wall} at {time:?}, whose masses are infinite, moves other walls by {moved:?}");
    trial.take_state(&state)?;
    let found = seen(trial)?;
    require!(PART, "state", found == original;
        "after a blow on wall {wall} at {time:?}, the state {state:?} does not restore the walls: disks touch {found:?}, and \
         touched {original:?} before");
    Ok(())
}

/// Returns the nearest walls and their depths at places all over the domain, and the points of all walls.
fn view(trial: &Trial<'_>, time: f64) -> View {
    let nearest = |place| {
        let found = trial.depth(place, trial.length(), time);
        found.map_or((trial.wall_count, 0.0), |found| (found.with, found.depth))
    };
    let points = (0..trial.wall_count).map(|wall| trial.boundary.wall_point(wall, time));
    (trial.places().map(nearest).collect(), points.collect())
}

/// Returns how far walls are from where they were in an earlier view; infinity if other walls are there.
fn moved(before: &View, now: &View) -> f64 {
    let way = |(&(was, from), &(is, to)): (&(usize, f64), &(usize, f64))| {
        if was == is { (to - from).abs() } else { f64::INFINITY }
    };
    let ways = before.0.iter().zip(&now.0).map(way);
    let points = before.1.iter().zip(&now.1);
    ways.chain(points.filter_map(|(from, to)| Some(from.as_ref()?.distance((*to)?)))).fold(0.0, f64::max)
}

/// Returns numbers that show the present and the later motion of a wall: its velocity, its angular velocity,
/// and depths of overlaps.
fn answers(trial: &Trial<'_>, touch: Touch, place: DVec2) -> [f64; 5] {
    let Touch { wall, time, .. } = touch;
    let Surface { velocity, angular_velocity, .. } = trial.boundary.surface(wall, place, time);
    let later = time + 0.1 * trial.length() / trial.speed;
    let [now, then] = [time, later].map(|time| trial.depth(place, trial.radius, time));
    let [now, then] = [now, then].map(|found| found.map_or(0.0, |found| found.depth));
    [velocity.x, velocity.y, angular_velocity, now, then]
}

/// Checks an impact along the normal and along the surface, and a couple, each given by the speed that it
/// adds to the wall.
fn check_blow(
    trial: &mut Trial<'_>,
    touch: Touch,
    place: DVec2,
    [along, across, couple]: [f64; 3],
) -> Result<(), Violation> {
    let Touch { wall, time, .. } = touch;
    let surface = trial.boundary.surface(wall, place, time);
    // A guide at a slant moves a wall along its surface, too, which only friction would feel. A wall that
    // states a tangential mass is not guided.
    let is_felt = surface.tangential_mass.is_finite() || has_friction(&surface);
    let friction = if is_felt { 1.0 } else { 0.0 };
    let (across, couple) = (friction * across, friction * couple);
    let (normal, tangent, velocity) = (surface.normal, surface.normal.perp(), surface.velocity);
    let (radius, masses) = (surface.radius, [surface.mass, surface.tangential_mass]);
    let [mass, tangential] = masses.map(|mass| if mass.is_finite() { mass } else { 1.0 });
    let impulse = trial.speed * (along * mass * normal + across * tangential * tangent);
    // A couple turns a wall that has a tangential mass, which is the moment of inertia divided by R².
    let arm = if radius.is_finite() { radius } else { trial.radius };
    let couple = couple * trial.speed * tangential * arm;
    let point = place - trial.radius * normal;
    let before = view(trial, time);
    let reaction = trial.boundary.react(&Impact::new(wall, impulse, point, time).with_couple(couple));
    let struck = trial.boundary.surface(wall, place, time);
    let gained = struck.velocity - velocity;
    let expected = DVec2::new(
        impulse.dot(normal) / masses[0],
        (impulse.dot(tangent) + if radius.is_finite() { couple / arm } else { 0.0 }) / masses[1],
    );
    let found = DVec2::new(gained.dot(normal), friction * gained.dot(tangent));
    let slack = EXACT * expected.length() + ROUNDING * (velocity.length() + trial.speed);
    let is_as_expected = (found - expected).length() <= slack;
    require!(PART, "reaction", is_as_expected;
        "a blow {impulse:?} with the couple {couple:?} at {time:?} gives wall {wall}, of the masses \
         {masses:?}, the velocity {found:?} along normal and tangent, not {expected:?}; if a blow along the normal moves it along its \
         surface, it must have a response without friction");
    let is_told = reaction == Reaction::Moved || gained.length() <= slack;
    require!(PART, "reaction", is_told; "wall {wall} answers {reaction:?} to a blow, and gains {gained:?}");
    let moved = moved(&before, &view(trial, time));
    require!(PART, "reaction", moved <= trial.rounding();
        "a blow on wall {wall} at {time:?} moves walls at once, by {moved:?} (infinity if other walls are there)");
    Ok(())
}

/// Checks that the boundary refuses a state of another length.
fn check_state(trial: &mut Trial<'_>, state: &[f64]) -> Result<(), Violation> {
    let longer = [state, &[0.0]].concat();
    for wrong in [&longer[..], &longer[..state.len().saturating_sub(1)], &[]] {
        let is_refused = wrong.len() == state.len() || trial.boundary.set_state(wrong).is_err();
        require!(PART, "state", is_refused; "{} numbers are accepted as a state of {}", wrong.len(), state.len());
    }
    Ok(())
}
