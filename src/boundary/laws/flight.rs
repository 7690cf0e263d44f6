//! A flight under trial, from its start to its touch.

use glam::DVec2;

use super::trial::Trial;
use super::violation::Violation;
use crate::Flight;
use crate::boundary::{Boundary, Overlap, Response, Surface, Touch};

/// Number of samples along a flight.
const SAMPLES: u32 = 200;

/// Longest flight, in units of the time that a disk takes to cross the domain.
const LONGEST: f64 = 3.0;

/// Closing speed below which a touch is grazing, as a fraction of the speeds. Rounding decides the time of
/// such a touch, or that there is none.
const GRAZING: f64 = 1e-2;

/// Fraction of the radius by which a disk is moved to probe a wall.
const STEP: f64 = 1e-3;

/// Largest errors of a normal: of its squared length, and of its direction. The direction is judged by the
/// depths of disks moved along it.
const UNIT: f64 = 1e-9;
const SLOPE: f64 = 0.2;

/// A touch that was found, and how the disk meets the wall.
struct Meeting {
    touch: Touch,
    place: DVec2,
    /// Velocity of the disk.
    velocity: DVec2,
    /// Speed at which the gap opens; negative while it closes.
    rate: f64,
    /// True if the gap closes so slowly that rounding decides.
    is_grazing: bool,
}

/// Checks consecutive flights of a disk. Each wall that the disk touches turns it back.
pub(super) fn check_flights<B: Boundary + ?Sized>(
    trial: &mut Trial<'_, B>,
    first: Flight,
    flights: usize,
) -> Result<(), Violation> {
    let mut flight = first;
    for _ in 0..flights {
        let touched = check_flight(trial, &flight)?;
        trial.check_constants()?;
        match touched {
            Some(next) => flight = next,
            None => break,
        }
    }
    Ok(())
}

/// Checks a flight, and returns the next one, which begins where a wall turned this one back.
fn check_flight<B: Boundary + ?Sized>(
    trial: &mut Trial<'_, B>,
    flight: &Flight,
) -> Result<Option<Flight>, Violation> {
    let until = flight.time() + longest(trial, flight);
    let found = trial.first_touch(flight, until)?;
    if let Some(touch) = found {
        check_touch(trial, flight, touch, until)?;
    }
    check_way(trial, flight, found.map_or(until, |touch| touch.time), found)?;
    if found.is_some_and(|touch| is_absorbed(trial, flight, touch)) {
        return Ok(None);
    }
    let meeting = found.map(|touch| check_place(trial, flight, touch)).transpose()?;
    check_origin(trial, flight, until, meeting.as_ref())?;
    let Some(meeting) = meeting else { return Ok(None) };
    check_limits(trial, flight, &meeting)?;
    trial.check_regions(meeting.place)?;
    Ok(Some(turned_back(trial, flight, &meeting)))
}

/// Returns how long a flight may last. Like flights of the engine, it ends at a periodic side or end at
/// the latest.
fn longest<B: Boundary + ?Sized>(trial: &Trial<'_, B>, flight: &Flight) -> f64 {
    let longest = LONGEST * trial.length() / trial.speed;
    let (domain, start) = (trial.domain, flight.time());
    let (place, velocity) = (flight.position(start), flight.velocity(start));
    let pull = flight.acceleration();
    let mut longest = longest;
    if domain.periodic_sides {
        let ahead = if velocity.x > 0.0 { domain.right - place.x } else { place.x - domain.left };
        let nearer = (domain.right - place.x).min(place.x - domain.left);
        let way = if pull.x == 0.0 { ahead } else { nearer };
        longest = longest.min(shortest_wait(way, velocity.x, pull.x));
    }
    if domain.periodic_ends {
        let way = (domain.top - place.y).min(place.y - domain.bottom);
        longest = longest.min(shortest_wait(way, velocity.y, pull.y));
    }
    longest
}

/// Returns the duration of a flight that goes no further than `way`, in whichever direction it turns:
/// |v| t + |a| t² / 2 is at most this way.
fn shortest_wait(way: f64, velocity: f64, pull: f64) -> f64 {
    let (way, speed) = (way.max(0.0), velocity.abs());
    2.0 * way / (speed + (speed * speed + 2.0 * pull.abs() * way).sqrt())
}

