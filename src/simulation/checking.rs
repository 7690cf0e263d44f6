//! Checks of the results that the engine receives: collisions happen where surfaces touch, no event is lost,
//! and no disk leaves the domain.
//!
//! Every part may be the user's code. No part can make the engine panic. However, a wall at another position
//! than it reports, or a scheduler that loses events, would let a run end as if nothing had happened. The
//! engine therefore checks where a check costs next to nothing: at each wall collision, at each new largest
//! overlap, at the partner of each collision, at the ends of searches for a wall, and at all disks whenever
//! the epoch moves, and at the ends of runs or steps once there were as many events as disks.

use glam::DVec2;

use super::Simulation;
use super::engine::Engine;
use super::errors::{BoundaryFault, Outcome, RunError};
use super::forecasting::HORIZON;
use super::state::{FARTHEST, Forecast};
use crate::boundary::{Boundary, FirstTouch, Overlap, Probe, Reaction, WallView};
use crate::collision::{CollisionRule, Material};
use crate::observable::{Collision, Partner};
use crate::scheduler::EventScheduler;

/// Largest gap at a collision with a wall, relative to the radius. It is a power of two (9e-10), so that the
/// enlarged radius loses no digits for usual radii.
const NEAR: f64 = 1.0 / (1_u64 << 30) as f64;

/// Largest overlap at a collision, relative to the radius. In ordinary runs, overlaps are about 1e-13. Disks
/// with speeds in the thousands that bounce a hundred thousand times in a closing corner reach 1e-8.
const DEEP: f64 = 1e-6;

/// Number of times that the search for a wall doubles its reach, in order to report the distance of the wall.
const MOST_DOUBLINGS: usize = 100;

/// Largest error of a wall's velocity after a collision, relative to the speeds.
const INEXACT: f64 = 1e-6;

/// Largest error of a position, relative to the coordinates.
const ROUNDINGS: f64 = 64.0 * f64::EPSILON;

impl<R: CollisionRule, B: Boundary, S: EventScheduler> Simulation<R, B, S> {
    /// Checks that a disk at this position touches a wall, and keeps the largest overlap.
    ///
    /// One query to the boundary serves both purposes. A disk that touches overlaps the wall once its radius
    /// is enlarged by the largest gap. The depth minus this gap is the depth of the disk itself.
    #[inline]
    pub(super) fn check_touch(&mut self, disk: usize, wall: usize) -> Outcome<()> {
        let probe = self.engine.probe(disk);
        let gap = NEAR * probe.radius();
        match self.parts.boundary.overlap(&probe.with_radius(probe.radius() + gap)) {
            Some(overlap) if overlap.depth - gap <= self.engine.counters.max_wall_overlap => Ok(()),
            // The deepest wall need not be the one that was touched.
            Some(Overlap { with: deepest, depth }) => {
                self.note_overlap(disk, Partner::Wall(wall), Partner::Wall(deepest), depth - gap)
            }
            None => self.check_gap(disk, wall, &probe),
        }
    }

    /// Puts the velocity of a wall after its reaction into the collision, and returns the velocity that the
    /// impulse gives if no stop holds the wall.
    #[cold]
    #[inline(never)]
    pub(super) fn see_wall(&self, wall: usize, collision: &mut Collision) -> DVec2 {
        let found = self.parts.boundary.surface(wall, collision.position, self.engine.clock.now).velocity;
        std::mem::replace(&mut collision.velocities[1], found)
    }

    /// Checks that a wall with a mass has taken the impulse of a collision, given its velocity before, and
    /// the expected one after. Notes the energy that a stop has absorbed.
    ///
    /// Rounding hides what the impulse does to a very heavy wall.
    #[cold]
    #[inline(never)]
    pub(super) fn check_reaction(
        &mut self,
        collision: &Collision,
        wall: usize,
        [before, expected]: [DVec2; 2],
        reaction: Reaction,
    ) -> Outcome<()> {
        let ([left, found], impulse, normal) = (collision.velocities, collision.impulse, collision.normal);
        let slack = INEXACT * (before.length() + expected.length() + left.length());
        let is_at = |velocity: DVec2, direction| (found - velocity).dot(direction).abs() <= slack;
        // At a stop, the wall may be held or bounce, which needs a state. It then has less than the expected
        // speed, in the other direction.
        let is_held = |direction| {
            let (found, expected) = (found.dot(direction), expected.dot(direction));
            found * expected <= 0.0
                && found.abs() <= expected.abs()
                && !self.parts.boundary.state().is_empty()
        };
        // A guide at a slant moves a wall along its surface, too. No disk feels it if there is no friction.
        let is_smooth = impulse.tangential() == 0.0 && impulse.couple() == 0.0;
        let is_right_across = is_smooth || is_at(expected, normal.perp());
        let is_told = reaction == Reaction::Moved || found.distance(before) <= slack;
        let is_free = is_at(expected, normal);
        if is_told && is_right_across && (is_free || is_held(normal)) {
            self.note_energies(
                collision,
                wall,
                [before, expected, found].map(|velocity| velocity.dot(normal)),
            );
            return Ok(());
        }
        let fault = BoundaryFault::Reaction { wall, expected, found };
        Err(self.engine.boundary_fault(collision.disk, fault).into())
    }

