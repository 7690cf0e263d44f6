//! A boundary under test: positions, sizes and the allowed rounding.

use glam::DVec2;

use crate::boundary::{Boundary, Domain, FirstTouch, Overlap, Probe, Region, Touch};
use crate::violation::require;
use crate::{Flight, Kind, Violation};

pub(super) const PART: &str = "boundary";

/// Allowed rounding, relative to the size of the domain.
const ROUNDING: f64 = 1e-9;

/// Longest flight, in units of the time that a disk takes to cross the domain.
const LONGEST: f64 = 3.0;

/// Longest wait for a flight after a blow, and longest flight then, in the same units: a free wall must not
/// leave the domain, and the disks of the check do not hold it up.
pub(super) const SOON: f64 = 0.1;

/// Largest depth, relative to the radius, at which the velocities on both sides of a seam are compared.
const SHALLOW: f64 = 0.7;

/// Largest relative difference between these velocities.
const SAME: f64 = 5e-8;

/// Largest number of searches that together follow one flight.
const MOST_SEARCHES: u32 = 10_000;

/// Sizes of the regions around a touch, relative to the radius. The smallest region is a point, up to
/// rounding.
const REGIONS: [f64; 3] = [0.0, 0.5, 5.0];

/// A boundary under test, and the numbers of the test.
pub(super) struct Trial<'a> {
    pub(super) boundary: &'a mut dyn Boundary,
    pub(super) domain: Domain,
    pub(super) wall_count: usize,
    /// The radius of the largest disks, and that of the present one.
    pub(super) largest: f64,
    pub(super) radius: f64,
    pub(super) kind: Kind,
    pub(super) speed: f64,
    pub(super) origin: f64,
    /// The initial state of the walls, and a state after a blow.
    pub(super) states: [Vec<f64>; 2],
    /// Time of that blow, from any origin.
    pub(super) struck_at: f64,
    /// True if flights begin in the second state.
    pub(super) is_struck: bool,
    /// Number of flights that graze a wall.
    pub(super) grazes: usize,
    /// Number of blows after which other disks were sent to the walls.
    pub(super) blows: usize,
}

impl<'a> Trial<'a> {
    pub(super) fn new(boundary: &'a mut dyn Boundary, domain: Domain, radius: f64, speed: f64) -> Self {
        let (wall_count, kind) = (boundary.wall_count(), Kind::DEFAULT);
        let states = [boundary.state(), boundary.state()];
        Self {
            boundary,
            domain,
            wall_count,
            largest: radius,
            radius,
            kind,
            speed,
            origin: 0.0,
            states,
            struck_at: 0.0,
            is_struck: false,
            grazes: 0,
            blows: 0,
        }
    }

    /// Returns the larger side of the domain, or its width if the domain is open above.
    pub(super) fn length(&self) -> f64 {
        let height = self.domain.height();
        if height.is_finite() { self.domain.width().max(height) } else { self.domain.width() }
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

    /// Returns the corners of the rectangle in which flights begin.
    pub(super) fn rectangle(&self) -> (DVec2, DVec2) {
        let Domain { left, right, bottom, top, .. } = self.domain;
        (DVec2::new(left, bottom), DVec2::new(right, top.min(bottom + self.length())))
    }

    /// Returns places all over the domain. In a box of a usual shape, none of them is equally far from two
    /// walls, where rounding would decide which wall is the nearest.
    pub(super) fn places(&self) -> impl Iterator<Item = DVec2> + use<> {
        let (low, high) = self.rectangle();
        let (across, up) = ([0.05, 0.35, 0.65, 0.95], [0.061_83, 0.343_37, 0.671_19, 0.928_61]);
        across.into_iter().flat_map(move |x| up.map(move |y| low + DVec2::new(x, y) * (high - low)))
    }

    /// Returns the time from which the walls are known.
    pub(super) fn earliest(&self) -> f64 {
        if self.is_struck { self.struck_at } else { 0.0 }
    }

    pub(super) fn set_origin(&mut self, origin: f64) {
        self.boundary.set_time_origin(origin);
        self.origin = origin;
    }

    /// Adds to a violation that it is one of walls in motion, if it is.
    pub(super) fn told(&self, violation: Violation) -> Violation {
        if !self.is_struck {
            return violation;
        }
        let found = format!(
            "{}, after a blow that left the walls in the state {:?}",
            violation.found(),
            self.states[1]
        );
        Violation::new(violation.part(), violation.law(), found)
    }

    /// Sets a time origin, and the state of the walls that react in which flights begin.
    pub(super) fn begin(&mut self, origin: f64) -> Result<(), Violation> {
        self.set_origin(origin);
        self.take_state(&self.states[usize::from(self.is_struck)].clone())
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
            let open = match self.boundary.first_touch(&rest, until) {
                FirstTouch::At(touch) => {
                    let (wall, count) = (touch.wall, self.wall_count);
                    require!(PART, "touched wall", wall < count;
                        "wall {wall} is touched, but there are {count}, on {flight:?}");
                    return Ok(Some(touch));
                }
                FirstTouch::NotBefore(open) if open >= until => return Ok(None),
                FirstTouch::NotBefore(open) => open,
            };
            if open.is_nan() || open <= rest.time() {
                break;
            }
            rest = restarted(flight, open);
        }
        let sentence = format!("the search gets no further than time {:?}, on {flight:?}", rest.time());
        Err(Violation::new(PART, "progress", sentence))
    }

