//! Straight bricks, and round ones: circles, arcs and points.

use std::f64::consts::TAU;

use glam::DVec2;

use super::path::{Beside, Path};
use super::{MARGIN, Side, Sight};
use crate::boundary::Region;
use crate::boundary::domain::direction;

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
        if !self.bounds().meets(&region.enlarged(reach)) {
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

/// A circle, or an arc of a circle. The arc leads counterclockwise, so its left side is inside. A point is a
/// circle of radius 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Arc {
    pub(super) center: DVec2,
    pub(super) radius: f64,
    pub(super) sector: Option<Sector>,
}

/// The directions from the center to an arc.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Sector {
    /// Unit vectors to both ends of the arc.
    pub(super) start: DVec2,
    pub(super) end: DVec2,
    /// True if the arc is longer than half of the circle.
    pub(super) is_wide: bool,
}

impl Sector {
    fn contains(&self, direction: DVec2) -> bool {
        let (after, before) = (self.start.perp_dot(direction) >= 0.0, direction.perp_dot(self.end) >= 0.0);
        if self.is_wide { after || before } else { after && before }
    }
}

impl Arc {
    /// Returns the start and the end, with the directions of the arc there.
    pub(super) fn ends(&self) -> Option<[(DVec2, DVec2); 2]> {
        let end = |direction: DVec2| (self.center + self.radius * direction, direction.perp());
        self.sector.map(|sector| [end(sector.start), end(sector.end)])
    }

    /// Returns points along the arc, at most this angle apart.
    pub(super) fn points(&self, step: f64) -> Vec<DVec2> {
        let (start, angle) = match self.sector {
            None => (DVec2::X, TAU),
            Some(Sector { start, end, .. }) => {
                let angle = libm::atan2(start.perp_dot(end), start.dot(end));
                (start, if angle > 0.0 { angle } else { angle + TAU })
            }
        };
        let count = (angle / step).ceil().max(1.0);
        let at = |k: u32| direction(angle * f64::from(k) / count).rotate(start);
        (0..=count as u32).map(|k| self.center + self.radius * at(k)).collect()
    }

    /// Returns the same arc after a rotation about the origin by the angle of this unit vector, and a shift.
    pub(super) fn moved(&self, turn: DVec2, shift: DVec2) -> Self {
        let turned = |sector: Sector| {
            let [start, end] = [sector.start, sector.end].map(|side| turn.rotate(side).normalize());
            Sector { start, end, ..sector }
        };
        Self { center: turn.rotate(self.center) + shift, sector: self.sector.map(turned), ..*self }
    }

    pub(super) fn side(&self, place: DVec2) -> Side {
        if place.distance(self.center) < self.radius { Side::Left } else { Side::Right }
    }

    /// Returns the gap on one side as a polynomial in time. It is a difference of two squared distances,
    /// which has the sign of the gap.
    pub(super) fn gap(&self, path: &Path, side: Side) -> [f64; 5] {
        let (r, v, a) = (path.place - self.center, path.velocity, path.acceleration);
        let (k, s) = (path.widening, path.spread);
        // The constant terms below are products, so a gap far smaller than the circle keeps its digits.
        let square = [2.0 * r.dot(v), v.length_squared() + r.dot(a), v.dot(a), 0.25 * a.length_squared()];
        match side {
            Side::Right => {
                let contact = self.radius + path.radius;
                let grown = [2.0 * contact * k, k * k + contact * s, k * s, 0.25 * s * s];
                let [c1, c2, c3, c4] = std::array::from_fn(|n| square[n] - grown[n]);
                [(r.length() - contact) * (r.length() + contact), c1, c2, c3, c4]
            }
            // A disk that is larger than the circle never touches it from inside, because it does not fit in.
            Side::Left if path.radius >= self.radius => [1.0, 0.0, 0.0, 0.0, 0.0],
            Side::Left => {
                let room = self.radius - path.radius;
                let shrunk = [-2.0 * room * k, k * k - room * s, k * s, 0.25 * s * s];
                let [c1, c2, c3, c4] = std::array::from_fn(|n| shrunk[n] - square[n]);
                [(room - r.length()) * (room + r.length()), c1, c2, c3, c4]
            }
        }
    }