    /// Notes the energy that stops have absorbed from a wall: what its impulse would have given it, and what
    /// it lost on its way since the last hit. The speeds are along the normal, before and after the hit,
    /// without and with a stop.
    fn note_energies(&mut self, collision: &Collision, wall: usize, [before, expected, found]: [f64; 3]) {
        let mass = self.parts.boundary.surface(wall, collision.position, self.engine.clock.now).mass;
        let kinetic = |speed: f64| 0.5 * mass * speed * speed;
        if found != expected && found * expected <= 0.0 {
            self.engine.note_stop(wall, kinetic(expected) - kinetic(found));
        }
        let view = self.parts.boundary.wall(wall, self.engine.clock.now);
        if let Some(after) = view.energy {
            self.engine.note_energies(wall, &view.name, [after - kinetic(found) + kinetic(before), after]);
        }
    }

    /// Checks that a wall has not jumped away from a disk that it touches, or into the disk.
    #[cold]
    #[inline(never)]
    pub(super) fn check_place(&self, disk: usize, wall: usize) -> Outcome<()> {
        self.check_gap(disk, wall, &self.engine.probe(disk))?;
        self.check_passed(disk)
    }

    /// Records the largest overlap so far, or returns an error if an overlap is larger than rounding.
    ///
    /// A larger overlap is not kept, so that the next overlap of this size is noticed, too. The error names
    /// the partner that the disk overlaps. This may be a wall other than the touched one.
    #[cold]
    #[inline(never)]
    pub(super) fn note_overlap(
        &mut self,
        disk: usize,
        partner: Partner,
        inside: Partner,
        depth: f64,
    ) -> Outcome<()> {
        let radius = match partner {
            Partner::Disk(other) => self.engine.bodies.radius(disk).min(self.engine.bodies.radius(other)),
            Partner::Wall(_) => self.engine.bodies.radius(disk),
        };
        // A depth that is not a number would stay the largest forever.
        if depth.is_nan() || depth > DEEP * radius + self.rounding_at(disk, partner) {
            return Err(self.false_contact(disk, inside, depth).into());
        }
        match partner {
            Partner::Disk(_) => self.engine.counters.max_overlap = depth,
            Partner::Wall(_) => self.engine.counters.max_wall_overlap = depth,
        }
        Ok(())
    }

    /// Returns whether a disk on its present flight touches a wall at `time`, up to rounding.
    pub(super) fn touches(&self, disk: usize, wall: usize, time: f64) -> bool {
        let Material { radius, kind, .. } = self.engine.bodies.material(disk);
        let probe = Probe::new(self.engine.bodies.position(disk, time), radius, time).with_kind(kind);
        self.parts.boundary.overlap(&self.enlarged(disk, wall, &probe)).is_some()
    }

    /// Returns a probe that overlaps each wall from which a gap within rounding separates the disk.
    fn enlarged(&self, disk: usize, wall: usize, probe: &Probe) -> Probe {
        probe.with_radius((1.0 + NEAR) * probe.radius() + self.rounding_at(disk, Partner::Wall(wall)))
    }

    /// Checks that a gap before a wall is within rounding.
    #[cold]
    fn check_gap(&self, disk: usize, wall: usize, probe: &Probe) -> Outcome<()> {
        let (now, radius) = (self.engine.clock.now, probe.radius());
        let within = self.enlarged(disk, wall, probe);
        // A wall that jumps away from the disks may have jumped within the rounding error of the time. The
        // engine never passes times before the epoch.
        let before = (now - self.engine.clock.rounding()).max(0.0);
        if [now, before].iter().any(|&time| self.parts.boundary.overlap(&within.with_time(time)).is_some()) {
            return Ok(());
        }
        let mut gaps = std::iter::successors(Some(NEAR * radius), |gap| Some(2.0 * gap)).take(MOST_DOUBLINGS);
        let found =
            |gap: f64| Some(gap - self.parts.boundary.overlap(&probe.with_radius(radius + gap))?.depth);
        let gap = gaps.find_map(found).unwrap_or(f64::INFINITY);
        Err(self.false_contact(disk, Partner::Wall(wall), -gap).into())
    }

