//! The shapes of parts: their constructors, the sides of polygons, and corners, where bricks end.

use std::collections::HashMap;

use glam::DVec2;

use super::{Part, Travel};
use crate::Kind;
use crate::boundary::WallError;
use crate::boundary::brick::Brick;
use crate::boundary::domain::finite_point;
use crate::boundary::surface::Conduct;
use crate::quantity::accept;

impl Part {
    /// Creates a part of these bricks, and adds points at the ends that disks can touch.
    ///
    /// A one-sided brick has the wall behind it. A brick with a free end should therefore be
    /// [two-sided](Brick::two_sided), because disks can come around the end.
    ///
    /// # Errors
    /// If there are no bricks.
    pub fn new(bricks: impl IntoIterator<Item = Brick>) -> Result<Self, WallError> {
        let bricks: Vec<Brick> = bricks.into_iter().collect();
        accept(!bricks.is_empty(), "number of bricks", "at least 1", 0.0)?;
        let (corners, travel) = (corners(&bricks), Travel::default());
        let (conduct, kind) = (Conduct::Shared, Kind::WALL);
        Ok(Self { bricks, corners, travel, conduct, kind, surface_speed: 0.0, start: 0.0, kinds: None })
    }

    /// Creates a closed polygon with the disks inside.
    ///
    /// The points may be in either order around the polygon, and the last one may repeat the first. Brick 0
    /// is between the first two points.
    ///
    /// # Errors
    /// If there are fewer than three points, a coordinate is not finite, neighboring points are equal, the
    /// polygon has no area, or two of its sides cross.
    ///
    /// ```
    /// use granular_edmd::boundary::Part;
    /// use granular_edmd::glam::DVec2;
    /// // Points from a table of two columns, as a drawing program or a script writes them.
    /// let rows = "0 0\n4 0\n0 3".lines().map(|line| line.split_whitespace().map(str::parse));
    /// let rows = rows.map(Iterator::collect).collect::<Result<Vec<Vec<f64>>, _>>()?;
    /// let triangle = Part::polygon(rows.iter().map(|row| DVec2::from_slice(row)))?;
    /// assert_eq!(triangle.bricks().len(), 3);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn polygon(points: impl IntoIterator<Item = DVec2>) -> Result<Self, WallError> {
        Self::new(sides(points.into_iter().collect(), true)?)
    }

    /// Creates a closed polygon with the disks outside: a solid block.
    ///
    /// The points may be in either order around the block.
    ///
    /// # Errors
    /// The same as for [`polygon`](Self::polygon).
    ///
    /// ```
    /// use granular_edmd::boundary::Part;
    /// use granular_edmd::glam::DVec2;
    /// let ramp = Part::block([DVec2::ZERO, DVec2::new(9.0, 0.0), DVec2::new(0.0, 6.0)])?;
    /// assert!(ramp.signed_distance(DVec2::new(1.0, 1.0)) < 0.0);
    /// assert_eq!(ramp.signed_distance(DVec2::new(-2.0, 1.0)), 2.0);
    /// # Ok::<(), granular_edmd::boundary::WallError>(())
    /// ```
    pub fn block(points: impl IntoIterator<Item = DVec2>) -> Result<Self, WallError> {
        Self::new(sides(points.into_iter().collect(), false)?)
    }

    /// Creates a thin wall from point to point, with disks on both sides.
    ///
    /// Initial states put disks on both sides, too. For a solid body, use [`block`](Self::block).
    ///
    /// # Errors
    /// If there are fewer than two points, a coordinate is not finite, or neighboring points are equal.
    pub fn polyline(points: impl IntoIterator<Item = DVec2>) -> Result<Self, WallError> {
        let points: Vec<DVec2> = points.into_iter().collect();
        accept(points.len() >= 2, "number of points", "at least 2", points.len() as f64)?;
        let bricks = points.windows(2).map(|pair| Ok(Brick::segment(pair[0], pair[1])?.two_sided()));
        Self::new(bricks.collect::<Result<Vec<_>, WallError>>()?)
    }

    /// Creates a circle with the disks inside.
    ///
    /// # Errors
    /// If a coordinate is not finite, or the radius is not finite and positive.
    pub fn drum(center: DVec2, radius: f64) -> Result<Self, WallError> {
        Self::new([Brick::circle(center, radius)?])
    }

    /// Creates a circle with the disks outside.
    ///
    /// # Errors
    /// If a coordinate is not finite, or the radius is not finite and positive.
    pub fn peg(center: DVec2, radius: f64) -> Result<Self, WallError> {
        Self::new([Brick::circle(center, radius)?.reversed()])
    }
}

