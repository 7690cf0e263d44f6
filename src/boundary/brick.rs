//! Bricks: the shapes of which vessels are built, and when a disk first touches one.

mod arc;
#[cfg(feature = "serde")]
mod file;
mod path;
mod segment;

pub(super) use path::Path;

use glam::DVec2;

use super::Region;
use super::vessel::VesselError;
use crate::quantity::{accept, finite, positive};
use crate::roots::first_descent_of_quartic;
use crate::{Fingerprint, ParameterError};
use arc::{Arc, Sector};
use segment::Segment;

/// Length by which bricks reach beyond their ends, relative to their places and sizes. Rounding leaves no
/// hole between two bricks that meet.
const MARGIN: f64 = 1e-12;

/// A piece of a wall: a segment, a half-line, an arc, a circle or a point.
///
/// A brick has a direction, and the disks are free on its left side. On the other side there is the wall. A
/// segment leads from its first point to its second one; arcs and circles lead counterclockwise, so that
/// disks are free inside. [`reversed`](Self::reversed) turns the direction, and so the free side.
/// [`two_sided`](Self::two_sided) makes a thin wall, with disks on both sides.
///
/// | brick | touch of a disk of radius `$R$` | root of a |
/// |---|---|---|
/// | [`segment`](Self::segment), [`half_line`](Self::half_line) | at `$R$`, beside it | parabola |
/// | [`circle`](Self::circle), [`arc`](Self::arc), from inside | at `$r - R$` from the center | quartic |
/// | the same, from outside | at `$r + R$` from the center | quartic |
/// | [`point`](Self::point) | at `$R$` | quartic |
///
/// ```
/// use granular_edmd::boundary::Brick;
/// use granular_edmd::glam::DVec2;
///
/// let floor = Brick::segment(DVec2::ZERO, DVec2::new(4.0, 0.0))?;
/// assert_eq!(floor.signed_distance(DVec2::new(1.0, 2.0)), 2.0);
/// assert_eq!(floor.reversed().signed_distance(DVec2::new(1.0, 2.0)), -2.0);
/// let peg = Brick::circle(DVec2::ZERO, 1.0)?.reversed();
/// assert_eq!(peg.signed_distance(DVec2::new(3.0, 0.0)), 2.0);
/// # Ok::<(), granular_edmd::boundary::VesselError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "file::Record", into = "file::Record"))]
pub struct Brick {
    shape: Shape,
    free: Free,
}

/// The shape of a brick.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Shape {
    Segment(Segment),
    Arc(Arc),
}

/// A side of a brick.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Side {
    Left,
    Right,
}

/// The sides of a brick on which disks are free.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
enum Free {
    Left,
    Right,
    Both,
}

impl Free {
    fn has(self, side: Side) -> bool {
        match self {
            Self::Left => side == Side::Left,
            Self::Right => side == Side::Right,
            Self::Both => true,
        }
    }
}

/// A brick as seen from a place.
#[derive(Debug, Clone, Copy)]
struct Sight {
    /// Distance of the nearest point of the brick.
    distance: f64,
    /// Unit vector from there to the place.
    normal: DVec2,
    side: Side,
    /// Distance from the brick as it would be if it went on straight beyond its ends. Of two bricks that end
    /// at the nearest point, the one with the larger distance knows the side.
    weight: f64,
}

/// The nearest point of a brick, as seen from a place.
#[derive(Debug, Clone, Copy)]
pub(super) struct Nearest {
    pub(super) distance: f64,
    pub(super) normal: DVec2,
    /// True if the place is on a free side.
    pub(super) is_free: bool,
    pub(super) weight: f64,
}

/// Constructors.
impl Brick {
    /// Creates a segment between two points. Disks are free on the left of the way from the first point to
    /// the second one.
    ///
    /// # Errors
    /// If a coordinate is not finite, or the points are equal.
    pub fn segment(from: DVec2, to: DVec2) -> Result<Self, VesselError> {
        let (from, to) = (finite_point(from)?, finite_point(to)?);
        positive("length of a segment", from.distance(to))?;
        Ok(Self::left_of(Shape::Segment(Segment::between(from, to))))
    }

    /// Creates a half-line from a point on, in a direction of any length. Disks are free on its left.
    ///
    /// # Errors
    /// If a coordinate is not finite, or the direction has no length.
    pub fn half_line(from: DVec2, direction: DVec2) -> Result<Self, VesselError> {
        Ok(Self::left_of(Shape::Segment(Segment::endless(finite_point(from)?, unit(direction)?))))
    }

