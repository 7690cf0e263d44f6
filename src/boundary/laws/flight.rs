//! The check of one flight, from its start to its touch.

use glam::DVec2;

use super::reaction::check_reaction;
use super::seen::{Seen, name};
use super::surface::check_surface;
use super::trial::{PART, Trial, restarted};
use super::{LATEST, SMALLEST};
use crate::boundary::{Boundary, Overlap, Response, Touch};
use crate::violation::require;
use crate::{Flight, Violation};

/// Number of samples along a flight.
const SAMPLES: u32 = 200;

/// Closing speed below which a touch is grazing, as a fraction of the speeds. Rounding decides when such a
/// touch happens, and whether it happens.
const GRAZING: f64 = 1e-2;

/// Closing speeds of flights that graze a wall, as fractions of the speed along it.
const GRAZES: [f64; 4] = [3e-2, 3e-3, 3e-4, 3e-5];

/// A touch, and how the disk meets the wall.
struct Meeting {
    touch: Touch,
    place: DVec2,
    /// Speed at which the gap opens; negative while it closes.
    rate: f64,
    /// True if the gap closes so slowly that rounding decides.
    is_grazing: bool,
}

/// Checks consecutive flights of a disk. Each wall that the disk touches reflects it.
pub(super) fn check_flights(trial: &mut Trial<'_>, first: Flight, flights: usize) -> Result<(), Violation> {
    let mut flight = first;
    for number in 0..flights {
        let touched = check_flight(trial, &flight)?;
        trial.check_constants()?;
        let Some(meeting) = touched else { break };
        check_reaction(trial, meeting.touch, meeting.place)?;
        flight = turned_back(trial, &flight, &meeting);
        if number % 2 == 1 {
            trial.grazes += 1;
            let grazing = grazing(trial, &flight, &meeting, GRAZES[trial.grazes % GRAZES.len()]);
            if trial.depth(grazing.position(grazing.time()), 0.0, grazing.time()).is_none() {
                check_flight(trial, &grazing)?;
            }
        }
    }
    Ok(())
}

/// Checks a flight, and returns its touch with a wall that reflects the disk.
fn check_flight(trial: &mut Trial<'_>, flight: &Flight) -> Result<Option<Meeting>, Violation> {
    let until = flight.time() + trial.longest(flight);
    let found = trial.first_touch(flight, until)?;
    if let Some(Touch { time, .. }) = found {
        let is_inside = time >= flight.time() && time <= until;
        require!(PART, "touch time", is_inside;
            "a touch at {time:?} is not on the flight until {until:?}: {flight:?}");
    }
    check_way(trial, flight, found.map_or(until, |touch| touch.time), found)?;
    if let Some(touch) = found.filter(|&touch| is_sink_for_centers(trial, flight, touch)) {
        trial.check_regions(touch, flight.position(touch.time))?;
        return Ok(None);
    }
    let meeting = found.map(|touch| check_place(trial, flight, touch)).transpose()?;
    let again = trial.first_touch(flight, until)?;
    let is_same = again == found;
    require!(PART, "repeatable", is_same;
        "the touch {found:?} is {again:?} when asked for again: {flight:?}");
    check_origin(trial, flight, until, meeting.as_ref())?;
    if let Some(meeting) = &meeting {
        check_limits(trial, flight, meeting)?;
        trial.check_regions(meeting.touch, meeting.place)?;
    }
    Ok(meeting)
}

/// Returns whether the flight ends at a sink that takes a disk out before a touch, when its center arrives.
fn is_sink_for_centers(trial: &Trial<'_>, flight: &Flight, touch: Touch) -> bool {
    let place = flight.position(touch.time);
    let surface = trial.boundary.surface(touch.wall, place, touch.time);
    let is_open = trial.depth(place, trial.rounding(), touch.time).is_none();
    matches!(surface.response, Response::Absorbing) && is_open
}

/// Returns the distance by which a gap closes during the rounding error of an absolute time. The phase of a
/// motion without a period has this error.
fn lateness(trial: &Trial<'_>, flight: &Flight, Touch { wall, time, .. }: Touch) -> f64 {
    let surface = trial.boundary.surface(wall, flight.position(time), time);
    let rate = (flight.velocity(time) - surface.velocity).dot(surface.normal);
    // The check of the surface finds a rate that is NaN.
    (16.0 * f64::EPSILON * (trial.origin + time) * rate.abs()).max(0.0)
}

