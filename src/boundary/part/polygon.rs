//! Polygons: their sides, and the checks of their points.

use glam::DVec2;

use crate::boundary::WallError;
use crate::boundary::brick::Brick;
use crate::boundary::vector::finite_point;
use crate::quantity::accept;

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
