//! Parts: bricks that share a rule, a motion and a surface.

mod constructors;
mod corners;
mod polygon;
mod travel;

use travel::Along;
pub(super) use travel::{Phase, Travel, Turning};

use glam::DVec2;

use super::brick::{Brick, Nearest};
use super::conduct::Conduct;
use super::vector::{finite_point, unit};
use super::{Surface, Thermal, VesselError};
use crate::collision::CollisionRule;
use crate::quantity::{accept, finite};
use crate::wall::{Motion, WallMotion};
use crate::{Fingerprint, Kind};

/// A part of a [`Vessel`](super::Vessel): bricks that share a rule, a kind, the motion of their surface and
/// their own motion.
///
/// A new part is at rest, follows the rule of the disks, and has the kind of walls. Corners are added
/// automatically wherever bricks end and a disk can touch the end.
///
/// | constructor | disks are free |
/// |---|---|
/// | [`polygon`](Self::polygon), [`drum`](Self::drum) | inside |
/// | [`block`](Self::block), [`peg`](Self::peg) | outside |
/// | [`polyline`](Self::polyline) | on both sides of a thin wall |
/// | [`new`](Self::new) | on the free sides of the bricks |
///
/// ```
/// use granular_edmd::boundary::{Part, Vessel};
/// use granular_edmd::glam::DVec2;
///
/// // An hourglass. Its points may go counterclockwise or clockwise.
/// let right = [(8.0, 0.0), (8.0, 6.0), (5.0, 10.0), (8.0, 14.0), (8.0, 20.0)];
/// let left = right.iter().rev().map(|&(x, y)| (8.0 - x, y));
/// let glass = Part::polygon(right.into_iter().chain(left).map(DVec2::from))?;
/// let vessel = Vessel::around([("glass", glass)])?;
/// # Ok::<(), granular_edmd::boundary::VesselError>(())
/// ```
#[derive(Debug, Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Part {
    bricks: Vec<Brick>,
    /// Points where the bricks end. They follow from the bricks, so files do not hold them.
    #[cfg_attr(feature = "serde", serde(skip))]
    corners: Vec<Brick>,
    travel: Travel,
    conduct: Conduct,
    kind: Kind,
    surface_speed: f64,
    /// Absolute time at which the motion has phase 0.
    start: f64,
    /// The kinds of the disks that it stops, in order; all kinds if there are none.
    #[cfg_attr(feature = "serde", serde(rename = "only_for"))]
    kinds: Vec<Kind>,
}

/// Properties.
impl Part {
    /// Returns the same part with its own rule.
    #[must_use]
    pub fn with_rule(self, rule: impl CollisionRule + Send + Sync + 'static) -> Self {
        Self { conduct: Conduct::rule(rule), ..self }
    }

    /// Returns the same part as a thermal wall.
    #[must_use]
    pub fn with_temperature(self, thermal: Thermal) -> Self {
        Self { conduct: Conduct::Thermal(thermal), ..self }
    }

    /// Returns the same part as a sink that takes a disk out of the run at its first touch.
    ///
    /// Observers see the touch as a last collision with the wall ([`Response::Absorbing`]).
    /// [`Arrivals`](crate::observable::Arrivals) counts them, and an [`Inlet`](crate::simulation::Inlet) puts
    /// disks in. A removal takes the same time however many disks there are: the last disk gets the index of
    /// the one that leaves.
    ///
    /// [`Response::Absorbing`]: super::Response::Absorbing
    #[must_use]
    pub fn absorbing(self) -> Self {
        Self { conduct: Conduct::Absorbing, ..self }
    }

