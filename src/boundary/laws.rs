//! Checks of a boundary's contract, for custom boundaries.
//!
//! [`check`] sends disks on random flights between the walls. It takes the gap between a disk and the nearest
//! wall from [`overlap`](Boundary::overlap), and compares all other results with this gap: a touch is its
//! first root along the flight, the normal its gradient, and the free area the area in which it is positive.

mod area;
mod flight;
mod meeting;
mod reaction;
mod surface;
mod trial;

use area::check_areas;
use flight::check_flights;
use glam::DVec2;
use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;
use trial::{PART, Trial};

use super::{Boundary, Domain, Region};
use crate::error::require;
use crate::random::uniform;
use crate::{Flight, Kind, Violation};

/// Number of disks that fly in the check.
const DISKS: usize = 400;

/// Number of flights of each disk, from touch to touch.
const FLIGHTS: usize = 4;

/// Number of attempts to find a free position for a disk.
const PLACES: usize = 10_000;

/// Largest time origin of a flight, in units of the time that a disk takes to cross the domain.
const LATEST: f64 = 100.0;

/// Kinds of the disks, through which the check cycles.
const KINDS: [u16; 8] = [0, 1, 0, 2, 0, 3, 300, 7];

/// Smallest size of the disks, relative to the given radius.
const SMALLEST: f64 = 0.3;

/// Checks that a boundary keeps its contract with disks of this radius and of radii down to 0.3 times it, on
/// random flights at about this speed and from rest.
///
/// Each of four hundred disks, of the kinds 0 to 3, 7 and 300, flies from a free position, with or without
/// gravity, at various speeds, at times up to a hundred times the time in which it crosses the domain, and
/// seldom later. Each wall that it touches reflects it, for up to four flights in a row. The check requires
/// of each flight:
/// - At samples along the flight, the disk neither overlaps a wall nor leaves the domain before the touch, or
///   before the end of the flight if there is no touch.
/// - The touch is neither before the flight nor after its limit. Its wall exists, and the gap to that wall is
///   closed up to rounding. The disk approaches the wall there, and would touch it again immediately if it
///   did not turn. A search that ends just after the touch finds it, too, and a second search finds the same.
///   A smaller disk touches the wall at the same point. Walls with the same surface at a place are not told
///   apart.
/// - The normal is a unit vector and the gradient of the gap. The velocity of the surface along the normal is
///   the rate at which the wall moves there, and the radius of the surface is its radius of curvature. The
///   angular velocity agrees with the velocities of the points beside the touch.
/// - `may_touch` and `may_meet` hold for all kinds of regions around the touch, including regions that extend
///   to infinity at the edges of the domain. `may_meet` of a wall also holds where walls that a blow on this
///   wall moves reach disks at rest.
/// - With another time origin, the same flight touches the same wall at the same absolute time, and finds the
///   same surface with the same response.
/// - A wall that reacts to an impact moves according to its mass, also after an earlier impact, and does not
///   jump. `state` and `set_state` restore all walls. An impact on a wall whose mass is infinite changes no
///   gap, now or later. A stop that takes the impulse of a wall, as a [`Piston`](crate::wall::Piston) has it,
///   is refused.
/// - The domain and the number of walls stay the same, and the interior lies in the domain. On both sides of
///   a periodic seam, a disk is equally deep in a wall.
///
/// If the boundary knows its free `area`, the check computes the same area from the gaps to the walls, which
/// it measures by the overlaps of larger disks. Both areas must agree to 2e-5 of the region, for centers of
/// disks and for matter (radius 0). Along thin walls, which leave no gap behind them, the area of matter may
/// be too large by about 1e-3 of the region.
///
/// The speed should be typical of your disks, so that they meet moving walls at all phases of the motion. The
/// check leaves the boundary with the time origin 0, in its initial state.
///
/// # Errors
/// Returns the first violation that the check finds, with the flight on which it was found. The page
/// "Validation" says which planted faults the check finds.
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
    // Messages contain names. Asking for a name must not panic.
    (0..boundary.wall_count()).for_each(|wall| drop(boundary.wall(wall, 0.0)));
    let mut boundary = boundary;
    let mut trial = Trial::new(&mut boundary, domain, radius, speed);
    let mut random = Random(Xoshiro256PlusPlus::seed_from_u64(seed));
    for number in 0..DISKS {
        check_disk(&mut trial, &mut random, number)?;
    }
    trial.begin(0.0)
}

