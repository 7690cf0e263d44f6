//! The boundary in which disks are packed.

use glam::DVec2;

use crate::boundary::{
    Boundary, Domain, FirstTouch, Overlap, Probe, Region, Response, Surface, Touch, WallView,
};
use crate::initial::cut;
use crate::roots::first_descent;
use crate::{Flight, ParameterError};

/// A boundary with a rectangle inside, which the disks do not leave.
///
/// The rectangle keeps disks out of the reach of moving walls, and has a lid where the boundary has none. All
/// walls follow the rule of the disks.
pub(super) struct Enclosure<'a, B: ?Sized> {
    boundary: &'a B,
    room: Domain,
}

// `Clone` is written out, because a derived implementation would require `Clone` of the boundary.
impl<B: ?Sized> Clone for Enclosure<'_, B> {
    fn clone(&self) -> Self {
        Self { boundary: self.boundary, room: self.room }
    }
}

impl<'a, B: Boundary + ?Sized> Enclosure<'a, B> {
    /// Encloses the interior of the boundary below a height.
    pub(super) fn new(boundary: &'a B, below: f64) -> Result<Self, ParameterError> {
        Ok(Self { boundary, room: cut(boundary.interior(), below)? })
    }

    /// Checks that each wall that reacts stands still until it is hit, and that the reason of a failed run
    /// names no sink.
    ///
    /// The interior ends at the initial position of a wall that reacts. If that wall moves far, it gets among
    /// the disks. A sink, a line that removes disks, lies among the disks and would have to hold them back
    /// here.
    pub(super) fn check_walls(&self, reason: &str) -> Result<(), ParameterError> {
        (0..self.boundary.wall_count()).try_for_each(|wall| stands(self.boundary, wall, &self.room, reason))
    }

    /// Returns the normal and the position of each side of the rectangle. Where the rectangle is periodic, it
    /// has no sides.
    fn sides(&self) -> impl Iterator<Item = (DVec2, f64)> {
        let Domain { left, right, bottom, top, periodic_sides, periodic_ends } = self.room;
        let ends = [(DVec2::Y, bottom), (DVec2::NEG_Y, -top)];
        let sides = [(DVec2::X, left), (DVec2::NEG_X, -right)];
        let ends = ends.into_iter().filter(move |_| !periodic_ends);
        ends.chain(sides.into_iter().filter(move |_| !periodic_sides))
    }
}

/// Checks that a wall stands still until it is hit, and is no sink.
fn stands<B: Boundary + ?Sized>(
    boundary: &B,
    wall: usize,
    room: &Domain,
    reason: &str,
) -> Result<(), ParameterError> {
    let middle = DVec2::new(0.5 * (room.left + room.right), 0.5 * (room.bottom + room.top));
    let surface = boundary.surface(wall, middle, 0.0);
    let view = |time| boundary.wall(wall, time);
    let is_named = || reason.contains(&format!("\"{}\"", view(0.0)));
    if matches!(surface.response, Response::Absorbing) && is_named() {
        let name = format!("wall index of the sink \"{}\"", view(0.0));
        return Err(ParameterError::new(
            name,
            "absent while disks are packed (add the sink afterwards)",
            wall as f64,
        ));
    }
    if surface.mass == f64::INFINITY {
        return Ok(());
    }
    let place = |time| view(time).motion.map_or(DVec2::ZERO, |(displacement, _)| displacement);
    let way = place(1.0).distance(place(0.0));
    let name = || format!("displacement of the wall \"{}\" in a unit of time", view(0.0));
    let requirement = "0 while disks are packed (add the piston afterwards)";
    if way == 0.0 { Ok(()) } else { Err(ParameterError::new(name(), requirement, way)) }
}

impl<B: Boundary + ?Sized> Boundary for Enclosure<'_, B> {
    fn domain(&self) -> Domain {
        self.room
    }

    fn wall_count(&self) -> usize {
        self.sides().count() + self.boundary.wall_count()
    }

    fn wall(&self, wall: usize, time: f64) -> WallView<'_> {
        match wall.checked_sub(self.sides().count()) {
            Some(inner) => self.boundary.wall(inner, time),
            None => WallView::new("the edge of the interior"),
        }
    }

    fn set_time_origin(&mut self, _origin: f64) {}

    fn may_touch(&self, region: &Region, radius: f64) -> bool {
        self.sides().any(|(normal, place)| region.least_along(normal) - place <= radius)
            || self.boundary.may_touch(region, radius)
    }

    fn first_touch(&self, flight: &Flight, until: f64) -> FirstTouch<Touch> {
        let start = flight.time();
        let (position, velocity) = (flight.position(start), flight.velocity(start));
        let side = |(wall, (normal, place)): (usize, (DVec2, f64))| {
            let gap = position.dot(normal) - place - flight.radius();
            let wait = first_descent(gap, velocity.dot(normal), flight.acceleration().dot(normal))?;
            (start + wait <= until).then(|| Touch::new(start + wait, wall))
        };
        let own = self.sides().enumerate().filter_map(side).min_by(|a, b| a.time.total_cmp(&b.time));
        let (own, sides) = (FirstTouch::from(own), self.sides().count());
        let other = self.boundary.first_touch(flight, until.min(own.time()));
        own.or(other.map(|touch| Touch::new(touch.time, touch.wall + sides)))
    }

    fn surface(&self, wall: usize, position: DVec2, time: f64) -> Surface<'_> {
        match self.sides().nth(wall) {
            Some((normal, _)) => Surface::new(normal, DVec2::ZERO),
            None => self
                .boundary
                .surface(wall - self.sides().count(), position, time)
                .with_response(Response::Shared)
                // A wall that reacts stands still here, like all others.
                .with_mass(f64::INFINITY),
        }
    }

    fn overlap(&self, probe: &Probe) -> Option<Overlap> {
        let count = self.sides().count();
        let depth = |(normal, place)| probe.radius() + place - probe.position().dot(normal);
        let own = self.sides().map(depth).enumerate().map(|(wall, depth)| Overlap::new(wall, depth));
        let behind = |overlap: Overlap| Overlap::new(overlap.with + count, overlap.depth);
        Overlap::deepest(own.chain(self.boundary.overlap(probe).map(behind)))
    }
}

#[cfg(test)]
mod tests {
    use super::Enclosure;
    use crate::boundary::{Container, Wall, laws};
    use crate::glam::DVec2;
    use crate::wall::BiParabolic;
    use crate::{Disk, ParameterError};

    #[test]
    fn enclosures_keep_the_contract() -> Result<(), Box<dyn std::error::Error>> {
        let base = BiParabolic::new(0.1, 10.0)?;
        let peg = |x: f64| -> Result<Disk, ParameterError> { Disk::new(DVec2::new(x, 3.0), 0.8) };
        for container in [
            Container::open(8.0)?.with_motion(Wall::Floor, base)?,
            Container::closed(8.0, 5.0)?.with_periodic_sides()?,
            Container::periodic(8.0, 6.0)?,
            Container::periodic(8.0, 20.0)?,
        ] {
            let board = container.with_pegs([peg(2.0)?, peg(7.5)?])?;
            assert_eq!(laws::check(&mut Enclosure::new(&board, 6.0)?, 0.3, 1.0, 1), Ok(()));
        }
        Ok(())
    }
}