    /// Returns the same part as a sink that takes a disk out of the run when its center arrives at a brick.
    ///
    /// Disks may overlap such a part: it is a line that their centers must not pass.
    ///
    /// ```
    /// use granular_edmd::prelude::*;
    ///
    /// // Grains that fall out of an open silo leave the run at the height 1.
    /// let line = Part::polyline([(-1.0, 1.0), (5.0, 1.0)].map(DVec2::from))?;
    /// let vessel = Vessel::new(Container::open(4.0)?).with("exit", line.absorbing_centers())?;
    /// let disk = |y: f64| Disk::new(DVec2::new(2.0, y), 0.5);
    /// let disks = [disk(1.25)?, disk(9.0)?];
    /// let mut run = Simulation::builder(Elastic, vessel).disks(disks).gravity(1.0).build()?;
    /// run.run_until(0.7, &mut ())?;
    /// assert_eq!(run.len(), 2);
    /// // The first center falls by 0.25 in the square root of 1/2.
    /// run.run_until(0.71, &mut ())?;
    /// assert_eq!((run.len(), run.disks()[0].id(), run.counters().removals), (1, 2, 1));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn absorbing_centers(self) -> Self {
        self.with_conduct(Conduct::AbsorbingCenters)
    }

    /// Returns the same part with this kind, as rules find it in the contact.
    #[must_use]
    pub fn with_kind(self, kind: Kind) -> Self {
        Self { kind, ..self }
    }

    /// Returns the same part for disks of these kinds only: all others pass through it, as through a sieve or
    /// a membrane.
    ///
    /// ```
    /// use granular_edmd::prelude::*;
    ///
    /// const SMALL: Kind = Kind::new(1);
    /// let membrane = Part::polyline([(5.0, 0.0), (5.0, 4.0)].map(DVec2::from))?;
    /// let vessel = Vessel::new(Container::closed(10.0, 4.0)?).with("membrane", membrane.only_for([SMALL]))?;
    /// let disk = |y: f64| Disk::new(DVec2::new(2.0, y), 0.5)?.with_velocity(DVec2::X);
    /// let disks = [disk(1.0)?, disk(3.0)?.with_kind(SMALL)];
    /// let mut run = Simulation::builder(Elastic, vessel).disks(disks).build()?;
    /// run.run_until(4.0, &mut ())?;
    /// assert_eq!(run.disks()[0].position().x, 6.0);
    /// assert_eq!(run.disks()[1].position().x, 3.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn only_for(self, kinds: impl IntoIterator<Item = Kind>) -> Self {
        let mut kinds: Vec<Kind> = kinds.into_iter().collect();
        kinds.sort_unstable();
        kinds.dedup();
        Self { kinds, ..self }
    }

    /// Returns the same part with a surface that moves along itself at this speed, like a conveyor belt.
    ///
    /// At a positive speed, the surface moves in the direction that has the free side on its left: from left
    /// to right on the upper side of a floor, counterclockwise inside a polygon or a drum, clockwise around a
    /// block. The belt around a thin wall runs along the wall's direction on its left side, and back on the
    /// other side.
    ///
    /// # Errors
    /// If the speed is not finite.
    pub fn with_surface_speed(self, speed: f64) -> Result<Self, VesselError> {
        Ok(Self { surface_speed: finite("surface speed", speed)?, ..self })
    }

    /// Returns the same part with a motion along a direction, in place of an earlier motion along one.
    ///
    /// The vector `direction` can have any length except 0. A part that also [turns](Self::with_rotation)
    /// moves along the same direction at all times, and takes the point about which it turns along.
    ///
    /// # Errors
    /// If the direction has no length, or the motion gives numbers that are not finite at one of the phases
    /// that [`check_finite`](crate::wall::check_finite) looks at. Also if the motion jumps, as a
    /// [`Sawtooth`](crate::wall::Sawtooth) does, and disks are free on a side of the part toward which it
    /// would jump. A part that turns has no such side, so no motion of it may jump.
    pub fn with_motion(
        self,
        direction: DVec2,
        motion: impl WallMotion + Send + Sync + 'static,
    ) -> Result<Self, VesselError> {
        let direction = unit(direction)?;
        let motion = Motion::new(motion).map_err(|violation| VesselError::Motion { violation })?;
        self.moving(Along { direction, motion })
    }

    /// Returns the same part, turning about a point in place of an earlier rotation, counterclockwise at this
    /// angular velocity.
    ///
    /// With a [motion](Self::with_motion), the point moves along: with the point $`c`$, the direction $`e`$
    /// and the displacement $`z`$, the place $`r`$ of the part as built is at the time $`t`$ in
    ///
    /// ```math
    /// c + z(t)\,e + R(\omega t)\,(r - c),\qquad\text{at the velocity}\quad
    /// \dot z(t)\,e + \omega\,R(\omega t)\,(r - c)_\perp .
    /// ```
    ///
    /// A circle about that point stays in place; only its surface moves. Any other part is where it was built
    /// at time 0, and after each whole turn.
    ///
    /// # Errors
    /// If a number is not finite, or the angular velocity is so small or large that a turn would take more
    /// than 1e60 or less than 1e-60. An angular velocity of 0 is allowed: the part then does not turn.
    /// Also if the part has a motion that jumps.
    ///
    /// ```
    /// use granular_edmd::boundary::{Boundary, Part, Vessel};
    /// use granular_edmd::glam::DVec2;
    /// use granular_edmd::wall::Tabulated;
    ///
    /// // A stirrer that turns, and travels by 10 to the right in a time of 20.
    /// let stirrer = Part::polyline([DVec2::new(-3.0, 0.0), DVec2::new(3.0, 0.0)])?
    ///     .with_rotation(DVec2::ZERO, 1.0)?
    ///     .with_motion(DVec2::X, Tabulated::from_to(0.0, 10.0, 20.0)?)?;
    /// let vessel = Vessel::around([("stirrer", stirrer)])?;
    /// let wall = vessel.walls("stirrer").unwrap().start;
    /// // Halfway, its middle moves at the speed 1.
    /// let surface = vessel.surface(wall, DVec2::new(5.0, 0.0), 10.0);
    /// assert!(surface.velocity.distance(DVec2::X) < 1e-12);
    /// # Ok::<(), granular_edmd::boundary::VesselError>(())
    /// ```
    pub fn with_rotation(self, about: DVec2, angular_velocity: f64) -> Result<Self, VesselError> {
        let about = finite_point(about)?;
        if finite("angular velocity", angular_velocity)? == 0.0 {
            return Ok(Self { travel: Travel { turning: None, ..self.travel }, ..self });
        }
        let turn = std::f64::consts::TAU / angular_velocity.abs();
        let range = "such that a turn takes from 1e-60 to 1e60";
        accept((1e-60..=1e60).contains(&turn), "angular velocity", range, angular_velocity)?;
        let is_round = self.all_bricks().all(|brick| brick.is_circle_about(about));
        let turning = Some(Turning { about, angular_velocity, is_round });
        Self { travel: Travel { turning, ..self.travel }, ..self }.safe()
    }

    /// Returns the same part with a motion whose phase counts from this absolute time instead of 0.
    ///
    /// A moving part that is added to a run should start at the present time. It is then where it was built,
    /// if its motion has no displacement at phase 0. The start is no delay: before it, the part goes through
    /// the phases before 0.
    ///
    /// # Errors
    /// If the time is not finite.
    ///
    /// ```
    /// use granular_edmd::boundary::{Boundary, Part, Probe, Vessel};
    /// use granular_edmd::glam::DVec2;
    ///
    /// let wheel = Part::block([(0.0, 0.0), (8.0, 0.0), (8.0, 1.0), (0.0, 1.0)].map(DVec2::from))?;
    /// let wheel = wheel.with_rotation(DVec2::new(4.0, 0.5), 0.7)?.starting_at(30.0)?;
    /// let vessel = Vessel::around([("wheel", wheel)])?;
    /// // At time 30 the wheel lies as it was built.
    /// let probe = Probe::new(DVec2::new(1.0, 1.25), 0.5, 0.0);
    /// let depth = |time| vessel.overlap(&probe.with_time(time)).map_or(0.0, |overlap| overlap.depth);
    /// assert!((depth(30.0) - 0.25).abs() < 1e-12);
    /// assert_eq!(depth(0.0), 0.0);
    /// # Ok::<(), granular_edmd::boundary::VesselError>(())
    /// ```
    pub fn starting_at(self, time: f64) -> Result<Self, VesselError> {
        Ok(Self { start: finite("start of a motion", time)?, ..self })
    }

    /// Returns the same part, shifted by a vector.
    ///
    /// If the part turns about a point, that point shifts with it.
    ///
    /// # Errors
    /// If a coordinate would not be finite.
    pub fn shifted(mut self, by: DVec2) -> Result<Self, VesselError> {
        for brick in self.bricks.iter_mut().chain(&mut self.corners) {
            *brick = brick.shifted(by)?;
        }
        if let Some(Turning { about, .. }) = &mut self.travel.turning {
            *about = finite_point(*about + by)?;
        }
        Ok(self)
    }

    /// Returns the same part, rotated about a point, counterclockwise by this angle in radians.
    ///
    /// The direction of its motion and the point about which it turns rotate with it.
    ///
    /// # Errors
    /// If an argument is not finite, or a coordinate would not be.
    pub fn rotated(mut self, about: DVec2, angle: f64) -> Result<Self, VesselError> {
        for brick in self.bricks.iter_mut().chain(&mut self.corners) {
            *brick = brick.rotated(about, angle)?;
        }
        let turn = super::vector::direction(angle);
        if let Some(Along { direction, .. }) = &mut self.travel.along {
            *direction = unit(turn.rotate(*direction))?;
        }
        if let Some(Turning { about: pivot, .. }) = &mut self.travel.turning {
            *pivot = finite_point(about + turn.rotate(*pivot - about))?;
        }
        Ok(self)
    }

    /// Returns the bricks, without the corners that were added.
    pub fn bricks(&self) -> &[Brick] {
        &self.bricks
    }

    /// Returns the distance of a place from the part as it was built, negative where no disk can be.
    pub fn signed_distance(&self, place: DVec2) -> f64 {
        self.nearest(place).map_or(f64::INFINITY, |(_, distance)| distance)
    }
}

