//! Resumption: building a run from a checkpoint.

use super::{Checkpoint, CheckpointError, check_layouts, check_lengths, check_places};
use crate::boundary::Boundary;
use crate::collision::CollisionRule;
use crate::observable::Mark;
use crate::scheduler::{BySize, EventScheduler};
use crate::simulation::Simulation;
use crate::simulation::builder::count_walls;
use crate::simulation::cells::Cells;
use crate::simulation::engine::{Engine, Parts};
use crate::simulation::state::{Bodies, Clock};

/// A builder of a run that continues from a checkpoint; see [`Simulation::resume`].
#[derive(Debug, Clone)]
#[must_use]
pub struct Resumption<'a, R, B, S = BySize> {
    checkpoint: &'a Checkpoint,
    rule: R,
    boundary: B,
    scheduler: S,
    another_rule: bool,
    another_boundary: bool,
    seed: Option<u64>,
}

impl<R: CollisionRule, B: Boundary> Simulation<R, B, BySize> {
    /// Starts to build a run that continues from the checkpoint, with its gravity, random numbers and
    /// counters.
    ///
    /// The rule and the boundary are code, so the caller gives them again. The same rule and boundary give
    /// the same future. Others are refused, unless the caller allows them. Only two parts that both have no
    /// fingerprint (closures, for example) cannot be distinguished. [`Checkpoint`] has an example.
    pub const fn resume(checkpoint: &Checkpoint, rule: R, boundary: B) -> Resumption<'_, R, B> {
        let scheduler = BySize::new();
        Resumption {
            checkpoint,
            rule,
            boundary,
            scheduler,
            another_rule: false,
            another_boundary: false,
            seed: None,
        }
    }
}