/// Checks that a disk overlaps no wall and stays in the domain during its flight.
fn check_way(trial: &Trial<'_>, flight: &Flight, end: f64, found: Option<Touch>) -> Result<(), Violation> {
    let domain = trial.domain;
    let rounding = trial.rounding() + found.map_or(0.0, |touch| lateness(trial, flight, touch));
    let found = found.map(|touch| touch.time);
    for k in 0..=SAMPLES {
        let time = (flight.time() + (end - flight.time()) * f64::from(k) / f64::from(SAMPLES)).min(end);
        let place = flight.position(time);
        if let Some(Overlap { with: wall, depth }) = trial.depth(place, -rounding, time) {
            let sentence = format!(
                "a disk goes into wall {wall}: at time {time:?} it is {depth:?} deep, with the touch {found:?}, \
                 on {flight:?}"
            );
            return Err(Violation::new(PART, "no missed touch", sentence));
        }
        let is_inside = domain.contains(place, rounding);
        require!(PART, "inside the domain", is_inside;
            "a disk is at {place:?} at time {time:?}, on {flight:?}");
    }
    Ok(())
}

/// Checks that the gap is closed at the touch, and checks the surface there.
fn check_place(trial: &mut Trial<'_>, flight: &Flight, touch: Touch) -> Result<Meeting, Violation> {
    let Touch { time, wall, .. } = touch;
    let place = flight.position(time);
    let is_closed = trial.depth(place, trial.rounding(), time).is_some();
    require!(PART, "no early touch", is_closed; "the gap to wall {wall} is open at {time:?}, on {flight:?}");
    check_surface(trial, touch, place)?;
    trial.check_seams(place, time)?;
    let surface = trial.boundary.surface(wall, place, time);
    let small = SMALLEST * trial.largest;
    let nearer = place - (trial.radius - small) * surface.normal;
    let is_closed = trial.depth(nearer, small - trial.radius + 2.0 * trial.rounding(), time).is_some();
    require!(PART, "sizes", is_closed;
        "a disk of radius {:?} at {place:?}, {time:?}, touches wall {wall}, but one of radius {small:?} at the same point does \
         not: walls tell disks apart by their kinds, not by their sizes", trial.radius);
    let velocity = flight.velocity(time);
    let rate = (velocity - surface.velocity).dot(surface.normal);
    let speed = velocity.length() + surface.velocity.length();
    let closes = rate <= GRAZING * speed;
    require!(PART, "approach", closes;
        "wall {wall} is touched at {time:?}, but left at {rate:?}, on {flight:?}");
    Ok(Meeting { touch, place, rate, is_grazing: rate > -GRAZING * speed })
}

/// Checks that a flight that ends before the touch finds none, unless the gap is closed up to rounding there,
/// that a flight that ends just after the touch finds it, and that a flight that begins at the touch finds it
/// immediately.
fn check_limits(trial: &Trial<'_>, flight: &Flight, meeting: &Meeting) -> Result<(), Violation> {
    let Touch { time, wall, .. } = meeting.touch;
    let half = flight.time() + 0.5 * (time - flight.time());
    let early = trial.first_touch(flight, half)?;
    // A search may end at any time at which the gap is closed up to rounding, as it is before a slow touch.
    let is_closed = |Touch { time, .. }: Touch| {
        time <= half && trial.depth(flight.position(time), trial.rounding(), time).is_some()
    };
    let is_open = early.is_none_or(is_closed) || time <= half;
    require!(PART, "touch time", is_open; "a search that ends at {half:?} finds {early:?}, on {flight:?}");
    if meeting.is_grazing {
        return Ok(());
    }
    // Rounding may have left the gap open. It then closes within this time.
    let soon = time + slack(trial, meeting);
    for start in [*flight, restarted(flight, time)] {
        let found = trial.first_touch(&start, soon)?;
        let is_same = |other| other == wall || name(trial, meeting.touch, meeting.place).is_none();
        let is_found = found.is_some_and(|again| {
            (time - slack(trial, meeting)..=soon).contains(&again.time) && is_same(again.wall)
        });
        require!(PART, "no missed touch", is_found;
            "wall {wall} is touched at {time:?}, but a search until {soon:?} finds {found:?}, on {start:?}");
    }
    Ok(())
}