crate::gate::from_file! {
    Part {
        bricks: Vec<Brick>, travel: Travel, conduct: Conduct, kind: Kind, surface_speed: f64, #[serde(default)] start: f64,
        only_for: Option<Vec<Kind>>
    } => {
        let part = Self { kind, ..Self::new(bricks)?.with_conduct(conduct) };
        let part = if let Some(kinds) = only_for { part.only_for(kinds) } else { part };
        let mut part = part.with_surface_speed(surface_speed)?.starting_at(start)?;
        if let Some(super::Turning { about, angular_velocity, .. }) = travel.turning {
            part = part.with_rotation(about, angular_velocity)?;
        }
        let Some(super::Along { direction, motion }) = travel.along else { return Ok(part) };
        part.moving(super::Along { direction: crate::boundary::domain::unit_vector(direction)?, motion })
    }, WallError
}

/// Returns the sides of a polygon with the disks inside or outside, each from one point to the next.
pub(super) fn sides(mut points: Vec<DVec2>, inside: bool) -> Result<Vec<Brick>, WallError> {
    accept(points.len() >= 3, "number of points", "at least 3", points.len() as f64)?;
    for point in &points {
        finite_point(*point)?;
    }
    // In many files, the first point of a polygon is repeated as the last.
    if points.len() > 3 && points.first() == points.last() {
        points.pop();
    }
    if let Some(first) = pairs(&points).position(|(from, to)| from == to) {
        return Err(WallError::EqualPoints { first, second: (first + 1) % points.len() });
    }
    let area = doubled_area(&points);
    // A line that goes back and forth has no area, though its sides do not cross.
    if area == 0.0 {
        return Err(WallError::NoArea);
    }
    if let Some((first, second)) = crossing(&points) {
        return Err(WallError::Crossing { first, second });
    }
    // Each side keeps its number, so that the names of walls follow the list of points.
    // A brick has the disks on its left, so with the disks inside, the sides lead counterclockwise.
    let is_turned = (area > 0.0) != inside;
    let side = |(from, to)| if is_turned { Brick::segment(to, from) } else { Brick::segment(from, to) };
    pairs(&points).map(side).collect()
}

/// Returns the two ends of each side.
fn pairs(points: &[DVec2]) -> impl Iterator<Item = (DVec2, DVec2)> {
    points.iter().zip(points.iter().cycle().skip(1)).map(|(from, to)| (*from, *to))
}

/// Returns twice the area, positive if the points go around counterclockwise.
fn doubled_area(points: &[DVec2]) -> f64 {
    // Coordinates are relative to one of the points, so that a polygon far from the origin loses no digits.
    let first = points[0];
    pairs(points).map(|(from, to)| (from - first).perp_dot(to - first)).sum()
}

/// Returns the numbers of two sides that cross or touch, or `None` if no two do. Neighbors may share only
/// their common end.
///
/// Sides are sorted by their left ends, so that each side is compared only with sides that begin before it
/// ends.
fn crossing(points: &[DVec2]) -> Option<(usize, usize)> {
    let sides: Vec<(DVec2, DVec2)> = pairs(points).collect();
    let mut order: Vec<usize> = (0..sides.len()).collect();
    let left = |side: usize| sides[side].0.x.min(sides[side].1.x);
    let right = |side: usize| sides[side].0.x.max(sides[side].1.x);
    order.sort_by(|&a, &b| left(a).total_cmp(&left(b)));
    for (rank, &one) in order.iter().enumerate() {
        let later = order[rank + 1..].iter().take_while(|&&other| left(other) <= right(one));
        for &other in later {
            let are_neighbors = (one + 1) % sides.len() == other || (other + 1) % sides.len() == one;
            if cross(sides[one], sides[other], are_neighbors) {
                return Some((one.min(other), one.max(other)));
            }
        }
    }
    None
}