    /// Creates a circle. Disks are free inside.
    ///
    /// # Errors
    /// If a coordinate is not finite, or the radius is not finite and positive.
    pub fn circle(center: DVec2, radius: f64) -> Result<Self, VesselError> {
        let (center, radius) = (finite_point(center)?, positive("radius of a circle", radius)?);
        Ok(Self::left_of(Shape::Arc(Arc::new(center, radius, None))))
    }

    /// Creates an arc, counterclockwise from the angle `from` to the angle `to`. Disks are free inside.
    /// Angles are in radians from the `$x$` axis.
    ///
    /// # Errors
    /// If a number is not finite, the radius is not positive, or `to` is not above `from` by less than a
    /// whole turn.
    ///
    /// ```
    /// use std::f64::consts::PI;
    /// use granular_edmd::boundary::Brick;
    /// use granular_edmd::glam::DVec2;
    /// let bowl = Brick::arc(DVec2::ZERO, 5.0, PI, 2.0 * PI)?;
    /// assert_eq!(bowl.signed_distance(DVec2::new(0.0, -2.0)), 3.0);
    /// # Ok::<(), granular_edmd::boundary::VesselError>(())
    /// ```
    pub fn arc(center: DVec2, radius: f64, from: f64, to: f64) -> Result<Self, VesselError> {
        const TURN: f64 = std::f64::consts::TAU;
        let (center, radius) = (finite_point(center)?, positive("radius of an arc", radius)?);
        let angle = finite("angle of an arc", to)? - finite("angle of an arc", from)?;
        accept(angle > 0.0 && angle < TURN, "angle of an arc", "above 0 and less than 2π", angle)?;
        let sector = Sector::new(direction(from), direction(to), angle > 0.5 * TURN);
        Ok(Self::left_of(Shape::Arc(Arc::new(center, radius, Some(sector)))))
    }

    /// Creates a point, with disks around it. [`Part`](super::Part) adds the corners of its bricks by itself.
    ///
    /// # Errors
    /// If a coordinate is not finite.
    pub fn point(place: DVec2) -> Result<Self, VesselError> {
        Ok(Self::corner(finite_point(place)?))
    }

    pub(super) const fn corner(place: DVec2) -> Self {
        Self { shape: Shape::Arc(Arc::point(place)), free: Free::Right }
    }

    const fn left_of(shape: Shape) -> Self {
        Self { shape, free: Free::Left }
    }

    /// Returns the same brick with the disks on its other side. A point stays as it is.
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

    /// Returns the same brick elsewhere.
    ///
    /// # Errors
    /// If a coordinate would not be finite.
    pub fn shifted(self, by: DVec2) -> Result<Self, VesselError> {
        self.moved(DVec2::X, finite_point(by)?)
    }

    /// Returns the same brick after a turn about a point, counterclockwise by this angle in radians.
    ///
    /// # Errors
    /// If a number is not finite, or would not be.
    pub fn rotated(self, about: DVec2, angle: f64) -> Result<Self, VesselError> {
        let turn = direction(finite("angle", angle)?);
        self.moved(turn, finite_point(about)? - turn.rotate(about))
    }

    fn moved(self, turn: DVec2, shift: DVec2) -> Result<Self, VesselError> {
        let shape = match self.shape {
            Shape::Segment(segment) => Shape::Segment(segment.moved(turn, shift)),
            Shape::Arc(arc) => Shape::Arc(arc.moved(turn, shift)),
        };
        for place in (Self { shape, ..self }).landmarks() {
            finite_point(place)?;
        }
        if let Shape::Segment(segment) = shape {
            // Far away, both ends may be the same number.
            let length = segment.to().map_or(1.0, |to| to.distance(segment.from()));
            positive("length of a segment", length)?;
        }
        Ok(Self { shape, ..self })
    }

    /// Returns the distance of a place from the brick, negative behind it.
    pub fn signed_distance(&self, place: DVec2) -> f64 {
        let Nearest { distance, is_free, .. } = self.nearest(place);
        if is_free { distance } else { -distance }
    }
}

/// Geometry.
impl Brick {
    pub(super) fn is_point(&self) -> bool {
        matches!(self.shape, Shape::Arc(arc) if arc.radius() == 0.0)
    }

