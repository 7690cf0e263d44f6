//! A boundary under test, the gap between a disk and its nearest wall, and the allowed rounding.

use glam::DVec2;

use crate::boundary::{Boundary, Domain, FirstTouch, Probe, Region, Touch};
use crate::error::require;
use crate::{Flight, Kind, Violation};

pub(super) const PART: &str = "boundary";

/// Allowed rounding, relative to the size of the domain.
const ROUNDING: f64 = 1e-9;

/// Longest flight, in units of the time that a disk takes to cross the domain.
const LONGEST: f64 = 3.0;

/// Largest number of searches that together follow one flight.
const MOST_SEARCHES: u32 = 10_000;

/// The gap between a disk and the nearest wall: negative inside a wall.
///
/// All laws of walls follow from this function of place and time. A flight touches a wall at the first root
/// of the gap along the flight; the normal is its gradient, the velocity along the normal is its rate with
/// the opposite sign, the curvature its second derivative, and the free area is where it is positive.
#[derive(Clone, Copy)]
pub(super) struct Gap<'a> {
    pub(super) boundary: &'a dyn Boundary,
    pub(super) radius: f64,
    pub(super) kind: Kind,
}

impl Gap<'_> {
    /// Returns the nearest wall and the gap to it, or `None` if all walls are farther than `reach`. The reach
    /// may be negative: then the disk must be deeper in a wall.
    pub(super) fn nearest(&self, place: DVec2, reach: f64, time: f64) -> Option<(usize, f64)> {
        let probe = Probe::new(place, self.radius + reach, time).with_kind(self.kind);
        self.boundary.overlap(&probe).map(|found| (found.with, reach - found.depth))
    }

    /// Returns the gap, at most `reach`.
    pub(super) fn at(&self, place: DVec2, reach: f64, time: f64) -> f64 {
        self.nearest(place, reach, time).map_or(reach, |(_, gap)| gap)
    }

    /// Returns whether the gap is less than `slack`.
    pub(super) fn is_below(&self, slack: f64, place: DVec2, time: f64) -> bool {
        self.nearest(place, slack, time).is_some()
    }
}

/// A boundary under test, and the numbers of the test.
pub(super) struct Trial<'a> {
    pub(super) boundary: &'a mut dyn Boundary,
    pub(super) domain: Domain,
    pub(super) wall_count: usize,
    /// The radii of the largest disks and of the present disk.
    pub(super) largest: f64,
    pub(super) radius: f64,
    pub(super) kind: Kind,
    pub(super) speed: f64,
    pub(super) origin: f64,
    /// The initial state of the walls.
    pub(super) state: Vec<f64>,
}

impl<'a> Trial<'a> {
    pub(super) fn new(boundary: &'a mut dyn Boundary, domain: Domain, radius: f64, speed: f64) -> Self {
        let (wall_count, state) = (boundary.wall_count(), boundary.state());
        let (largest, kind, origin) = (radius, Kind::DEFAULT, 0.0);
        Self { boundary, domain, wall_count, largest, radius, kind, speed, origin, state }
    }