impl Part {
    /// Gives the part this conduct. Centers are points, so they need no corners where bricks end.
    fn with_conduct(mut self, conduct: Conduct) -> Self {
        self.conduct = conduct;
        if self.takes_centers() {
            self.corners.clear();
        }
        self
    }

    /// Tells whether the part is a line for centers, which disks may overlap.
    pub(super) fn takes_centers(&self) -> bool {
        matches!(self.conduct, Conduct::AbsorbingCenters)
    }

    /// Returns whether disks of this kind touch the part.
    #[inline]
    pub(super) fn stops(&self, kind: Kind) -> bool {
        self.kinds.is_empty() || self.kinds.contains(&kind)
    }

    /// Returns whether the part treats disks otherwise than a plain wall, so that it replaces the stretch of
    /// a wall in which it lies.
    pub(super) fn is_patch(&self) -> bool {
        let is_plain = matches!(self.conduct, Conduct::Shared) && self.kind == Kind::WALL;
        !is_plain || self.surface_speed != 0.0
    }

    /// Gives the part a motion along a direction, if the part can move in this way.
    fn moving(self, along: Along) -> Result<Self, VesselError> {
        Self { travel: Travel { along: Some(along), ..self.travel }, ..self }.safe()
    }

    /// Returns the part, if it never jumps into disks.
    fn safe(self) -> Result<Self, VesselError> {
        let Travel { along: Some(Along { direction, motion }), turning } = &self.travel else {
            return Ok(self);
        };
        let faces = turning.is_none() && self.all_bricks().all(|brick| brick.faces(*direction));
        if faces || !motion.jumps() { Ok(self) } else { Err(VesselError::Jump) }
    }

