//! Forwarding: a boxed or borrowed boundary is a boundary, too.

use std::borrow::Cow;

use glam::DVec2;

use super::{Boundary, Domain, Region, Surface, Touch};
use crate::{Fingerprint, Flight};

impl<T: Boundary + ?Sized> Boundary for &mut T {
    fn domain(&self) -> Domain {
        (**self).domain()
    }
    fn interior(&self) -> Domain {
        (**self).interior()
    }
    fn wall_count(&self) -> usize {
        (**self).wall_count()
    }
    fn wall_name(&self, wall: usize) -> Cow<'_, str> {
        (**self).wall_name(wall)
    }
    fn set_time_origin(&mut self, origin: f64) {
        (**self).set_time_origin(origin);
    }
    fn may_touch(&self, region: &Region, radius: f64) -> bool {
        (**self).may_touch(region, radius)
    }
    fn first_touch(&self, flight: &Flight, until: f64) -> Option<Touch> {
        (**self).first_touch(flight, until)
    }
    fn surface(&self, wall: usize, position: DVec2, time: f64) -> Surface<'_> {
        (**self).surface(wall, position, time)
    }
    fn overlap(&self, position: DVec2, radius: f64, time: f64) -> Option<(usize, f64)> {
        (**self).overlap(position, radius, time)
    }
    fn wall_lines(&self, time: f64) -> Vec<Vec<DVec2>> {
        (**self).wall_lines(time)
    }
    fn fingerprint(&self) -> Option<Fingerprint> {
        (**self).fingerprint()
    }
}

impl<T: Boundary + ?Sized> Boundary for Box<T> {
    fn domain(&self) -> Domain {
        (**self).domain()
    }
    fn interior(&self) -> Domain {
        (**self).interior()
    }
    fn wall_count(&self) -> usize {
        (**self).wall_count()
    }
    fn wall_name(&self, wall: usize) -> Cow<'_, str> {
        (**self).wall_name(wall)
    }
    fn set_time_origin(&mut self, origin: f64) {
        (**self).set_time_origin(origin);
    }
    fn may_touch(&self, region: &Region, radius: f64) -> bool {
        (**self).may_touch(region, radius)
    }
    fn first_touch(&self, flight: &Flight, until: f64) -> Option<Touch> {
        (**self).first_touch(flight, until)
    }
    fn surface(&self, wall: usize, position: DVec2, time: f64) -> Surface<'_> {
        (**self).surface(wall, position, time)
    }
    fn overlap(&self, position: DVec2, radius: f64, time: f64) -> Option<(usize, f64)> {
        (**self).overlap(position, radius, time)
    }
    fn wall_lines(&self, time: f64) -> Vec<Vec<DVec2>> {
        (**self).wall_lines(time)
    }
    fn fingerprint(&self) -> Option<Fingerprint> {
        (**self).fingerprint()
    }
}
