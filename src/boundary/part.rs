//! Parts: bricks that share a rule, a motion and a surface.

mod motion;
mod shapes;
mod travel;

use travel::Along;
pub(super) use travel::{Phase, Pose, Travel, Turning};

use glam::DVec2;

use super::brick::Brick;
use super::surface::Conduct;
use super::{Region, Surface, Thermal, WallError};
use crate::collision::CollisionRule;
use crate::quantity::finite;
use crate::{Fingerprint, Kind};

/// A part of a [`Container`](super::Container): bricks that share a rule, a kind, the motion of their surface
/// and their own motion.
///
/// A new part is at rest, follows the rule of the disks, and has the default kind of walls. It has one
/// response: a rule, a temperature and an absorbing part replace each other. Corners are added automatically
/// wherever bricks end and a disk can touch the end.
///
/// | constructor | disks are free |
/// |---|---|
/// | [`polygon`](Self::polygon), [`drum`](Self::drum) | inside |
/// | [`block`](Self::block), [`peg`](Self::peg) | outside |
/// | [`polyline`](Self::polyline) | on both sides of a thin wall |
/// | [`new`](Self::new) | on the free sides of the bricks |
///
/// ```
/// use granular_edmd::boundary::{Container, Part};
/// use granular_edmd::glam::DVec2;
///
/// // An hourglass. Its points may go counterclockwise or clockwise.
/// let right = [(8.0, 0.0), (8.0, 6.0), (5.0, 10.0), (8.0, 14.0), (8.0, 20.0)];
/// let left = right.iter().rev().map(|&(x, y)| (8.0 - x, y));
/// let glass = Part::polygon(right.into_iter().chain(left).map(DVec2::from))?;
/// let container = Container::around([("glass", glass)])?;
/// # Ok::<(), granular_edmd::boundary::WallError>(())
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
    /// The kinds of the disks that the part stops, in order, unless it stops all.
    #[cfg_attr(feature = "serde", serde(rename = "only_for"))]
    kinds: Option<Vec<Kind>>,
}

/// Properties.
impl Part {
    /// Returns the same part, at which disks collide by this rule instead of their own.
    #[must_use]
    pub fn with_rule(self, rule: impl CollisionRule + Send + Sync + 'static) -> Self {
        self.with_conduct(Conduct::rule(rule))
    }

    /// Returns the same part as a thermal wall.
    #[must_use]
    pub fn with_temperature(self, thermal: Thermal) -> Self {
        self.with_conduct(Conduct::Thermal(thermal))
    }

    /// Returns the same part as a sink that takes a disk out of the run at its first touch.
    ///
    /// Observers see the touch as a last collision with the wall ([`Response::Absorbing`]).
    /// [`Arrivals`](crate::observable::Arrivals) counts these collisions, and an
    /// [`Inlet`](crate::simulation::Inlet) puts disks in. A removal takes the same time however many disks
    /// there are: the last disk gets the index of the removed disk.
    ///
    /// [`Response::Absorbing`]: super::Response::Absorbing
    #[must_use]
    pub fn absorbing(self) -> Self {
        self.with_conduct(Conduct::Absorbing)
    }

    /// Returns the same part as a sink that takes a disk out of the run when its center arrives at a brick.
    ///
    /// Disks may overlap such a part: it is a line that their centers must not pass. A center arrives when it
    /// is within 1e-7 radii of the line, on a side on which the brick is free. A center that begins on the
    /// line, or behind a one-sided brick, does not arrive. At times later than $`10^8R/v`$, the position of a
    /// line that moves without a period has a rounding error above this distance, and centers may pass. A
    /// line that lies in a wall, which no center can reach, takes a disk out when the disk touches the wall
    /// there, as [`absorbing`](Self::absorbing) does.
    ///
    /// ```
    /// use granular_edmd::prelude::*;
    ///
    /// // Grains that fall out of an open silo leave the run at the height 1.
    /// let line = Part::polyline([(-1.0, 1.0), (5.0, 1.0)].map(DVec2::from))?;
    /// let silo = Container::open(4.0)?.with_part("exit", line.absorbing_centers())?;
    /// let disk = |y: f64| Disk::new(DVec2::new(2.0, y), 0.5);
    /// let disks = [disk(1.25)?, disk(9.0)?];
    /// let mut run = Simulation::builder(Elastic, silo).disks(disks).gravity(1.0).build()?;
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

    /// Returns the same part with this kind, which rules read from the contact.
    #[must_use]
    pub fn with_kind(self, kind: Kind) -> Self {
        Self { kind, ..self }
    }

