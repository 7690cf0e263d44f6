//! The area in a vessel.

use glam::DVec2;

use super::Vessel;
use crate::boundary::area::{Curve, Field, LOOKS, meet};
use crate::boundary::{Boundary, Probe, Region};

impl Vessel {
    /// Returns the area of the places in a region at which the center of a disk is free at a time.
    pub(super) fn free_area(&self, region: &Region, radius: f64, time: f64) -> f64 {
        let region = region.within(&self.container.room(radius, time));
        let is_free = |place| self.overlap_with_parts(&Probe::new(place, radius, time)).is_none();
        let is_closed = |placed: &super::Placed| placed.part.takes_centers() || placed.part.is_closed();
        let looks = if self.parts.iter().all(is_closed) { 1 } else { LOOKS };
        Field { region, curves: self.curves(&region, radius, time), looks, is_free: &is_free }.area()
    }

    /// Returns the curves in a region on which the center of a disk touches a part.
    fn curves(&self, region: &Region, radius: f64, time: f64) -> Vec<Curve> {
        let mut curves = Vec::new();
        for placed in self.parts.iter().filter(|placed| !placed.part.takes_centers()) {
            let pose = placed.part.travel().pose(placed.phase.after(time));
            let (low, high) = placed.bounds;
            let reach = Region::new(low - radius, high + radius);
            let size = [region.min, region.max].map(DVec2::length).into_iter().filter(|end| end.is_finite());
            let length = size.fold(placed.size, f64::max) * 8.0;
            for image in self.domain().images_of(low, high) {
                if meet(region, &Region::new(reach.min + image, reach.max + image)) {
                    let bricks = placed.part.all_bricks().flat_map(|brick| brick.curves(radius, length));
                    curves.extend(bricks.map(|curve| curve.moved(|place| pose.outward(place) + image)));
                }
            }
        }
        curves
    }
}
