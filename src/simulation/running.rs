//! Runs: from sample to sample and from collision to collision, until a limit is reached.

use std::ops::ControlFlow;

use super::engine::Engine;
use super::errors::{Outcome, RunError};
use super::limits::{Limits, NEVER, Watch, rounded_up};
use super::state::effort;
use super::{Event, RunEnd, Simulation};
use crate::boundary::Boundary;
use crate::collision::CollisionRule;
use crate::observable::Observer;
use crate::scheduler::EventScheduler;

/// The reason why a run pauses or ends.
enum Reached {
    Collision(Event),
    /// The run has reached its target time.
    Time,
    Limit(RunEnd),
}

impl<R: CollisionRule, B: Boundary, S: EventScheduler> Simulation<R, B, S> {
    /// Runs until the absolute time `end` while `observer` watches (`&mut ()` for no observer).
    ///
    /// Returns what ended the run: its end time, or the observer.
    ///
    /// This is [`Self::run`] without any other limit.
    ///
    /// # Errors
    /// The same as for [`Self::run`].
    pub fn run_until<O: Observer + ?Sized>(
        &mut self,
        end: f64,
        observer: &mut O,
    ) -> Result<RunEnd, RunError> {
        self.run(&Limits::until(end), observer)
    }

    /// Runs up to the first of the `limits` while `observer` watches (`&mut ()` for no observer).
    ///
    /// Returns what ended the run.
    ///
    /// The run calls the observer at its start, at each collision, at the samples that the observer requests,
    /// and at its end, even if it ends with an error. If the observer stops the run, the present is the time
    /// of the collision or sample at which the observer did so. However the run ends, the next run continues
    /// from there with the same bits.
    ///
    /// # Errors
    /// If the end is not finite or is before the present, if the run hardly progresses, if a rule, boundary,
    /// scheduler or observer returns an impossible result, if times become too coarse, or if an observer
    /// fails. The simulation then keeps the state in which it noticed the error.
    pub fn run<O: Observer + ?Sized>(
        &mut self,
        limits: &Limits<'_>,
        observer: &mut O,
    ) -> Result<RunEnd, RunError> {
        #[cfg(debug_assertions)]
        return {
            // A reference to the reference, since an observer that is a trait object already has no size.
            let mut observer = observer;
            self.lend(|run| super::lending::run_erased(run, limits, &mut observer))
        };
        #[cfg(not(debug_assertions))]
        self.run_here(limits, observer)
    }

    /// Runs the event loop that is compiled for these parts and this observer.
    #[inline]
    pub(super) fn run_here<O: Observer + ?Sized>(
        &mut self,
        limits: &Limits<'_>,
        observer: &mut O,
    ) -> Result<RunEnd, RunError> {
        self.guarded(|run| run.watched_run(limits, observer)).map_err(|error| *error)
    }

    /// Performs some work on the run, unless a panic interrupted earlier work. A part that panics in the
    /// midst of an event leaves disks whose next events are not known.
    #[inline]
    fn guarded<T>(&mut self, work: impl FnOnce(&mut Self) -> Outcome<T>) -> Outcome<T> {
        if std::mem::replace(&mut self.engine.ledger.is_running, true) {
            return Err(Box::new(RunError::Torn { time: self.time() }));
        }
        let done = work(self);
        self.engine.ledger.is_running = false;
        done
    }

    fn watched_run<O: Observer + ?Sized>(
        &mut self,
        limits: &Limits<'_>,
        observer: &mut O,
    ) -> Outcome<RunEnd> {
        self.engine.check_end(limits.end())?;
        let watch = Watch::new(limits, &self.engine.counters);
        self.engine.clock.events_to_look = 1;
        let started = observer.on_start(&self.snapshot());
        let started = started.map_err(|source| Box::new(RunError::Observer { time: self.time(), source }));
        let ended = match started.and_then(|()| self.verdict_of(observer)) {
            Ok(ControlFlow::Continue(())) => self.engine.instructions.run(
                #[inline(always)]
                || self.sample_until(&watch, observer),
            ),
            stopped => stopped.map(|_| RunEnd::Observer),
        };
        let ended = ended.and_then(|end| self.check_sometimes().map(|()| end));
        observer.on_end(&self.snapshot());
        // At this point, a verdict to stop has no effect. A failure, of a last write for example, must still
        // be reported.
        let last = self.verdict_of(observer);
        ended.and_then(|end| last.map(|_| end))
    }

    /// Advances to the next collision and returns it, unless the collision is after the absolute time `end`.
    ///
    /// If no collision comes before `end`, the run advances to `end`, and the result is `None`.
    ///
    /// The observer receives the collision, and the disks that inlets insert and sinks remove. `on_start`,
    /// `on_sample` and `on_end` are not called, so the observer's clock stands still. If the observer fails,
    /// the step returns an error. A verdict to stop has no effect, since the caller decides on each step.
    ///
    /// ```
    /// # use granular_edmd::glam::DVec2;
    /// # use granular_edmd::{Disk, Simulation, boundary::Container, collision::Elastic, simulation::Event};
    /// let disk = Disk::new(DVec2::new(2.0, 1.0), 0.5)?.with_velocity(DVec2::NEG_Y)?;
    /// let mut run = Simulation::builder(Elastic, Container::open(4.0)?).disks([disk]).build()?;
    /// assert_eq!(run.step_until(10.0, &mut ())?, Some(Event::WallCollision { disk: 0, wall: 0 }));
    /// assert_eq!(run.time(), 0.5);
    /// assert_eq!(run.step_until(10.0, &mut ())?, None);
    /// assert_eq!(run.time(), 10.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// The same as for [`Self::run_until`].
    pub fn step_until<O: Observer + ?Sized>(
        &mut self,
        end: f64,
        observer: &mut O,
    ) -> Result<Option<Event>, RunError> {
        #[cfg(debug_assertions)]
        return {
            let mut observer = observer;
            self.lend(|run| super::lending::step_erased(run, end, &mut observer))
        };
        #[cfg(not(debug_assertions))]
        self.step_here(end, observer)
    }

