//! The event loop, which finds the next event, carries it out, and predicts what follows.
//!
//! This file shows one collision from top to bottom. [`Simulation::next_due`] queries the scheduler, and
//! [`Simulation::advance`] carries out the event. [`Simulation::collide`] lets the rule decide
//! (`resolution.rs`, and `encounter.rs` of the rules) and kicks both disks. It then predicts the next event
//! of each disk, and passes its time to the scheduler (`forecasting.rs`). The arithmetic of predictions is in
//! `prediction.rs`, and epochs are in `epoch.rs`. If rounding leaves partners approaching after a collision,
//! `resolution.rs` makes them part. The results of rules, boundaries and schedulers are checked where they
//! are used; `checking.rs` makes the errors. None of these files calls back into the event loop.

use glam::DVec2;

use super::engine::{Engine, Parts};
use super::errors::{BoundaryFault, Outcome};
use super::resolution::{
    Kick, failed, has_mass, impact_of, is_parting, is_possible, resolve_pair, resolve_wall,
};
use super::state::{Clock, Earliest, Exit, Forecast};
use super::{Event, Simulation};
use crate::boundary::{Boundary, Reaction, Response};
use crate::collision::{CollisionRule, Regime};
use crate::observable::{Collision, Observer, Partner};
use crate::scheduler::{EventScheduler, LARGE_SYSTEM};

impl<R: CollisionRule, B: Boundary, S: EventScheduler> Simulation<R, B, S> {
    /// Returns the disk whose event is next and the offset of the event, if it is not after the absolute time
    /// `end`.
    #[inline(always)]
    pub(super) fn next_due(&self, end: f64) -> Option<(usize, f64)> {
        let (disk, due) = self.parts.scheduler.earliest();
        // Observers know the rounded absolute time of a collision. If the offset of `end` were compared, a
        // run until that time could end just before the collision. The comparison is not `<=`, since a time
        // that is not a number must be noticed, and must not end the run.
        if self.engine.clock.origin + due > end { None } else { Some((disk, due)) }
    }

    /// Carries out the next event of `disk`, and returns it if it is a collision.
    #[inline(always)]
    pub(super) fn advance<O: Observer + ?Sized>(
        &mut self,
        disk: usize,
        due: f64,
        observer: &mut O,
    ) -> Outcome<Option<Event>> {
        let Some(&forecast) = self.engine.bodies.forecast(disk) else {
            return Err(self.engine.scheduler_fault(disk, due).into());
        };
        // A scheduler that names an old time would take the run back in time, or past an event.
        if forecast.due() != due || due < self.engine.clock.now {
            return Err(self.engine.scheduler_fault(disk, due).into());
        }
        if due > self.engine.clock.epoch_length {
            // The event is still due, at another offset. The scheduler will name it again.
            self.move_epoch(due)?;
            self.adapt_cells();
            return Ok(None);
        }
        self.engine.clock.now = due;
        self.look_ahead();
        if forecast.is_collision() {
            let partner = forecast.partner as usize;
            // An equal count means that the partner is still on the flight for which the collision was
            // predicted. The partner may also have been removed.
            let known = self.engine.bodies.forecast(partner).copied();
            if let Some(known) = known.filter(|known| known.collisions == forecast.partner_collisions) {
                // The collision gives the partner another event, which would hide one that was lost.
                if known.due() < due {
                    return Err(self.engine.overdue(partner, known.due()).into());
                }
                return self.collide(disk, partner, observer).map(Some);
            }
            self.engine.counters.repredictions += 1;
            self.predict_partner(disk);
            return Ok(None);
        }
        match forecast.exit {
            Exit::Wall => {
                return self.collide_with_wall(disk, usize::from(forecast.wall), observer).map(Some);
            }
            Exit::Horizon => {
                self.check_passed(disk)?;
                self.engine.counters.horizons += 1;
                self.engine.clock.count_search();
                self.predict(disk);
            }
            Exit::Impossible => return Err(self.impossible_touch(disk).into()),
            exit => self.cross(disk, exit),
        }
        Ok(None)
    }

