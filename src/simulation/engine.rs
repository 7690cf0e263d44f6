//! The event loop.

use rand_xoshiro::Xoshiro256PlusPlus;

use super::bodies::Bodies;
use super::cells::Cells;
use super::errors::RunError;
use super::event::{Counters, Earliest, Event, Exit, Slot};
use super::guard::Guard;
use super::lookahead::Lookahead;
use super::resolution::{Meeting, NotFinite, by_contact_duration, resolve_pair, resolve_wall};
use crate::Disk;
use crate::boundary::{Boundary, Container};
use crate::collision::{CollisionRule, Frictional};
use crate::scheduler::{BySize, EventScheduler};

/// A system of disks that is taken from event to event.
///
/// Times are in the units of the caller; internally they are offsets from an epoch that moves on, so that late times
/// keep their digits. See [`Simulation::builder`] for how to make one, and [the module](crate::simulation) for what it
/// promises.
///
/// ```
/// use granular_edmd::boundary::{Container, Wall};
/// use granular_edmd::collision::Frictional;
/// use granular_edmd::initial;
/// use granular_edmd::observable::{OrderParameters, SampleTimes, Series};
/// use granular_edmd::wall::BiParabolic;
/// use granular_edmd::Simulation;
///
/// let boundary = Container::closed(20.0, 50.0)?.with_motion(Wall::Floor, BiParabolic::new(0.1, 10.0)?)?;
/// let disks = initial::lattice(&boundary, 100, 0.5)?;
/// let disks = initial::with_maxwellian_velocities(disks, 1.0, 7)?;
/// let mut simulation =
///     Simulation::builder(Frictional::new(0.0, 0.05)?, boundary).disks(disks).gravity(0.0156).build()?;
/// let mut series = Series::new(OrderParameters, SampleTimes::every(1.0)?);
/// simulation.run_until(10.0, &mut series)?;
/// assert_eq!(series.values().len(), 10);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct Simulation<R = Frictional, B = Container, S = BySize> {
    pub(super) rule: R,
    pub(super) boundary: B,
    pub(super) scheduler: S,
    pub(super) bodies: Bodies,
    pub(super) cells: Cells,
    pub(super) generator: Xoshiro256PlusPlus,
    /// The epoch: absolute time of the time offset 0.
    pub(super) origin: f64,
    /// The present, as an offset from the epoch.
    pub(super) now: f64,
    pub(super) epoch_length: f64,
    pub(super) counters: Counters,
    pub(super) guard: Guard,
    /// Cell crossings and collisions until the epoch last moved.
    pub(super) tally: (u64, u64),
    pub(super) lookahead: Lookahead,
    /// Room for the neighbours of one disk.
    pub(super) found: Vec<u32>,
    /// Room for the times of all disks.
    pub(super) due: Vec<f64>,
    /// Room for the disks of one snapshot.
    pub(super) copies: Vec<Disk>,
}

impl<R: CollisionRule, B: Boundary, S: EventScheduler> Simulation<R, B, S> {
    /// A simulation that knows of no event yet.
    pub(super) fn idle(
        rule: R,
        boundary: B,
        scheduler: S,
        bodies: Bodies,
        cells: Cells,
        generator: Xoshiro256PlusPlus,
        origin: f64,
    ) -> Self {
        Self {
            rule,
            boundary,
            scheduler,
            epoch_length: bodies.epoch_length(),
            bodies,
            cells,
            generator,
            origin,
            now: 0.0,
            counters: Counters::default(),
            guard: Guard::default(),
            tally: (0, 0),
            lookahead: Lookahead::default(),
            found: Vec::new(),
            due: Vec::new(),
            copies: Vec::new(),
        }
    }

    /// The present.
    pub fn time(&self) -> f64 {
        self.origin + self.now
    }

    /// The disk whose event is next, if that is not after the offset `end`.
    #[inline]
    pub(super) fn next_due(&self, end: f64) -> Option<(usize, f64)> {
        let (disk, due) = self.scheduler.earliest();
        (due <= end && disk < self.bodies.len()).then_some((disk, due))
    }

