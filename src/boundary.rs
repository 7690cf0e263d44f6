//! Boundaries: the walls around the disks, and what a touch does.
//!
//! [`Container`] is the rectangular box of the paper and its relatives: side walls or periodic sides, a floor that is
//! fixed, moving or thermal, a lid or an open top, each wall with a rule of its own if wanted. A geometry of your own
//! implements [`Boundary`].

mod container;
mod domain;
mod plane;
mod surface;

pub use container::{Container, MissingWall, Wall};
pub use domain::{Domain, Region};
pub use surface::{Response, Surface, Thermal};

use glam::DVec2;

use crate::Flight;

/// The first touch of a flight with a wall.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Touch {
    /// When.
    pub time: f64,
    /// Which wall, an index into [`Boundary::walls`].
    pub wall: usize,
}

/// The walls around the disks.
///
/// # Contract
/// All times are offsets from the origin set last by [`Self::set_time_origin`]: absolute times grow without bound and
/// would lose digits. A boundary whose walls do not move may ignore it. The centres of disks that no wall has been
/// passed by lie in [`Self::domain`] at all times.
pub trait Boundary {
    /// The rectangle that holds the centres of all disks at all times.
    fn domain(&self) -> Domain;

    /// A rectangle in the domain in which initial states are placed: without the reach of walls that move.
    fn interior(&self) -> Domain {
        self.domain()
    }

    fn wall_count(&self) -> usize;
    fn wall_name(&self, wall: usize) -> std::borrow::Cow<'_, str> {
        format!("wall {wall}").into()
    }
    fn fingerprint(&self) -> Option<crate::Fingerprint> {
        None
    }

    /// All times from now on are measured from this absolute time.
    fn set_time_origin(&mut self, origin: f64);

    /// Whether a disk with its centre in `region` can touch a wall; the engine asks [`Self::first_touch`] only there.
    ///
    /// Regions at the edge of the domain reach to infinity beyond it.
    fn may_touch(&self, region: &Region, radius: f64) -> bool;

    /// The first touch of this flight, not later than `until`.
    ///
    /// A wall that is touched already counts at once while it is approached, and never while it is left.
    fn first_touch(&self, flight: &Flight, until: f64) -> Option<Touch>;

    /// The surface that a disk at `position` touches at `time`.
    fn surface(&self, wall: usize, position: DVec2, time: f64) -> Surface<'_>;

    /// A wall that a disk at `position` overlaps at `time`, and by how much; `None` if it is inside.
    fn overlap(&self, position: DVec2, radius: f64, time: f64) -> Option<(usize, f64)>;
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
    fn wall_name(&self, wall: usize) -> std::borrow::Cow<'_, str> {
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
}