    /// Steps with the event loop that is compiled for these parts and this observer.
    #[inline]
    pub(super) fn step_here<O: Observer + ?Sized>(
        &mut self,
        end: f64,
        observer: &mut O,
    ) -> Result<Option<Event>, RunError> {
        self.guarded(|run| run.watched_step(end, observer)).map_err(|error| *error)
    }

    fn watched_step<O: Observer + ?Sized>(&mut self, end: f64, observer: &mut O) -> Outcome<Option<Event>> {
        self.engine.check_end(end)?;
        let limits = Limits::until(end);
        let watch = Watch::new(&limits, &self.engine.counters);
        let reached = loop {
            let opening = self.engine.next_opening()?;
            let end = rounded_up(end, opening);
            match self.collide_until(end.min(opening), &watch, observer)? {
                Reached::Time if opening <= end => self.open_inlets(opening, observer)?,
                reached => break reached,
            }
        };
        // A verdict to stop has no effect: the caller of single steps can stop at any of them.
        let _: ControlFlow<()> = self.verdict_of(observer)?;
        self.check_sometimes()?;
        Ok(if let Reached::Collision(event) = reached { Some(event) } else { None })
    }

    /// Advances from sample to sample until a limit is reached.
    #[inline(always)]
    fn sample_until<O: Observer + ?Sized>(&mut self, watch: &Watch<'_>, observer: &mut O) -> Outcome<RunEnd> {
        'samples: loop {
            let sample = observer.next_sample();
            if sample.is_nan() {
                return Err(Box::new(RunError::SampleTime { next: sample, time: self.time() }));
            }
            // A sample that the latest collision made due comes before the end of the run.
            if sample > self.time()
                && let Some(end) = watch.reached(&self.engine.counters)
            {
                return Ok(end);
            }
            let opening = self.engine.next_opening()?;
            let end = rounded_up(watch.end(), sample.min(opening));
            let stop = end.min(sample.max(self.time())).min(opening);
            loop {
                match self.collide_until(stop, watch, observer)? {
                    Reached::Collision(_) => {}
                    Reached::Time => break,
                    Reached::Limit(end) => return Ok(end),
                }
                if self.verdict_of(observer)?.is_break() {
                    return Ok(RunEnd::Observer);
                }
                // An observer may count collisions and request a sample now.
                if observer.next_sample() < stop {
                    continue 'samples;
                }
            }
            // Inlets open before a sample at the same time, so that the sample sees the new disks.
            if opening <= stop {
                self.open_inlets(opening, observer)?;
                continue;
            }
            if sample > stop {
                return Ok(RunEnd::Time);
            }
            observer.on_sample(&self.snapshot_as_of(stop));
            if self.verdict_of(observer)?.is_break() {
                return Ok(RunEnd::Observer);
            }
            let next = observer.next_sample();
            if next.is_nan() || next <= sample {
                return Err(Box::new(RunError::SampleTime { next, time: self.time() }));
            }
        }
    }

    /// Carries out all events up to the next collision, the absolute time `stop`, or a limit, whichever comes
    /// first.
    #[inline(always)]
    fn collide_until<O: Observer + ?Sized>(
        &mut self,
        stop: f64,
        watch: &Watch<'_>,
        observer: &mut O,
    ) -> Outcome<Reached> {
        while let Some((disk, due)) = self.next_due(stop) {
            if self.engine.clock.is_look_due()
                && let Some(end) = self.look(watch, disk, due)?
            {
                return Ok(Reached::Limit(end));
            }
            if let Some(event) = self.advance(disk, due, observer)? {
                return Ok(Reached::Collision(event));
            }
        }
        // A run without an end stays at its last event.
        if stop < NEVER {
            self.engine.clock.advance_to(stop);
        }
        Ok(Reached::Time)
    }

    /// Checks the limits and the progress of the run before the next event. Returns the limit that the run
    /// has reached, or `None`.
    #[cold]
    #[inline(never)]
    fn look(&mut self, watch: &Watch<'_>, disk: usize, due: f64) -> Outcome<Option<RunEnd>> {
        // In all cases, the next run checks its limits before its first event.
        self.engine.clock.events_to_look = 1;
        if let Some(end) = watch.reached(&self.engine.counters) {
            return Ok(Some(end));
        }
        let (events, disks) = (effort(&self.engine.counters), self.engine.bodies.len());
        if self.engine.clock.guard.left(events, disks) == 0 {
            let least = watch.least_progress(self.engine.clock.epoch_length, disks);
            if let Some(standstill) = self.engine.clock.guard.end_window(due, events, least)
                && let Some(error) = self.stalled(&standstill, disk, due)
            {
                return Err(error.into());
            }
        }
        let left = self.engine.clock.guard.left(events, disks);
        self.engine.clock.events_to_look = left.min(watch.events_to_look(&self.engine.counters));
        Ok(None)
    }

    /// Asks the observer whether the run continues.
    #[inline]
    fn verdict_of<O: Observer + ?Sized>(&self, observer: &mut O) -> Outcome<ControlFlow<()>> {
        observer.verdict().map_err(|source| Box::new(RunError::Observer { time: self.time(), source }))
    }
}

impl Engine {
    pub(super) fn check_end(&self, end: f64) -> Outcome<()> {
        let is_ahead = end.is_finite() && end >= self.time() - self.clock.rounding();
        if is_ahead { Ok(()) } else { Err(Box::new(RunError::End { end, time: self.time() })) }
    }
}
