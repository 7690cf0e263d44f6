//! Bricks: the shapes of which parts are built, and the first touch of a disk with a brick.

/// Evaluates an expression for the shape of a brick, a segment or an arc.
macro_rules! of_shape {
    ($brick:expr, $shape:ident => $value:expr) => {
        match $brick.shape {
            Shape::Segment($shape) => $value,
            Shape::Arc($shape) => $value,
        }
    };
}

mod constructors;
mod first_touch;
mod path;
#[cfg(feature = "serde")]
mod serialized;
mod shapes;

pub(super) use path::Path;

use glam::DVec2;
use shapes::Arc;
use shapes::Segment;

use super::Region;
use super::area::Curve;
use crate::Fingerprint;

/// Rounding of lengths, relative to coordinates and sizes. Bricks reach beyond their ends by it: otherwise,
/// rounding could leave a hole between two bricks that meet.
const MARGIN: f64 = 1e-12;

/// Direction from the center of a circle to the point that shows its position. The outermost points are
/// less suitable: circles of other sizes often have one of them in common.
const ASLANT: DVec2 = DVec2::new(0.6, 0.8);

/// A piece of a wall: a segment, an arc, a circle or a point.
///
/// A brick has a direction. Disks are free on its left side; the wall is on the other side. A segment leads
/// from its first point to its second; arcs and circles lead counterclockwise, so disks are free inside them.
/// [`reversed`](Self::reversed) turns the direction around, and with it the free side.
/// [`two_sided`](Self::two_sided) makes a thin wall, with disks on both sides.
///
/// | brick | center of a touching disk of radius $`R`$ | the time is a root of a |
/// |---|---|---|
/// | [`segment`](Self::segment) | beside it, at $`R`$ | parabola |
/// | [`circle`](Self::circle), [`arc`](Self::arc), from inside | at $`r - R`$ from the center | quartic |
/// | the same, from outside | at $`r + R`$ from the center | quartic |
/// | [`point`](Self::point) | at $`R`$ from the point | quartic |
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
/// # Ok::<(), granular_edmd::boundary::WallError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "serialized::Record", into = "serialized::Record"))]
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

/// The relation of a brick to a point: its distance and direction.
#[derive(Debug, Clone, Copy)]
struct Sight {
    /// Distance of the nearest point of the brick.
    distance: f64,
    /// Unit vector from the nearest point of the brick to the given point.
    normal: DVec2,
    side: Side,
    /// Distance from the brick, extended straight beyond its ends. If two bricks meet at the nearest point,
    /// the brick with the larger `weight` decides the side.
    weight: f64,
}

/// The nearest point of a brick, as seen from a given point.
#[derive(Debug, Clone, Copy)]
pub(super) struct Nearest {
    pub(super) distance: f64,
    /// The distance, negative behind the brick.
    pub(super) signed_distance: f64,
    pub(super) normal: DVec2,
    weight: f64,
    /// Largest difference between two distances for which two bricks count as equally far away.
    rounding: f64,
}

impl Nearest {
    /// Returns whether this brick, rather than another, decides on which side a point is: it is nearer, or
    /// equally near and seen less edge-on.
    ///
    /// Two bricks that meet at the nearest point are equally far away up to rounding. The brick that is seen
    /// more broadside then decides: the brick whose straight extension is farther from the position.
    pub(super) fn is_better_than(&self, other: &Self) -> bool {
        let nearer = other.distance - self.distance;
        let is_tie = nearer.abs() <= other.rounding;
        if is_tie { self.weight > other.weight } else { nearer > 0.0 }
    }
}

/// Geometry.
impl Brick {
    pub(super) fn is_point(&self) -> bool {
        matches!(self.shape, Shape::Arc(arc) if arc.radius == 0.0)
    }

    pub(super) fn is_two_sided(&self) -> bool {
        self.free == Free::Both
    }

    /// Returns the radius of an arc with disks inside.
    pub(super) fn hollow(&self) -> Option<f64> {
        match self.shape {
            Shape::Arc(arc) if self.free.has(Side::Left) && arc.radius > 0.0 => Some(arc.radius),
            _ => None,
        }
    }

    /// Returns whether the brick is a whole circle about this point.
    pub(super) fn is_circle_about(&self, place: DVec2) -> bool {
        matches!(self.shape, Shape::Arc(arc) if arc.sector.is_none() && arc.center == place)
    }