/// Checks the flights of one disk, and some areas.
fn check_disk(trial: &mut Trial<'_>, random: &mut Random, number: usize) -> Result<(), Violation> {
    let sizes = [1.0, 1.0, random.between(SMALLEST, 1.0), 0.7, SMALLEST];
    trial.radius = trial.largest * sizes[number % sizes.len()];
    trial.kind = Kind::new(KINDS[number % KINDS.len()]);
    let flight = random.flight(trial)?;
    trial.check_seams(flight.position(flight.time()), flight.time())?;
    check_flights(trial, flight, FLIGHTS)?;
    // Disks of all sizes.
    if number % 41 == 4 { check_areas(trial, flight.time(), random) } else { Ok(()) }
}

/// Checks that the domain is a rectangle, which may be open only above, and that it contains the interior.
fn check_rectangles(domain: &Domain, interior: &Domain) -> Result<(), Violation> {
    let Region { min, max } = domain.region();
    let is_rectangle = min.is_finite() && max.x.is_finite() && min.cmplt(max).all();
    require!(PART, "domain", is_rectangle;
        "the domain {domain} is not a rectangle with a finite bottom and sides");
    let Region { min, max } = interior.region();
    let are_alike = [domain, interior].map(|domain| [domain.periodic_sides, domain.periodic_ends]);
    let is_inside = domain.contains(min, 0.0) && domain.contains(max, 0.0) && are_alike[0] == are_alike[1];
    require!(PART, "interior", is_inside; "the interior {interior} is not inside the domain {domain}");
    Ok(())
}

/// A generator of random flights.
struct Random(Xoshiro256PlusPlus);

impl Random {
    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * uniform(&mut self.0)
    }

    /// Sets a time origin, and returns a flight that begins at a free position soon after this time.
    fn flight(&mut self, trial: &mut Trial<'_>) -> Result<Flight, Violation> {
        let crossing = trial.crossing();
        let late = self.between(-21.0, 3.0).max(0.0);
        let origin = self.between(0.0, LATEST * crossing) * libm::exp10(late);
        let time = self.between(0.0, crossing);
        trial.begin(origin)?;
        let place = self.place(trial, time)?;
        let speed = trial.speed * self.share();
        // The direction comes from a point in a square, not from an angle: sine and cosine differ
        // between platforms.
        let direction = DVec2::new(self.between(-1.0, 1.0), self.between(-1.0, 1.0)).normalize_or(DVec2::X);
        let pull = trial.speed * trial.speed / trial.length();
        let choice = self.between(0.0, 4.0);
        let gravity = [0.0, 0.5 * pull, 4.0 * pull, -pull][choice as usize];
        // A third of the pulls are not vertical.
        let down = if choice.fract() < 1.0 / 3.0 { DVec2::new(0.6, -0.8) } else { DVec2::NEG_Y };
        Ok(trial.flight(time, place, speed * direction, gravity * down))
    }

    /// Returns a speed in units of the typical speed: mostly about 1, sometimes from a range of several
    /// decades, seldom very slow or at rest.
    fn share(&mut self) -> f64 {
        match self.between(0.0, 8.5) as u32 {
            8 => 0.0,
            0..=4 => self.between(0.1, 4.0),
            5 | 6 => libm::exp10(self.between(-2.2, 0.6)),
            _ => libm::exp10(self.between(-10.0, -2.0)),
        }
    }

    /// Returns a position in the domain at which a disk overlaps no wall.
    fn place(&mut self, trial: &Trial<'_>, time: f64) -> Result<DVec2, Violation> {
        let (Region { min, max }, radius) = (trial.rectangle(), trial.radius);
        (0..PLACES)
            .map(|_| DVec2::new(self.between(min.x, max.x), self.between(min.y, max.y)))
            .find(|&place| !trial.gap().is_below(0.0, place, time))
            .ok_or_else(|| Violation::new(PART, "room", format!("there is none for the radius {radius:?}")))
    }
}