    /// Iterates over all bricks: as given, then the corners.
    pub(super) fn all_bricks(&self) -> impl Iterator<Item = &Brick> {
        self.bricks.iter().chain(&self.corners)
    }

    /// Returns whether a place changes from free to not free only across bricks.
    pub(super) fn is_closed(&self) -> bool {
        corners::are_closed(&self.bricks)
    }

    pub(super) fn travel(&self) -> &Travel {
        &self.travel
    }

    /// Returns the phase of the motion at a time origin.
    ///
    /// Both remainders are exact. Their difference has the rounding of a phase, not that of a late time.
    pub(super) fn phase(&self, origin: f64) -> Phase {
        self.travel.phase(origin).since(self.travel.phase(self.start))
    }

    /// Returns a rectangle around the part as it was built. Its edges may be infinite.
    pub(super) fn bounds(&self) -> (DVec2, DVec2) {
        enclosing(self.all_bricks().map(Brick::bounds))
    }

    /// Returns a rectangle that holds the part at all times. Its edges may be infinite.
    pub(super) fn swept_bounds(&self) -> (DVec2, DVec2) {
        enclosing(self.all_bricks().map(|brick| self.travel.bounds(brick)))
    }

    /// Returns the number of the nearest brick and the distance from it, negative behind it.
    pub(super) fn nearest(&self, place: DVec2) -> Option<(usize, f64)> {
        let sights = self.all_bricks().map(|brick| Sighted::new(brick, place)).enumerate();
        let nearest = sights.reduce(|a, b| if b.1.is_better_than(&a.1) { b } else { a });
        nearest.map(|(brick, sighted)| (brick, sighted.signed_distance()))
    }

