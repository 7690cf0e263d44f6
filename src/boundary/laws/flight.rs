//! The check of one flight: its touch is the first root of the gap.

use glam::DVec2;

use super::reaction::check_reaction;
use super::surface::{check_surface, in_words, is_same};
use super::trial::{PART, Trial, restarted};
use super::{LATEST, SMALLEST};
use crate::boundary::{Boundary, Region, Response, Surface, Touch};
use crate::error::require;
use crate::{Flight, Violation};

/// Number of samples along a flight.
const SAMPLES: u32 = 200;

/// Closing speed below which a touch is grazing, as a fraction of the speeds. Rounding decides when such a
/// touch happens, and whether it happens.
const GRAZING: f64 = 1e-2;

/// Sizes of the regions around a touch, relative to the radius. The smallest region is a point, up to
/// rounding.
const REGIONS: [f64; 3] = [0.0, 0.5, 5.0];

/// Largest relative difference between surfaces that are seen from two time origins.
const SAME: f64 = 1e-9;

/// A touch, and how the disk meets the wall.
struct Meeting {
    touch: Touch,
    place: DVec2,
    /// Speed at which the gap opens; negative while it closes.
    rate: f64,
    /// True if the gap closes so slowly that rounding decides.
    is_grazing: bool,
    /// The surface, and its response in words.
    surface: (Surface<'static>, String),
}

impl Meeting {
    /// Returns the uncertainty of the time of the touch: the time in which the gap closes by its rounding
    /// error.
    fn slack(&self, trial: &Trial<'_>) -> f64 {
        4.0 * trial.rounding() / self.rate.abs()
    }

