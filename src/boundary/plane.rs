//! A straight wall that may move along its normal.

use glam::DVec2;

use super::surface::Conduct;
use super::surface::Surface;
use super::{Region, Wall, WallError, WallView};
use crate::wall::{Approach, FirstTouch, Motion, Stroke, first_touch};
use crate::{Fingerprint, Flight, Kind};

/// A straight wall of a container: the disks stay on one side of a line.
///
/// Files do not hold its position, which follows from the size and the corner of the container.
#[derive(Debug, Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields, rename = "ContainerWall"))]
pub(super) struct Plane {
    pub(super) wall: Wall,
    /// Unit vector from the wall to the disks.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub(super) normal: DVec2,
    /// Position of the wall at rest, along its normal.
    #[cfg_attr(feature = "serde", serde(skip))]
    place: f64,
    #[cfg_attr(feature = "serde", serde(deserialize_with = "crate::wall::motion_or_piston"))]
    pub(super) motion: Motion,
    /// Largest displacement of the motion.
    #[cfg_attr(feature = "serde", serde(skip))]
    highest: f64,
    pub(super) conduct: Conduct,
    pub(super) kind: Kind,
    /// Phase of the motion at the time origin.
    #[cfg_attr(feature = "serde", serde(skip))]
    phase: f64,
    #[cfg_attr(feature = "serde", serde(default))]
    pub(super) slide: Option<Slide>,
}

/// The tangential motion of a wall: to the right, or up. It sets disks spinning and carries them along, but
/// never moves the wall into them.
#[derive(Debug, Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case", deny_unknown_fields))]
pub(super) enum Slide {
    Speed(f64),
    Motion {
        motion: Motion,
        /// Phase of the motion at the time origin.
        #[cfg_attr(feature = "serde", serde(skip))]
        phase: f64,
    },
}

impl Slide {
    fn set_time_origin(&mut self, origin: f64) {
        if let Self::Motion { motion, phase } = self {
            *phase = motion.phase(origin);
        }
    }

    fn speed(&self, time: f64) -> f64 {
        match self {
            Self::Speed(speed) => *speed,
            Self::Motion { motion, phase } => motion.state(time + phase).velocity,
        }
    }

    fn fingerprint(&self) -> Option<Fingerprint> {
        let slide = Fingerprint::of("Slide");
        match self {
            Self::Speed(speed) => Some(slide.number(*speed)),
            Self::Motion { motion, .. } => Some(slide.part(motion.fingerprint()?)),
        }
    }
}

impl Plane {
    pub(super) fn new(wall: Wall, normal: DVec2, place: f64) -> Self {
        let (motion, conduct, kind) = (Motion::none(), Conduct::Shared, Kind::WALL);
        Self { wall, normal, place, motion, highest: 0.0, conduct, kind, phase: 0.0, slide: None }
    }

    /// Returns whether the wall has its default properties.
    pub(super) fn is_plain(&self) -> bool {
        let is_still = self.motion.reach() == (0.0, 0.0) && self.slide.is_none();
        is_still && matches!(self.conduct, Conduct::Shared) && self.kind == Kind::WALL
    }

    pub(super) fn shift(&mut self, by: DVec2) {
        self.place += self.normal.dot(by);
    }

    /// Sets the motion along the normal. A piston and a motion would replace each other, which is an error.
    pub(super) fn set_motion(&mut self, motion: Motion) -> Result<(), WallError> {
        let moves = self.motion.reach() != (0.0, 0.0);
        if moves && self.motion.stroke().is_some() != motion.stroke().is_some() {
            return Err(WallError::Lost { wall: self.wall });
        }
        self.highest = motion.reach().1;
        self.motion = motion;
        Ok(())
    }

    /// Sets the sliding motion of the wall. Returns an error if the wall has one already, which would be
    /// lost, such as a belt in a box that is shaken sideways.
    pub(super) fn set_slide(&mut self, slide: Slide) -> Result<(), WallError> {
        if self.slide.replace(slide).is_some() { Err(WallError::Lost { wall: self.wall }) } else { Ok(()) }
    }

    /// Returns the smallest distance to a wall that faces this one; `None` for any other wall.
    pub(super) fn least_gap(&self, other: &Self) -> Option<f64> {
        let faces = self.normal == -other.normal;
        faces.then(|| -(self.place + other.place) - self.highest - other.highest)
    }

    /// Returns how far the wall can move inward; for a piston, its displacement at the start.
    pub(super) fn advance(&self) -> f64 {
        self.motion.stroke().map_or(self.highest, Stroke::first_displacement).max(0.0)
    }

