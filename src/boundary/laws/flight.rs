//! The check of one flight: its touch is the first root of the gap.

use glam::DVec2;

use super::meeting::Meeting;
use super::reaction::check_reaction;
use super::surface::check_surface;
use super::trial::{PART, Trial};
use super::{LATEST, SMALLEST};
use crate::boundary::{Boundary, Region, Response, Touch};
use crate::error::require;
use crate::{Flight, Violation};

/// Number of samples along a flight.
const SAMPLES: u32 = 200;

/// A search for the first touch of a flight.
struct Search {
    flight: Flight,
    until: f64,
    /// Amount by which all times are later than in the first search: they count from an earlier origin.
    shift: f64,
}

/// Checks consecutive flights of a disk. Each wall that the disk touches reflects it, as if wall and disk
/// were elastic and smooth.
pub(super) fn check_flights(trial: &mut Trial<'_>, first: Flight, flights: usize) -> Result<(), Violation> {
    let mut flight = first;
    for _ in 0..flights {
        let touched = check_flight(trial, &flight)?;
        let (before, now) =
            ((trial.domain, trial.wall_count), (trial.boundary.domain(), trial.boundary.wall_count()));
        require!(PART, "constants", now == before;
            "the domain was {} with {} walls, and is now {} with {}", before.0, before.1, now.0, now.1);
        let Some(meeting) = touched else { break };
        check_reaction(trial, &meeting)?;
        let Meeting { touch: Touch { time, .. }, place, surface, rate, .. } = meeting;
        let velocity = flight.velocity(time) - 2.0 * rate.min(0.0) * surface.normal;
        flight = trial.flight(time, place, velocity, flight.acceleration());
    }
    Ok(())
}

/// Checks a flight, and returns its touch with a wall that reflects the disk.
fn check_flight(trial: &mut Trial<'_>, flight: &Flight) -> Result<Option<Meeting>, Violation> {
    let until = flight.time() + trial.longest(flight);
    let found = trial.first_touch(flight, until)?;
    let again = trial.first_touch(flight, until)?;
    require!(PART, "repeatable", again == found;
        "the touch {found:?} is {again:?} when asked for again: {flight:?}");
    let meeting = found.map(|touch| Meeting::of(trial, flight, touch));
    let search = Search { flight: *flight, until, shift: 0.0 };
    check_way(trial, &search, meeting.as_ref())?;
    if let Some(sink) = meeting.as_ref().filter(|meeting| is_sink_for_centers(trial, meeting)) {
        return check_regions(trial, sink).map(|()| None);
    }
    if let Some(meeting) = &meeting {
        check_place(trial, flight, meeting)?;
        // Rounding may have left the gap open. It then closes soon after the touch.
        let soon = until.min(meeting.touch.time + 3.0 * meeting.slack(trial));
        for flight in [*flight, trial.restarted(flight, meeting.touch.time)] {
            check_again(trial, &Search { flight, until: soon, shift: 0.0 }, Some(meeting))?;
        }
    }
    check_origin(trial, &search, meeting.as_ref())?;
    meeting.iter().try_for_each(|meeting| check_regions(trial, meeting))?;
    Ok(meeting)
}

/// Returns whether a flight ends at a sink that takes a disk out before a touch, when its center arrives.
fn is_sink_for_centers(trial: &Trial<'_>, Meeting { touch, place, .. }: &Meeting) -> bool {
    let response = trial.boundary.surface(touch.wall, *place, touch.time).response;
    matches!(response, Response::Absorbing) && !trial.gap().is_below(trial.rounding(), *place, touch.time)
}

/// Checks that a disk overlaps no wall and stays in the domain during its flight.
fn check_way(trial: &Trial<'_>, search: &Search, meeting: Option<&Meeting>) -> Result<(), Violation> {
    let (flight, found) = (&search.flight, meeting.map(|meeting| meeting.touch));
    let end = found.map_or(search.until, |touch| touch.time);
    // The phase of a motion without a period has the rounding error of an absolute time, during which the gap
    // closes a little. The check of the surface finds a rate that is NaN.
    let rate = meeting.map_or(0.0, |meeting| meeting.rate.abs());
    let rounding = trial.rounding() + (16.0 * f64::EPSILON * (trial.origin + end) * rate).max(0.0);
    for k in 0..=SAMPLES {
        let time = (flight.time() + (end - flight.time()) * f64::from(k) / f64::from(SAMPLES)).min(end);
        let place = flight.position(time);
        let is_free = !trial.gap().is_below(-rounding, place, time);
        require!(PART, "no missed touch", is_free;
            "a disk is in a wall at time {time:?}, with the touch {found:?}, on {flight:?}");
        require!(PART, "inside the domain", trial.domain.contains(place, rounding);
            "a disk is at {place:?} at time {time:?}, on {flight:?}");
    }
    Ok(())
}