    /// Carries out a collision of two disks.
    #[inline(always)]
    fn collide<O: Observer + ?Sized>(
        &mut self,
        disk: usize,
        partner: usize,
        observer: &mut O,
    ) -> Outcome<Event> {
        let Self { parts, engine } = self;
        let periods = engine.cells.grid.periods;
        // Neighbors are listed before the collision is known: the processor then has this work to do while
        // it waits for the roots and quotients of the collision.
        let counts = [engine.neighbors(disk, 0), engine.neighbors(partner, 1)];
        let (collision, kicks) =
            resolve_pair(&engine.bodies, &parts.rule, periods, &engine.clock, disk, partner);
        // A couple can make a spin impossible while the velocity stays possible. For a rule that never gives
        // a couple, the compiler knows the result of the comparison.
        let may_spin = (collision.impulse.couple() == 0.0) | (kicks[0].may_spin() & kicks[1].may_spin());
        if !(may_spin & engine.is_tame(&kicks[0]) & engine.is_tame(&kicks[1])) {
            self.prepare_for_pair(disk, partner)?;
        }
        let depth = self.engine.bodies.radius(disk) + self.engine.bodies.radius(partner) - collision.distance;
        if depth > self.engine.counters.max_overlap {
            self.note_overlap(disk, Partner::Disk(partner), Partner::Disk(partner), depth)?;
        }
        self.engine.counters.disk_collisions += 1;
        self.engine.count_regime(&collision);
        self.engine.kick(disk, &kicks[0]);
        self.engine.kick(partner, &kicks[1]);
        if !is_parting(collision.normal, &kicks) {
            let left = collision.impulse.closing_speed_after(&collision.contact);
            self.engine.part(disk, partner, collision.normal, left);
        }
        observer.on_collision(&collision);
        self.find_next_of_both([disk, partner], counts);
        // Both times go to the scheduler after both predictions: with one call after each prediction, a run
        // is 2 to 4 % slower.
        for disk in [disk, partner] {
            self.schedule(disk);
        }
        Ok(Event::Collision { disk, partner })
    }

    /// Carries out a collision of a disk with a wall.
    fn collide_with_wall<O: Observer + ?Sized>(
        &mut self,
        disk: usize,
        wall: usize,
        observer: &mut O,
    ) -> Outcome<Event> {
        let Parts { rule, boundary, .. } = &mut self.parts;
        let engine: &mut Engine = &mut self.engine;
        let now = engine.clock.now;
        let position = engine.bodies.position(disk, now);
        let surface = boundary.surface(wall, position, now);
        if !is_possible(&surface) {
            let (normal, velocity) = (surface.normal, surface.velocity);
            return Err(engine
                .boundary_fault(disk, BoundaryFault::Surface { wall, normal, velocity })
                .into());
        }
        // Because of rounding, the disk may already be leaving the wall in the engine's arithmetic. The rule
        // then receives a closing speed of zero and may change nothing, and the boundary would find the same
        // touch again.
        let is_leaving = (engine.bodies.velocity(disk, now) - surface.velocity).dot(surface.normal) > 0.0;
        let (mut collision, kick) = resolve_wall(engine, rule, &surface, &engine.clock, disk, wall);
        if !kick.is_possible() {
            let name = self.name_of(Partner::Wall(wall));
            return Err(failed(&collision, name).into());
        }
        let before = has_mass(&surface).then_some(surface.velocity);
        let is_plain = matches!(surface.response, Response::Shared | Response::Rule(_));
        self.engine.ledger.has_source |= !is_plain || surface.velocity != DVec2::ZERO;
        // The removal comes before the check of the touch, since disks may lie deep in the wall of a sink for
        // centers.
        if let Response::Absorbing = surface.response {
            return self.absorb(&mut collision, disk, wall, before, observer);
        }
        self.check_touch(disk, wall)?;
        if !self.engine.is_tame(&kick) {
            self.begin_epoch_for(&[kick])?;
        }
        self.engine.counters.wall_collisions += 1;
        self.engine.count_regime(&collision);
        self.engine.kick(disk, &kick);
        // The wall reacts before the disk's next flight is predicted, since the prediction needs the new
        // motion of the wall.
        let reaction = self.parts.boundary.react(&impact_of(&collision, wall, self.engine.clock.now));
        let velocities = before.map(|before| [before, self.see_wall(wall, &mut collision)]);
        self.find_next(disk);
        if is_leaving {
            self.leave_wall(disk, wall, &mut collision);
        }
        observer.on_collision(&collision);
        self.schedule(disk);
        if reaction == Reaction::Moved {
            self.end_flights_that_may_meet(wall);
        }
        if let Some(velocities) = velocities {
            self.check_reaction(&collision, wall, velocities, reaction)?;
            self.check_place(disk, wall)?;
        }
        Ok(Event::WallCollision { disk, wall })
    }

