//! A boundary under trial: places, sizes and the allowed rounding.

use glam::DVec2;

use super::violation::Violation;
use crate::Flight;
use crate::boundary::{Boundary, Domain, FirstTouch, Overlap, Probe, Region, Touch};

/// Allowed rounding, relative to the size of the domain.
const ROUNDING: f64 = 1e-9;

/// Largest number of searches that together follow one flight.
const MOST_SEARCHES: u32 = 10_000;

/// Sizes of the regions around a touch, relative to the radius. The smallest region is a point, up to
/// rounding.
const REGIONS: [f64; 3] = [0.0, 0.5, 5.0];

/// A boundary, and the numbers of its trial.
pub(super) struct Trial<'a, B: ?Sized> {
    pub(super) boundary: &'a mut B,
    pub(super) domain: Domain,
    pub(super) wall_count: usize,
    pub(super) radius: f64,
    pub(super) speed: f64,
    pub(super) origin: f64,
}

impl<'a, B: Boundary + ?Sized> Trial<'a, B> {
    pub(super) fn new(boundary: &'a mut B, domain: Domain, radius: f64, speed: f64) -> Self {
        let wall_count = boundary.wall_count();
        Self { boundary, domain, wall_count, radius, speed, origin: 0.0 }
    }

    /// Returns the size of the domain. If the domain is open above, this is its width.
    pub(super) fn length(&self) -> f64 {
        let height = self.domain.height();
        if height.is_finite() { self.domain.width().max(height) } else { self.domain.width() }
    }

    /// Returns the depth of an overlap that counts as rounding.
    pub(super) fn rounding(&self) -> f64 {
        let Domain { left, right, bottom, .. } = self.domain;
        ROUNDING * (self.length() + left.abs().max(right.abs()).max(bottom.abs()) + self.radius)
    }

    /// Returns the corners of the rectangle in which flights begin.
    pub(super) fn rectangle(&self) -> (DVec2, DVec2) {
        let Domain { left, right, bottom, top, .. } = self.domain;
        (DVec2::new(left, bottom), DVec2::new(right, top.min(bottom + self.length())))
    }

    pub(super) fn set_origin(&mut self, origin: f64) {
        self.boundary.set_time_origin(origin);
        self.origin = origin;
    }

    /// Returns the first touch of a flight. If the boundary answers that its search has not come to an end,
    /// this asks again, as the engine does.
    pub(super) fn first_touch(&self, flight: &Flight, until: f64) -> Result<Option<Touch>, Violation> {
        let mut rest = *flight;
        for _ in 0..MOST_SEARCHES {
            let open = match self.boundary.first_touch(&rest, until) {
                FirstTouch::At(touch) => return Ok(Some(touch)),
                FirstTouch::NotBefore(open) if open >= until => return Ok(None),
                FirstTouch::NotBefore(open) => open,
            };
            if open.is_nan() || open <= rest.time() {
                break;
            }
            let (place, velocity) = (flight.position(open), flight.velocity(open));
            rest = Flight::new(open, place, velocity, flight.acceleration(), flight.radius());
        }
        Err(Violation::NoProgress { time: rest.time(), flight: *flight })
    }

    /// Returns the wall that a disk with a radius larger by `more` overlaps at this place, and the depth.
    pub(super) fn depth(&self, place: DVec2, more: f64, time: f64) -> Option<Overlap> {
        self.boundary.overlap(&Probe::new(place, self.radius + more, time))
    }

    /// Checks that the domain and the number of walls have not changed.
    pub(super) fn check_constants(&self) -> Result<(), Violation> {
        let (now, walls) = (self.boundary.domain(), self.boundary.wall_count());
        if now != self.domain {
            return Err(Violation::DomainChanged { before: self.domain, now });
        }
        if walls != self.wall_count {
            return Err(Violation::WallsChanged { before: self.wall_count, now: walls });
        }
        Ok(())
    }

    /// Checks that `may_touch` is true for every region that contains this place of a touch.
    pub(super) fn check_regions(&self, place: DVec2) -> Result<(), Violation> {
        for size in REGIONS.map(|size| DVec2::splat(size * self.radius + self.rounding())) {
            let around = Region::new(place - size, place + size);
            for region in [around, self.open_at_edges(around)] {
                for radius in [self.radius, 1.5 * self.radius] {
                    if !self.boundary.may_touch(&region, radius) {
                        return Err(Violation::MayTouch { region, radius, place });
                    }
                }
            }
        }
        Ok(())
    }

    /// Returns the region, extended as the engine does it: to infinity where it is near an edge of the
    /// domain.
    fn open_at_edges(&self, region: Region) -> Region {
        let Domain { left, right, bottom, top, periodic_sides, periodic_ends } = self.domain;
        let near = 2.0 * self.radius;
        let open = |is_near: bool, edge: f64, end: f64| if is_near { end } else { edge };
        let Region { min, max } = region;
        Region::new(
            DVec2::new(
                open(!periodic_sides && min.x < left + near, min.x, f64::NEG_INFINITY),
                open(!periodic_ends && min.y < bottom + near, min.y, f64::NEG_INFINITY),
            ),
            DVec2::new(
                open(!periodic_sides && max.x > right - near, max.x, f64::INFINITY),
                open(!periodic_ends && max.y > top - near, max.y, f64::INFINITY),
            ),
        )
    }
}
