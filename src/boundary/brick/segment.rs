//! Straight bricks.

use glam::DVec2;

use super::path::{Beside, Path};
use super::{MARGIN, Side, Sight};
use crate::boundary::Region;

/// A straight brick. Its left side is on the left of its direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Segment {
    pub(super) from: DVec2,
    pub(super) to: DVec2,
    /// Unit vector.
    pub(super) direction: DVec2,
    length: f64,
}

impl Segment {
    pub(super) fn between(from: DVec2, to: DVec2) -> Self {
        let length = from.distance(to);
        Self { from, to, direction: (to - from) / length, length }
    }

    /// Returns the same segment after a rotation about the origin by the angle of this unit vector, and a
    /// shift.
    pub(super) fn moved(&self, turn: DVec2, shift: DVec2) -> Self {
        Self::between(turn.rotate(self.from) + shift, turn.rotate(self.to) + shift)
    }

    pub(super) fn side(&self, place: DVec2) -> Side {
        if self.direction.perp_dot(place - self.from) >= 0.0 { Side::Left } else { Side::Right }
    }

    /// Returns the gap on one side as a polynomial in time.
    pub(super) fn gap(&self, path: &Path, side: Side) -> [f64; 5] {
        let height = path.along(self.from, self.normal(side));
        let gap = height.negated().widened(path.radius, path).negated();
        [gap.value, gap.rate, 0.5 * gap.acceleration, 0.0, 0.0]
    }

    fn normal(&self, side: Side) -> DVec2 {
        if side == Side::Left { self.direction.perp() } else { -self.direction.perp() }
    }

    /// Returns the condition that the disk is beside a segment that is longer by `more` at both ends.
    pub(super) fn beside(&self, path: &Path, more: f64) -> Beside {
        let along = path.along(self.from, self.direction);
        let margin = more + MARGIN * (self.from.length() + self.from.distance(self.to));
        let before_end = along.negated().widened(margin + self.length, path);
        Beside { quantities: [along.widened(margin, path), before_end], one_is_enough: false }
    }

    /// Returns whether the path stays too far from the brick for a touch. Most paths do.
    pub(super) fn is_out_of_reach(&self, path: &Path, wait: f64) -> bool {
        let (place, growth) = (path.place - self.from, path.growth(wait));
        let passes_by = |direction: DVec2, length: f64| {
            let (from, drift) = (place.dot(direction), 1.001 * path.velocity.dot(direction) * wait);
            let bend = 0.5 * path.acceleration.dot(direction).abs() * wait * wait;
            let reach = path.radius + 1.001 * (bend + growth);
            from + drift.min(0.0) - reach > length || from + drift.max(0.0) + reach < 0.0
        };
        passes_by(self.direction.perp(), 0.0) || passes_by(self.direction, self.length)
    }

    pub(super) fn sight(&self, place: DVec2) -> Sight {
        let along = (place - self.from).dot(self.direction);
        let height = self.direction.perp_dot(place - self.from);
        let nearest = if along <= 0.0 {
            self.from
        } else if along >= self.length {
            self.to
        } else {
            let normal = self.normal(self.side(place));
            return Sight { distance: height.abs(), normal, side: self.side(place), weight: height.abs() };
        };
        let distance = place.distance(nearest);
        let normal = (place - nearest).try_normalize().unwrap_or(self.direction.perp());
        Sight { distance, normal, side: self.side(place), weight: height.abs() }
    }

    /// Returns whether a point of the brick may be within `reach` of a region.
    pub(super) fn is_near(&self, region: &Region, reach: f64) -> bool {
        let Region { min: low, max: high } = self.bounds();
        let (min, max) = (region.min - reach, region.max + reach);
        let boxes_meet = low.x <= max.x && low.y <= max.y && high.x >= min.x && high.y >= min.y;
        if !boxes_meet {
            return false;
        }
        let height = |normal: DVec2| region.least_along(normal) - normal.dot(self.from);
        let normal = self.direction.perp();
        height(normal) <= reach && height(-normal) <= reach
    }

    /// Returns the rectangle around the brick.
    pub(super) fn bounds(&self) -> Region {
        Region::new(self.from.min(self.to), self.from.max(self.to))
    }

    /// Returns the smallest and the largest distance of the segment's points from a given point.
    pub(super) fn distances(&self, place: DVec2) -> (f64, f64) {
        (self.sight(place).distance, place.distance(self.to).max(place.distance(self.from)))
    }
}