    /// Returns the error by which the gap between a disk and its partner may differ from zero.
    ///
    /// Positions are rounded relative to their distance from the origin, and to the distance traveled since
    /// the epoch. The time of a touch is rounded as absolute times are, since some walls know only absolute
    /// times. Both the disk and the wall move during this error of the time.
    fn rounding_at(&self, disk: usize, partner: Partner) -> f64 {
        let now = self.engine.clock.now;
        let position = self.engine.bodies.position(disk, now);
        let way = self.engine.fastest() * self.engine.clock.epoch_length;
        let rounding = ROUNDINGS * (position.x.abs() + position.y.abs() + way);
        let Partner::Wall(wall) = partner else { return rounding };
        let speed = self.parts.boundary.surface(wall, position, now).velocity.length();
        rounding + self.engine.clock.rounding() * (speed + self.engine.fastest())
    }

    /// Checks a disk that reached the horizon of a search without a touch: no later search would find a wall
    /// that the disk has passed.
    pub(super) fn check_passed(&self, disk: usize) -> Outcome<()> {
        let probe = self.engine.probe(disk);
        let Some(Overlap { with: wall, depth }) = self.parts.boundary.overlap(&probe) else { return Ok(()) };
        let most = DEEP * probe.radius() + self.rounding_at(disk, Partner::Wall(wall));
        let is_false = depth.is_nan() || depth > most;
        if is_false { Err(self.false_contact(disk, Partner::Wall(wall), depth).into()) } else { Ok(()) }
    }

    /// Checks all disks at the end of a run or a step, if there were as many events as disks since the last
    /// check. More checks would cost more than the runs. A scheduler that names no disk at all is noticed
    /// when an epoch has passed.
    pub(super) fn check_sometimes(&mut self) -> Outcome<()> {
        let (events, time) = (self.engine.counters.events(), self.time());
        let is_due = self.engine.scratch.checked.is_none_or(|(before, since)| {
            events - before >= self.len() as u64 || time - since >= self.engine.clock.epoch_length
        });
        if is_due {
            self.check_all(self.engine.clock.now)?;
            self.engine.scratch.checked = Some((events, time));
        }
        Ok(())
    }

    /// Checks that no event before this time offset was lost, and that all disks are in the domain at that
    /// time.
    pub(super) fn check_all(&self, offset: f64) -> Outcome<()> {
        let domain = self.parts.boundary.domain();
        let rounding = self.engine.clock.rounding() * self.engine.fastest();
        for (disk, particle) in self.engine.bodies.particles.iter().enumerate() {
            if particle.forecast.due() < offset {
                return Err(self.engine.overdue(disk, particle.forecast.due()).into());
            }
            let position = self.engine.bodies.position(disk, offset);
            if !domain.contains(position, rounding + self.engine.bodies.radius(disk)) {
                let DVec2 { x, y } = position;
                return Err(self.engine.boundary_fault(disk, BoundaryFault::Outside { x, y }).into());
            }
        }
        Ok(())
    }

    fn false_contact(&self, disk: usize, partner: Partner, depth: f64) -> RunError {
        RunError::FalseContact { disk, partner, wall: self.name_of(partner), depth, time: self.time() }
    }

    /// Returns the name of the partner if it is a wall.
    pub(super) fn name_of(&self, partner: Partner) -> Option<String> {
        let Partner::Wall(wall) = partner else { return None };
        Some(WallView::of(&self.parts.boundary, wall, self.engine.clock.now).to_string())
    }

    /// Repeats the search that returned an impossible touch, in order to report the touch.
    #[cold]
    pub(super) fn impossible_touch(&self, disk: usize) -> RunError {
        let now = self.engine.clock.now;
        let until = now + HORIZON * self.engine.clock.epoch_length;
        let FirstTouch::At(touch) = self.parts.boundary.first_touch(&self.engine.flight(disk), until) else {
            return self.engine.boundary_fault(disk, BoundaryFault::Search);
        };
        let (wall, early_by) = (touch.wall, now - touch.time);
        self.engine
            .boundary_fault(disk, BoundaryFault::Touch { wall, early_by, walls: self.engine.wall_count })
    }
}

impl Engine {
    /// Returns a probe of the disk as it is now, for queries to the boundary.
    pub(super) fn probe(&self, disk: usize) -> Probe {
        let Material { radius, kind, .. } = self.bodies.material(disk);
        Probe::new(self.bodies.position(disk, self.clock.now), radius, self.clock.now).with_kind(kind)
    }

    /// Returns the speed that no disk exceeds in this epoch.
    fn fastest(&self) -> f64 {
        FARTHEST * self.bodies.typical_diameter / self.clock.epoch_length
    }

    #[cold]
    pub(super) fn scheduler_fault(&self, disk: usize, due: f64) -> RunError {
        let expected = self.bodies.forecast(disk).map(Forecast::due);
        RunError::Scheduler { disk, due, expected, time: self.time() }
    }

    #[cold]
    pub(super) fn overdue(&self, disk: usize, due: f64) -> RunError {
        RunError::Overdue { disk, due: self.clock.origin + due, time: self.time() }
    }

    #[cold]
    pub(super) fn boundary_fault(&self, disk: usize, fault: BoundaryFault) -> RunError {
        RunError::Boundary { disk, time: self.time(), fault }
    }
}
