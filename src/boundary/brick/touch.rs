//! The first touch of a brick.

use glam::DVec2;

use super::path::Path;
use super::{Brick, Shape, Side};
use crate::Flight;
use crate::boundary::Region;
use crate::roots::first_descent_of_quartic;

impl Brick {
    /// Returns the first time, from the start of a flight to `until`, at which the disk touches the brick and
    /// closes further; `None` if it does not.
    ///
    /// This is the first touch for a [`Boundary`](crate::boundary::Boundary) of your own, exact for constant
    /// acceleration. The brick counts beside it only: close open ends by a [`point`](Self::point).
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
    /// # Ok::<(), granular_edmd::boundary::VesselError>(())
    /// ```
    pub fn first_touch(&self, flight: &Flight, until: f64) -> Option<f64> {
        let wait = self.wait_for_touch(&Path::of(flight), until - flight.time())?;
        Some((flight.time() + wait).min(until))
    }

    /// Tells whether a disk of this radius can touch the brick with its center in a region, for
    /// [`Boundary::may_touch`](crate::boundary::Boundary::may_touch).
    pub fn may_touch(&self, region: &Region, radius: f64) -> bool {
        // Rounding may not hide a touch at the edge of the region.
        self.is_near(region, 1.001 * radius)
    }

    /// Returns the first time, not later than `wait`, at which a disk touches the brick and closes further.
    /// If the disk grows, no touch is earlier, but that time need not be one.
    ///
    /// The side on which the center is decides which side of the brick counts. A disk whose center is behind
    /// the brick goes on until it has come out in front. The brick counts beside it only. What it would leave
    /// open at its ends is closed by the next brick, or by a point.
    pub(in crate::boundary) fn wait_for_touch(&self, path: &Path, wait: f64) -> Option<f64> {
        let beside = match self.shape {
            Shape::Segment(segment) if segment.is_out_of_reach(path, wait) => return None,
            Shape::Arc(arc) if arc.is_out_of_reach(path, wait) => return None,
            Shape::Segment(segment) => Some(segment.beside(path)),
            Shape::Arc(arc) => arc.beside(path),
        };
        let Some(beside) = beside else {
            return self.touch_between(path, 0.0, wait);
        };
        let side = self.side(path.place);
        if self.free.has(side) {
            // Mostly, the disk is beside the brick when it comes to the line or the circle. A disk that is
            // beyond the end may be across the line already, so that it does not come to it.
            let gap = self.gap(path, side);
            if (gap[0] > 0.0 || beside.holds(0.0))
                && let Some(touch) = first_descent_of_quartic(&gap, wait)
                && beside.holds(touch)
            {
                return Some(touch);
            }
        }
        beside.stretches(wait).find_map(|(from, to)| self.touch_between(path, from, to))
    }

    /// Returns the first touch between two times at which the disk is beside the brick.
    fn touch_between(&self, path: &Path, from: f64, to: f64) -> Option<f64> {
        let (here, wait) = (path.later(from), to - from);
        let side = self.side(here.place);
        let growth = here.radius - path.radius;
        // The true center may be on the other side.
        if growth > 0.0 && self.distance_from_line(here.place) <= growth {
            return Some(from);
        }
        if self.free.has(side) {
            let gap = self.gap(&here, side);
            // A gap that rounding has closed counts only while it closes. One that growth has closed may be
            // open, and must be looked at.
            if growth > 0.0 && gap[0] <= 0.0 {
                return Some(from);
            }
            return Some(from + first_descent_of_quartic(&gap, wait)?);
        }
        let front = if side == Side::Left { Side::Right } else { Side::Left };
        if path.spread > 0.0 {
            // The true disk comes out no earlier than one that shrinks. From then on, it is looked at again.
            let shrinking = here.shrinking(path.radius);
            let opens = first_descent_of_quartic(&self.gap(&shrinking, front).map(|c| -c), wait)?;
            return Some(from + opens);
        }
        let opens = first_descent_of_quartic(&self.gap(&here, front).map(|c| -c), wait)?;
        let there = here.later(opens);
        let touch = first_descent_of_quartic(&self.gap(&there, front), wait - opens)?;
        Some(from + opens + touch)
    }

    /// Returns the largest growth of a disk for which its first touch is found.
    pub(in crate::boundary) fn most_growth(&self, radius: f64) -> f64 {
        match self.shape {
            Shape::Segment(_) => f64::INFINITY,
            Shape::Arc(arc) => arc.most_growth(radius),
        }
    }

    /// Returns the distance from the line or the circle on which the brick lies.
    fn distance_from_line(&self, place: DVec2) -> f64 {
        match self.shape {
            Shape::Segment(segment) => segment.direction().perp_dot(place - segment.from()).abs(),
            Shape::Arc(arc) => (place.distance(arc.center()) - arc.radius()).abs(),
        }
    }

    /// Returns the radius of the brick as a disk at this place sees it: infinite for a segment, and for a
    /// corner, which has none; negative from inside an arc.
    pub(in crate::boundary) fn radius_at(&self, place: DVec2) -> f64 {
        match self.shape {
            Shape::Arc(arc) if arc.radius() > 0.0 => match arc.side(place) {
                Side::Left => -arc.radius(),
                Side::Right => arc.radius(),
            },
            _ => f64::INFINITY,
        }
    }

    fn side(&self, place: DVec2) -> Side {
        match self.shape {
            Shape::Segment(segment) => segment.side(place),
            Shape::Arc(arc) => arc.side(place),
        }
    }

    fn gap(&self, path: &Path, side: Side) -> [f64; 5] {
        match self.shape {
            Shape::Segment(segment) => segment.gap(path, side),
            Shape::Arc(arc) => arc.gap(path, side),
        }
    }
}
