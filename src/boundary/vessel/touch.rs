//! Touches of a vessel's parts: the search among the bricks near a flight.

use glam::DVec2;

use super::index::Entry;
use super::{Placed, Vessel, Wall};
use crate::Flight;
use crate::boundary::brick::Path;
use crate::boundary::part::Travel;
use crate::boundary::{Boundary, Surface, Touch};

/// Largest number of steps of a search. If the motion of a part consists of pieces, the search takes a few
/// steps in each piece during which the disk is near the brick.
const MOST_STEPS: u32 = 1 << 16;

/// Gap below which surfaces count as touching, relative to the lengths whose difference the gap is.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

impl Vessel {
    /// Returns a brick and the motion of its part.
    pub(super) fn wall(&self, brick: usize) -> (&Wall, &Travel) {
        let wall = &self.walls[brick];
        (wall, self.parts[wall.part].part.travel())
    }

    /// Returns the first touch of a part, or `other`, whichever is earlier. At equal times, the wall with the
    /// smaller index counts.
    pub(super) fn first_touch_with_parts(
        &self,
        flight: &Flight,
        until: f64,
        other: Option<Touch>,
    ) -> Option<Touch> {
        let (low, high) = rectangle(flight, until);
        let (mut first, mut until) = (other, until);
        let mut last = None;
        for entry in self.index.near(low, high) {
            if last.replace(entry) == Some(entry) {
                continue;
            }
            let wall = entry.wall as usize + self.container.wall_count();
            if let Some(time) = self.touch_of(entry, flight, until)
                && first.is_none_or(|touch| time < touch.time || (time == touch.time && wall < touch.wall))
            {
                first = Some(Touch::new(time, wall));
                until = time;
            }
        }
        first
    }

    /// Returns the first touch of a brick.
    fn touch_of(&self, entry: Entry, flight: &Flight, until: f64) -> Option<f64> {
        let wall = &self.walls[entry.wall as usize];
        let placed = &self.parts[wall.part];
        let flight = if entry.image == DVec2::ZERO { *flight } else { shifted(flight, -entry.image) };
        if !placed.part.travel().is_at_rest() {
            return Search { wall, placed, flight: &flight, until }.run();
        }
        wall.brick.first_touch(&flight, until)
    }

    /// Returns the surface of a brick that a disk at this place touches.
    pub(super) fn surface_of_brick(&self, brick: usize, position: DVec2, time: f64) -> Surface<'_> {
        let wall = &self.walls[brick];
        let placed = &self.parts[wall.part];
        let travel = placed.part.travel();
        let pose = travel.pose(time + placed.phase);
        let images = self.domain().images();
        let sights = images.map(|image| (image, wall.brick.nearest(pose.inward(position - image))));
        let nearest = sights.reduce(|a, b| if b.1.distance < a.1.distance { b } else { a });
        let Some((image, nearest)) = nearest else {
            return Surface::new(DVec2::Y, DVec2::ZERO);
        };
        let normal = pose.direction_outward(nearest.normal);
        let contact = position - image - nearest.distance * normal;
        let surface = placed.part.surface(normal, travel.velocity(contact, time + placed.phase));
        surface.with_radius(wall.brick.radius_at(pose.inward(position - image)))
    }
}

