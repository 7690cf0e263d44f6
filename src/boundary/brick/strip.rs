//! The strip that a moving brick sweeps, and the time at which a disk enters it.

use glam::DVec2;

use super::arc::Arc;
use super::path::Path;
use super::{Brick, Shape, Side};
use crate::roots::first_descent_of_quartic;

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
        let (across, beside) = match self.shape {
            Shape::Segment(segment) => {
                let across = segment.direction.perp_dot(stroke).abs();
                (across, Some(segment.beside(path, stroke.length())))
            }
            Shape::Arc(arc) => (stroke.length(), arc.beside(path, stroke.length())),
        };
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