    /// Returns the wall that a disk with a radius larger by `more` overlaps at this position, and the depth.
    pub(super) fn depth(&self, place: DVec2, more: f64, time: f64) -> Option<Overlap> {
        self.boundary.overlap(&Probe::new(place, self.radius + more, time).with_kind(self.kind))
    }

    /// Returns the positions on both sides of each seam of a periodic domain, at the height or the width of
    /// this position.
    fn seams(&self, place: DVec2) -> impl Iterator<Item = [DVec2; 2]> {
        let Domain { left, right, bottom, top, periodic_sides, periodic_ends } = self.domain;
        let sides = [left, right].map(|x| DVec2::new(x, place.y));
        let ends = [bottom, top].map(|y| DVec2::new(place.x, y));
        let seams = [(periodic_sides, sides), (periodic_ends, ends)];
        seams.into_iter().filter(|(is_seam, _)| *is_seam).map(|(_, places)| places)
    }

    /// Checks that a disk finds the same walls on both sides of each seam, with the same velocities.
    pub(super) fn check_seams(&self, place: DVec2, time: f64) -> Result<(), Violation> {
        for places in self.seams(place) {
            let found = places.map(|place| self.depth(place, self.rounding(), time));
            let [here, there] = found.map(|found| found.map_or(0.0, |found| found.depth));
            // Deep inside a wall, depths need not be continuous.
            let is_same = (here.min(self.radius) - there.min(self.radius)).abs() <= 2.0 * self.rounding();
            require!(PART, "periodic images", is_same;
                "a disk of radius {:?} at {:?} is {here:?} deep in a wall at {time:?}, but {there:?} at its image {:?}",
                self.radius, places[0], places[1]);
            let [Some(one), Some(other)] = found else { continue };
            // A smaller disk touches the wall there. Two walls may meet at a seam.
            if here < SHALLOW * self.radius && one.with == other.with && one.with < self.wall_count {
                self.check_velocities(one.with, places, time)?;
            }
        }
        Ok(())
    }

    fn check_velocities(&self, wall: usize, places: [DVec2; 2], time: f64) -> Result<(), Violation> {
        let [here, there] = places.map(|place| self.boundary.surface(wall, place, time).velocity);
        let is_same = here.distance(there) <= SAME * (here.length() + self.speed);
        require!(PART, "periodic images", is_same;
            "wall {wall} moves at {here:?} at {:?}, time {time:?}, but at {there:?} at its image {:?}",
            places[0], places[1]);
        Ok(())
    }

    /// Returns the longest duration of a flight. Like flights of the engine, it ends at a periodic side or
    /// end at the latest.
    pub(super) fn longest(&self, flight: &Flight) -> f64 {
        let mut longest = if self.is_struck { SOON } else { LONGEST } * self.length() / self.speed;
        let (domain, start) = (self.domain, flight.time());
        let (place, velocity) = (flight.position(start), flight.velocity(start));
        let pull = flight.acceleration();
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

    /// Checks that the domain and the number of walls have not changed.
    pub(super) fn check_constants(&self) -> Result<(), Violation> {
        let (before, now, walls) = (self.domain, self.boundary.domain(), self.boundary.wall_count());
        require!(PART, "constant domain", now == before; "the domain was {before} and is now {now}");
        let count = self.wall_count;
        require!(PART, "constant walls", walls == count;
            "there were {count} walls, and now there are {walls}");
        Ok(())
    }

    /// Checks that `may_touch` and `may_meet` are true for every region that contains the position of a
    /// touch.
    pub(super) fn check_regions(&self, touch: Touch, place: DVec2) -> Result<(), Violation> {
        for size in REGIONS.map(|size| size * self.radius) {
            let [low, high] = [0.0, size].map(|size| DVec2::splat(size + self.rounding()));
            let regions = [[low, low], [high, high], [low, high], [high, low]];
            for [low, high] in regions {
                let around = Region::new(place - low, place + high);
                self.check_region(touch, around)?;
                self.check_region(touch, self.open_at_edges(around))?;
            }
        }
        let (low, high) = self.rectangle();
        self.check_region(touch, Region::new(low.min(place), high.max(place)))
    }

    fn check_region(&self, Touch { time, wall, .. }: Touch, region: Region) -> Result<(), Violation> {
        for radius in [self.radius, 1.5 * self.radius] {
            let may = self.boundary.may_touch(&region, radius);
            require!(PART, "may_touch", may;
                "a disk of radius {radius:?} touches in {region:?}, where it is denied");
            for until in [time, time + self.length() / self.speed] {
                let may = self.boundary.may_meet(wall, &region, radius, until);
                require!(PART, "may_meet", may;
                    "a disk meets wall {wall} in {region:?} at {time:?}, where it is denied up to {until:?}");
            }
        }
        Ok(())
    }

    /// Returns the region as the engine extends it: to infinity where the region is near an edge of the
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

/// Returns the time in which a flight moves no farther than `way`, whatever the direction of its
/// acceleration. It solves v t + a t² / 2 = `way` for the speed v and the magnitude a of the acceleration.
fn shortest_wait(way: f64, velocity: f64, pull: f64) -> f64 {
    let (way, speed) = (way.max(0.0), velocity.abs());
    2.0 * way / (speed + (speed * speed + 2.0 * pull.abs() * way).sqrt())
}

/// Returns the remainder of a flight from this time on.
pub(super) fn restarted(flight: &Flight, time: f64) -> Flight {
    let (place, velocity) = (flight.position(time), flight.velocity(time));
    Flight::new(time, place, velocity, flight.acceleration(), flight.radius()).with_kind(flight.kind())
}
