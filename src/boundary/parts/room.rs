//! The area that parts leave free.

use super::Parts;
use crate::boundary::area::{Curve, Field, meet};
use crate::boundary::{Probe, Region};

impl Parts {
    /// Returns the area of the part of a region in which the center of a disk is free of parts at a time, or
    /// `None` if it depends on the kind of the disk. The region is free of the container's own walls.
    pub(in crate::boundary) fn area(&self, region: &Region, radius: f64, time: f64) -> Option<f64> {
        if self.placed.iter().any(|placed| placed.part.is_full_for_some()) {
            return None;
        }
        let is_free = |place| self.overlap(&Probe::new(place, radius, time)).is_none();
        // Centers change between free and occupied at the surfaces of bricks only.
        let are_known =
            self.placed.iter().all(|placed| placed.part.takes_centers() || placed.part.is_closed());
        let is_near = self.may_touch(region, radius);
        let curves = if is_near { self.curves(region, radius, time) } else { Vec::new() };
        Some(Field { region: *region, curves, are_known, is_free: &is_free }.area())
    }

    /// Returns whether a disk with its center in a region can touch a part at any time.
    pub(in crate::boundary) fn may_touch(&self, region: &Region, radius: f64) -> bool {
        // The region holds centers of disks. The margin keeps rounding from hiding a touch at its edge.
        let reach = 1.001 * radius;
        self.index.near(&region.enlarged(reach)).any(|entry| {
            let (of, travel) = self.brick(entry.wall as usize);
            travel.may_reach(&of.brick, &region.shifted(-entry.image), reach)
        })
    }

    /// Returns the curves in a region on which the center of a disk touches a part.
    fn curves(&self, region: &Region, radius: f64, time: f64) -> Vec<Curve> {
        let mut curves = Vec::new();
        for placed in self.placed.iter().filter(|placed| !placed.part.takes_centers()) {
            let pose = placed.part.travel().pose(placed.phase.after(time));
            let reach = placed.bounds.enlarged(radius);
            for image in self.domain.images_of(&placed.bounds) {
                if meet(region, &reach.shifted(image)) {
                    let bricks = placed.part.all_bricks().flat_map(|brick| brick.curves(radius));
                    curves.extend(bricks.map(|curve| curve.moved(|place| pose.outward(place) + image)));
                }
            }
        }
        curves
    }
}
