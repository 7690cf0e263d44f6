//! Parts: bricks that belong together, with a rule, a motion and a surface of their own.

mod corners;
mod polygon;
mod travel;

pub(super) use travel::Travel;

use std::path::Path;

use glam::DVec2;

use super::brick::{Brick, Nearest, finite_point, unit};
use super::conduct::Conduct;
use super::vessel::VesselError;
use super::{Surface, Thermal};
use crate::collision::CollisionRule;
use crate::quantity::{accept, finite};
use crate::wall::{Motion, WallMotion};
use crate::{Fingerprint, Kind};

/// A part of a [`Vessel`](super::Vessel): bricks that share a rule, a kind, the motion of their surface and
/// their own motion.
///
/// A part begins at rest, under the rule of the disks and with the kind of walls. Its corners are added by
/// themselves, wherever bricks end so that a disk can touch the corner.
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
/// // An hourglass, from points counterclockwise or clockwise.
/// let right = [(8.0, 0.0), (8.0, 6.0), (5.0, 10.0), (8.0, 14.0), (8.0, 20.0)];
/// let left = right.iter().rev().map(|&(x, y)| (8.0 - x, y));
/// let glass = Part::polygon(right.into_iter().chain(left).map(DVec2::from))?;
/// let vessel = Vessel::around([("glass", glass)])?;
/// # Ok::<(), granular_edmd::boundary::VesselError>(())
/// ```
#[derive(Debug, Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "file::Record", into = "file::Record"))]
pub struct Part {
    /// The bricks as given, then the corners.
    bricks: Vec<Brick>,
    /// Number of bricks as given.
    given: usize,
    travel: Travel,
    conduct: Conduct,
    kind: Kind,
    surface_speed: f64,
}

/// Constructors.
impl Part {
    /// Creates a part of these bricks, and of points at their ends.
    ///
    /// Behind a one-sided brick there is the wall. Bricks that have a free end should therefore be
    /// [two-sided](Brick::two_sided): disks come round the end.
    ///
    /// # Errors
    /// If there are no bricks.
    pub fn new(bricks: impl IntoIterator<Item = Brick>) -> Result<Self, VesselError> {
        let mut bricks: Vec<Brick> = bricks.into_iter().collect();
        let given = bricks.len();
        if given == 0 {
            return Err(VesselError::TooFewPoints { count: 0, least: 1 });
        }
        bricks.extend(corners::corners(&bricks));
        let (conduct, kind) = (Conduct::Shared, Kind::WALL);
        Ok(Self { bricks, given, travel: Travel::Rest, conduct, kind, surface_speed: 0.0 })
    }

    /// Creates a closed polygon with the disks inside. The points may go round either way.
    ///
    /// # Errors
    /// If there are fewer than three points, a coordinate is not finite, neighboring points are equal, the
    /// polygon has no area, or two of its sides cross.
    pub fn polygon(points: impl IntoIterator<Item = DVec2>) -> Result<Self, VesselError> {
        Self::new(polygon::sides(points.into_iter().collect(), true)?)
    }

    /// Creates a closed polygon with the disks outside: a solid block. The points may go round either way.
    ///
    /// # Errors
    /// As [`polygon`](Self::polygon).
    ///
    /// ```
    /// use granular_edmd::boundary::Part;
    /// use granular_edmd::glam::DVec2;
    /// let ramp = Part::block([DVec2::ZERO, DVec2::new(9.0, 0.0), DVec2::new(0.0, 6.0)])?;
    /// assert!(ramp.signed_distance(DVec2::new(1.0, 1.0)) < 0.0);
    /// assert_eq!(ramp.signed_distance(DVec2::new(-2.0, 1.0)), 2.0);
    /// # Ok::<(), granular_edmd::boundary::VesselError>(())
    /// ```
    pub fn block(points: impl IntoIterator<Item = DVec2>) -> Result<Self, VesselError> {
        Self::new(polygon::sides(points.into_iter().collect(), false)?)
    }