    /// Predicts anew the ends of all flights that may meet this wall, whose motion has changed. The predicted
    /// partners of the disks stay the same.
    #[cold]
    #[inline(never)]
    fn end_flights_that_may_meet(&mut self, wall: usize) {
        for disk in 0..self.engine.bodies.len() {
            let (region, at_wall) = self.engine.cells.region(disk);
            let Forecast { exit, exit_due: until, wall: expected, .. } = *self.engine.forecast(disk);
            // A predicted touch of the body may now happen later, or not at all.
            let expected = (exit == Exit::Wall).then_some(usize::from(expected));
            let is_lost = |expected| expected == wall || !self.touches(disk, expected, until);
            let may_meet =
                || self.parts.boundary.may_meet(wall, &region, self.engine.bodies.radius(disk), until);
            if at_wall && (expected.is_some_and(is_lost) || may_meet()) {
                self.end_flight(disk);
                self.schedule(disk);
            }
        }
    }

    /// Removes a disk that has come to a sink from the run.
    #[cold]
    #[inline(never)]
    fn absorb<O: Observer + ?Sized>(
        &mut self,
        collision: &mut Collision,
        disk: usize,
        wall: usize,
        before: Option<DVec2>,
        observer: &mut O,
    ) -> Outcome<Event> {
        self.engine.counters.wall_collisions += 1;
        self.engine.counters.removals += 1;
        self.engine.ledger.count(collision.time, self.len());
        let reaction = self.parts.boundary.react(&impact_of(collision, wall, self.engine.clock.now));
        let velocities = before.map(|before| [before, self.see_wall(wall, collision)]);
        observer.on_collision(collision);
        let gone = self.engine.bodies.disk(disk, self.engine.clock.now);
        observer.on_remove(&gone, collision.time);
        self.take_out(disk);
        self.engine.take_back(&gone);
        if reaction == Reaction::Moved {
            self.end_flights_that_may_meet(wall);
        }
        if let Some(velocities) = velocities {
            self.check_reaction(collision, wall, velocities, reaction)?;
        }
        Ok(Event::WallCollision { disk, wall })
    }

    /// Begins a shorter epoch for the collision of two disks, or returns an error if its outcome is not a
    /// possible motion.
    ///
    /// The collision is computed once more, so that usual collisions need not be kept in memory for this
    /// case.
    #[cold]
    #[inline(never)]
    fn prepare_for_pair(&mut self, disk: usize, partner: usize) -> Outcome<()> {
        let periods = self.engine.cells.grid.periods;
        let (collision, kicks) =
            resolve_pair(&self.engine.bodies, &self.parts.rule, periods, &self.engine.clock, disk, partner);
        if !kicks.iter().all(Kick::is_possible) {
            return Err(failed(&collision, None).into());
        }
        self.begin_epoch_for(&kicks)
    }

    /// Begins a shorter epoch for disks that are about to become very fast.
    fn begin_epoch_for(&mut self, kicks: &[Kick]) -> Outcome<()> {
        self.begin_epoch_at(kicks.iter().map(|kick| kick.after.velocity))
    }

    /// Begins a shorter epoch for disks of these velocities in the free-fall frame.
    ///
    /// After the kick, the position of a fast disk at the old epoch would be so far away that it would lack
    /// digits. The epoch therefore moves before the kick.
    #[cold]
    #[inline(never)]
    pub(super) fn begin_epoch_at(&mut self, velocities: impl Iterator<Item = DVec2>) -> Outcome<()> {
        let lengths = velocities.map(|velocity| self.engine.bodies.epoch_length_for(velocity));
        let epoch_length = lengths.fold(self.engine.clock.epoch_length, f64::min);
        // Very late times are so coarse that no epoch can begin near the present. The kick would then lose
        // the digits of the disk's position.
        Clock { epoch_length, ..self.engine.clock }.check_coarseness(self.engine.clock.now)?;
        self.shift_epoch(self.engine.clock.exact_offset());
        self.engine.clock.epoch_length = epoch_length;
        Ok(())
    }

