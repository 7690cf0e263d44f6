//! The free area in a vessel.

use super::Vessel;
use crate::boundary::area::{Curve, Field, Gap, meet};
use crate::boundary::{Boundary, Probe, Region};

impl Vessel {
    /// Returns the area of the part of a region in which the center of a disk is free at a time.
    pub(super) fn free_area(&self, region: &Region, radius: f64, time: f64) -> f64 {
        let region = region.within(&self.container.room(radius, time));
        let is_free = |place| self.overlap_with_parts(&Probe::new(place, radius, time)).is_none();
        // Behind an open one-sided wall, the distance to the wall jumps and is no help.
        let gap = |_, _| f64::INFINITY;
        let unknown = (!self.knows_all_curves()).then_some(&gap as Gap<'_>);
        let is_near = self.parts_may_touch(&region, radius);
        let curves = if is_near { self.curves_of_parts(&region, radius, time) } else { Vec::new() };
        Field { region, curves, unknown, is_free: &is_free }.area()
    }

    /// Returns whether centers change between free and occupied at the surfaces of bricks only.
    pub(super) fn knows_all_curves(&self) -> bool {
        self.parts.iter().all(|placed| placed.part.takes_centers() || placed.part.is_closed())
    }

    /// Returns whether a disk with its center in a region can touch a part at any time.
    pub(super) fn parts_may_touch(&self, region: &Region, radius: f64) -> bool {
        // The region holds centers of disks. The margin keeps rounding from hiding a touch at its edge.
        let reach = 1.001 * radius;
        self.index.near(region.min - reach, region.max + reach).any(|entry| {
            let region = Region::new(region.min - entry.image, region.max - entry.image);
            let (wall, travel) = self.wall(entry.wall as usize);
            travel.may_reach(&wall.brick, &region, reach)
        })
    }

    /// Returns the curves in a region on which the center of a disk touches a part.
    pub(super) fn curves_of_parts(&self, region: &Region, radius: f64, time: f64) -> Vec<Curve> {
        let mut curves = Vec::new();
        for placed in self.parts.iter().filter(|placed| !placed.part.takes_centers()) {
            let pose = placed.part.travel().pose(placed.phase.after(time));
            let (low, high) = placed.bounds;
            let reach = Region::new(low - radius, high + radius);
            for image in self.domain().images_of(low, high) {
                if meet(region, &Region::new(reach.min + image, reach.max + image)) {
                    let bricks = placed.part.all_bricks().flat_map(|brick| brick.curves(radius));
                    curves.extend(bricks.map(|curve| curve.moved(|place| pose.outward(place) + image)));
                }
            }
        }
        curves
    }
}
