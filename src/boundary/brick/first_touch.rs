//! The first touch of a brick, also while it moves in a strip.

use glam::DVec2;

use super::path::{Beside, Path};
use super::shapes::Arc;
use super::{Brick, Shape, Side};
use crate::Flight;
use crate::boundary::Region;
use crate::roots::first_descent_of_quartic;

impl Brick {
    /// Returns the first time, from the start of a flight to `until`, at which the disk touches the brick and
    /// approaches it; `None` if there is no such time.
    ///
    /// A custom [`Boundary`](crate::boundary::Boundary) can find its first touch with this method, which is
    /// exact for constant acceleration. Only touches beside the brick count, not touches at its ends: close
    /// open ends with a [`point`](Self::point).
    ///
    /// ```
    /// use granular_edmd::Flight;
    /// use granular_edmd::boundary::Brick;
    /// use granular_edmd::glam::DVec2;
    ///
    /// // A disk of radius 1/2 falls from the middle of a drum of radius 5.
    /// let drum = Brick::circle(DVec2::ZERO, 5.0)?;
    /// let flight = Flight::new(2.0, DVec2::ZERO, DVec2::ZERO, DVec2::NEG_Y, 0.5);
    /// assert_eq!(drum.first_touch(&flight, 10.0), Some(5.0));
    /// assert_eq!(drum.normal(flight.position(5.0)), DVec2::Y);
    /// assert_eq!(drum.first_touch(&flight, 4.0), None);
    /// # Ok::<(), granular_edmd::boundary::WallError>(())
    /// ```
    pub fn first_touch(&self, flight: &Flight, until: f64) -> Option<f64> {
        let wait = self.wait_for_touch(&Path::of(flight, flight.time()), until - flight.time())?;
        Some((flight.time() + wait).min(until))
    }

    /// Returns whether a disk of this radius may touch the brick while its center is in a region.
    ///
    /// A custom boundary can implement [`Boundary::may_touch`](crate::boundary::Boundary::may_touch) with it.
    pub fn may_touch(&self, region: &Region, radius: f64) -> bool {
        // The margin keeps rounding from hiding a touch at the edge of the region.
        self.is_near(region, 1.001 * radius)
    }

    /// Returns the first time, not later than `wait`, at which a disk touches the brick and approaches it. If
    /// `path` has an error bound, the disk grows to contain the actual disk. The actual disk then touches no
    /// earlier, and possibly not at that time.
    ///
    /// The disk can touch only the side of the brick on which its center is. A disk whose center is behind
    /// the brick flies on until it is in front. Only touches beside the brick count. At its ends, the next
    /// brick or a point takes over.
    pub(in crate::boundary) fn wait_for_touch(&self, path: &Path, wait: f64) -> Option<f64> {
        if of_shape!(self, shape => shape.is_out_of_reach(path, wait)) {
            return None;
        }
        let Some(beside) = self.beside(path, 0.0) else {
            return self.touch_between(path, 0.0, wait);
        };
        let side = self.side(path.place);
        if self.free.has(side) {
            // In most cases, the disk is beside the brick when it reaches the line or the circle, and this
            // one root is enough. A disk beyond the end may be behind the line already, and then it never
            // reaches the line from the front.
            let gap = self.gap(path, side);
            if gap[0] > 0.0 || beside.holds(0.0) {
                match first_descent_of_quartic(&gap, wait) {
                    Some(touch) if beside.holds(touch) => return Some(touch),
                    // The disk stays in front of the brick.
                    None if gap[0] > 0.0 => return None,
                    _ => {}
                }
            }
        }
        beside.stretches(wait).find_map(|(from, to)| self.touch_between(path, from, to))
    }

    /// Returns the condition that the disk is beside the brick, or beyond its ends by at most `more`; `None`
    /// for a circle, which has no ends.
    fn beside(&self, path: &Path, more: f64) -> Option<Beside> {
        match self.shape {
            Shape::Segment(segment) => Some(segment.beside(path, more)),
            Shape::Arc(arc) => arc.beside(path, more),
        }
    }