    /// Creates a thin wall from point to point, with disks on both sides.
    ///
    /// # Errors
    /// If there are fewer than two points, a coordinate is not finite, or neighboring points are equal.
    pub fn polyline(points: impl IntoIterator<Item = DVec2>) -> Result<Self, VesselError> {
        let points: Vec<DVec2> = points.into_iter().collect();
        if points.len() < 2 {
            return Err(VesselError::TooFewPoints { count: points.len(), least: 2 });
        }
        let bricks = points.windows(2).map(|pair| Ok(Brick::segment(pair[0], pair[1])?.two_sided()));
        Self::new(bricks.collect::<Result<Vec<_>, VesselError>>()?)
    }

    /// Creates a circle with the disks inside.
    ///
    /// # Errors
    /// If a coordinate is not finite, or the radius is not finite and positive.
    pub fn drum(center: DVec2, radius: f64) -> Result<Self, VesselError> {
        Self::new([Brick::circle(center, radius)?])
    }

    /// Creates a circle with the disks outside.
    ///
    /// # Errors
    /// If a coordinate is not finite, or the radius is not finite and positive.
    pub fn peg(center: DVec2, radius: f64) -> Result<Self, VesselError> {
        Self::new([Brick::circle(center, radius)?.reversed()])
    }

    /// Reads points from text: two numbers in each line, with white space or a comma between them. Empty lines
    /// and lines that begin with `#` are left out.
    ///
    /// # Errors
    /// If a line is not two numbers. The error names the line.
    ///
    /// ```
    /// use granular_edmd::boundary::Part;
    /// let triangle = Part::polygon(Part::points_from_text("# x y\n0 0\n4, 0\n\n0 3")?)?;
    /// assert_eq!(triangle.bricks().len(), 3);
    /// let error = Part::points_from_text("0 0\n4").unwrap_err();
    /// assert_eq!(error.to_string(), "line 2 must be two numbers, but is \"4\"");
    /// # Ok::<(), granular_edmd::boundary::VesselError>(())
    /// ```
    pub fn points_from_text(text: &str) -> Result<Vec<DVec2>, VesselError> {
        polygon::points(text)
    }

    /// Reads a closed polygon with the disks inside from a file of points, as
    /// [`points_from_text`](Self::points_from_text) reads them.
    ///
    /// # Errors
    /// If the file cannot be read, a line is not two numbers, or the points make no
    /// [`polygon`](Self::polygon).
    pub fn polygon_from_file(path: impl AsRef<Path>) -> Result<Self, VesselError> {
        let path = path.as_ref();
        let text = std::fs::read_to_string(path);
        let text =
            text.map_err(|error| VesselError::File { path: path.to_owned(), reason: error.to_string() })?;
        Self::polygon(Self::points_from_text(&text)?)
    }
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

    /// Returns the same part with this kind, which rules find in the contact.
    #[must_use]
    pub fn with_kind(self, kind: Kind) -> Self {
        Self { kind, ..self }
    }

    /// Returns the same part with a surface that moves along itself at this speed, as a conveyor belt.
    ///
    /// A positive speed leads in the direction in which the free side is on the left: from left to right on
    /// the upper side of a floor, counterclockwise inside a polygon or a drum, clockwise around a block. A
    /// belt around a thin wall runs on its left side along the wall's direction, and on the other side back.
    ///
    /// # Errors
    /// If the speed is not finite.
    pub fn with_surface_speed(self, speed: f64) -> Result<Self, VesselError> {
        Ok(Self { surface_speed: finite("surface speed", speed)?, ..self })
    }