    /// Does the next event of `disk`.
    #[inline]
    pub(super) fn advance<O: crate::observable::Observer + ?Sized>(
        &mut self,
        disk: usize,
        due: f64,
        observer: &mut O,
    ) -> Result<Event, RunError> {
        if due > self.epoch_length {
            self.now = self.move_epoch(due);
            if self.adapt_cells() {
                return Ok(Event::Repredicted { disk });
            }
        } else {
            self.now = due;
        }
        if let Some(events) = self.guard.watch(self.now, self.epoch_length, self.bodies.len()) {
            return Err(RunError::Stalled { time: self.time(), disk, events });
        }
        self.look_ahead();
        let slot = *self.slot(disk);
        if slot.collision_due <= slot.exit_due {
            let partner = slot.partner as usize;
            if self.slot(partner).collisions != slot.partner_collisions {
                self.counters.repredictions += 1;
                self.predict_partner(disk);
                return Ok(Event::Repredicted { disk });
            }
            return self.collide(disk, partner, observer);
        }
        match slot.exit {
            Exit::Wall => return self.collide_with_wall(disk, usize::from(slot.wall), observer),
            Exit::Stay => self.predict(disk),
            exit => self.cross(disk, exit),
        }
        Ok(Event::CellCrossing { disk })
    }

    #[inline]
    fn collide<O: crate::observable::Observer + ?Sized>(
        &mut self,
        disk: usize,
        partner: usize,
        observer: &mut O,
    ) -> Result<Event, RunError> {
        let meeting = self.meeting(disk);
        let (collision, overlap) =
            resolve_pair(&mut self.bodies, &self.rule, self.cells.grid().period(), meeting, partner)
                .map_err(|NotFinite| RunError::NotFinite { disk, time: meeting.time })?;
        self.counters.collisions += 1;
        self.counters.contact_duration_collisions += u64::from(by_contact_duration(&collision));
        self.counters.max_overlap = self.counters.max_overlap.max(overlap);
        self.has_collided(disk);
        self.has_collided(partner);
        observer.on_collision(&collision);
        for disk in [disk, partner] {
            self.find_next(disk);
        }
        for disk in [disk, partner] {
            self.schedule(disk);
        }
        Ok(Event::Collision { disk, partner })
    }

    fn collide_with_wall<O: crate::observable::Observer + ?Sized>(
        &mut self,
        disk: usize,
        wall: usize,
        observer: &mut O,
    ) -> Result<Event, RunError> {
        let meeting = self.meeting(disk);
        let surface = self.boundary.surface(wall, self.bodies.position(disk, self.now), self.now);
        let collision =
            resolve_wall(&mut self.bodies, &self.rule, &mut self.generator, &surface, meeting, wall)
                .map_err(|NotFinite| RunError::NotFinite { disk, time: meeting.time })?;
        self.counters.wall_collisions += 1;
        self.counters.contact_duration_collisions += u64::from(by_contact_duration(&collision));
        self.has_collided(disk);
        observer.on_collision(&collision);
        self.predict(disk);
        Ok(Event::WallCollision { disk, wall })
    }

    #[inline]
    pub(super) fn slot(&self, disk: usize) -> &Slot {
        &self.bodies.particles[disk].slot
    }

    #[inline]
    pub(super) fn slot_mut(&mut self, disk: usize) -> &mut Slot {
        &mut self.bodies.particles[disk].slot
    }

    fn meeting(&self, disk: usize) -> Meeting {
        Meeting { disk, offset: self.now, time: self.time() }
    }

    /// What all collisions of a disk have in common: predictions with it are out of date, and it may have become so fast that
    /// the epoch must end early.
    #[inline]
    fn has_collided(&mut self, disk: usize) {
        let collisions = &mut self.slot_mut(disk).collisions;
        *collisions = collisions.wrapping_add(1);
        if self.bodies.outruns(disk, self.epoch_length) {
            self.epoch_length = self.bodies.epoch_length_of(disk);
        }
    }

    /// Takes a disk to its next cell. Its trajectory does not change: only the cells ahead can hold an earlier partner.
    #[inline]
    fn cross(&mut self, disk: usize, exit: Exit) {
        self.counters.cell_crossings += 1;
        self.bodies.particles[disk].trajectory.position.x += self.cells.cross(disk, exit);
        self.make_room();
        let count = self.cells.ahead(self.cells.place(disk), exit, &mut self.found);
        // Before the search for a partner: its branches are then decided, right or wrong, while that is still under way.
        self.end_flight(disk);
        let slot = self.slot(disk);
        let known = Earliest { due: slot.collision_due, partner: slot.partner };
        let earliest = self.earliest_collision(disk, count, known);
        self.meet_next(disk, earliest, known);
        self.schedule(disk);
    }
}