    /// Returns the first touch between two times, between which the disk stays beside the brick.
    fn touch_between(&self, path: &Path, from: f64, to: f64) -> Option<f64> {
        let (here, wait) = (path.later(from), to - from);
        let side = self.side(here.place);
        let growth = here.radius - path.radius;
        // The position of the center is known only up to the growth, so the center may be on the other side
        // of the line.
        if growth > 0.0 && self.distance_from_line(here.place) <= growth {
            return Some(from);
        }
        if self.free.has(side) {
            let gap = self.gap(&here, side);
            // A gap that rounding has closed counts only while it closes further. A gap that growth has
            // closed may still be open for the actual disk, so the search must look again from here.
            if growth > 0.0 && gap[0] <= 0.0 {
                return Some(from);
            }
            return Some(from + first_descent_of_quartic(&gap, wait)?);
        }
        let front = if side == Side::Left { Side::Right } else { Side::Left };
        if path.spread > 0.0 {
            // The actual disk appears in front of the brick no earlier than the shrinking disk. The search
            // looks again from that time.
            let shrinking = here.shrinking(path.radius);
            let opens = first_descent_of_quartic(&self.gap(&shrinking, front).map(|c| -c), wait)?;
            return Some(from + opens);
        }
        let opens = first_descent_of_quartic(&self.gap(&here, front).map(|c| -c), wait)?;
        let there = here.later(opens);
        let touch = first_descent_of_quartic(&self.gap(&there, front), wait - opens)?;
        Some(from + opens + touch)
    }

    /// Returns the largest growth of a disk at which the search still finds the disk's first touch.
    pub(in crate::boundary) fn most_growth(&self, radius: f64) -> f64 {
        match self.shape {
            Shape::Segment(_) => f64::INFINITY,
            Shape::Arc(arc) => arc.most_growth(radius),
        }
    }

    /// Returns the distance from the line or the circle on which the brick lies.
    fn distance_from_line(&self, place: DVec2) -> f64 {
        match self.shape {
            Shape::Segment(segment) => segment.direction.perp_dot(place - segment.from).abs(),
            Shape::Arc(arc) => (place.distance(arc.center) - arc.radius).abs(),
        }
    }

    /// Returns the radius of the brick as seen by a disk at this position. It is negative inside an arc, and
    /// infinite for a segment and for a corner, which have no radius.
    pub(in crate::boundary) fn radius_at(&self, place: DVec2) -> f64 {
        match self.shape {
            Shape::Arc(arc) if arc.radius > 0.0 => match arc.side(place) {
                Side::Left => -arc.radius,
                Side::Right => arc.radius,
            },
            _ => f64::INFINITY,
        }
    }

    pub(super) fn side(&self, place: DVec2) -> Side {
        of_shape!(self, shape => shape.side(place))
    }

    pub(super) fn gap(&self, path: &Path, side: Side) -> [f64; 5] {
        of_shape!(self, shape => shape.gap(path, side))
    }
}

impl Brick {
    /// Returns the first time, not later than `wait`, at which a disk is in the strip of a brick that moves
    /// back and forth: the disk would touch the brick at some displacement from `-stroke` to `stroke`. The
    /// time may be too early, but never too late.
    ///
    /// The strip is the band along the brick that is as wide as the stroke across it, and longer than the
    /// brick by the stroke at both ends. A rectangle around the brick in all its positions would be too
    /// large. For a side at 45 degrees, disks would always be in the rectangle, and the search would follow
    /// them through every piece of a motion that never brings the brick to them.
    pub(in crate::boundary) fn wait_to_enter_strip(
        &self,
        path: &Path,
        stroke: DVec2,
        wait: f64,
    ) -> Option<f64> {
        let across = match self.shape {
            Shape::Segment(segment) => segment.direction.perp_dot(stroke).abs(),
            Shape::Arc(_) => stroke.length(),
        };
        let beside = self.beside(path, stroke.length());
        let path = Path { radius: path.radius + across, ..*path };
        match beside {
            None => self.wait_to_enter_band(&path, wait),
            Some(beside) => beside
                .stretches(wait)
                .find_map(|(from, to)| Some(from + self.wait_to_enter_band(&path.later(from), to - from)?)),
        }
    }

    /// Returns the first time at which the disk reaches the line or the circle on which the brick lies.
    ///
    /// This is not a search for a touch: for a disk that is in the strip already, the time is 0, even if the
    /// disk is leaving.
    fn wait_to_enter_band(&self, path: &Path, wait: f64) -> Option<f64> {
        if self.distance_from_line(path.place) <= path.radius {
            return Some(0.0);
        }
        first_descent_of_quartic(&self.gap(path, self.side(path.place)), wait)
    }

    /// Returns the first time, not later than `wait`, at which a disk is in the ring that a brick sweeps when
    /// it turns about a point: the distance of the disk's center from that point then equals, up to the
    /// disk's radius, the distance of some point of the brick.
    pub(in crate::boundary) fn wait_to_enter_ring(
        &self,
        path: &Path,
        about: DVec2,
        wait: f64,
    ) -> Option<f64> {
        let (nearest, farthest) = self.distances(about);
        let distance = path.place.distance(about);
        let gap = if distance > farthest + path.radius {
            Arc { center: about, radius: farthest, sector: None }.gap(path, Side::Right)
        } else if distance < nearest - path.radius {
            Arc { center: about, radius: nearest, sector: None }.gap(path, Side::Left)
        } else {
            return Some(0.0);
        };
        first_descent_of_quartic(&gap, wait)
    }
}