    /// Returns the same part for disks of these kinds only: all others pass through it, as through a sieve or
    /// a membrane. A part for no kinds at all would stop no disk, and a container refuses it.
    ///
    /// If such a part has an inside, as a block, a peg, a polygon and a drum have, the free area is not the
    /// same for all kinds. Its container then does not know the [`area`](super::Boundary::area), and
    /// stresses, densities and profiles are refused unless they are restricted to a region that no wall
    /// reaches. A line of two-sided bricks, such as a [`polyline`](Self::polyline), encloses no area, so this
    /// restriction does not apply to it.
    ///
    /// ```
    /// use granular_edmd::prelude::*;
    ///
    /// const SMALL: Kind = Kind::new(1);
    /// let membrane = Part::polyline([(5.0, 0.0), (5.0, 4.0)].map(DVec2::from))?;
    /// let cell = Container::closed(10.0, 4.0)?.with_part("membrane", membrane.only_for([SMALL]))?;
    /// let disk = |y: f64| Disk::new(DVec2::new(2.0, y), 0.5)?.with_velocity(DVec2::X);
    /// let disks = [disk(1.0)?, disk(3.0)?.with_kind(SMALL)];
    /// let mut run = Simulation::builder(Elastic, cell).disks(disks).build()?;
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
        Self { kinds: Some(kinds), ..self }
    }

    /// Returns the same part with a surface that moves tangentially at this speed, like a conveyor belt.
    ///
    /// At a positive speed, the surface moves in the direction that has the free side on its left: from left
    /// to right on the upper side of a floor, counterclockwise inside a polygon or a drum, clockwise around a
    /// block. The belt around a thin wall runs along the wall's direction on its left side, and back on the
    /// other side.
    ///
    /// # Errors
    /// If the speed is not finite.
    pub fn with_surface_speed(self, speed: f64) -> Result<Self, WallError> {
        Ok(Self { surface_speed: finite("surface speed", speed)?, ..self })
    }

    /// Returns the bricks, without the corners that were added.
    pub fn bricks(&self) -> &[Brick] {
        &self.bricks
    }

    /// Returns the distance of a point from the part in its original position, negative where no disk can be.
    pub fn signed_distance(&self, place: DVec2) -> f64 {
        self.nearest(place).map_or(f64::INFINITY, |(_, distance)| distance)
    }
}

impl Part {
    /// Sets the response of the part. A line for centers needs no corners where its bricks end, since a
    /// center is a point.
    fn with_conduct(mut self, conduct: Conduct) -> Self {
        self.conduct = conduct;
        self.corners = if self.takes_centers() { Vec::new() } else { shapes::corners(&self.bricks) };
        self
    }

    /// Returns whether the part is a line for centers, which disks may overlap.
    pub(super) fn takes_centers(&self) -> bool {
        matches!(self.conduct, Conduct::AbsorbingCenters)
    }

    /// Returns whether disks of this kind touch the part.
    #[inline]
    pub(super) fn stops(&self, kind: Kind) -> bool {
        self.kinds.as_ref().is_none_or(|kinds| kinds.contains(&kind))
    }

    /// Returns whether there are places behind the part, where no disk can be.
    pub(super) fn has_back(&self) -> bool {
        !self.takes_centers() && self.all_bricks().any(|brick| !brick.is_two_sided() && !brick.is_point())
    }

    /// Returns whether the places behind the part are free for some kinds of disks, and for others not.
    pub(super) fn is_full_for_some(&self) -> bool {
        self.kinds.is_some() && self.has_back()
    }

    /// Returns whether the part stops no disk at all.
    pub(super) fn stops_none(&self) -> bool {
        self.kinds.as_ref().is_some_and(Vec::is_empty)
    }

    /// Returns whether the part treats disks differently from a plain wall, so that it replaces the section
    /// of a wall in which it lies.
    pub(super) fn is_patch(&self) -> bool {
        let is_plain = matches!(self.conduct, Conduct::Shared) && self.kind == Kind::WALL;
        !is_plain || self.surface_speed != 0.0
    }

    /// Iterates over all bricks: the given bricks, then the corners.
    pub(super) fn all_bricks(&self) -> impl Iterator<Item = &Brick> {
        self.bricks.iter().chain(&self.corners)
    }

    /// Returns whether all borders between free and occupied regions lie on bricks.
    pub(super) fn is_closed(&self) -> bool {
        shapes::are_closed(&self.bricks)
    }

    pub(super) fn travel(&self) -> &Travel {
        &self.travel
    }

    /// Returns the phase of the motion at a time origin.
    ///
    /// Both remainders are exact. Their difference has the rounding error of a phase, not of a late time.
    pub(super) fn phase(&self, origin: f64) -> Phase {
        self.travel.phase(origin).since(self.travel.phase(self.start))
    }

    /// Returns a rectangle that holds the part at all times.
    pub(super) fn swept_bounds(&self) -> Region {
        Region::enclosing(self.all_bricks().map(|brick| self.travel.bounds(brick)))
    }

    /// Returns the number of the nearest brick and the distance from it, negative behind the brick.
    pub(super) fn nearest(&self, place: DVec2) -> Option<(usize, f64)> {
        let all = self.all_bricks().map(|brick| brick.nearest(place)).enumerate();
        let nearest = all.reduce(|a, b| if b.1.is_better_than(&a.1) { b } else { a });
        nearest.map(|(brick, nearest)| (brick, nearest.signed_distance))
    }

    /// Returns the surface of the part with this normal and radius, where the part moves at this velocity.
    /// A belt turns like a drum where it is curved.
    pub(super) fn surface(&self, normal: DVec2, radius: f64, velocity: DVec2) -> Surface<'_> {
        let along = -normal.perp() * self.surface_speed;
        Surface::new(normal, velocity + along)
            .with_radius(radius)
            .with_response(self.conduct.response())
            .with_kind(self.kind)
            .with_angular_velocity(self.travel.angular_velocity() - self.surface_speed / radius)
            .with_mass(self.travel.mass(normal))
    }

    pub(super) fn fingerprint(&self) -> Option<Fingerprint> {
        let kind = f64::from(self.kind.number());
        let part = Fingerprint::of("Part").number(self.surface_speed).number(self.start).number(kind);
        let part = part.part(self.travel.fingerprint()?).part(self.conduct.fingerprint()?);
        let kinds = self
            .kinds
            .iter()
            .flatten()
            .fold(part, |part, kind| part.text("only for").number(kind.number().into()));
        Some(self.all_bricks().fold(kinds, |part, brick| part.part(brick.fingerprint())))
    }
}