/// A search for the first touch of a brick that moves.
///
/// The search follows the flight in the frame of the part, in which the brick is at rest. On a piece of time
/// in which the part has constant acceleration, the path in that frame is a parabola like any other, and its
/// first touch is exact. Otherwise, the path is known up to an error. A disk that grows by this error touches
/// no later than the true disk. The search advances to the touch of the growing disk, and starts again from
/// there, until the gap is within rounding. It never steps over a touch.
struct Search<'a> {
    wall: &'a Wall,
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
    fn run(&self) -> Option<f64> {
        let mut time = self.flight.time();
        for _ in 0..MOST_STEPS {
            time = self.enters_reach(time)?;
            if time > self.until || self.is_out_of_reach(time) {
                return None;
            }
            match self.step(time) {
                Step::Touch(touch) => return (touch <= self.until).then_some(touch),
                Step::Open(_) if time >= self.until => return None,
                Step::Open(next) => time = next.max(time.next_up()),
            }
        }
        // A search that makes no progress may be at a touch, so the function returns one. If the run makes no
        // progress either, the engine reports that.
        Some(time.min(self.until))
    }

    /// Tells whether a turning brick is out of the disk's reach at this time. Most bricks of a turning part
    /// are, even where the circles on which they turn are near.
    fn is_out_of_reach(&self, time: f64) -> bool {
        let travel = self.placed.part.travel();
        let Travel::Turning { about, angular_velocity } = travel else { return false };
        let (low, high) = self.wall.brick.bounds();
        let middle = travel.pose(time + self.placed.phase).outward(0.5 * (low + high));
        let wait = self.until - time;
        let speed = self.flight.velocity(time).length()
            + self.flight.acceleration().length() * wait
            + angular_velocity.abs() * middle.distance(*about);
        let reach = 0.5 * (high - low).length() + 1.001 * self.flight.radius();
        self.flight.position(time).distance(middle) - reach > speed * wait
    }

    fn step(&self, time: f64) -> Step {
        let travel = self.placed.part.travel();
        let look = travel.look(self.flight, self.placed.phase, time, self.until - time);
        let (path, brick) = (look.path, &self.wall.brick);
        let mut wait = (self.until.min(look.until) - time).max(0.0);
        if path.spread > 0.0 {
            // The disk must not grow so much that it no longer fits into a circle.
            wait = wait.min((2.0 * brick.most_growth(path.radius) / path.spread).sqrt());
        }
        let is_exact = path.spread == 0.0;
        if is_exact {
            let touch = brick.wait_for_touch(&path, wait);
            return touch.map_or(Step::Open(time + wait), |touch| Step::Touch(time + touch));
        }
        let rounding = ROUNDING * (self.flight.position(time).length() + path.place.length() + path.radius);
        let at_once = Path { radius: path.radius + rounding, spread: 0.0, ..path };
        if brick.wait_for_touch(&at_once, 0.0).is_some() {
            return Step::Touch(time);
        }
        // In each step the gap may close by its rounding, so that the search advances. Otherwise, the search
        // would follow a disk that leaves the brick at a speed near rounding in steps too small to change
        // anything.
        let smaller = Path { radius: path.radius - rounding, ..path };
        let open = brick.wait_for_touch(&smaller, wait).unwrap_or(wait);
        Step::Open(time + open.max(time_for(&path, rounding)))
    }

    /// Returns the first time, from this one on, at which the disk is within the rectangle that the brick
    /// never leaves. The result may be too early, but never too late.
    fn enters_reach(&self, time: f64) -> Option<f64> {
        let (low, high) = self.placed.part.travel().bounds(&self.wall.brick);
        let (place, velocity) = (self.flight.position(time), self.flight.velocity(time));
        let (pull, radius) = (self.flight.acceleration(), 1.001 * self.flight.radius());
        let entry = |value: f64, rate: f64, pull: f64, low: f64, high: f64| {
            let gap = (low - radius - value).max(value - high - radius);
            if gap <= 0.0 {
                return Some(0.0);
            }
            let sign = if value > high { 1.0 } else { -1.0 };
            crate::roots::first_descent(gap, sign * rate, sign * pull)
        };
        let x = entry(place.x, velocity.x, pull.x, low.x, high.x)?;
        let y = entry(place.y, velocity.y, pull.y, low.y, high.y)?;
        Some(time + x.max(y))
    }
}

/// Returns a time in which a disk goes no farther than the distance `way` on its path.
fn time_for(path: &Path, way: f64) -> f64 {
    let (speed, pull) = (path.velocity.length(), path.acceleration.length() + path.spread);
    // The larger root of ½ pull t² + speed t = way, in a form in which nothing cancels.
    2.0 * way / (speed + (speed * speed + 2.0 * pull * way).sqrt())
}

/// Returns a rectangle that holds the disk on its flight.
fn rectangle(flight: &Flight, until: f64) -> (DVec2, DVec2) {
    let wait = until - flight.time();
    let (from, to) = (flight.position(flight.time()), flight.position(until));
    // No point of the flight is farther from its chord than this.
    let sagitta = 0.125 * flight.acceleration().length() * wait * wait;
    let reach = 1.001 * (flight.radius() + sagitta);
    (from.min(to) - reach, from.max(to) + reach)
}

fn shifted(flight: &Flight, by: DVec2) -> Flight {
    let time = flight.time();
    let (place, velocity) = (flight.position(time), flight.velocity(time));
    Flight::new(time, place + by, velocity, flight.acceleration(), flight.radius())
}
