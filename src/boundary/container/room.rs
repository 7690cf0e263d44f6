//! The room between the walls of a container.

use glam::DVec2;

use super::Container;
use crate::boundary::plane::Plane;
use crate::boundary::{Domain, Region, Wall};

impl Container {
    /// Returns the rectangle in which the center of a disk of this radius is free at a time.
    pub(in crate::boundary) fn room(&self, radius: f64, time: f64) -> Region {
        let mut room = Region::new(self.corner, self.corner + DVec2::new(self.width, self.height));
        for plane in &self.planes {
            let place = plane.place(time);
            match plane.wall {
                Wall::Left => room.min.x = place.x + radius,
                Wall::Right => room.max.x = place.x - radius,
                Wall::Floor => room.min.y = place.y + radius,
                Wall::Lid => room.max.y = place.y - radius,
            }
        }
        room
    }

    /// Returns the rectangle of the container with each wall displaced inward by this distance, periodic
    /// where the container has no walls.
    pub(super) fn rectangle(&self, inward: impl Fn(&Plane) -> f64) -> Domain {
        let way = |wall| self.index(wall).map_or(0.0, |index| inward(&self.planes[index]));
        let DVec2 { x, y } = self.corner;
        self.with_sides(Domain::new(
            x + way(Wall::Left),
            x + self.width - way(Wall::Right),
            y + way(Wall::Floor),
            y + self.height - way(Wall::Lid),
        ))
    }

    /// Makes a rectangle periodic where the container has no walls.
    pub(super) fn with_sides(&self, domain: Domain) -> Domain {
        let domain = if self.index(Wall::Left).is_none() { domain.with_periodic_sides() } else { domain };
        if self.index(Wall::Floor).is_none() { domain.with_periodic_ends() } else { domain }
    }
}
