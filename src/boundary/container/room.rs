//! The room between the walls of a container.

use glam::DVec2;

use super::Container;
use crate::boundary::{Region, Wall};

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
}