    pub(super) fn is_two_sided(&self) -> bool {
        self.free == Free::Both
    }

    /// Tells whether the brick is a whole circle about this point.
    pub(super) fn is_circle_about(&self, place: DVec2) -> bool {
        matches!(self.shape, Shape::Arc(arc) if arc.is_whole() && arc.center() == place)
    }

    /// Tells whether no disk in front of the brick is behind it in a direction.
    pub(super) fn faces(&self, direction: DVec2) -> bool {
        match (self.shape, self.free) {
            (Shape::Segment(segment), Free::Left) => segment.direction().perp_dot(direction) >= 0.0,
            (Shape::Segment(segment), Free::Right) => segment.direction().perp_dot(direction) <= 0.0,
            _ => false,
        }
    }

    /// Returns the start and the end, as far as there are any, with the direction of the brick there. The
    /// free side is on the left.
    pub(super) fn ends(&self) -> [Option<(DVec2, DVec2)>; 2] {
        let forward = match self.shape {
            Shape::Segment(segment) => {
                let direction = segment.direction();
                [Some((segment.from(), direction)), segment.to().map(|to| (to, direction))]
            }
            Shape::Arc(arc) => arc.ends().map_or([None; 2], |ends| ends.map(Some)),
        };
        match self.free {
            Free::Right => {
                let [start, end] = forward.map(|end| end.map(|(place, direction)| (place, -direction)));
                [end, start]
            }
            Free::Left | Free::Both => forward,
        }
    }

    /// Returns the points that place the brick.
    fn landmarks(&self) -> impl Iterator<Item = DVec2> {
        let places = match self.shape {
            Shape::Segment(segment) => [segment.from(), segment.to().unwrap_or(segment.from())],
            Shape::Arc(arc) => [arc.center(), arc.center() + arc.radius()],
        };
        places.into_iter()
    }

    pub(super) fn nearest(&self, place: DVec2) -> Nearest {
        let Sight { distance, normal, side, weight } = match self.shape {
            Shape::Segment(segment) => segment.sight(place),
            Shape::Arc(arc) => arc.sight(place),
        };
        Nearest { distance, normal, is_free: self.free.has(side), weight }
    }

    /// Tells whether a place of the brick is within `reach` of a region.
    pub(super) fn is_near(&self, region: &Region, reach: f64) -> bool {
        match self.shape {
            Shape::Segment(segment) => segment.is_near(region, reach),
            Shape::Arc(arc) => arc.is_near(region, reach),
        }
    }

    /// Returns a rectangle around the brick. Its edges may be infinite.
    pub(super) fn bounds(&self) -> (DVec2, DVec2) {
        match self.shape {
            Shape::Segment(segment) => segment.bounds(),
            Shape::Arc(arc) => arc.bounds(),
        }
    }

    /// Returns bounds of the distances of the brick from a place.
    pub(super) fn distances(&self, place: DVec2) -> (f64, f64) {
        match self.shape {
            Shape::Segment(segment) => segment.distances(place),
            Shape::Arc(arc) => arc.distances(place),
        }
    }

    pub(super) fn fingerprint(&self) -> Fingerprint {
        let free = match self.free {
            Free::Left => "left",
            Free::Right => "right",
            Free::Both => "both",
        };
        let brick = match self.shape {
            Shape::Segment(segment) => {
                let direction = segment.direction();
                let brick = Fingerprint::of("Segment").number(direction.x).number(direction.y);
                brick.text(if segment.to().is_some() { "finite" } else { "endless" })
            }
            Shape::Arc(arc) => arc
                .ends()
                .into_iter()
                .flatten()
                .fold(Fingerprint::of("Arc"), |arc, (end, _)| arc.number(end.x).number(end.y)),
        };
        self.landmarks().fold(brick.text(free), |brick, place| brick.number(place.x).number(place.y))
    }
}