    /// Returns the same part with a motion along a direction of any length, in place of an earlier motion.
    ///
    /// # Errors
    /// If the direction has no length, or the motion answers with numbers that are not finite at one of the
    /// phases that [`laws::check_finite`](crate::wall::laws::check_finite) looks at. If the motion jumps, as a
    /// [`Sawtooth`](crate::wall::Sawtooth) does, and disks are free on a side of the part from which it would
    /// jump into them.
    pub fn with_motion(
        self,
        direction: DVec2,
        motion: impl WallMotion + Send + Sync + 'static,
    ) -> Result<Self, VesselError> {
        let direction = unit(direction)?;
        let motion = Motion::new(motion).map_err(|violation| VesselError::Motion { violation })?;
        self.traveling(Travel::Along { direction, motion })
    }

    /// Returns the same part turning about a point, counterclockwise at this angular velocity, in place of an
    /// earlier motion.
    ///
    /// A circle about that point does not move, but its surface does. Every other part is at its place at time
    /// 0, and at all times at which it has done whole turns.
    ///
    /// # Errors
    /// If a number is not finite, or the angular velocity is so small or large that a turn is no time.
    pub fn with_rotation(self, about: DVec2, angular_velocity: f64) -> Result<Self, VesselError> {
        let about = finite_point(about)?;
        if finite("angular velocity", angular_velocity)? == 0.0 {
            return self.traveling(Travel::Rest);
        }
        let is_round = self.bricks.iter().all(|brick| brick.is_circle_about(about));
        self.traveling(if is_round {
            Travel::Spinning { about, angular_velocity }
        } else {
            Travel::Turning { about, angular_velocity }
        })
    }

    /// Returns the same part elsewhere. A point about which it turns moves with it.
    ///
    /// # Errors
    /// If a coordinate would not be finite.
    pub fn shifted(mut self, by: DVec2) -> Result<Self, VesselError> {
        for brick in &mut self.bricks {
            *brick = brick.shifted(by)?;
        }
        if let Travel::Turning { about, .. } | Travel::Spinning { about, .. } = &mut self.travel {
            *about = finite_point(*about + by)?;
        }
        Ok(self)
    }

    /// Returns the same part after a turn about a point, counterclockwise by this angle in radians. The
    /// direction of its motion turns with it.
    ///
    /// # Errors
    /// If a number is not finite, or would not be.
    pub fn rotated(mut self, about: DVec2, angle: f64) -> Result<Self, VesselError> {
        for brick in &mut self.bricks {
            *brick = brick.rotated(about, angle)?;
        }
        let turn = super::brick::direction(angle);
        match &mut self.travel {
            Travel::Along { direction, .. } => *direction = unit(turn.rotate(*direction))?,
            Travel::Turning { about: pivot, .. } | Travel::Spinning { about: pivot, .. } => {
                *pivot = about + turn.rotate(*pivot - about);
            }
            Travel::Rest => {}
        }
        Ok(self)
    }

    /// Returns the bricks, without the corners that were added.
    pub fn bricks(&self) -> &[Brick] {
        &self.bricks[..self.given]
    }

    /// Returns the distance of a place from the part as it was built, negative where no disk can be.
    pub fn signed_distance(&self, place: DVec2) -> f64 {
        self.nearest(place).map_or(f64::INFINITY, |(_, distance)| distance)
    }
}

impl Part {
    /// Gives the part a motion, if the part can move so.
    fn traveling(self, travel: Travel) -> Result<Self, VesselError> {
        match &travel {
            Travel::Along { direction, motion } => {
                let is_safe = !motion.jumps() || self.bricks.iter().all(|brick| brick.faces(*direction));
                if !is_safe {
                    return Err(VesselError::Jump);
                }
            }
            Travel::Turning { angular_velocity, .. } | Travel::Spinning { angular_velocity, .. } => {
                let turn = std::f64::consts::TAU / angular_velocity.abs();
                accept(
                    turn.is_finite() && (1e-60..=1e60).contains(&turn),
                    "angular velocity",
                    "such that a turn takes from 1e-60 to 1e60",
                    *angular_velocity,
                )?;
            }
            Travel::Rest => {}
        }
        Ok(Self { travel, ..self })
    }