    /// Returns the surface of the part with this normal, where the part moves at this velocity.
    pub(super) fn surface(&self, normal: DVec2, velocity: DVec2) -> Surface<'_> {
        let along = -normal.perp() * self.surface_speed;
        Surface::new(normal, velocity + along).with_response(self.conduct.response()).with_kind(self.kind)
    }

    pub(super) fn fingerprint(&self) -> Option<Fingerprint> {
        let kind = f64::from(self.kind.number());
        let part = Fingerprint::of("Part").number(self.surface_speed).number(self.start).number(kind);
        let part = part.part(self.travel.fingerprint()?).part(self.conduct.fingerprint()?);
        let kinds =
            self.kinds.iter().fold(part, |part, kind| part.text("only for").number(kind.number().into()));
        Some(self.all_bricks().fold(kinds, |part, brick| part.part(brick.fingerprint())))
    }
}

/// Returns the rectangle around some rectangles.
pub(super) fn enclosing(rectangles: impl Iterator<Item = (DVec2, DVec2)>) -> (DVec2, DVec2) {
    let none = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    rectangles.fold(none, |all, one| (all.0.min(one.0), all.1.max(one.1)))
}

/// A brick as seen from a place.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sighted {
    nearest: Nearest,
    /// Distance below which two bricks count as equally far.
    rounding: f64,
}

impl Sighted {
    pub(super) fn new(brick: &Brick, place: DVec2) -> Self {
        const ROUNDING: f64 = 1e-12;
        let nearest = brick.nearest(place);
        Self { nearest, rounding: ROUNDING * (nearest.distance + place.length()) }
    }

    /// Tells whether this brick decides the side of a place rather than another one: it is nearer, or equally
    /// near and seen less edge-on.
    ///
    /// Two bricks that meet at the nearest point are equally far away up to rounding. Of these, the brick
    /// whose extension beyond its ends is farther from the place decides: the place sees it less from its
    /// end.
    pub(super) fn is_better_than(&self, other: &Self) -> bool {
        let nearer = other.nearest.distance - self.nearest.distance;
        let is_tie = nearer.abs() <= other.rounding;
        if is_tie { self.nearest.weight > other.nearest.weight } else { nearer > 0.0 }
    }

    pub(super) fn distance(&self) -> f64 {
        self.nearest.distance
    }

    /// Returns the distance, negative behind the brick.
    pub(super) fn signed_distance(&self) -> f64 {
        if self.nearest.is_free { self.nearest.distance } else { -self.nearest.distance }
    }
}