/// Tells whether the flight ends at a sink. It may take a disk out without a touch, when the center arrives.
fn is_absorbed<B: Boundary + ?Sized>(trial: &Trial<'_, B>, flight: &Flight, touch: Touch) -> bool {
    let place = flight.position(touch.time);
    matches!(trial.boundary.surface(touch.wall, place, touch.time).response, Response::Absorbing)
}

fn check_touch<B: Boundary + ?Sized>(
    trial: &Trial<'_, B>,
    flight: &Flight,
    touch: Touch,
    until: f64,
) -> Result<(), Violation> {
    if !(touch.time >= flight.time() && touch.time <= until) {
        return Err(Violation::TouchTime { time: touch.time, until, flight: *flight });
    }
    let count = trial.wall_count;
    if touch.wall >= count {
        return Err(Violation::TouchWall { wall: touch.wall, count, flight: *flight });
    }
    Ok(())
}

/// Checks that a disk overlaps no wall and stays in the domain on its way.
fn check_way<B: Boundary + ?Sized>(
    trial: &Trial<'_, B>,
    flight: &Flight,
    end: f64,
    found: Option<Touch>,
) -> Result<(), Violation> {
    let (domain, rounding) = (trial.domain, trial.rounding());
    for k in 0..=SAMPLES {
        let time = (flight.time() + (end - flight.time()) * f64::from(k) / f64::from(SAMPLES)).min(end);
        let place = flight.position(time);
        if let Some(Overlap { with: wall, depth }) = trial.depth(place, -rounding, time) {
            let (found, flight) = (found.map(|touch| touch.time), *flight);
            return Err(Violation::LetThrough { wall, depth, time, found, flight });
        }
        if !domain.contains(place, rounding) {
            return Err(Violation::LeftDomain { place, time, flight: *flight });
        }
    }
    Ok(())
}

/// Checks that the gap is closed at the touch, and that the surface there points out of the wall.
fn check_place<B: Boundary + ?Sized>(
    trial: &Trial<'_, B>,
    flight: &Flight,
    touch: Touch,
) -> Result<Meeting, Violation> {
    let place = flight.position(touch.time);
    if trial.depth(place, trial.rounding(), touch.time).is_none() {
        return Err(Violation::EarlyTouch { wall: touch.wall, time: touch.time, flight: *flight });
    }
    let surface = trial.boundary.surface(touch.wall, place, touch.time);
    check_surface(trial, touch, place, &surface)?;
    let velocity = flight.velocity(touch.time);
    let relative = velocity - surface.velocity;
    let rate = relative.dot(surface.normal);
    let speed = velocity.length() + surface.velocity.length();
    if rate > GRAZING * speed {
        return Err(Violation::Leaving { wall: touch.wall, rate, time: touch.time, flight: *flight });
    }
    Ok(Meeting { touch, place, velocity, rate, is_grazing: rate > -GRAZING * speed })
}

/// Checks that the normal is a unit vector, that a disk moved along it comes out of the wall, and that the
/// velocity of the wall is finite.
fn check_surface<B: Boundary + ?Sized>(
    trial: &Trial<'_, B>,
    touch: Touch,
    place: DVec2,
    surface: &Surface<'_>,
) -> Result<(), Violation> {
    let Touch { wall, time, .. } = touch;
    let normal = surface.normal;
    if !normal.is_finite() || (normal.length_squared() - 1.0).abs() > UNIT {
        return Err(Violation::NormalLength { wall, normal, place, time });
    }
    if !surface.velocity.is_finite() {
        return Err(Violation::Velocity { wall, velocity: surface.velocity, time });
    }
    let step = STEP * trial.radius;
    let none = Overlap::new(wall, 0.0);
    let depth = |place: DVec2| trial.depth(place, 2.0 * step, time).unwrap_or(none);
    let (here, inward, outward) = (depth(place), depth(place - step * normal), depth(place + step * normal));
    // In a corner, another wall may be the deepest one, before the step and after it.
    let is_alone = here.with == wall && outward.with == wall;
    let comes_out = (here.depth - outward.depth - step).abs() <= SLOPE * step;
    let goes_in = inward.depth - here.depth >= (1.0 - SLOPE) * step;
    if goes_in && (comes_out || !is_alone) {
        Ok(())
    } else {
        Err(Violation::NormalDirection { wall, normal, place, time })
    }
}

