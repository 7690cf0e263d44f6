//! The event loop: which disk is next, what happens to it, and what follows.
//!
//! One collision, read from top to bottom: [`Simulation::next_due`] asks the scheduler, [`Simulation::advance`] goes there,
//! [`Simulation::collide`] has the rule decide (`resolution.rs`) and kicks both disks, [`Simulation::find_next`] finds what each does
//! next (`prediction.rs`), [`Simulation::schedule`] tells the scheduler.

use std::hint::select_unpredictable;

use glam::DVec2;

use super::Simulation;
use super::errors::{Outcome, RunError};
use super::events::Event;
use super::prediction::{LANES, are_closing, cell_exit, earliest_collision};
use super::resolution::{Kick, failed, is_parting, resolve_pair};
use super::state::{Earliest, Exit, Forecast};
use crate::boundary::Boundary;
use crate::collision::laws::closing_speed_after;
use crate::collision::{CollisionRule, Regime};
use crate::observable::{Collision, Observer};
use crate::scheduler::{EventScheduler, LARGE_SYSTEM};

/// Doublings after which two surfaces that a collision has left within rounding of each other are let be.
pub(super) const MOST_NUDGES: u32 = 24;

/// Closing speed after a collision, in terms of the speeds of the disks, that is more than rounding: the rule wants it so.
const WANTED: f64 = 1e-9;

impl<R: CollisionRule, B: Boundary, S: EventScheduler> Simulation<R, B, S> {
    /// The disk whose event is next and its offset, if that is not after the offset `end`.
    #[inline]
    pub(super) fn next_due(&self, end: f64) -> Option<(usize, f64)> {
        let (disk, due) = self.scheduler.earliest();
        // Not `due <= end`: a time that is not a number must come to light, not end the run.
        if due > end { None } else { Some((disk, due)) }
    }

    /// Does the next event of `disk`; returns it if it is a collision.
    #[inline]
    pub(super) fn advance<O: Observer + ?Sized>(
        &mut self,
        disk: usize,
        due: f64,
        observer: &mut O,
    ) -> Outcome<Option<Event>> {
        let Some(&forecast) = self.bodies.forecast(disk) else {
            return Err(self.scheduler_fault(disk, due).into());
        };
        // A scheduler that names an old time would take the run back, or past an event.
        if forecast.due() != due || due < self.clock.now {
            return Err(self.scheduler_fault(disk, due).into());
        }
        if due > self.clock.epoch_length {
            // The event is due all the same, at another offset: it comes up again.
            self.move_epoch(due)?;
            self.adapt_cells();
            return Ok(None);
        }
        self.clock.now = due;
        if let Some(events) = self.clock.watch(self.bodies.len()) {
            return Err(Box::new(RunError::Stalled { time: self.time(), disk, events }));
        }
        self.look_ahead();
        if forecast.is_collision() {
            let partner = forecast.partner as usize;
            if self.forecast(partner).collisions == forecast.partner_collisions {
                return self.collide(disk, partner, observer).map(Some);
            }
            self.counters.repredictions += 1;
            self.predict_partner(disk);
            return Ok(None);
        }
        match forecast.exit {
            Exit::Wall => {
                return self.collide_with_wall(disk, usize::from(forecast.wall), observer).map(Some);
            }
            Exit::Horizon => {
                self.counters.horizons += 1;
                self.predict(disk);
            }
            Exit::Impossible => return Err(self.impossible_touch(disk).into()),
            exit => self.cross(disk, exit),
        }
        Ok(None)
    }

    /// Two disks collide.
    #[inline]
    fn collide<O: Observer + ?Sized>(
        &mut self,
        disk: usize,
        partner: usize,
        observer: &mut O,
    ) -> Outcome<Event> {
        let period = self.cells.grid().period();
        let (collision, kicks) = resolve_pair(&self.bodies, &self.rule, period, &self.clock, disk, partner);
        if !(self.is_tame(&kicks[0]) & self.is_tame(&kicks[1])) {
            self.prepare_for_pair(disk, partner)?;
        }
        let touching = self.bodies.material(disk).radius + self.bodies.material(partner).radius;
        self.counters.collisions += 1;
        self.counters.max_overlap = self.counters.max_overlap.max(touching - collision.distance);
        self.count_regime(&collision);
        self.kick(disk, &kicks[0]);
        self.kick(partner, &kicks[1]);
        if !is_parting(collision.normal, &kicks) {
            let left = closing_speed_after(&collision.contact, collision.impulse);
            self.part(disk, partner, collision.normal, left);
        }
        observer.on_collision(&collision);
        for disk in [disk, partner] {
            self.find_next(disk);
        }
        for disk in [disk, partner] {
            self.schedule(disk);
        }
        Ok(Event::Collision { disk, partner })
    }