/// Checks that the same flight, given relative to another time origin, touches at the same absolute time, and
/// finds the same surface.
///
/// Rounding decides whether there is a grazing touch, or a touch just before the end of the flight. Such a
/// touch may be found with one origin only.
fn check_origin(
    trial: &mut Trial<'_>,
    flight: &Flight,
    until: f64,
    meeting: Option<&Meeting>,
) -> Result<(), Violation> {
    let (origin, start) = (trial.origin, flight.time());
    let state = trial.boundary.state();
    // The other origin is earlier, so that no offset is negative. A late offset would lose digits. Walls that
    // react keep no record of their past, so for them the other origin is later.
    let earlier = origin.min(LATEST * trial.length() / trial.speed);
    let known = trial.earliest();
    let shift = if state.is_empty() { 0.37 * earlier } else { -known - 0.37 * (start - known) };
    let (position, velocity) = (flight.position(start), flight.velocity(start));
    let shifted = Flight::new(start + shift, position, velocity, flight.acceleration(), flight.radius())
        .with_kind(flight.kind());
    let seen = |trial: &Trial<'_>, meeting: &Meeting, shift: f64| {
        let Touch { wall, time, .. } = meeting.touch;
        Seen::of(trial, Touch::new(time + shift, wall), meeting.place)
    };
    let before = meeting.map(|meeting| seen(trial, meeting, 0.0));
    trial.set_origin(origin - shift);
    let found = trial.first_touch(&shifted, until + shift)?;
    let other = found.map(|touch| check_place(trial, &shifted, touch)).transpose();
    let after = meeting.map(|meeting| seen(trial, meeting, shift));
    trial.set_origin(origin);
    trial.take_state(&state)?;
    let other = other?;
    let later = |other: &Meeting| other.touch.time - shift;
    let agree = match (meeting, &other) {
        (None, None) => true,
        (Some(one), None) => one.is_grazing || until - one.touch.time < 2.0 * slack(trial, one),
        (None, Some(one)) => one.is_grazing || until - later(one) < 2.0 * slack(trial, one),
        (Some(one), Some(other)) => {
            let apart = (one.touch.time - later(other)).abs();
            let is_same = one.touch.wall == other.touch.wall || name(trial, one.touch, one.place).is_none();
            one.is_grazing || other.is_grazing || apart <= slack(trial, one) && is_same
        }
    };
    let (one, other) = (meeting.map(|one| one.touch), other.map(|other| other.touch));
    require!(PART, "time origin", agree;
        "an origin {shift:?} before {origin:?} changes the touch {one:?} to {other:?}: {flight:?}");
    let is_same =
        before.as_ref().zip(after.as_ref()).is_none_or(|(before, after)| before.agrees(after, trial));
    require!(PART, "time origin", is_same;
        "an origin {shift:?} before {origin:?} changes {before:?} to {after:?}: {flight:?}");
    Ok(())
}

/// Returns the uncertainty of the time of a touch: the time in which the gap closes by its rounding error.
fn slack(trial: &Trial<'_>, meeting: &Meeting) -> f64 {
    4.0 * trial.rounding() / meeting.rate.abs()
}

/// Returns the flight after the touch, as if wall and disk were elastic and smooth.
fn turned_back(trial: &Trial<'_>, flight: &Flight, meeting: &Meeting) -> Flight {
    let time = meeting.touch.time;
    let surface = trial.boundary.surface(meeting.touch.wall, meeting.place, time);
    let velocity = flight.velocity(time) - 2.0 * meeting.rate.min(0.0) * surface.normal;
    Flight::new(time, meeting.place, velocity, flight.acceleration(), flight.radius())
        .with_kind(flight.kind())
}

/// Returns a flight that starts slightly off the wall and approaches it slowly while moving along it.
fn grazing(trial: &Trial<'_>, flight: &Flight, meeting: &Meeting, share: f64) -> Flight {
    let Touch { time, wall, .. } = meeting.touch;
    let surface = trial.boundary.surface(wall, meeting.place, time);
    let normal = surface.normal;
    let velocity = surface.velocity + trial.speed * (normal.perp() - share * normal);
    let place = meeting.place + 0.1 * share * share * flight.radius() * normal;
    Flight::new(time, place, velocity, flight.acceleration(), flight.radius()).with_kind(flight.kind())
}