/// Checks that a flight which ends before the touch finds none, and that a flight which begins at the touch
/// finds it at once.
fn check_limits<B: Boundary + ?Sized>(
    trial: &Trial<'_, B>,
    flight: &Flight,
    meeting: &Meeting,
) -> Result<(), Violation> {
    let time = meeting.touch.time;
    let half = flight.time() + 0.5 * (time - flight.time());
    if let Some(early) = trial.first_touch(flight, half)?
        && time > half
    {
        return Err(Violation::TouchTime { time: early.time, until: half, flight: *flight });
    }
    if meeting.is_grazing {
        return Ok(());
    }
    let going_on = Flight::new(time, meeting.place, meeting.velocity, flight.acceleration(), flight.radius());
    // Rounding may have left the gap open. It then closes within this time.
    let soon = time + 4.0 * trial.rounding() / meeting.rate.abs();
    match trial.first_touch(&going_on, soon)? {
        Some(again) if again.time >= time && again.time <= soon => Ok(()),
        _ => Err(Violation::Missed { wall: meeting.touch.wall, flight: going_on }),
    }
}

/// Checks that the same flight, given relative to another time origin, touches at the same absolute time.
///
/// Rounding decides a grazing touch, or one just before the flight is over, so it may be found with one
/// origin only.
fn check_origin<B: Boundary + ?Sized>(
    trial: &mut Trial<'_, B>,
    flight: &Flight,
    until: f64,
    meeting: Option<&Meeting>,
) -> Result<(), Violation> {
    let (origin, start) = (trial.origin, flight.time());
    // The other origin is earlier, so that no offset is negative.
    let shift = 0.37 * origin;
    let (position, velocity) = (flight.position(start), flight.velocity(start));
    let shifted = Flight::new(start + shift, position, velocity, flight.acceleration(), flight.radius());
    trial.set_origin(origin - shift);
    let found = trial.first_touch(&shifted, until + shift)?;
    let other = found.map(|touch| check_place(trial, &shifted, touch)).transpose();
    trial.set_origin(origin);
    // The other touch, relative to the first origin.
    let other = other?
        .map(|other| Meeting { touch: Touch::new(other.touch.time - shift, other.touch.wall), ..other });
    let agree = match (meeting, &other) {
        (None, None) => true,
        (Some(one), None) | (None, Some(one)) => {
            one.is_grazing || until - one.touch.time < 2.0 * slack(trial, one)
        }
        (Some(one), Some(other)) => {
            let apart = (one.touch.time - other.touch.time).abs();
            one.is_grazing || other.is_grazing || apart <= slack(trial, one)
        }
    };
    let time = |meeting: &Meeting| meeting.touch.time;
    let (before, after) = (meeting.map(time), other.as_ref().map(time));
    if agree { Ok(()) } else { Err(Violation::TimeOrigin { origin, shift, before, after, flight: *flight }) }
}

/// Returns the uncertainty of the time of a touch: the time in which the gap closes by its rounding.
fn slack<B: Boundary + ?Sized>(trial: &Trial<'_, B>, meeting: &Meeting) -> f64 {
    4.0 * trial.rounding() / meeting.rate.abs()
}

/// Returns the flight after the touch, as if wall and disk were elastic and smooth.
fn turned_back<B: Boundary + ?Sized>(trial: &Trial<'_, B>, flight: &Flight, meeting: &Meeting) -> Flight {
    let time = meeting.touch.time;
    let surface = trial.boundary.surface(meeting.touch.wall, meeting.place, time);
    let velocity = meeting.velocity - 2.0 * meeting.rate.min(0.0) * surface.normal;
    Flight::new(time, meeting.place, velocity, flight.acceleration(), flight.radius())
}
