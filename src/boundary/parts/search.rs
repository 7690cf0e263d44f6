//! The search for the first touch of a part, among the bricks near a flight.

use glam::DVec2;

use super::index::Entry;
use super::{Parts, Placed};
use crate::Flight;
use crate::boundary::brick::{Brick, Nearest, Path};
use crate::boundary::part::{Pose, Turning};
use crate::boundary::plane::Plane;
use crate::boundary::{FirstTouch, Region, Surface, Touch};

/// Largest number of steps of a search, for all moving bricks near a flight together. The last brick may take
/// one more round. The engine reads the clock every 256 events, so it still respects a limit of wall-clock
/// time.
const MOST_STEPS: u32 = 256;

/// Largest number of steps of a search for one brick, before the search continues with the next brick.
///
/// A brick that moves fast near the disk may take many steps without ever touching the disk, because another
/// brick touches the disk first. A turning arm has such a brick on its trailing side. The rounds keep such a
/// brick from taking all the steps.
const STEPS_IN_A_ROUND: u32 = 16;

/// Gap below which surfaces count as touching, relative to the two lengths whose difference is the gap.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// Largest gap, relative to the radius, and largest deviation of the normal, for which a patch counts as
/// lying in a wall.
const IN_WALL: f64 = 1e-9;

/// Margin of the strip that a brick sweeps, relative to the lengths in the search.
const MARGIN: f64 = 64.0 * f64::EPSILON;

/// Radius of the point that stands for the center of a disk at a line for centers, relative to the radius of
/// the disk. It is far above rounding errors and far below any length that is measured.
///
/// A point without a radius could get through the line, because rounding can put it behind the line as it
/// arrives. If all events are predicted anew just then, the new search finds a point that flies away from the
/// line.
const CENTER: f64 = 1e-7;

/// Longest flight for which entries into the strip are computed. Squares of longer times would overflow.
const LONGEST: f64 = 1e150;

/// Smallest period of a part, in units of the distance between two floating-point times. Floating-point times
/// do not determine the position of a faster part.
const LEAST_PERIOD: f64 = 64.0;

impl Parts {
    /// Returns the first touch of a part, or the first touch of the container's own walls, whichever is
    /// earlier.
    #[inline(never)]
    pub(in crate::boundary) fn first_touch(
        &self,
        flight: &Flight,
        until: f64,
        other: FirstTouch<Touch>,
        planes: &[Plane],
    ) -> FirstTouch<Touch> {
        let first = self.first_touch_or(flight, until, other);
        if self.has_patches { first.map(|touch| self.on_patch(touch, flight, planes)) } else { first }
    }

    fn first_touch_or(&self, flight: &Flight, until: f64, other: FirstTouch<Touch>) -> FirstTouch<Touch> {
        let mut first = other;
        let mut moving: Vec<Entry> = Vec::new();
        let mut last = None;
        for entry in self.index.near(&rectangle(flight, until)) {
            // A brick that lies in several cells appears several times, mostly in a row. A second search of a
            // brick at rest costs time and changes nothing.
            if last.replace(entry) == Some(entry) {
                continue;
            }
            let (placed, brick) = self.owner(entry.brick as usize);
            if !placed.part.stops(flight.kind()) {
                continue;
            }
            if !placed.part.travel().is_at_rest() {
                if !moving.contains(&entry) {
                    moving.push(entry);
                }
            } else if let Some(time) =
                brick.first_touch(&self.seen_from(entry, flight), until.min(first.time()))
            {
                first = first.or(FirstTouch::At(self.touch(entry, time)));
            }
        }
        if moving.is_empty() { first } else { self.search(&moving, flight, until, first) }
    }

    /// Returns the flight as seen from a periodic image of a brick. For a brick that takes out centers, the
    /// disk shrinks to its center.
    fn seen_from(&self, entry: Entry, flight: &Flight) -> Flight {
        let is_line = self.owner(entry.brick as usize).0.part.takes_centers();
        if entry.image == DVec2::ZERO && !is_line {
            return *flight;
        }
        let (time, radius) = (flight.time(), if is_line { CENTER } else { 1.0 } * flight.radius());
        let (place, velocity) = (flight.position(time), flight.velocity(time));
        Flight::new(time, place - entry.image, velocity, flight.acceleration(), radius)
            .with_kind(flight.kind())
    }

    fn touch(&self, entry: Entry, time: f64) -> Touch {
        Touch::new(time, entry.brick as usize + self.first)
    }

