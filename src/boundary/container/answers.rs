//! A container as a boundary, and the room between its walls.

use glam::DVec2;

use super::Container;
use crate::boundary::plane::Plane;
use crate::boundary::{
    Boundary, Domain, FirstTouch, Impact, Overlap, Probe, Reaction, Region, Surface, Touch, Wall, WallView,
};
use crate::quantity::accept;
use crate::wall::{Motion, Stroke};
use crate::{Fingerprint, Flight, ParameterError};

impl Boundary for Container {
    fn domain(&self) -> Domain {
        self.rectangle(|plane| plane.motion.reach().0.min(0.0))
    }

    fn interior(&self) -> Domain {
        self.rectangle(Plane::advance)
    }

    fn wall_count(&self) -> usize {
        self.planes.len() + self.parts.as_ref().map_or(0, |parts| parts.wall_count())
    }

    fn wall(&self, wall: usize, time: f64) -> WallView<'_> {
        match (self.planes.get(wall), &self.parts) {
            (Some(plane), _) => plane.view(time),
            (None, Some(parts)) if wall < self.wall_count() => parts.view(wall, time),
            _ => WallView::new(format!("wall {wall}")),
        }
    }

    fn set_time_origin(&mut self, origin: f64) {
        for plane in &mut self.planes {
            plane.set_time_origin(origin);
        }
        self.origin = origin;
        if let Some(parts) = &mut self.parts {
            parts.set_time_origin(origin);
        }
    }

    fn react(&mut self, impact: &Impact) -> Reaction {
        let is_moved = match (self.planes.get_mut(impact.wall), &mut self.parts) {
            (Some(plane), _) => plane.take(impact.impulse, impact.time),
            (None, parts) => parts.as_mut().is_some_and(|parts| parts.take(impact)),
        };
        if is_moved { Reaction::Moved } else { Reaction::None }
    }

    fn may_meet(&self, wall: usize, region: &Region, radius: f64, until: f64) -> bool {
        match (self.planes.get(wall), &self.parts) {
            (None, Some(parts)) => parts.may_meet(wall, region, radius, until),
            (plane, _) => plane.is_some_and(|plane| plane.may_meet(region, radius, until)),
        }
    }

    fn state(&self) -> Vec<f64> {
        let parts = self.placed().iter().filter_map(|placed| placed.part.travel().piston());
        let own = self.planes.iter().filter_map(|plane| plane.motion.stroke());
        own.chain(parts).flat_map(Stroke::numbers).collect()
    }

    fn set_state(&mut self, state: &[f64]) -> Result<(), ParameterError> {
        let (numbers, rest) = state.as_chunks::<3>();
        let parts = self.parts.iter_mut().flat_map(|parts| parts.motions());
        let motions = self.planes.iter_mut().map(|plane| &mut plane.motion).chain(parts);
        let pistons: Vec<_> = motions.filter(|motion| motion.stroke().is_some()).collect();
        let is_whole = rest.is_empty() && numbers.len() == pistons.len();
        accept(is_whole, "state of the walls", "three numbers for each piston", state.len() as f64)?;
        for (motion, &numbers) in pistons.into_iter().zip(numbers) {
            if let Some(stroke) = motion.stroke() {
                *motion = Motion::of(stroke.with_numbers(numbers)?);
            }
        }
        Ok(())
    }

    fn may_touch(&self, region: &Region, radius: f64) -> bool {
        self.planes.iter().any(|plane| plane.may_touch(region, radius))
            || self.parts.as_ref().is_some_and(|parts| parts.may_touch(region, radius))
    }

    fn first_touch(&self, flight: &Flight, until: f64) -> FirstTouch<Touch> {
        let mut first = FirstTouch::NONE;
        for (wall, plane) in self.planes.iter().enumerate() {
            let found = plane.first_touch(flight, until.min(first.time()));
            first = first.or(found.map(|time| Touch::new(time, wall)));
        }
        match &self.parts {
            None => first,
            Some(parts) => parts.first_touch(flight, until, first, &self.planes),
        }
    }

    fn surface(&self, wall: usize, position: DVec2, time: f64) -> Surface<'_> {
        match &self.parts {
            Some(parts) if wall >= self.planes.len() => parts.surface(wall, position, time),
            _ => self.planes[wall].surface(time),
        }
    }

    fn overlap(&self, probe: &Probe) -> Option<Overlap> {
        // Most walls are far away, so their positions need not be computed.
        let (position, radius, time) = (probe.position(), probe.radius(), probe.time());
        let near =
            self.planes.iter().enumerate().filter(|(_, plane)| plane.is_within_reach(position, radius));
        let own = near.map(|(wall, plane)| Overlap::new(wall, plane.depth(position, radius, time)));
        let own = Overlap::deepest(own);
        match &self.parts {
            None => own,
            Some(parts) => Overlap::deepest(own.into_iter().chain(parts.overlap(probe))),
        }
    }

    fn tight_fit(&self, radius: f64) -> Option<usize> {
        self.parts.as_ref().and_then(|parts| parts.tight_fit(radius))
    }

    fn area(&self, region: &Region, radius: f64, time: f64) -> Option<f64> {
        let region = region.within(&self.room(radius, time));
        match &self.parts {
            None => Some(region.area()),
            Some(parts) => parts.area(&region, radius, time),
        }
    }

    fn fingerprint(&self) -> Option<Fingerprint> {
        let sizes = Fingerprint::of("Container").number(self.width).number(self.height);
        let DVec2 { x, y } = self.corner;
        let sizes = if self.corner == DVec2::ZERO { sizes } else { sizes.number(x).number(y) };
        let own = self.planes.iter().try_fold(sizes, |container, plane| {
            Some(container.text(plane.wall.name()).part(plane.fingerprint()?))
        });
        self.placed().iter().try_fold(own?, |container, placed| {
            Some(container.text(&placed.name).part(placed.part.fingerprint()?))
        })
    }
}

impl Container {
    /// Returns the rectangle in which the center of a disk of this radius is free at a time.
    pub(in crate::boundary) fn room(&self, radius: f64, time: f64) -> Region {
        let mut room = Region::new(self.corner, self.corner + DVec2::new(self.width, self.height));
        for plane in &self.planes {
            let edge = plane.place(time) + radius * plane.normal;
            room.min = DVec2::select(plane.normal.cmpgt(DVec2::ZERO), edge, room.min);
            room.max = DVec2::select(plane.normal.cmplt(DVec2::ZERO), edge, room.max);
        }
        room
    }

    /// Returns the rectangle of the container with each wall displaced inward by this distance, periodic
    /// where the container has no walls.
    pub(super) fn rectangle(&self, inward: impl Fn(&Plane) -> f64) -> Domain {
        let way = |wall| self.index(wall).map_or(0.0, |index| inward(&self.planes[index]));
        let DVec2 { x, y } = self.corner;
        let (left, right) = (x + way(Wall::Left), x + self.width - way(Wall::Right));
        let mut domain = Domain::new(left, right, y + way(Wall::Floor), y + self.height - way(Wall::Lid));
        domain.periodic_sides = self.index(Wall::Left).is_none();
        domain.periodic_ends = self.index(Wall::Floor).is_none();
        domain
    }
}