/// Returns whether two sides have a point in common, other than the common end of neighbors.
fn cross(one: (DVec2, DVec2), other: (DVec2, DVec2), are_neighbors: bool) -> bool {
    // Two sides cross if each has its ends on both sides of the other. Signs decide: the position of the
    // crossing would need a division, which rounds.
    let side = |(from, to): (DVec2, DVec2), place: DVec2| (to - from).perp_dot(place - from);
    let within = |(from, to): (DVec2, DVec2), place: DVec2| {
        let (low, high) = (from.min(to), from.max(to));
        place.cmpge(low).all() && place.cmple(high).all()
    };
    if are_neighbors {
        // Neighbors share an end. They cross only if one lies on the other.
        let (shared, ends) = match (one, other) {
            ((a, b), (c, d)) if b == c => (b, (a, d)),
            ((a, b), (c, d)) if a == d => (a, (b, c)),
            _ => return false,
        };
        let (back, on) = (ends.0 - shared, ends.1 - shared);
        return back.perp_dot(on) == 0.0 && back.dot(on) > 0.0;
    }
    let (a, b) = (side(one, other.0), side(one, other.1));
    let (c, d) = (side(other, one.0), side(other, one.1));
    // An end that lies on the other side makes a product 0, and the signs do not show that the two touch.
    let lies_on = (a == 0.0 && within(one, other.0))
        || (b == 0.0 && within(one, other.1))
        || (c == 0.0 && within(other, one.0))
        || (d == 0.0 && within(other, one.1));
    lies_on
        || ([a, b, c, d].iter().all(|&side| side != 0.0) && (a > 0.0) != (b > 0.0) && (c > 0.0) != (d > 0.0))
}

/// Sine of the smallest angle between two bricks that turn toward the disks and thereby shield their corner.
/// A disk at such a corner touches both bricks and never the corner itself, so the corner needs no point.
const CLEARLY: f64 = 1e-6;

/// The bricks that meet at a point, by the directions in which they arrive and leave.
#[derive(Debug, Default)]
struct Joint {
    coming: Vec<DVec2>,
    going: Vec<DVec2>,
    is_thin: bool,
}

impl Joint {
    /// Returns whether a disk can touch the corner.
    fn is_exposed(&self) -> bool {
        // Disks are on the left of a brick, so a left turn is a turn toward the disks. A free end, or a point
        // where more than two bricks meet, counts as exposed: an unnecessary point costs a little time, but a
        // missing point would let disks through.
        match (self.coming.as_slice(), self.going.as_slice()) {
            ([coming], [going]) if !self.is_thin => coming.perp_dot(*going) <= CLEARLY,
            _ => true,
        }
    }
}

/// Returns a point for each corner where bricks end and that a disk can touch, in the order of the bricks.
pub(super) fn corners(bricks: &[Brick]) -> Vec<Brick> {
    let mut joints: HashMap<[u64; 2], Joint> = HashMap::new();
    let mut places = Vec::new();
    for brick in bricks {
        let Some([start, end]) = brick.ends() else { continue };
        for ((place, direction), is_start) in [(start, true), (end, false)] {
            // Ends that are close but not equal get a point each, and these points close the gap.
            let key = key(place);
            if !joints.contains_key(&key) {
                places.push((key, place));
            }
            let joint = joints.entry(key).or_default();
            if is_start {
                joint.going.push(direction);
            } else {
                joint.coming.push(direction);
            }
            joint.is_thin |= brick.is_two_sided();
        }
    }
    let is_exposed = |key| joints.get(key).is_some_and(Joint::is_exposed);
    places.iter().filter(|(key, _)| is_exposed(key)).map(|(_, place)| Brick::corner(*place)).collect()
}

/// Returns whether all borders between free and occupied regions lie on bricks: all bricks are thin, or no
/// brick is thin and the bricks form closed lines.
///
/// In all other cases, the nearest brick decides on which side of the bricks a position is.
pub(super) fn are_closed(bricks: &[Brick]) -> bool {
    let mut more_starts: HashMap<[u64; 2], i32> = HashMap::new();
    let walls = || bricks.iter().filter(|brick| !brick.is_point());
    for brick in walls() {
        let Some([(start, _), (end, _)]) = brick.ends() else { continue };
        *more_starts.entry(key(start)).or_default() += 1;
        *more_starts.entry(key(end)).or_default() -= 1;
    }
    let are_lines_closed =
        walls().all(|brick| !brick.is_two_sided()) && more_starts.values().all(|&n| n == 0);
    are_lines_closed || walls().all(Brick::is_two_sided)
}

/// Returns the bits of a point. Ends of bricks meet if their coordinates are equal.
fn key(place: DVec2) -> [u64; 2] {
    // The sum turns a negative zero into a positive one: the two are equal, but their bits differ.
    [(place.x + 0.0).to_bits(), (place.y + 0.0).to_bits()]
}
