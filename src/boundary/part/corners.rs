//! The corners of a part: points where its bricks end.

use std::collections::HashMap;

use glam::DVec2;

use crate::boundary::brick::Brick;

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