    /// Returns whether a direction leads to the only free side of the brick, or along the brick. A jump of
    /// the brick in the opposite direction then hits no disk.
    pub(super) fn faces(&self, direction: DVec2) -> bool {
        match (self.shape, self.free) {
            (Shape::Segment(segment), Free::Left) => segment.direction.perp_dot(direction) >= 0.0,
            (Shape::Segment(segment), Free::Right) => segment.direction.perp_dot(direction) <= 0.0,
            _ => false,
        }
    }

    /// Returns the start and the end, if they exist, each with the direction of the brick there. The free
    /// side of a one-sided brick is on the left of that direction.
    pub(super) fn ends(&self) -> Option<[(DVec2, DVec2); 2]> {
        let [start, end] = match self.shape {
            Shape::Segment(segment) => [segment.from, segment.to].map(|end| (end, segment.direction)),
            Shape::Arc(arc) => arc.ends()?,
        };
        let turned = |(place, direction): (DVec2, DVec2)| (place, -direction);
        Some(if self.free == Free::Right { [turned(end), turned(start)] } else { [start, end] })
    }

    /// Returns a line along the brick: its ends, or points on an arc.
    pub(super) fn outline(&self) -> Vec<DVec2> {
        /// Angle between two points of an arc.
        const STEP: f64 = std::f64::consts::PI / 60.0;
        match self.shape {
            Shape::Segment(segment) => vec![segment.from, segment.to],
            Shape::Arc(arc) => arc.points(STEP),
        }
    }

    /// Returns the curves on which the center of a disk of this radius lies while it touches the brick.
    pub(super) fn curves(&self, radius: f64) -> impl Iterator<Item = Curve> + use<> {
        let shape = self.shape;
        let sides = [radius, -radius].into_iter().take(if radius > 0.0 { 2 } else { 1 });
        sides.filter_map(move |away| match shape {
            Shape::Segment(segment) => {
                let aside = away * segment.direction.perp();
                Some(Curve::Line(segment.from + aside, segment.to + aside))
            }
            Shape::Arc(arc) => {
                (arc.radius + away > 0.0).then_some(Curve::Circle(arc.center, arc.radius + away))
            }
        })
    }

    /// Returns a point that moves with the brick, and the way from there to the surface, which does not turn:
    /// the start, or the center and the radius of a circle. A circle that turns about its center stays where
    /// it is.
    pub(super) fn anchor(&self) -> (DVec2, DVec2) {
        let whole = |arc: Arc| (arc.center, arc.radius * ASLANT);
        match self.shape {
            Shape::Segment(segment) => (segment.from, DVec2::ZERO),
            Shape::Arc(arc) => arc.ends().map_or(whole(arc), |[(start, _), _]| (start, DVec2::ZERO)),
        }
    }

    /// Returns whether the brick is a straight line across a direction, to rounding.
    pub(super) fn is_across(&self, direction: DVec2) -> bool {
        matches!(self.shape, Shape::Segment(segment) if segment.direction.dot(direction).abs() <= MARGIN)
    }

    /// Returns the points that fix the position of the brick.
    pub(super) fn landmarks(&self) -> impl Iterator<Item = DVec2> {
        let places = match self.shape {
            Shape::Segment(segment) => [segment.from, segment.to],
            Shape::Arc(arc) => [arc.center, arc.center + arc.radius],
        };
        places.into_iter()
    }

    pub(super) fn nearest(&self, place: DVec2) -> Nearest {
        let Sight { distance, normal, side, weight } = of_shape!(self, shape => shape.sight(place));
        let signed_distance = if self.free.has(side) { distance } else { -distance };
        let rounding = MARGIN * (distance + place.length());
        Nearest { distance, signed_distance, normal, weight, rounding }
    }

    /// Returns whether a point of the brick may be within `reach` of a region.
    pub(super) fn is_near(&self, region: &Region, reach: f64) -> bool {
        of_shape!(self, shape => shape.is_near(region, reach))
    }

    /// Returns a rectangle around the brick.
    pub(super) fn bounds(&self) -> Region {
        of_shape!(self, shape => shape.bounds())
    }

    /// Returns a lower and an upper bound on the distances of the brick's points from a given point.
    pub(super) fn distances(&self, place: DVec2) -> (f64, f64) {
        of_shape!(self, shape => shape.distances(place))
    }

    pub(super) fn fingerprint(&self) -> Fingerprint {
        let free = match self.free {
            Free::Left => "left",
            Free::Right => "right",
            Free::Both => "both",
        };
        let brick = match self.shape {
            Shape::Segment(segment) => {
                let direction = segment.direction;
                // Earlier versions had other segments, too. This text keeps the fingerprint of a finite
                // segment as it was.
                Fingerprint::of("Segment").number(direction.x).number(direction.y).text("finite")
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