    /// Returns the gap of the present disk.
    pub(super) fn gap(&self) -> Gap<'_> {
        Gap { boundary: &*self.boundary, radius: self.radius, kind: self.kind }
    }

    /// Returns the larger side of the domain, or its width if the domain is open above.
    pub(super) fn length(&self) -> f64 {
        let height = self.domain.height();
        if height.is_finite() { self.domain.width().max(height) } else { self.domain.width() }
    }

    /// Returns the time in which a disk crosses the domain.
    pub(super) fn crossing(&self) -> f64 {
        self.length() / self.speed
    }

    /// Returns the largest number in the coordinates of a disk and its surface.
    pub(super) fn extent(&self) -> f64 {
        let Domain { left, right, bottom, .. } = self.domain;
        self.length() + left.abs().max(right.abs()).max(bottom.abs()) + self.radius
    }

    /// Returns the depth of an overlap that counts as rounding.
    pub(super) fn rounding(&self) -> f64 {
        ROUNDING * self.extent()
    }

    /// Returns the rectangle in which flights begin.
    pub(super) fn rectangle(&self) -> Region {
        let Region { min, max } = self.domain.region();
        Region::new(min, DVec2::new(max.x, max.y.min(min.y + self.length())))
    }

    /// Returns places all over the domain. In a box of a usual shape, none of them is equally far from two
    /// walls, where rounding would decide which wall is the nearest.
    pub(super) fn places(&self) -> impl Iterator<Item = DVec2> + use<> {
        let Region { min, max } = self.rectangle();
        let (across, up) = ([0.05, 0.35, 0.65, 0.95], [0.061_83, 0.343_37, 0.671_19, 0.928_61]);
        across.into_iter().flat_map(move |x| up.map(move |y| min + DVec2::new(x, y) * (max - min)))
    }

    pub(super) fn set_origin(&mut self, origin: f64) {
        self.boundary.set_time_origin(origin);
        self.origin = origin;
    }

    /// Sets a time origin, and the initial state of the walls.
    pub(super) fn begin(&mut self, origin: f64) -> Result<(), Violation> {
        self.set_origin(origin);
        self.take_state(&self.state.clone())
    }

    /// Checks that the boundary accepts this state.
    pub(super) fn take_state(&mut self, state: &[f64]) -> Result<(), Violation> {
        let answer = self.boundary.set_state(state);
        require!(PART, "state", answer.is_ok(); "the state {state:?} is refused: {answer:?}");
        let again = self.boundary.state();
        require!(PART, "state", again == state; "the state {state:?} is {again:?} after it is set");
        Ok(())
    }

    /// Returns the first touch of a flight. If the search of the boundary ends before `until` without a
    /// touch, the method calls it again, as the engine does.
    pub(super) fn first_touch(&self, flight: &Flight, until: f64) -> Result<Option<Touch>, Violation> {
        let mut rest = *flight;
        for _ in 0..MOST_SEARCHES {
            match self.boundary.first_touch(&rest, until) {
                FirstTouch::At(touch) => {
                    let (Touch { time, wall, .. }, count) = (touch, self.wall_count);
                    require!(PART, "touched wall", wall < count;
                        "wall {wall} is touched, but there are {count}, on {flight:?}");
                    require!(PART, "touch time", (rest.time()..=until).contains(&time);
                        "wall {wall} is touched at {time:?}, not on the flight until {until:?}: {rest:?}");
                    return Ok(Some(touch));
                }
                FirstTouch::NotBefore(open) if open >= until => return Ok(None),
                FirstTouch::NotBefore(open) if open > rest.time() => rest = self.restarted(flight, open),
                FirstTouch::NotBefore(_) => break,
            }
        }
        let sentence = format!("the search gets no further than time {:?}, on {flight:?}", rest.time());
        Err(Violation::new(PART, "progress", sentence))
    }

    /// Checks that a disk is equally deep in the walls on both sides of each seam of a periodic domain, at
    /// the height or the width of this place.
    pub(super) fn check_seams(&self, place: DVec2, time: f64) -> Result<(), Violation> {
        let Domain { left, bottom, .. } = self.domain;
        for (one, axis) in [(DVec2::new(left, place.y), DVec2::X), (DVec2::new(place.x, bottom), DVec2::Y)] {
            // Where the domain has no seam, this is the same place.
            let other = one + axis * self.domain.periods();
            // Deep inside a wall, gaps need not be continuous.
            let gap = |place| self.gap().at(place, self.rounding(), time).max(-self.radius);
            let (here, there) = (gap(one), gap(other));
            require!(PART, "periodic images", (here - there).abs() <= 2.0 * self.rounding();
                "the gap to the nearest wall is {here:?} at {one:?}, time {time:?}, but {there:?} at its image \
                 {other:?}");
        }
        Ok(())
    }

    /// Returns a flight of the present disk.
    pub(super) fn flight(&self, time: f64, place: DVec2, velocity: DVec2, acceleration: DVec2) -> Flight {
        Flight::new(time, place, velocity, acceleration, self.radius).with_kind(self.kind)
    }

    /// Returns the remainder of a flight from this time on.
    pub(super) fn restarted(&self, flight: &Flight, time: f64) -> Flight {
        self.flight(time, flight.position(time), flight.velocity(time), flight.acceleration())
    }

    /// Returns the longest duration of a flight. Like flights of the engine, it ends at a periodic side or
    /// end at the latest.
    pub(super) fn longest(&self, flight: &Flight) -> f64 {
        let (start, Region { min, max }) = (flight.time(), self.domain.region());
        let (place, speed) = (flight.position(start), flight.velocity(start).abs());
        let way = (max - place).min(place - min).max(DVec2::ZERO);
        let fall = speed * speed + 2.0 * flight.acceleration().abs() * way;
        let wait = 2.0 * way / (speed + DVec2::new(fall.x.sqrt(), fall.y.sqrt()));
        let has_seam = self.domain.periods().cmpgt(DVec2::ZERO);
        DVec2::select(has_seam, wait, DVec2::INFINITY).min_element().min(LONGEST * self.crossing())
    }
}
