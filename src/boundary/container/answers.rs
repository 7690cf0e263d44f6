//! A container as a boundary.

use std::borrow::Cow;

use glam::DVec2;

use super::Container;
use crate::boundary::area::{Curve, Curves};
use crate::boundary::plane::Plane;
use crate::boundary::{
    Boundary, Domain, FirstTouch, Impact, Overlap, Probe, Reaction, Region, Surface, Touch,
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
        self.planes.len()
    }

    fn wall_name(&self, wall: usize) -> Cow<'_, str> {
        let plane = self.planes.get(wall);
        plane.map_or_else(|| Cow::Owned(format!("wall {wall}")), |plane| plane.wall.name().into())
    }

    fn set_time_origin(&mut self, origin: f64) {
        for plane in &mut self.planes {
            plane.set_time_origin(origin);
        }
    }

    fn react(&mut self, impact: &Impact) -> Reaction {
        let is_moved = self.planes[impact.wall].take(impact.impulse, impact.time);
        if is_moved { Reaction::Moved } else { Reaction::None }
    }

    fn may_meet(&self, wall: usize, region: &Region, radius: f64, until: f64) -> bool {
        self.planes[wall].may_meet(region, radius, until)
    }

    fn state(&self) -> Vec<f64> {
        let strokes = self.planes.iter().filter_map(|plane| plane.motion.stroke());
        strokes.flat_map(Stroke::numbers).collect()
    }

    fn set_state(&mut self, state: &[f64]) -> Result<(), ParameterError> {
        let (numbers, rest) = state.as_chunks::<3>();
        let pistons = self.planes.iter_mut().filter(|plane| plane.motion.stroke().is_some());
        let pistons: Vec<_> = pistons.collect();
        let is_whole = rest.is_empty() && numbers.len() == pistons.len();
        accept(is_whole, "state of the walls", "three numbers for each piston", state.len() as f64)?;
        for (plane, &numbers) in pistons.into_iter().zip(numbers) {
            if let Some(stroke) = plane.motion.stroke() {
                plane.motion = Motion::of(stroke.with_numbers(numbers)?);
            }
        }
        Ok(())
    }

    fn may_touch(&self, region: &Region, radius: f64) -> bool {
        self.planes.iter().any(|plane| plane.may_touch(region, radius))
    }

    fn first_touch(&self, flight: &Flight, until: f64) -> FirstTouch<Touch> {
        let mut first = FirstTouch::NONE;
        for (wall, plane) in self.planes.iter().enumerate() {
            let found = plane.first_touch(flight, until.min(first.time()));
            first = first.or(found.map(|time| Touch::new(time, wall)));
        }
        first
    }

    fn surface(&self, wall: usize, _position: DVec2, time: f64) -> Surface<'_> {
        self.planes[wall].surface(time)
    }

    fn wall_point(&self, wall: usize, time: f64) -> Option<DVec2> {
        self.planes.get(wall).map(|plane| plane.place(time))
    }

    fn edges(&self, time: f64) -> Domain {
        let Region { min, max } = self.room(0.0, time);
        self.with_sides(Domain::new(min.x, max.x, min.y, max.y))
    }

    fn wall_motion(&self, wall: usize, time: f64) -> Option<(DVec2, f64)> {
        self.planes.get(wall)?.moved(time)
    }

    fn overlap(&self, probe: &Probe) -> Option<Overlap> {
        // Most walls are far away, so their positions need not be computed.
        let (position, radius, time) = (probe.position(), probe.radius(), probe.time());
        let near =
            self.planes.iter().enumerate().filter(|(_, plane)| plane.is_within_reach(position, radius));
        Overlap::deepest(near.map(|(wall, plane)| Overlap::new(wall, plane.depth(position, radius, time))))
    }

    fn area(&self, region: &Region, radius: f64, time: f64) -> Option<f64> {
        Some(region.within(&self.room(radius, time)).area())
    }

    fn curves(&self, region: &Region, radius: f64, time: f64) -> Option<Curves> {
        let Region { min, max } = region.within(&self.room(radius, time));
        let corners = [min, DVec2::new(max.x, min.y), max, DVec2::new(min.x, max.y), min];
        Some(Curves(corners.windows(2).map(|ends| Curve::Line(ends[0], ends[1])).collect()))
    }

    fn fingerprint(&self) -> Option<Fingerprint> {
        let sizes = Fingerprint::of("Container").number(self.width).number(self.height);
        let DVec2 { x, y } = self.corner;
        let sizes = if self.corner == DVec2::ZERO { sizes } else { sizes.number(x).number(y) };
        self.planes.iter().try_fold(sizes, |container, plane| {
            Some(container.text(plane.wall.name()).part(plane.fingerprint()?))
        })
    }
}
