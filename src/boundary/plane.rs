//! A straight wall that may move along its normal.

use std::fmt;
use std::sync::Arc;

use glam::DVec2;

use super::Region;
use super::surface::{Response, Surface, Thermal};
use crate::collision::CollisionRule;
use crate::wall::{Approach, Fixed, WallMotion, first_touch};
use crate::{Fingerprint, Flight, Kind};

/// A straight wall: the disks stay on one side of a line.
#[derive(Clone)]
pub(super) struct Plane {
    /// Unit vector from the wall to the disks.
    normal: DVec2,
    /// Place of the wall at rest, along its normal.
    place: f64,
    motion: Arc<dyn WallMotion + Send + Sync>,
    /// Upper end of the motion's reach.
    highest: f64,
    conduct: Conduct,
    kind: Kind,
    /// Phase of the motion at the time origin.
    phase: f64,
}

/// Response of the wall to a touch, in owned form. [`Response`] lends it out.
#[derive(Clone)]
pub(super) enum Conduct {
    Shared,
    Rule(Arc<dyn CollisionRule + Send + Sync>),
    Thermal(Thermal),
}

impl fmt::Debug for Plane {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter
            .debug_struct("Plane")
            .field("normal", &self.normal)
            .field("place", &self.place)
            .field("reach", &self.motion.reach())
            .finish_non_exhaustive()
    }
}

impl Plane {
    pub(super) fn new(normal: DVec2, place: f64) -> Self {
        let (motion, conduct, kind) = (Arc::new(Fixed), Conduct::Shared, Kind::WALL);
        Self { normal, place, motion, highest: 0.0, conduct, kind, phase: 0.0 }
    }

    pub(super) fn set_motion(&mut self, motion: Arc<dyn WallMotion + Send + Sync>) {
        self.highest = motion.reach().1;
        self.motion = motion;
    }

    pub(super) fn set_conduct(&mut self, conduct: Conduct) {
        self.conduct = conduct;
    }

    pub(super) fn set_kind(&mut self, kind: Kind) {
        self.kind = kind;
    }

    pub(super) fn set_time_origin(&mut self, origin: f64) {
        let (low, high) = self.motion.reach();
        self.phase = match self.motion.period() {
            // A wall that never leaves its place is the same at all times. Phase 0 costs the times none of
            // their digits.
            _ if low == high => 0.0,
            // The remainder of two floats is exact, so the phase keeps all its digits however late the time
            // is.
            Some(period) => origin % period,
            None => origin,
        };
    }

    pub(super) fn reach(&self) -> (f64, f64) {
        self.motion.reach()
    }

    /// Tells whether a disk with its center in `region` can touch the wall at any time.
    pub(super) fn may_touch(&self, region: &Region, radius: f64) -> bool {
        let nearest = DVec2::select(self.normal.cmpgt(DVec2::ZERO), region.min, region.max);
        // A zero component of the normal must not be multiplied by an infinite edge: the product is not a
        // number.
        let along = |component: f64, edge: f64| if component == 0.0 { 0.0 } else { component * edge };
        let height = along(self.normal.x, nearest.x) + along(self.normal.y, nearest.y) - self.place;
        height - radius <= self.highest
    }

    pub(super) fn first_touch(&self, flight: &Flight, until: f64) -> Option<f64> {
        let height = flight.position(flight.time()).dot(self.normal) - self.place - flight.radius();
        let approach = Approach::new(
            flight.time() + self.phase,
            height,
            flight.velocity(flight.time()).dot(self.normal),
            flight.acceleration().dot(self.normal),
        );
        // Most flights end in another cell before they get near this wall. They need no search.
        if approach.stays_above(self.highest, until + self.phase) {
            return None;
        }
        let touch = first_touch(&*self.motion, &approach, until + self.phase)?;
        // Adding the phase rounds the time, and subtracting it rounds again. The bounds keep the touch within
        // the flight.
        Some((touch - self.phase).max(flight.time()).min(until))
    }

    pub(super) fn surface(&self, time: f64) -> Surface<'_> {
        let response = match &self.conduct {
            Conduct::Shared => Response::Shared,
            Conduct::Rule(rule) => Response::Rule(&**rule),
            Conduct::Thermal(thermal) => Response::Thermal(*thermal),
        };
        let velocity = self.normal * self.motion.state(time + self.phase).velocity;
        Surface::new(self.normal, velocity).with_response(response).with_kind(self.kind)
    }

    /// Tells whether a disk is so near that it overlaps the wall at some time of the motion.
    #[inline]
    pub(super) fn is_within_reach(&self, position: DVec2, radius: f64) -> bool {
        position.dot(self.normal) - self.place - radius <= self.highest
    }

    /// Returns how far a disk reaches into the wall; negative if the disk does not touch the wall.
    pub(super) fn depth(&self, position: DVec2, radius: f64, time: f64) -> f64 {
        let wall = self.place + self.motion.state(time + self.phase).displacement;
        wall + radius - position.dot(self.normal)
    }

    /// Returns the fingerprint of motion and response, if both have one. The container adds the place of the
    /// wall.
    pub(super) fn fingerprint(&self) -> Option<Fingerprint> {
        let kind = f64::from(self.kind.number());
        let plane = Fingerprint::of("Plane").part(self.motion.fingerprint()?).number(kind);
        Some(plane.part(match &self.conduct {
            Conduct::Shared => Fingerprint::of("Shared"),
            Conduct::Rule(rule) => Fingerprint::of("Rule").part(rule.fingerprint()?),
            Conduct::Thermal(thermal) => thermal.fingerprint(),
        }))
    }
}