/// First touches.
impl Brick {
    /// Returns the first time, not later than `wait`, at which a disk touches the brick and closes further. If
    /// the disk grows, no touch is earlier, but that time need not be one.
    ///
    /// The side on which the center is decides which side of the brick counts. A disk whose center is behind
    /// the brick goes on until it has come out in front. The brick counts beside it only. What it would leave
    /// open at its ends is closed by the next brick, or by a point.
    pub(super) fn first_touch(&self, path: &Path, wait: f64) -> Option<f64> {
        let beside = match self.shape {
            Shape::Segment(segment) if segment.is_out_of_reach(path, wait) => return None,
            Shape::Arc(arc) if arc.is_out_of_reach(path, wait) => return None,
            Shape::Segment(segment) => Some(segment.beside(path)),
            Shape::Arc(arc) => arc.beside(path),
        };
        let Some(beside) = beside else {
            return self.touch_between(path, 0.0, wait);
        };
        let side = self.side(path.place);
        // Mostly, the disk is beside the brick when it comes to the line or the circle.
        if self.free.has(side)
            && let Some(touch) = first_descent_of_quartic(&self.gap(path, side), wait)
            && beside.holds(touch)
        {
            return Some(touch);
        }
        beside.stretches(wait).find_map(|(from, to)| self.touch_between(path, from, to))
    }

    /// Returns the first touch between two times at which the disk is beside the brick.
    fn touch_between(&self, path: &Path, from: f64, to: f64) -> Option<f64> {
        let (here, wait) = (path.later(from), to - from);
        let side = self.side(here.place);
        let growth = here.radius - path.radius;
        // The true center may be on the other side.
        if growth > 0.0 && self.distance_from_line(here.place) <= growth {
            return Some(from);
        }
        if self.free.has(side) {
            let gap = self.gap(&here, side);
            // A gap that rounding has closed counts only while it closes. One that growth has closed may be
            // open, and must be looked at.
            if growth > 0.0 && gap[0] <= 0.0 {
                return Some(from);
            }
            return Some(from + first_descent_of_quartic(&gap, wait)?);
        }
        let front = if side == Side::Left { Side::Right } else { Side::Left };
        if path.spread > 0.0 {
            // The true disk comes out no earlier than one that shrinks. From then on, it is looked at again.
            let shrinking = here.shrinking(path.radius);
            let opens = first_descent_of_quartic(&self.gap(&shrinking, front).map(|c| -c), wait)?;
            return Some(from + opens);
        }
        let opens = first_descent_of_quartic(&self.gap(&here, front).map(|c| -c), wait)?;
        let there = here.later(opens);
        let touch = first_descent_of_quartic(&self.gap(&there, front), wait - opens)?;
        Some(from + opens + touch)
    }

    /// Returns the largest growth of a disk for which its first touch is found.
    pub(super) fn most_growth(&self, radius: f64) -> f64 {
        match self.shape {
            Shape::Segment(_) => f64::INFINITY,
            Shape::Arc(arc) => arc.most_growth(radius),
        }
    }

    /// Returns the distance from the line or the circle on which the brick lies.
    fn distance_from_line(&self, place: DVec2) -> f64 {
        match self.shape {
            Shape::Segment(segment) => segment.direction().perp_dot(place - segment.from()).abs(),
            Shape::Arc(arc) => (place.distance(arc.center()) - arc.radius()).abs(),
        }
    }

    fn side(&self, place: DVec2) -> Side {
        match self.shape {
            Shape::Segment(segment) => segment.side(place),
            Shape::Arc(arc) => arc.side(place),
        }
    }

    fn gap(&self, path: &Path, side: Side) -> [f64; 5] {
        match self.shape {
            Shape::Segment(segment) => segment.gap(path, side),
            Shape::Arc(arc) => arc.gap(path, side),
        }
    }
}

/// Returns the unit vector at this angle from the `x` axis.
pub(super) fn direction(angle: f64) -> DVec2 {
    let (sine, cosine) = libm::sincos(angle);
    DVec2::new(cosine, sine)
}

/// Returns the unit vector in a direction of any length.
pub(super) fn unit(direction: DVec2) -> Result<DVec2, ParameterError> {
    let direction = finite_point(direction)?;
    // The larger component is taken out first, so that squares neither vanish nor overflow.
    let larger = direction.abs().max_element();
    positive("length of a direction", larger)?;
    Ok((direction / larger).normalize())
}

pub(super) fn finite_point(place: DVec2) -> Result<DVec2, ParameterError> {
    /// Largest coordinate: squares of distances, and squares of these, stay finite.
    const LARGEST: f64 = 1e60;
    let check = |value: f64| accept(value.abs() <= LARGEST, "coordinate", "at most 1e60 in magnitude", value);
    Ok(DVec2::new(check(place.x)?, check(place.y)?))
}