    pub(super) fn count_regime(&mut self, collision: &Collision) {
        let by_contact_duration = collision.impulse.regime() == Regime::ContactDuration;
        self.counters.contact_duration_collisions += u64::from(by_contact_duration);
    }

    /// Tells whether a disk can be kicked in this epoch; so are nearly all.
    #[inline]
    pub(super) fn is_tame(&self, kick: &Kick) -> bool {
        // Not so for a velocity that is no number; rotation cannot go wrong alone, since its impulse moves the disk, too.
        self.bodies.keeps_pace(kick.after.velocity, self.clock.epoch_length)
    }

    /// Begins a shorter epoch for the collision of two disks, or refuses it if its outcome is no motion.
    ///
    /// The collision is worked out once more, so that the usual one need not be kept in memory for this.
    #[cold]
    #[inline(never)]
    fn prepare_for_pair(&mut self, disk: usize, partner: usize) -> Outcome<()> {
        let period = self.cells.grid().period();
        let (collision, kicks) = resolve_pair(&self.bodies, &self.rule, period, &self.clock, disk, partner);
        if !kicks.iter().all(Kick::is_possible) {
            return Err(failed(&self.rule, &collision).into());
        }
        self.begin_epoch_for(&kicks);
        Ok(())
    }

    /// Begins a shorter epoch for disks that are about to become very fast.
    ///
    /// The place of a disk at the epoch would be so far away that it lacked digits. So the epoch moves before the kick, not after.
    #[cold]
    #[inline(never)]
    pub(super) fn begin_epoch_for(&mut self, kicks: &[Kick]) {
        self.shift_epoch(self.clock.exact_offset());
        for kick in kicks {
            let length = self.bodies.epoch_length_for(kick.after.velocity);
            self.clock.epoch_length = self.clock.epoch_length.min(length);
        }
    }

    /// Changes the motion of a disk, as all collisions do: predictions with it are out of date.
    #[inline]
    pub(super) fn kick(&mut self, disk: usize, kick: &Kick) {
        self.bodies.kick(disk, kick.velocity, kick.angular_velocity, self.clock.now);
        self.forecast_mut(disk).count_collision();
    }

    /// Makes two disks part that a collision has left with a closing speed of rounding, or none.
    ///
    /// Velocities have digits relative to themselves, not to their difference: a rule that takes all of the closing speed
    /// leaves some 1e-17 of it, of either sign, and disks that touch and close collide at once, again and again. So the speed is
    /// raised, by as much on the scale of its rounding as it takes for the prediction to see them part.
    #[cold]
    #[inline(never)]
    fn part(&mut self, disk: usize, partner: usize, normal: DVec2, left: f64) {
        let masses = [disk, partner].map(|disk| self.bodies.material(disk).inverse_mass);
        let (period, now) = (self.cells.grid().period(), self.clock.now);
        let speed = self.bodies.speed(disk) + self.bodies.speed(partner);
        if left > WANTED * speed {
            return;
        }
        for doubling in 0..MOST_NUDGES {
            if !are_closing(&self.bodies, period, disk, partner, now) {
                return;
            }
            let push = normal * (f64::from(1_u32 << doubling) * f64::EPSILON * speed);
            // Shared as an impulse would be, so that momentum stays.
            let total = masses[0] + masses[1];
            self.bodies.push(disk, push * (masses[0] / total), now);
            self.bodies.push(partner, -push * (masses[1] / total), now);
        }
    }

    /// Takes a disk to its next cell. Its trajectory does not change: only the cells ahead can hold an earlier partner.
    #[inline]
    fn cross(&mut self, disk: usize, exit: Exit) {
        self.counters.cell_crossings += 1;
        self.bodies.particles[disk].trajectory.position.x += self.cells.cross(disk, exit);
        self.make_room();
        let count = self.cells.ahead(self.cells.place(disk), exit, &mut self.scratch.found);
        // Before the search for a partner: its branches are then decided, right or wrong, while that is still under way.
        self.end_flight(disk);
        let forecast = self.forecast(disk);
        let known = Earliest { due: forecast.collision_due, partner: forecast.partner };
        let earliest = self.earliest_collision(disk, count, known);
        self.expect_next(disk, earliest, known);
        self.schedule(disk);
    }