    /// Returns whether a touch is this one: of this wall, or of another wall with the same surface.
    fn is(&self, trial: &Trial<'_>, other: Touch) -> bool {
        other.wall == self.touch.wall || is_same(trial, self.touch, other.wall, self.place)
    }
}

/// Checks consecutive flights of a disk. Each wall that the disk touches reflects it.
pub(super) fn check_flights(trial: &mut Trial<'_>, first: Flight, flights: usize) -> Result<(), Violation> {
    let mut flight = first;
    for _ in 0..flights {
        let touched = check_flight(trial, &flight)?;
        trial.check_constants()?;
        let Some(meeting) = touched else { break };
        check_reaction(trial, meeting.touch, meeting.place)?;
        flight = turned_back(&flight, &meeting);
        trial.touches += 1;
    }
    Ok(())
}

/// Checks a flight, and returns its touch with a wall that reflects the disk.
fn check_flight(trial: &mut Trial<'_>, flight: &Flight) -> Result<Option<Meeting>, Violation> {
    let until = flight.time() + trial.longest(flight);
    let found = trial.first_touch(flight, until)?;
    let is_inside = found.is_none_or(|touch| (flight.time()..=until).contains(&touch.time));
    require!(PART, "touch time", is_inside;
        "the touch {found:?} is not on the flight until {until:?}: {flight:?}");
    check_way(trial, flight, found.map_or(until, |touch| touch.time), found)?;
    if let Some(touch) = found.filter(|&touch| is_sink_for_centers(trial, flight, touch)) {
        check_regions(trial, touch, flight.position(touch.time))?;
        return Ok(None);
    }
    let meeting = found.map(|touch| check_place(trial, flight, touch)).transpose()?;
    let again = trial.first_touch(flight, until)?;
    require!(PART, "repeatable", again == found;
        "the touch {found:?} is {again:?} when asked for again: {flight:?}");
    check_origin(trial, flight, until, meeting.as_ref())?;
    if let Some(meeting) = &meeting {
        check_limits(trial, flight, meeting)?;
        check_regions(trial, meeting.touch, meeting.place)?;
    }
    Ok(meeting)
}

/// Returns whether the flight ends at a sink that takes a disk out before a touch, when its center arrives.
fn is_sink_for_centers(trial: &Trial<'_>, flight: &Flight, Touch { wall, time, .. }: Touch) -> bool {
    let place = flight.position(time);
    let is_sink = matches!(trial.boundary.surface(wall, place, time).response, Response::Absorbing);
    is_sink && !trial.gap().is_below(trial.rounding(), place, time)
}

/// Checks that a disk overlaps no wall and stays in the domain during its flight.
fn check_way(trial: &Trial<'_>, flight: &Flight, end: f64, found: Option<Touch>) -> Result<(), Violation> {
    // The phase of a motion without a period has the rounding error of an absolute time, during which the gap
    // closes a little. The check of the surface finds a rate that is NaN.
    let lateness = found.map_or(0.0, |Touch { wall, time, .. }| {
        let surface = trial.boundary.surface(wall, flight.position(time), time);
        let rate = (flight.velocity(time) - surface.velocity).dot(surface.normal);
        (16.0 * f64::EPSILON * (trial.origin + time) * rate.abs()).max(0.0)
    });
    let rounding = trial.rounding() + lateness;
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

/// Checks that the gap is closed at the touch, and checks the surface there.
fn check_place(trial: &Trial<'_>, flight: &Flight, touch: Touch) -> Result<Meeting, Violation> {
    let (Touch { time, wall, .. }, rounding) = (touch, trial.rounding());
    let place = flight.position(time);
    require!(PART, "no early touch", trial.gap().is_below(rounding, place, time);
        "the gap to wall {wall} is open at {time:?}, on {flight:?}");
    check_surface(trial, touch, place)?;
    trial.check_seams(place, time)?;
    let surface = trial.boundary.surface(wall, place, time);
    let less = trial.radius - SMALLEST * trial.largest;
    let is_closed = trial.gap().is_below(2.0 * rounding - less, place - less * surface.normal, time);
    require!(PART, "sizes", is_closed;
        "a disk of radius {:?} at {place:?}, {time:?}, touches wall {wall}, but one that is smaller by {less:?} does not touch it at \
         the same point: walls tell disks apart by their kinds, not by their sizes", trial.radius);
    let velocity = flight.velocity(time);
    let rate = (velocity - surface.velocity).dot(surface.normal);
    let slow = GRAZING * (velocity.length() + surface.velocity.length());
    require!(PART, "approach", rate <= slow;
        "wall {wall} is touched at {time:?}, but left at {rate:?}, on {flight:?}");
    Ok(Meeting { touch, place, rate, is_grazing: rate > -slow, surface: seen(&surface) })
}

/// Checks that a flight that ends just after the touch, or begins at it, finds it.
fn check_limits(trial: &Trial<'_>, flight: &Flight, meeting: &Meeting) -> Result<(), Violation> {
    let Touch { time, wall, .. } = meeting.touch;
    if meeting.is_grazing {
        return Ok(());
    }
    // Rounding may have left the gap open. It then closes within this time.
    let slack = meeting.slack(trial);
    for start in [*flight, restarted(flight, time)] {
        let found = trial.first_touch(&start, time + slack)?;
        let is_found = found.is_some_and(|again| again.time >= time - slack && meeting.is(trial, again));
        require!(PART, "no missed touch", is_found;
            "wall {wall} is touched at {time:?}, but a search that ends just later finds {found:?}, on {start:?}");
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
    let earlier = 0.37 * origin.min(LATEST * trial.crossing());
    let shift = if state.is_empty() { earlier } else { -0.37 * start };
    let (position, velocity) = (flight.position(start), flight.velocity(start));
    let shifted = Flight::new(start + shift, position, velocity, flight.acceleration(), flight.radius())
        .with_kind(flight.kind());
    trial.set_origin(origin - shift);
    let found = trial.first_touch(&shifted, until + shift)?;
    let other = found.map(|touch| check_place(trial, &shifted, touch)).transpose();
    let after = meeting.map(|Meeting { touch: Touch { wall, time, .. }, place, .. }| {
        seen(&trial.boundary.surface(*wall, *place, time + shift))
    });
    trial.set_origin(origin);
    trial.take_state(&state)?;
    let other = other?;
    let later = |other: &Meeting| other.touch.time - shift;
    let ends = |one: &Meeting, time: f64| one.is_grazing || until - time < 2.0 * one.slack(trial);
    let agree = match (meeting, &other) {
        (None, None) => true,
        (Some(one), None) => ends(one, one.touch.time),
        (None, Some(one)) => ends(one, later(one)),
        (Some(one), Some(other)) => {
            let is_near = (one.touch.time - later(other)).abs() <= one.slack(trial);
            one.is_grazing || other.is_grazing || is_near && one.is(trial, other.touch)
        }
    };
    let (one, two) = (meeting.map(|one| one.touch), other.map(|other| other.touch));
    require!(PART, "time origin", agree;
        "an origin {shift:?} before {origin:?} changes the touch {one:?} to {two:?}: {flight:?}");
    let Some((before, after)) = meeting.map(|meeting| &meeting.surface).zip(after) else { return Ok(()) };
    require!(PART, "time origin", agrees(trial, before, &after);
        "an origin {shift:?} before {origin:?} changes {before:?} to {after:?}: {flight:?}");
    Ok(())
}

/// Returns the surface, with its response in words.
fn seen(surface: &Surface<'_>) -> (Surface<'static>, String) {
    let Surface { normal, velocity, kind, radius, mass, .. } = *surface;
    let bare = Surface::new(normal, velocity).with_kind(kind).with_radius(radius).with_mass(mass);
    let response = Surface::new(DVec2::Y, DVec2::ZERO).with_response(surface.response);
    (bare, in_words(&response, 20))
}

/// Returns whether two surfaces are the same up to the rounding error of late times, which shifts a wall that
/// moves.
fn agrees(trial: &Trial<'_>, one: &(Surface<'_>, String), two: &(Surface<'_>, String)) -> bool {
    let late = SAME * (1.0 + trial.origin / trial.crossing());
    // The difference of two infinite numbers is NaN.
    let is_near = |one: f64, two: f64| one == two || (one - two).abs() <= late * one.abs().min(two.abs());
    let ((one, response), (two, other)) = (one, two);
    one.normal.distance(two.normal) <= 100.0 * late
        && one.velocity.distance(two.velocity) <= SAME * one.velocity.length() + trial.speed * late
        && is_near(one.radius, two.radius)
        && is_near(one.mass, two.mass)
        && one.kind == two.kind
        && response == other
}

/// Returns the flight after the touch, as if wall and disk were elastic and smooth.
fn turned_back(flight: &Flight, meeting: &Meeting) -> Flight {
    let (time, normal) = (meeting.touch.time, meeting.surface.0.normal);
    let velocity = flight.velocity(time) - 2.0 * meeting.rate.min(0.0) * normal;
    Flight::new(time, meeting.place, velocity, flight.acceleration(), flight.radius())
        .with_kind(flight.kind())
}

/// Checks that `may_touch` and `may_meet` are true for regions that contain the position of a touch.
fn check_regions(trial: &Trial<'_>, touch: Touch, place: DVec2) -> Result<(), Violation> {
    for size in REGIONS.map(|size| size * trial.radius) {
        let [low, high] = [0.0, size].map(|size| DVec2::splat(size + trial.rounding()));
        for [low, high] in [[low, low], [high, high], [low, high], [high, low]] {
            let around = Region::new(place - low, place + high);
            check_region(trial, touch, around)?;
            check_region(trial, touch, open_at_edges(trial, around))?;
        }
    }
    let Region { min, max } = trial.rectangle();
    check_region(trial, touch, Region::new(min.min(place), max.max(place)))
}

fn check_region(trial: &Trial<'_>, Touch { time, wall, .. }: Touch, region: Region) -> Result<(), Violation> {
    for radius in [trial.radius, 1.5 * trial.radius] {
        let may = trial.boundary.may_touch(&region, radius);
        require!(PART, "may_touch", may;
            "a disk of radius {radius:?} touches in {region:?}, where it is denied");
        for until in [time, time + trial.crossing()] {
            let may = trial.boundary.may_meet(wall, &region, radius, until);
            require!(PART, "may_meet", may;
                "a disk meets wall {wall} in {region:?} at {time:?}, where it is denied up to {until:?}");
        }
    }
    Ok(())
}

/// Returns the region as the engine extends it: to infinity where it is near an edge of the domain.
fn open_at_edges(trial: &Trial<'_>, Region { min, max }: Region) -> Region {
    let (near, domain) = (2.0 * trial.radius, trial.domain.region());
    let has_walls = trial.domain.periods().cmpeq(DVec2::ZERO);
    let low = has_walls & min.cmplt(domain.min + near);
    let high = has_walls & max.cmpgt(domain.max - near);
    Region::new(DVec2::select(low, DVec2::NEG_INFINITY, min), DVec2::select(high, DVec2::INFINITY, max))
}