impl<'a, R: CollisionRule, B: Boundary, S: EventScheduler> Resumption<'a, R, B, S> {
    /// Sets another scheduler.
    ///
    /// The future is the same, bit for bit.
    pub fn scheduler<T: EventScheduler>(self, scheduler: T) -> Resumption<'a, R, B, T> {
        let Self { checkpoint, rule, boundary, another_rule, another_boundary, seed, scheduler: _ } = self;
        Resumption { checkpoint, rule, boundary, scheduler, another_rule, another_boundary, seed }
    }

    /// Allows a rule that differs from the checkpoint's, as for the next value of a ramp.
    pub const fn with_another_rule(mut self) -> Self {
        self.another_rule = true;
        self
    }

    /// Allows a boundary that differs from the checkpoint's.
    ///
    /// If it differs, all events are predicted anew, and a [`Piston`](crate::wall::Piston) begins in its
    /// initial state, as after [`Simulation::set_boundary`]. The checkpoint does not hold the former walls,
    /// so no warning says how far they jumped.
    pub const fn with_another_boundary(mut self) -> Self {
        self.another_boundary = true;
        self
    }

    /// Sets another seed for the stochastic walls and the inlets from now on, for several runs from one
    /// prepared state.
    ///
    /// ```
    /// use granular_edmd::boundary::Thermal;
    /// use granular_edmd::prelude::*;
    ///
    /// let container = Container::closed(9.0, 9.0)?.with_temperature(Wall::Floor, Thermal::new(1.0)?)?;
    /// let disks = initial::lattice(&container, 20, 0.5)?;
    /// let run = Simulation::builder(Elastic, container.clone()).disks(disks).gravity(1.0).build()?;
    /// let prepared = run.checkpoint();
    /// let branch = |seed| -> Result<_, Box<dyn std::error::Error>> {
    ///     let mut run = Simulation::resume(&prepared, Elastic, container.clone()).seed(seed).build()?;
    ///     run.run_until(9.0, &mut ())?;
    ///     Ok(run.disks())
    /// };
    /// assert_ne!(branch(1)?, branch(2)?);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub const fn seed(mut self, seed: u64) -> Self {
        self.seed = Some(seed);
        self
    }

    /// Builds the run.
    ///
    /// # Errors
    /// If the checkpoint does not contain a possible state; if its rule or boundary differs from the given
    /// one, and the difference was not allowed; or if its disks do not fit into another boundary that was
    /// allowed.
    pub fn build(self) -> Result<Simulation<R, B, S>, CheckpointError> {
        let saved = &self.checkpoint.0;
        // A part with a fingerprint never equals one without. Two parts without fingerprints cannot be
        // distinguished.
        if !self.another_rule && saved.rule != self.rule.fingerprint() {
            return Err(CheckpointError::AnotherRule);
        }
        crate::simulation::traffic::check_inlets(&self.boundary, &saved.inlets)?;
        let (given, fingerprint) = (self.boundary.domain(), self.boundary.fingerprint());
        let is_same = saved.boundary == fingerprint;
        if self.another_boundary && !(is_same && fingerprint.is_some() && saved.domain == given) {
            return self.build_anew();
        }
        if !is_same {
            return Err(CheckpointError::AnotherBoundary);
        }
        if saved.domain != given {
            return Err(CheckpointError::Domain { saved: saved.domain, given });
        }
        let wall_count = count_walls(&self.boundary)?;
        check_lengths(saved, wall_count)?;
        let bodies = saved.bodies.clone();
        let diameters = (0..bodies.len()).map(|disk| 2.0 * bodies.radius(disk));
        check_layouts(saved, diameters.clone())?;
        let mut cells = Cells::empty(&self.boundary, &saved.layouts, diameters);
        check_places(saved, &cells)?;
        cells.fill(saved.places.clone());
        let mut run = self.run(bodies, cells, wall_count);
        run.engine.make_room();
        // This call gives the boundary its origin and the scheduler its times.
        run.shift_epoch(0.0);
        let state = run.parts.boundary.set_state(&saved.walls);
        state.map_err(|error| CheckpointError::Inconsistent(error.to_string()))?;
        Ok(run)
    }

    /// Builds a run with another boundary. The disks keep their states, and all data about walls are computed
    /// anew.
    fn build_anew(mut self) -> Result<Simulation<R, B, S>, CheckpointError> {
        let saved = &self.checkpoint.0;
        check_lengths(saved, usize::MAX)?;
        let bodies = saved.bodies.clone();
        // Walls that react begin at the time origin.
        let by = if self.boundary.state().is_empty() { 0.0 } else { saved.clock.exact_offset() };
        self.boundary.set_time_origin(saved.clock.origin + by);
        let (now, disks) = (saved.clock.now - by, bodies.disks(saved.clock.now));
        let (wall_count, cells) = crate::simulation::builder::fit(&self.boundary, &disks, now)?;
        let mut run = self.run(bodies, cells, wall_count);
        if by > 0.0 {
            run.shift_epoch(by);
        }
        run.engine.balance_anew(&run.parts.boundary.domain());
        run.predict_all();
        Ok(run)
    }

    fn run(self, bodies: Bodies, cells: Cells, wall_count: usize) -> Simulation<R, B, S> {
        let saved = &self.checkpoint.0;
        let clock = Clock { events_to_look: 1, ..saved.clock };
        let seed = self.seed.unwrap_or(saved.seed);
        let engine = Engine::new(wall_count, bodies, cells, clock, seed, saved.ledger);
        let mut inlets = saved.inlets.clone();
        for inlet in &mut inlets {
            inlet.seed = self.seed.unwrap_or(inlet.seed);
        }
        Simulation {
            parts: Parts { rule: self.rule, boundary: self.boundary, scheduler: self.scheduler },
            engine: Engine {
                counters: saved.counters,
                inlets,
                // The observers that are read with a checkpoint have lost the mark of the saved run.
                marks: [Mark::default(), Mark::new()],
                ..engine
            }
            .into(),
        }
    }
}