    /// Finds the next event of a disk among all its neighbors, and tells the scheduler.
    fn predict(&mut self, disk: usize) {
        self.find_next(disk);
        self.schedule(disk);
    }

    /// Finds the next event of a disk among all its neighbors.
    ///
    /// One copy for all callers: the whole search is inlined into it.
    #[inline(never)]
    pub(super) fn find_next(&mut self, disk: usize) {
        self.find_partner(disk);
        self.end_flight(disk);
    }

    /// Finds another partner for a disk whose partner has collided meanwhile: its own flight in its cell ends as it did.
    #[inline(never)]
    fn predict_partner(&mut self, disk: usize) {
        self.find_partner(disk);
        self.schedule(disk);
    }

    /// Finds the next collision of a disk among all its neighbors.
    #[inline(always)]
    fn find_partner(&mut self, disk: usize) {
        let count = self.cells.around(disk, &mut self.scratch.found);
        let earliest = self.earliest_collision(disk, count, Earliest::NONE);
        let partner_collisions =
            self.bodies.forecast(earliest.partner as usize).map_or(0, |partner| partner.collisions);
        self.forecast_mut(disk).expect(earliest, partner_collisions);
    }

    #[inline]
    fn earliest_collision(&mut self, disk: usize, count: usize, known: Earliest) -> Earliest {
        let period = self.cells.grid().period();
        let found = &mut self.scratch.found;
        earliest_collision(&self.bodies, period, disk, found, count, self.clock.now, known)
    }

    /// Takes `earliest` as the next collision of a disk whose next was `known` before.
    ///
    /// No branch on whether they are the same: that is known last of all, and a wrong guess would undo much.
    #[inline]
    fn expect_next(&mut self, disk: usize, earliest: Earliest, known: Earliest) {
        let nobody = earliest.partner as usize >= self.bodies.len();
        let partner = select_unpredictable(nobody, disk, earliest.partner as usize);
        let counted = self.forecast(disk).partner_collisions;
        let collisions = select_unpredictable(earliest == known, counted, self.forecast(partner).collisions);
        self.forecast_mut(disk).expect(earliest, collisions);
    }

    /// Tells the scheduler when the next event of a disk is due.
    #[inline]
    pub(super) fn schedule(&mut self, disk: usize) {
        self.scheduler.set(disk, self.forecast(disk).due());
    }

    /// Keeps the room for neighbors in step with the cells, which grow when one gets crowded: asked for wherever disks come into
    /// cells.
    #[inline]
    pub(super) fn make_room(&mut self) {
        let room = self.cells.room() + LANES;
        if self.scratch.found.len() < room {
            self.scratch.found.resize(room, 0);
        }
    }

    /// Finds when the flight of a disk in its cell ends, and how.
    #[inline]
    fn end_flight(&mut self, disk: usize) {
        let (place, grid) = (self.cells.place(disk), self.cells.grid());
        let (exit_due, exit) = cell_exit(&self.bodies, disk, &grid.region(place), self.clock.now);
        let at_wall = self.cells.is_at_wall(place);
        let forecast = self.forecast_mut(disk);
        (forecast.exit_due, forecast.exit) = (exit_due, exit);
        if at_wall {
            self.end_at_wall(disk);
        }
    }

    #[inline]
    fn look_ahead(&mut self) {
        if self.bodies.len() >= LARGE_SYSTEM {
            self.make_room();
            self.lookahead.look(&mut self.scheduler, &self.bodies, &self.cells, &mut self.scratch.found);
        }
    }

    #[inline]
    pub(super) fn forecast(&self, disk: usize) -> &Forecast {
        &self.bodies.particles[disk].forecast
    }

    #[inline]
    pub(super) fn forecast_mut(&mut self, disk: usize) -> &mut Forecast {
        &mut self.bodies.particles[disk].forecast
    }

    #[cold]
    fn scheduler_fault(&self, disk: usize, due: f64) -> RunError {
        let expected = self.bodies.forecast(disk).map(Forecast::due);
        RunError::Scheduler { disk, due, expected, time: self.time() }
    }
}