    /// Searches for the first touch of the `moving` bricks, in rounds, up to `until` or the touch of another
    /// wall.
    fn search(
        &self,
        moving: &[Entry],
        flight: &Flight,
        until: f64,
        other: FirstTouch<Touch>,
    ) -> FirstTouch<Touch> {
        let end = until.min(other.time());
        let (mut from, mut steps) = (flight.time(), 0);
        loop {
            // All bricks take turns. The back of an arm never meets the disk that its front is about to hit,
            // and a search of the back alone would use up all steps.
            let mut first = other;
            for &entry in moving {
                let (placed, brick) = self.owner(entry.brick as usize);
                let (flight, until) = (&self.seen_from(entry, flight), until.min(first.time()));
                let search = Search { brick, placed, flight, until };
                first = first.or(search.run(from, &mut steps).map(|time| self.touch(entry, time)));
            }
            match first {
                FirstTouch::NotBefore(open) if open < end && open > from && steps < MOST_STEPS => from = open,
                _ => return first,
            }
        }
    }

    /// Returns the touch of the patch at this point of the touched wall, or the unchanged touch if there is
    /// no patch.
    ///
    /// A sink in a wall, a belt or a thermal section is usually built as a part on the line of the wall.
    /// Without this rule, rounding would decide whether the part or the wall is touched first.
    fn on_patch(&self, touch: Touch, flight: &Flight, planes: &[Plane]) -> Touch {
        let (place, radius) = (flight.position(touch.time), flight.radius());
        let part = |brick: usize| &self.owner(brick).0.part;
        if touch.wall.checked_sub(self.first).is_some_and(|brick| part(brick).is_patch()) {
            return touch;
        }
        let normal_of = |wall: usize| self.surface(wall, place, touch.time).normal;
        let normal = planes.get(touch.wall).map_or_else(|| normal_of(touch.wall), |plane| plane.normal);
        let mut near = self.index.near(&Region::around(place, 2.0 * radius)).filter(|entry| {
            let brick = entry.brick as usize;
            let gap = || self.nearest_image(brick, place, touch.time).2.distance - radius;
            let is_along = || normal_of(brick + self.first).dot(normal) >= 1.0 - IN_WALL;
            let is_one = part(brick).is_patch() && part(brick).stops(flight.kind());
            is_one && gap().abs() <= IN_WALL * radius && is_along()
        });
        near.next().map_or(touch, |entry| self.touch(entry, touch.time))
    }

    /// Returns the periodic image of a brick that is nearest to a position, the pose of its part, and the
    /// nearest point.
    fn nearest_image(&self, brick: usize, position: DVec2, time: f64) -> (DVec2, Pose, Nearest) {
        let (Placed { part, phase, .. }, brick) = self.owner(brick);
        let pose = part.travel().pose(phase.after(time));
        let seen = |image| (image, pose, brick.nearest(pose.inward(position - image)));
        let images = self.domain.images_of(&part.travel().bounds(brick)).map(seen);
        let nearest = images.reduce(|a, b| if b.2.distance < a.2.distance { b } else { a });
        nearest.unwrap_or_else(|| seen(DVec2::ZERO))
    }

    /// Returns the surface of a wall that a disk at this position touches.
    pub(in crate::boundary) fn surface(&self, wall: usize, position: DVec2, time: f64) -> Surface<'_> {
        let (Placed { part, phase, .. }, brick) = self.owner(wall - self.first);
        let (image, pose, nearest) = self.nearest_image(wall - self.first, position, time);
        let normal = pose.direction_outward(nearest.normal);
        let contact = position - image - nearest.distance * normal;
        let radius = brick.radius_at(pose.inward(position - image));
        part.surface(normal, radius, part.travel().velocity(contact, phase.after(time)))
    }
}

/// A search for the first touch of a brick that moves.
///
/// The search follows the flight in the frame of the part, in which the brick is at rest. On a piece of time
/// in which the part has constant acceleration, the path in that frame is a parabola like any other, and its
/// first touch is exact. Otherwise, the path is known up to an error. A disk that grows by this error touches
/// no later than the actual disk. The search advances to the touch of the growing disk, and starts again from
/// there, until the gap is within rounding. It never steps over a touch.
///
/// A fast part has many pieces of motion during a flight. A disk, however, can touch the part only in the
/// strip that the part sweeps, and the part sweeps all of the strip within a period. The search therefore
/// goes straight to the time at which the disk enters the strip, and ends a few pieces later.
struct Search<'a> {
    brick: &'a Brick,
    placed: &'a Placed,
    flight: &'a Flight,
    until: f64,
}

/// Outcome of one step of the search.
enum Step {
    /// The surfaces touch at this time.
    Touch(f64),
    /// The surfaces do not touch before this time.
    Open(f64),
}

