//! Sinks that no disk can reach, because walls keep centers away from them.

use std::collections::BTreeMap;

use glam::DVec2;

use super::Simulation;
use super::engine::Engine;
use crate::boundary::{Boundary, FirstTouch, Probe, Response};
use crate::collision::CollisionRule;
use crate::scheduler::EventScheduler;
use crate::{Flight, Kind};

/// Distance from a wall at which a flight to it starts, in radii.
const AWAY: f64 = 1.5;

/// Largest distance between two positions at which disks are sent to a wall, in radii. Disks that need less
/// room beside them do not count as able to pass.
const STEP: f64 = 0.25;

/// Speed of such a flight, relative to the speed of a typical disk. The speed is high, so that walls hardly
/// move during the flight.
const FAST: f64 = 1e3;

impl<R: CollisionRule, B: Boundary, S: EventScheduler> Simulation<R, B, S> {
    /// Returns the first sink that no disk can touch now, because its walls lie in or beside other walls.
    ///
    /// To find it, the smallest disk of each kind is sent from both sides to closely spaced positions along
    /// all walls.
    #[cold]
    pub(super) fn closed_sink(&self) -> Option<usize> {
        let now = self.engine.clock.now;
        let is_sink = |wall: usize| {
            let place = self.parts.boundary.wall_point(wall, now).unwrap_or_default();
            matches!(self.parts.boundary.surface(wall, place, now).response, Response::Absorbing)
        };
        let mut sinks: Vec<usize> = (0..self.engine.wall_count).filter(|&wall| is_sink(wall)).collect();
        for (kind, radius) in self.engine.smallest_disks() {
            for (place, across) in self.places_at_walls(radius) {
                if sinks.is_empty() {
                    return None;
                }
                let ahead = [across, -across].map(|side| self.wall_ahead(place, side, radius, kind));
                // Other bricks of the same part need not be reached.
                let names = ahead.map(|wall| wall.map(|wall| self.parts.boundary.wall_name(wall)));
                sinks.retain(|&sink| !names.contains(&Some(self.parts.boundary.wall_name(sink))));
            }
        }
        sinks.first().copied()
    }

    /// Returns positions on all walls and on the edges of the domain, at most a [`STEP`] apart, each with a
    /// unit vector normal to the wall or edge.
    fn places_at_walls(&self, radius: f64) -> impl Iterator<Item = (DVec2, DVec2)> {
        let inside = self.parts.boundary.interior();
        let top = inside.top.min(inside.bottom + inside.width());
        let [low, high] = [DVec2::new(inside.left, inside.bottom), DVec2::new(inside.right, top)];
        let edges = vec![low, DVec2::new(high.x, low.y), high, DVec2::new(low.x, high.y), low];
        let lines = self.parts.boundary.wall_lines(self.engine.clock.now).into_iter().chain([edges]);
        let pieces =
            lines.flat_map(|line| line.windows(2).map(|ends| [ends[0], ends[1]]).collect::<Vec<_>>());
        pieces.flat_map(move |[from, to]| {
            let (way, across) = (to - from, (to - from).perp().normalize_or_zero());
            let count = (way.length() / (STEP * radius)).ceil();
            (0..count as u32).map(move |step| (from + (f64::from(step) + 0.5) / count * way, across))
        })
    }

    /// Returns the wall that a disk touches first when it flies from `side` across this position.
    fn wall_ahead(&self, place: DVec2, side: DVec2, radius: f64, kind: Kind) -> Option<usize> {
        let (domain, inside, now) =
            (self.parts.boundary.domain(), self.parts.boundary.interior(), self.engine.clock.now);
        let start = domain.wrapped(place + AWAY * radius * side);
        let probe = Probe::new(start, radius, now).with_kind(kind);
        if !domain.contains(start, 0.0) || self.parts.boundary.overlap(&probe).is_some() {
            return None;
        }
        // Moving walls of a container may be behind the edges of its interior.
        let reach =
            (inside.bottom - domain.bottom).max(inside.left - domain.left).max(domain.right - inside.right);
        let speed = FAST * self.engine.bodies.typical_diameter / self.engine.clock.epoch_length;
        let until = now + (2.0 * AWAY * radius + reach) / speed;
        let flight = Flight::new(now, start, -speed * side, DVec2::ZERO, radius).with_kind(kind);
        match self.parts.boundary.first_touch(&flight, until) {
            FirstTouch::At(touch) => Some(touch.wall),
            FirstTouch::NotBefore(_) => None,
        }
    }
}

impl Engine {
    fn smallest_disks(&self) -> BTreeMap<Kind, f64> {
        let mut smallest = BTreeMap::new();
        let probes = (0..self.len()).map(|disk| self.probe(disk));
        let models = self.inlets.iter().flat_map(|inlet| inlet.models().iter());
        for probe in probes.chain(models.map(|model| Probe::of(model, 0.0))) {
            let radius = smallest.entry(probe.kind()).or_insert(probe.radius());
            *radius = probe.radius().min(*radius);
        }
        smallest
    }
}
