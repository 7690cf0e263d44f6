//! Checks of a boundary's contract, for boundaries of your own.
//!
//! [`check`] sends disks on random flights between the walls, and checks every answer of the boundary about
//! them.

mod flight;
mod trial;
mod violation;

pub use violation::Violation;

use glam::DVec2;
use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;

use super::{Boundary, Domain};
use crate::Flight;
use crate::random::uniform;
use flight::check_flights;
use trial::Trial;

/// Number of disks that are sent on flights.
const DISKS: usize = 400;

/// Number of flights of each disk, from touch to touch.
const FLIGHTS: usize = 4;

/// Number of attempts to find a free place for a disk.
const PLACES: usize = 10_000;

/// Largest time origin of a flight, in units of the time that a disk takes to cross the domain.
const LATEST: f64 = 100.0;

/// Checks that a boundary keeps its contract with disks of this radius, on random flights at about this
/// speed.
///
/// Each of four hundred disks flies from a free place, with or without gravity, at various times. A wall that
/// it touches turns it back, for up to four flights in a row. The check requires of each flight:
/// - At samples along the flight, the disk neither overlaps a wall nor leaves the domain before the touch, or
///   before the end of the flight if there is no touch.
/// - The touch is neither before the flight nor after its limit. Its wall exists, and the gap to that wall is
///   closed up to rounding. The disk approaches the wall there, and would touch it again at once if it did
///   not turn.
/// - The normal is a unit vector, a disk that is moved along it comes out of the wall, and the velocity is
///   finite.
/// - `may_touch` holds for all kinds of regions around the touch, also for those that extend to infinity at
///   the edges of the domain.
/// - With another time origin, the same flight touches at the same absolute time.
/// - The domain and the number of walls stay the same, and the interior lies in the domain.
///
/// The speed should be typical of your disks, so that they meet moving walls at all phases of the motion. The
/// check changes the boundary's time origin.
///
/// # Errors
/// The first violation that the check finds, with the flight on which it was found.
///
/// ```
/// use granular_edmd::boundary::{Container, Wall, laws};
/// use granular_edmd::wall::BiParabolic;
/// let mut container = Container::closed(8.0, 6.0)?.with_motion(Wall::Floor, BiParabolic::new(0.1, 10.0)?)?;
/// assert_eq!(laws::check(&mut container, 0.5, 1.0, 42), Ok(()));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn check<B: Boundary + ?Sized>(
    boundary: &mut B,
    radius: f64,
    speed: f64,
    seed: u64,
) -> Result<(), Violation> {
    let domain = boundary.domain();
    check_rectangles(&domain, &boundary.interior())?;
    // Messages contain names, even of walls that do not exist. Asking for a name must not panic.
    for wall in [0, boundary.wall_count(), usize::MAX] {
        drop(boundary.wall_name(wall));
    }
    let mut trial = Trial::new(boundary, domain, radius, speed);
    let mut random = Random(Xoshiro256PlusPlus::seed_from_u64(seed));
    for _ in 0..DISKS {
        let (origin, flight) = random.flight(&mut trial)?;
        trial.set_origin(origin);
        check_flights(&mut trial, flight, FLIGHTS)?;
    }
    Ok(())
}

/// Checks that the domain is a rectangle, open above at most, and that it contains the interior.
fn check_rectangles(domain: &Domain, interior: &Domain) -> Result<(), Violation> {
    let is_bounded = [domain.left, domain.right, domain.bottom].iter().all(|edge| edge.is_finite());
    if !(is_bounded && domain.left < domain.right && domain.bottom < domain.top) {
        return Err(Violation::Domain { domain: *domain });
    }
    let is_inside = domain.left <= interior.left
        && interior.right <= domain.right
        && domain.bottom <= interior.bottom
        && interior.top <= domain.top
        && domain.periodic_sides == interior.periodic_sides
        && domain.periodic_ends == interior.periodic_ends;
    if is_inside { Ok(()) } else { Err(Violation::Interior { interior: *interior, domain: *domain }) }
}

/// A generator of random flights.
struct Random(Xoshiro256PlusPlus);

impl Random {
    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * uniform(&mut self.0)
    }

    /// Returns a time origin, and a flight that begins at a free place soon after it.
    fn flight<B: Boundary + ?Sized>(&mut self, trial: &mut Trial<'_, B>) -> Result<(f64, Flight), Violation> {
        let crossing = trial.length() / trial.speed;
        let origin = self.between(0.0, LATEST * crossing);
        let time = self.between(0.0, crossing);
        trial.set_origin(origin);
        let position = self.place(trial, time)?;
        let speed = trial.speed * self.between(0.1, 3.0);
        // The direction comes from a point in a square, not from an angle: sine and cosine differ
        // between platforms.
        let direction = DVec2::new(self.between(-1.0, 1.0), self.between(-1.0, 1.0)).normalize_or(DVec2::X);
        let pull = trial.speed * trial.speed / trial.length();
        let choice = self.between(0.0, 4.0);
        let gravity = [0.0, 0.5 * pull, 4.0 * pull, -pull][choice as usize];
        // A third of the pulls are not vertical.
        let down = if choice.fract() < 1.0 / 3.0 { DVec2::new(0.6, -0.8) } else { DVec2::NEG_Y };
        let acceleration = gravity * down;
        Ok((origin, Flight::new(time, position, speed * direction, acceleration, trial.radius)))
    }

    /// Returns a place in the domain where a disk overlaps no wall.
    fn place<B: Boundary + ?Sized>(&mut self, trial: &Trial<'_, B>, time: f64) -> Result<DVec2, Violation> {
        let (low, high) = trial.rectangle();
        let place = (0..PLACES)
            .map(|_| DVec2::new(self.between(low.x, high.x), self.between(low.y, high.y)))
            .find(|&place| trial.depth(place, 0.0, time).is_none());
        place.ok_or(Violation::NoRoom { radius: trial.radius, time })
    }
}