/// Checks that the gap is closed at the touch, and still closes, and checks the surface there.
fn check_place(trial: &Trial<'_>, flight: &Flight, meeting: &Meeting) -> Result<(), Violation> {
    let Meeting { touch, place, rate, is_grazing, .. } = *meeting;
    let (Touch { time, wall, .. }, rounding) = (touch, trial.rounding());
    require!(PART, "no early touch", trial.gap().is_below(rounding, place, time);
        "the gap to wall {wall} is open at {time:?}, on {flight:?}");
    check_surface(trial, meeting)?;
    trial.check_seams(place, time)?;
    let less = trial.radius - SMALLEST * trial.largest;
    let smaller = place - less * meeting.surface.normal;
    require!(PART, "sizes", trial.gap().is_below(2.0 * rounding - less, smaller, time);
        "a disk of radius {:?} at {place:?}, {time:?}, touches wall {wall}, but one that is smaller by {less:?} does not touch it at \
         the same point: walls tell disks apart by their kinds, not by their sizes", trial.radius);
    require!(PART, "approach", is_grazing || rate < 0.0;
        "wall {wall} is touched at {time:?}, but left at {rate:?}, on {flight:?}");
    Ok(())
}

/// Checks that a flight is found to touch as it did before, in another search: one that ends just after the
/// touch, begins at it, or counts all times from an origin that is earlier by `shift`.
///
/// A touch just before the end of a search may be found once only.
fn check_again(trial: &Trial<'_>, search: &Search, before: Option<&Meeting>) -> Result<(), Violation> {
    let Search { ref flight, until, shift } = *search;
    let again = trial.first_touch(flight, until)?.map(|touch| Meeting::of(trial, flight, touch));
    if let Some(again) = &again {
        check_place(trial, flight, again)?;
    }
    // A flight without a touch ends with the search.
    let time = |meeting: Option<&Meeting>, shift: f64| meeting.map_or(until, |one| one.touch.time + shift);
    let apart = (time(before, shift) - time(again.as_ref(), 0.0)).abs();
    let slack = before.into_iter().chain(&again).map(|one| one.slack(trial)).fold(0.0, f64::max);
    let is_wall = before.zip(again.as_ref()).is_none_or(|(one, two)| one.is_with(trial, two.touch.wall));
    let (one, two) = (before.map(|one| one.touch), again.map(|two| two.touch));
    let law = if shift == 0.0 { "no missed touch" } else { "time origin" };
    require!(PART, law, slack == f64::INFINITY || is_wall && apart <= 2.0 * slack;
        "the touch {one:?} is {two:?} in a search up to {until:?}, from an origin {shift:?} before: {flight:?}");
    let Some(before) = before else { return Ok(()) };
    require!(PART, "time origin", before.is_same_from(trial, shift);
        "an origin {shift:?} before changes the surface at {one:?} from {:?} and {}: {flight:?}",
        before.surface, before.response);
    Ok(())
}

/// Checks that the same flight, given relative to another time origin, touches at the same absolute time, and
/// finds the same surface.
fn check_origin(trial: &mut Trial<'_>, search: &Search, meeting: Option<&Meeting>) -> Result<(), Violation> {
    let Search { flight, until, .. } = search;
    let (origin, start, state) = (trial.origin, flight.time(), trial.boundary.state());
    // The other origin is earlier, so that no offset is negative. A late offset would lose digits. Walls that
    // react keep no record of their past, so for them the other origin is later.
    let earlier = 0.37 * origin.min(LATEST * trial.crossing());
    let shift = if state.is_empty() { earlier } else { -0.37 * start };
    let (position, velocity) = (flight.position(start), flight.velocity(start));
    let flight = trial.flight(start + shift, position, velocity, flight.acceleration());
    trial.set_origin(origin - shift);
    check_again(trial, &Search { flight, until: until + shift, shift }, meeting)?;
    trial.set_origin(origin);
    trial.take_state(&state)
}

/// Checks that `may_touch` and `may_meet` are true for regions that contain the position of a touch: the
/// point itself up to rounding, and rectangles from it to places all over the domain, and to infinity across
/// the walls of the domain, as the engine extends its cells there.
fn check_regions(trial: &Trial<'_>, Meeting { touch, place, .. }: &Meeting) -> Result<(), Violation> {
    let (Touch { time, wall, .. }, radius) = (*touch, trial.radius);
    let has_walls = trial.domain.periods().cmpeq(DVec2::ZERO);
    let outside = [DVec2::NEG_INFINITY, DVec2::INFINITY].map(|far| DVec2::select(has_walls, far, *place));
    for other in trial.places().chain(outside).chain([*place]) {
        let region = Region::new(place.min(other), place.max(other)).enlarged(trial.rounding());
        require!(PART, "may_touch", trial.boundary.may_touch(&region, radius);
            "a disk of radius {radius:?} touches in {region:?}, where it is denied");
        require!(PART, "may_meet", trial.boundary.may_meet(wall, &region, radius, time);
            "a disk meets wall {wall} in {region:?} at {time:?}, where it is denied");
    }
    Ok(())
}