    pub(super) fn set_time_origin(&mut self, origin: f64) {
        self.motion.change(|piston| piston.at_origin(origin));
        self.phase = self.motion.phase(origin);
        if let Some(slide) = &mut self.slide {
            slide.set_time_origin(origin);
        }
    }

    /// Changes the motion of the wall by this impulse. Returns whether the wall has a mass, so that its
    /// motion has changed.
    pub(super) fn take(&mut self, impulse: DVec2, time: f64) -> bool {
        let (normal, phase) = (self.normal, self.phase);
        self.motion.change(|piston| piston.struck(impulse.dot(normal), time + phase))
    }

    /// Returns whether a disk with its center in `region` may touch the wall up to this time, unless another
    /// disk hits the wall.
    pub(super) fn may_meet(&self, region: &Region, radius: f64, until: f64) -> bool {
        let highest = self.motion.stroke().map_or(self.highest, |stroke| stroke.range_until(until).1);
        region.least_along(self.normal) - self.place - radius <= highest
    }

    /// Returns whether a disk with its center in `region` can touch the wall at any time.
    pub(super) fn may_touch(&self, region: &Region, radius: f64) -> bool {
        region.least_along(self.normal) - self.place - radius <= self.highest
    }

    pub(super) fn first_touch(&self, flight: &Flight, until: f64) -> FirstTouch<f64> {
        let height = flight.position(flight.time()).dot(self.normal) - self.place - flight.radius();
        let approach = Approach::new(
            flight.time() + self.phase,
            height,
            flight.velocity(flight.time()).dot(self.normal),
            flight.acceleration().dot(self.normal),
        );
        // Most flights end at the edge of their cell before they get near this wall. They need no search.
        if approach.stays_above(self.highest, until + self.phase) {
            return FirstTouch::NONE;
        }
        // Adding the phase rounds the time, and subtracting it rounds again. The bounds keep the touch within
        // the flight.
        match first_touch(&*self.motion, &approach, until + self.phase) {
            FirstTouch::At(touch) => FirstTouch::At((touch - self.phase).max(flight.time()).min(until)),
            FirstTouch::NotBefore(open) => FirstTouch::NotBefore((open - self.phase).max(flight.time())),
        }
    }

    pub(super) fn surface(&self, time: f64) -> Surface<'_> {
        let mut velocity = self.normal * self.motion.state(time + self.phase).velocity;
        if let Some(slide) = &self.slide {
            // The direction is to the right along a floor or a lid, and up along a side.
            velocity += self.normal.perp().abs() * slide.speed(time);
        }
        let surface = Surface::new(self.normal, velocity).with_response(self.conduct.response());
        let mass = self.motion.stroke().map_or(f64::INFINITY, Stroke::mass);
        surface.with_kind(self.kind).with_mass(mass)
    }

    /// Returns a point of the wall.
    pub(super) fn place(&self, time: f64) -> DVec2 {
        self.normal * (self.place + self.motion.state(time + self.phase).displacement)
    }

    /// Returns the view of the wall at a time.
    pub(super) fn view(&self, time: f64) -> WallView<'_> {
        let mut view = WallView::new(self.wall.name()).with_side(self.wall).with_point(self.place(time));
        let ((low, high), phase) = (self.motion.reach(), self.motion.phase(time + self.phase));
        let displacement = self.motion.state(time + self.phase).displacement;
        view.energy = self.motion.stroke().map(|piston| piston.energy(time));
        // Adding zeros turns negative zeros into positive ones.
        let moved = (displacement * self.normal + DVec2::ZERO, phase);
        view.motion = (low != high || view.energy.is_some()).then_some(moved);
        view
    }

    /// Returns whether a disk is near enough to overlap the wall at some phase of the motion.
    #[inline]
    pub(super) fn is_within_reach(&self, position: DVec2, radius: f64) -> bool {
        position.dot(self.normal) - self.place - radius <= self.highest
    }

    /// Returns the depth to which a disk reaches into the wall; negative if the disk does not touch the wall.
    pub(super) fn depth(&self, position: DVec2, radius: f64, time: f64) -> f64 {
        let wall = self.place + self.motion.state(time + self.phase).displacement;
        wall + radius - position.dot(self.normal)
    }

    /// Returns the fingerprint of motion, kind, response and sliding, if all of them have one. The container
    /// adds the position of the wall.
    pub(super) fn fingerprint(&self) -> Option<Fingerprint> {
        let kind = f64::from(self.kind.number());
        let plane = Fingerprint::of("Plane").part(self.motion.fingerprint()?).number(kind);
        let plane = plane.part(self.conduct.fingerprint()?);
        match &self.slide {
            Some(slide) => Some(plane.part(slide.fingerprint()?)),
            None => Some(plane),
        }
    }
}
