//! Constructors of bricks, and bricks shifted and rotated.

use glam::DVec2;

use super::shapes::Segment;
use super::shapes::{Arc, Sector};
use super::{Brick, Free, Shape};
use crate::boundary::WallError;
use crate::boundary::domain::{direction, finite_point};
use crate::quantity::{accept, finite, positive};

impl Brick {
    /// Creates a segment between two points.
    ///
    /// Disks are free on its left, as seen on the way from the first point to the second.
    ///
    /// # Errors
    /// If a coordinate is not finite, or the points are equal.
    pub fn segment(from: DVec2, to: DVec2) -> Result<Self, WallError> {
        let (from, to) = (finite_point(from)?, finite_point(to)?);
        positive("length of a segment", from.distance(to))?;
        Ok(Self::left_of(Shape::Segment(Segment::between(from, to))))
    }

    /// Creates a circle with the disks inside.
    ///
    /// # Errors
    /// If a coordinate is not finite, or the radius is not finite and positive.
    pub fn circle(center: DVec2, radius: f64) -> Result<Self, WallError> {
        let (center, radius) = (finite_point(center)?, positive("radius of a circle", radius)?);
        Ok(Self::left_of(Shape::Arc(Arc { center, radius, sector: None })))
    }

    /// Creates an arc, counterclockwise from the angle `from` to the angle `to`.
    ///
    /// Disks are free inside. Angles are in radians from the $`x`$ axis.
    ///
    /// # Errors
    /// If a number is not finite, the radius is not positive, or `to - from` is not between 0 and a whole
    /// turn.
    ///
    /// ```
    /// use std::f64::consts::PI;
    /// use granular_edmd::boundary::Brick;
    /// use granular_edmd::glam::DVec2;
    /// let bowl = Brick::arc(DVec2::ZERO, 5.0, PI, 2.0 * PI)?;
    /// assert_eq!(bowl.signed_distance(DVec2::new(0.0, -2.0)), 3.0);
    /// # Ok::<(), granular_edmd::boundary::WallError>(())
    /// ```
    pub fn arc(center: DVec2, radius: f64, from: f64, to: f64) -> Result<Self, WallError> {
        const TURN: f64 = std::f64::consts::TAU;
        let (center, radius) = (finite_point(center)?, positive("radius of an arc", radius)?);
        let angle = finite("angle of an arc", to)? - finite("angle of an arc", from)?;
        accept(angle > 0.0 && angle < TURN, "angle of an arc", "above 0 and less than 2π", angle)?;
        let is_wide = angle > 0.5 * TURN;
        let sector = Some(Sector { start: direction(from), end: direction(to), is_wide });
        Ok(Self::left_of(Shape::Arc(Arc { center, radius, sector })))
    }

    /// Creates a point, with disks around it.
    ///
    /// A [`Part`](crate::boundary::Part) adds the corners of its bricks automatically.
    ///
    /// # Errors
    /// If a coordinate is not finite.
    pub fn point(place: DVec2) -> Result<Self, WallError> {
        Ok(Self::corner(finite_point(place)?))
    }

    pub(in crate::boundary) const fn corner(place: DVec2) -> Self {
        Self::round(place, 0.0)
    }

    /// Creates a circle with the disks outside.
    pub(in crate::boundary) const fn round(center: DVec2, radius: f64) -> Self {
        Self { shape: Shape::Arc(Arc { center, radius, sector: None }), free: Free::Right }
    }

    const fn left_of(shape: Shape) -> Self {
        Self { shape, free: Free::Left }
    }

    /// Returns the same brick with the disks on its other side.
    ///
    /// A point does not change.
    #[must_use]
    pub fn reversed(self) -> Self {
        let free = match self.free {
            Free::Left => Free::Right,
            Free::Right if !self.is_point() => Free::Left,
            free => free,
        };
        Self { free, ..self }
    }

    /// Returns the same brick as a thin wall, with disks on both sides.
    #[must_use]
    pub fn two_sided(self) -> Self {
        let free = if self.is_point() { self.free } else { Free::Both };
        Self { free, ..self }
    }

    /// Returns the same brick, shifted by a vector.
    ///
    /// # Errors
    /// If a coordinate would not be finite.
    pub fn shifted(self, by: DVec2) -> Result<Self, WallError> {
        self.moved(DVec2::X, finite_point(by)?)
    }

    /// Returns the same brick, rotated about a point, counterclockwise by this angle in radians.
    ///
    /// # Errors
    /// If an argument or a resulting coordinate is not finite.
    pub fn rotated(self, about: DVec2, angle: f64) -> Result<Self, WallError> {
        let turn = direction(finite("angle", angle)?);
        self.moved(turn, finite_point(about)? - turn.rotate(about))
    }

    fn moved(self, turn: DVec2, shift: DVec2) -> Result<Self, WallError> {
        let shape = match self.shape {
            Shape::Segment(segment) => Shape::Segment(segment.moved(turn, shift)),
            Shape::Arc(arc) => Shape::Arc(arc.moved(turn, shift)),
        };
        for place in (Self { shape, ..self }).landmarks() {
            finite_point(place)?;
        }
        if let Shape::Segment(segment) = shape {
            // Far from the origin, rounding may make both ends equal.
            positive("length of a segment", segment.to.distance(segment.from))?;
        }
        Ok(Self { shape, ..self })
    }

    /// Returns the distance of a point from the brick, negative behind the brick.
    pub fn signed_distance(&self, place: DVec2) -> f64 {
        self.nearest(place).signed_distance
    }

    /// Returns the unit vector from the nearest point of the brick to a position: the normal of a
    /// [`Surface`](crate::boundary::Surface) for a disk that touches there.
    pub fn normal(&self, place: DVec2) -> DVec2 {
        self.nearest(place).normal
    }
}