impl Search<'_> {
    /// Searches for one round of steps, from a time up to which there is no touch.
    fn run(&self, from: f64, steps: &mut u32) -> FirstTouch<f64> {
        let mut time = from;
        for _ in 0..STEPS_IN_A_ROUND {
            match self.enters_strip(time) {
                Some(entry) if entry <= self.until && !self.is_out_of_reach(entry) => time = entry,
                _ => return FirstTouch::NONE,
            }
            if self.is_too_fast(time) {
                break;
            }
            *steps += 1;
            match self.step(time) {
                Step::Touch(touch) if touch <= self.until => return FirstTouch::At(touch),
                Step::Open(next) if time < self.until => time = next.max(time.next_up()),
                _ => return FirstTouch::NONE,
            }
            if *steps >= MOST_STEPS {
                break;
            }
        }
        FirstTouch::NotBefore(time)
    }

    /// Returns whether floating-point times are too coarse to determine the position of the part.
    fn is_too_fast(&self, time: f64) -> bool {
        let latest = time.abs() + self.placed.phase.size();
        let spacing = latest.next_up() - latest;
        self.placed.part.travel().period().is_some_and(|period| period < LEAST_PERIOD * spacing)
    }

    /// Returns whether a turning brick is out of the disk's reach at this time. Most bricks of a turning part
    /// are out of reach, even where the circles on which they turn are near.
    fn is_out_of_reach(&self, time: f64) -> bool {
        let travel = self.placed.part.travel();
        let Some(Turning { about, angular_velocity, .. }) = travel.frame() else { return false };
        let phase = self.placed.phase.after(time);
        let Region { min, max } = self.brick.bounds();
        let middle = travel.pose(phase).outward(0.5 * (min + max));
        let wait = self.until - time;
        let speed = self.flight.velocity(time).length()
            + self.flight.acceleration().length() * wait
            + angular_velocity.abs() * middle.distance(*about + travel.shift(phase));
        let reach = 0.5 * (max - min).length() + 1.001 * self.flight.radius() + travel.stroke();
        self.flight.position(time).distance(middle) - reach > speed * wait
    }

    fn step(&self, time: f64) -> Step {
        let travel = self.placed.part.travel();
        let look = travel.look(self.flight, self.placed.phase, time, self.until - time);
        let (path, brick) = (look.path, self.brick);
        let wait = (self.until.min(look.until) - time).max(0.0);
        if path.spread == 0.0 {
            let touch = brick.wait_for_touch(&path, wait);
            return touch.map_or(Step::Open(time + wait), |touch| Step::Touch(time + touch));
        }
        // The disk must not grow so much that it no longer fits into a circle.
        let wait = wait.min((2.0 * brick.most_growth(path.radius) / path.spread).sqrt());
        let rounding = ROUNDING * (self.flight.position(time).length() + path.place.length() + path.radius);
        let at_once = Path { radius: path.radius + rounding, spread: 0.0, ..path };
        if brick.wait_for_touch(&at_once, 0.0).is_some() {
            return Step::Touch(time);
        }
        // In each step the gap may close by its rounding error, so that the search advances. Otherwise, the
        // search would follow a disk that leaves the brick at a speed near rounding in steps too small to
        // change anything.
        let smaller = Path { radius: path.radius - rounding, ..path };
        let open = brick.wait_for_touch(&smaller, wait).unwrap_or(wait);
        Step::Open(time + open.max(time_for(&path, rounding)))
    }

    /// Returns the first time, from this time on, at which the disk is near enough for a touch with this
    /// brick at any position of the part. The result may be too early, but never too late.
    fn enters_strip(&self, time: f64) -> Option<f64> {
        let mut path = Path::of(self.flight, time);
        // The margin is far above the rounding error of lengths, and far below the stroke of any motion that
        // a container accepts: a disk that waits in the margin costs steps.
        path.radius += MARGIN * (path.radius + path.place.abs().max_element() + self.placed.size);
        let wait = (self.until - time).clamp(0.0, LONGEST);
        Some(time + self.placed.part.travel().wait_to_enter_strip(self.brick, &path, wait)?)
    }
}

/// Returns a time in which a disk moves no farther than the distance `way` on its path.
fn time_for(path: &Path, way: f64) -> f64 {
    let (speed, pull) = (path.velocity.length(), path.acceleration.length() + path.spread);
    // The larger root of ½ pull t² + speed t = way, in a form in which nothing cancels.
    2.0 * way / (speed + (speed * speed + 2.0 * pull * way).sqrt())
}

/// Returns a rectangle that holds the disk on its flight.
fn rectangle(flight: &Flight, until: f64) -> Region {
    let wait = until - flight.time();
    let (from, to) = (flight.position(flight.time()), flight.position(until));
    // No point of the flight is farther from its chord than this.
    let sagitta = 0.125 * flight.acceleration().length() * wait * wait;
    let reach = 1.001 * (flight.radius() + sagitta);
    Region::new(from.min(to) - reach, from.max(to) + reach)
}
