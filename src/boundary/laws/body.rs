//! The check that walls answer blows as the surfaces of bodies do.
//!
//! A blow on a body moves its other surfaces, too. The speed that it gives them along some direction is the
//! speed that the same blow there, along this direction, would give here along its own: bodies have a kinetic
//! energy, so their responses are symmetric. A peg that floats and has no tangential mass breaks this law. A
//! blow on its front moves its flank along the surface, but a blow along the flank would move nothing. The
//! energy of disks that rub against it grows without limit.

use glam::DVec2;

use super::trial::{PART, Trial};
use crate::Violation;
use crate::boundary::{Boundary, Impact, Response, Surface, Touch};
use crate::collision::laws::hostile_contacts;
use crate::violation::require;

/// Largest gap to a wall, or depth in it, at which a disk stands for one of another size that touches the
/// wall; also the distance between places along the wall. Both relative to the radius.
const NEAR: f64 = 0.5;

/// Largest difference between the speeds that two equal blows give, relative to the typical speed and to the
/// speeds of the walls.
const SAME: f64 = 1e-6;
const ROUNDING: f64 = 1e-12;

/// A place from which a disk touches a wall.
struct Spot {
    wall: usize,
    place: DVec2,
    point: DVec2,
    /// Into the wall, and along its surface if a disk can push it there.
    directions: Vec<DVec2>,
    /// The smallest mass, possibly infinite.
    mass: f64,
}

impl Spot {
    /// Returns the spot of a disk with this radius, which may be another one than that of the trial.
    fn new(trial: &Trial<'_>, Touch { wall, time, .. }: Touch, place: DVec2, radius: f64) -> Self {
        let surface = trial.boundary.surface(wall, place, time);
        let (normal, mass) = (surface.normal, surface.mass.min(surface.tangential_mass));
        let along = Some(normal.perp()).filter(|_| has_friction(&surface));
        let directions = std::iter::once(-normal).chain(along).collect();
        Self { wall, place, point: place - radius * normal, directions, mass }
    }

    /// Returns the spot at the wall nearest to a place, if one is near.
    fn near(trial: &Trial<'_>, place: DVec2, time: f64) -> Option<Self> {
        let larger = NEAR * trial.radius;
        let found = trial.depth(place, larger, time).filter(|found| found.with < trial.wall_count)?;
        let radius = trial.radius + larger - found.depth;
        (radius > NEAR * trial.radius).then(|| Self::new(trial, Touch::new(time, found.with), place, radius))
    }
}

/// Returns whether disks may push a wall along its surface. The rule of the disks is not known.
pub(super) fn has_friction(surface: &Surface<'_>) -> bool {
    match surface.response {
        Response::Thermal(thermal) => !thermal.slip(),
        Response::Rule(rule) => hostile_contacts().any(|contact| rule.impulse(&contact).tangential() != 0.0),
        _ => true,
    }
}

/// Checks that a blow at a touch moves other surfaces as blows there would move the surface at the touch.
pub(super) fn check_body(trial: &mut Trial<'_>, touch: Touch, place: DVec2) -> Result<(), Violation> {
    let time = touch.time;
    let here = Spot::new(trial, touch, place, trial.radius);
    let (low, high) = trial.rectangle();
    let step = NEAR * trial.radius * here.directions[0].perp();
    let beside = [place - step, place + step].into_iter();
    let is_inside = |place: &DVec2| place.clamp(low, high) == *place;
    let places = beside.chain(trial.places()).filter(is_inside);
    let spots: Vec<_> = places.filter_map(|place| Spot::near(trial, place, time)).collect();
    for there in spots {
        for &one in &here.directions {
            for &other in &there.directions {
                check_pair(trial, time, (&here, one), (&there, other))?;
            }
        }
    }
    Ok(())
}

fn check_pair(
    trial: &mut Trial<'_>,
    time: f64,
    (here, one): (&Spot, DVec2),
    (there, other): (&Spot, DVec2),
) -> Result<(), Violation> {
    let blow = trial.speed * here.mass.min(there.mass);
    let [forth, speed] = gain(trial, time, (here, blow * one), (there, other))?;
    let [back, own] = gain(trial, time, (there, blow * other), (here, one))?;
    let slack = SAME * trial.speed + ROUNDING * (speed + own);
    require!(PART, "reaction", (forth - back).abs() <= slack;
        "a blow {blow:?} along {one:?} on wall {} at {:?}, time {time:?}, gives wall {} at {:?} the speed {forth:?} along \
         {other:?}, but such a blow there gives {back:?} here: bodies answer alike; a wall that blows move along its surface has a \
         tangential mass, or a response without friction",
        here.wall, here.point, there.wall, there.point);
    Ok(())
}

/// Returns the speed that a blow on one wall gives to another in this direction, and the speed of the latter.
fn gain(
    trial: &mut Trial<'_>,
    time: f64,
    (struck, impulse): (&Spot, DVec2),
    (seen, direction): (&Spot, DVec2),
) -> Result<[f64; 2], Violation> {
    let state = trial.boundary.state();
    let velocity = |trial: &Trial<'_>| trial.boundary.surface(seen.wall, seen.place, time).velocity;
    let before = velocity(trial);
    trial.boundary.react(&Impact::new(struck.wall, impulse, struck.point, time));
    let gained = (velocity(trial) - before).dot(direction);
    trial.take_state(&state)?;
    Ok([gained, before.length()])
}