    /// Returns all bricks, with the corners.
    pub(super) fn all_bricks(&self) -> &[Brick] {
        &self.bricks
    }

    pub(super) fn travel(&self) -> &Travel {
        &self.travel
    }

    /// Returns a rectangle around the part as it was built. Its edges may be infinite.
    pub(super) fn bounds(&self) -> (DVec2, DVec2) {
        let none = (DVec2::splat(f64::INFINITY), DVec2::splat(f64::NEG_INFINITY));
        self.bricks.iter().map(Brick::bounds).fold(none, |all, one| (all.0.min(one.0), all.1.max(one.1)))
    }

    /// Returns the number of the nearest brick and the distance from it, negative behind it.
    pub(super) fn nearest(&self, place: DVec2) -> Option<(usize, f64)> {
        let sights = self.bricks.iter().map(|brick| Sighted::new(brick, place)).enumerate();
        let nearest = sights.reduce(|a, b| if b.1.is_better_than(&a.1) { b } else { a });
        nearest.map(|(brick, sighted)| (brick, sighted.signed_distance()))
    }

    /// Returns the surface of the part for a normal and a velocity.
    pub(super) fn surface(&self, normal: DVec2, velocity: DVec2) -> Surface<'_> {
        let along = -normal.perp() * self.surface_speed;
        Surface::new(normal, velocity + along).with_response(self.conduct.response()).with_kind(self.kind)
    }

    pub(super) fn fingerprint(&self) -> Option<Fingerprint> {
        let kind = f64::from(self.kind.number());
        let part = Fingerprint::of("Part").number(self.surface_speed).number(kind);
        let part = part.part(self.travel.fingerprint()?).part(self.conduct.fingerprint()?);
        Some(self.bricks.iter().fold(part, |part, brick| part.part(brick.fingerprint())))
    }
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

    /// Tells whether this brick is nearer than another one, or as near and knows better what is behind it.
    ///
    /// Two bricks that meet at the nearest point are equally far up to rounding. The one that is seen less
    /// from the side knows whether the place is behind it.
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

/// Parts in files.
#[cfg(feature = "serde")]
mod file {
    use serde::{Deserialize, Serialize};

    use super::{Part, Travel};
    use crate::Kind;
    use crate::boundary::brick::{Brick, finite_point, unit};
    use crate::boundary::conduct::Conduct;
    use crate::boundary::vessel::VesselError;
    use crate::quantity::{accept, finite};

    /// A part as it stands in a file.
    #[derive(Serialize, Deserialize)]
    #[serde(deny_unknown_fields, rename = "Part")]
    pub(super) struct Record {
        bricks: Vec<Brick>,
        travel: Travel,
        conduct: Conduct,
        kind: Kind,
        surface_speed: f64,
    }

    impl From<Part> for Record {
        fn from(part: Part) -> Self {
            let Part { mut bricks, given, travel, conduct, kind, surface_speed } = part;
            bricks.truncate(given);
            Self { bricks, travel, conduct, kind, surface_speed }
        }
    }

    impl TryFrom<Record> for Part {
        type Error = VesselError;

        fn try_from(record: Record) -> Result<Self, VesselError> {
            let Record { bricks, travel, conduct, kind, surface_speed } = record;
            let part = Part { conduct, kind, ..Part::new(bricks)? }.with_surface_speed(surface_speed)?;
            match &travel {
                Travel::Along { direction, .. } => {
                    unit(*direction)?;
                    let length = direction.length();
                    accept((length - 1.0).abs() <= 1e-12, "length of a direction", "1", length)?;
                    part.traveling(travel)
                }
                Travel::Turning { about, angular_velocity }
                | Travel::Spinning { about, angular_velocity } => {
                    finite_point(*about)?;
                    part.with_rotation(*about, finite("angular velocity", *angular_velocity)?)
                }
                Travel::Rest => Ok(part),
            }
        }
    }
}