    /// Returns the condition that the disk is beside the arc, or beyond its ends by at most `more`.
    pub(super) fn beside(&self, path: &Path, more: f64) -> Option<Beside> {
        let sector = self.sector?;
        let margin = more + MARGIN * (self.center.length() + self.radius);
        let after = path.along(self.center, sector.start.perp()).widened(margin, path);
        let before = path.along(self.center, -sector.end.perp()).widened(margin, path);
        Some(Beside { quantities: [after, before], one_is_enough: sector.is_wide })
    }

    /// Returns whether the path stays too far from the brick for a touch. Most paths do.
    pub(super) fn is_out_of_reach(&self, path: &Path, wait: f64) -> bool {
        const LESS: f64 = 1.0 - 1e-9;
        let (from, to) = (path.place - self.center, path.at(wait) - self.center);
        let sagitta = path.sagitta(wait);
        let contact = self.radius + path.radius + sagitta;
        if LESS * distance_to_chord(from, to) > contact {
            return true;
        }
        let farthest = from.length_squared().max(to.length_squared()).sqrt();
        farthest + sagitta < LESS * (self.radius - path.radius)
    }

    /// Returns the largest growth that the search allows a disk of this radius: half of its room inside the
    /// circle.
    pub(super) fn most_growth(&self, radius: f64) -> f64 {
        if self.radius > radius { 0.5 * (self.radius - radius) } else { f64::INFINITY }
    }

    pub(super) fn sight(&self, place: DVec2) -> Sight {
        let (r, side) = (place - self.center, self.side(place));
        if let (Some(sector), Some(ends)) = (self.sector, self.ends())
            && !sector.contains(r)
        {
            let [start, end] = ends.map(|(end, direction)| {
                let away = place - end;
                let normal = away.try_normalize().unwrap_or(direction.perp());
                let height = direction.perp_dot(away);
                let side = if height >= 0.0 { Side::Left } else { Side::Right };
                Sight { distance: away.length(), normal, side, weight: height.abs() }
            });
            return if start.distance <= end.distance { start } else { end };
        }
        let outward = r.try_normalize().unwrap_or(DVec2::Y);
        let normal = if side == Side::Left { -outward } else { outward };
        let distance = (r.length() - self.radius).abs();
        // A point has no sides, so the bricks that end at the point decide.
        Sight { distance, normal, side, weight: if self.radius == 0.0 { 0.0 } else { distance } }
    }

    /// Returns whether a point of the brick may be within `reach` of a region.
    pub(super) fn is_near(&self, region: &Region, reach: f64) -> bool {
        let nearest = self.center.clamp(region.min, region.max).distance(self.center);
        let farthest = (region.min - self.center).abs().max((region.max - self.center).abs()).length();
        nearest <= self.radius + reach && farthest >= self.radius - reach
    }

    /// Returns a rectangle around the brick.
    pub(super) fn bounds(&self) -> Region {
        Region::around(self.center, self.radius)
    }

    /// Returns the smallest and the largest distance of the arc's points from a given point.
    pub(super) fn distances(&self, place: DVec2) -> (f64, f64) {
        let nearest = self.sight(place).distance;
        // The point of the circle opposite the given point is the farthest, unless the arc does not reach it.
        let farthest = match (self.sector, self.ends()) {
            (Some(sector), Some(ends)) if !sector.contains(self.center - place) => {
                ends.iter().map(|(end, _)| end.distance(place)).fold(0.0, f64::max)
            }
            _ => place.distance(self.center) + self.radius,
        };
        (nearest, farthest)
    }
}

/// Returns the smallest distance of a chord from the origin.
fn distance_to_chord(from: DVec2, to: DVec2) -> f64 {
    let chord = to - from;
    let share = (-from.dot(chord) / chord.length_squared()).clamp(0.0, 1.0);
    // For a chord of length zero, the share is NaN.
    if share.is_nan() { from.length() } else { (from + share * chord).length() }
}