    /// Moves a disk to its next cell. Its trajectory does not change, so only the cells ahead can hold an
    /// earlier partner.
    #[inline(always)]
    fn cross(&mut self, disk: usize, exit: Exit) {
        if self.engine.cells.is_large(disk) {
            return self.cross_large(disk, exit);
        }
        self.engine.counters.cell_crossings += 1;
        let passed = self.engine.cells.cross(disk, exit);
        self.engine.bodies.bring_back(disk, passed, self.engine.cells.grid.periods);
        self.engine.make_room();
        let count = self.engine.cells.ahead(disk, exit, &mut self.engine.scratch.found[0]);
        self.go_on(disk, count);
    }

    /// Predicts the next event of a disk that has entered a cell, with `count` disks found ahead of it.
    #[inline(always)]
    fn go_on(&mut self, disk: usize, count: usize) {
        // The end of the flight is computed before the search for a partner. The processor then resolves the
        // branches of the flight's end, whether it has predicted them correctly or not, while the search is
        // still under way.
        self.end_flight(disk);
        let forecast = self.engine.forecast(disk);
        let known = Earliest { due: forecast.collision_due, partner: forecast.partner };
        let earliest = self.engine.earliest_collision(disk, count, known);
        self.engine.expect_next(disk, earliest, known);
        self.schedule(disk);
    }

    /// Moves a disk of a larger class to its next cell.
    #[inline(never)]
    fn cross_large(&mut self, disk: usize, exit: Exit) {
        self.engine.counters.cell_crossings += 1;
        let passed = self.engine.cells.cross_large(disk, exit);
        self.engine.bodies.bring_back(disk, passed, self.engine.cells.grid.periods);
        self.engine.make_room();
        let count = self.engine.cells.ahead_of_large(disk, exit, &mut self.engine.scratch.found[0]);
        self.go_on(disk, count);
    }

    #[inline]
    fn look_ahead(&mut self) {
        if self.engine.bodies.len() >= LARGE_SYSTEM {
            self.engine.make_room();
            let engine: &mut Engine = &mut self.engine;
            let Engine { lookahead, bodies, cells, scratch, .. } = engine;
            lookahead.look(&mut self.parts.scheduler, bodies, cells, &mut scratch.found[0]);
        }
    }
}

impl Engine {
    #[inline]
    fn count_regime(&mut self, collision: &Collision) {
        let (contact, impulse) = (collision.contact, collision.impulse);
        // These are selections, since a branch would cost 3 % of a dense run, although it would hardly ever
        // be taken.
        let by_contact_duration = impulse.regime() == Regime::ContactDuration;
        let since = if by_contact_duration { contact.time_since_last_collision() } else { 0.0 };
        self.counters.contact_duration_collisions += u64::from(by_contact_duration);
        self.counters.longest_contact = self.counters.longest_contact.max(since);
        if impulse.regime() == Regime::LeastRebound {
            self.counters.least_rebound_collisions += 1;
            self.counters.energy_of_rebounds += impulse.energy_change(&contact).max(0.0);
        }
    }

    /// Returns whether a disk is slow enough for this epoch after a kick. Nearly all disks are.
    #[inline]
    fn is_tame(&self, kick: &Kick) -> bool {
        // The result is false for a velocity that is not a number. Spins need no test: an impulse that makes
        // the spin NaN makes the velocity NaN, too.
        self.bodies.keeps_pace(kick.after.velocity, self.clock.epoch_length)
    }

    /// Changes the motion of a disk in a collision. Predictions that involve the disk are then out of date.
    #[inline]
    fn kick(&mut self, disk: usize, kick: &Kick) {
        self.bodies.kick(disk, &kick.change, self.clock.now);
        self.forecast_mut(disk).count_collision();
    }
}
