//! The engine, which advances disks from event to event.
//!
//! [`Simulation::builder`] checks the disks, gravity and the boundary, and builds a [`Simulation`].
//! [`Simulation::run_until`], [`Simulation::run`] with its [`Limits`] and [`Simulation::step_until`] advance
//! it. Between runs, you can change the rule, the boundary and gravity, insert disks ([`Simulation::insert`])
//! and remove them ([`Simulation::remove`]). During a run, [sinks](crate::boundary::Part::absorbing) take
//! disks out, and [inlets](Simulation::add_inlet) let them in.
//!
//! # Promises
//! 1. The same inputs give the same bits, under every scheduler, with any observer, and however a run is cut
//!    into pieces.
//! 2. Equal times are ordered by the smaller disk index, then by the smaller partner index, with disks before
//!    walls. Inlets come after all events of disks, in the order in which they were added.
//! 3. A sample at time $`t`$ includes all events up to and including $`t`$. A run until the
//!    [time](crate::observable::Collision::time) of a collision thus includes this collision.
//! 4. A run that hardly progresses ends with [`RunError::Stalled`], within seconds. Progress is the simulated
//!    time per event, over windows of 200 000 events plus 20 events per disk. The caller sets how much
//!    progress a run needs: [`Limits::with_least_progress`].
//! 5. A checkpoint restores everything on which the future depends, except the rule and the boundary, which
//!    the caller gives again. If they have fingerprints, the checkpoint notices if the caller gives others.
//! 6. A part (a rule, boundary, scheduler or observer) that returns an impossible result ends the run with an
//!    error that names the result. No part can make the engine go back in time, or name a disk or wall that
//!    does not exist. A collision that is carried out happens at the surface of the partner, up to rounding.
//!    The sections of [`Boundary`] and [`EventScheduler`] on broken contracts say which faults go unnoticed.

mod builder;
mod cells;
mod checking;
#[cfg(feature = "serde")]
mod checkpoint;
mod driving;
mod engine;
mod epoch;
mod errors;
mod event_loop;
mod events;
mod forecasting;
mod inlet;
#[cfg(debug_assertions)]
mod lending;
mod limits;
mod lookahead;
mod population;
mod prediction;
mod resolution;
mod running;
mod stall;
mod state;
mod traffic;
mod warnings;

pub use builder::SimulationBuilder;
pub(crate) use cells::FEWEST;
#[cfg(feature = "serde")]
pub use checkpoint::{Checkpoint, CheckpointError, Resumption};
pub(crate) use driving::drift_of;
pub use driving::{Driving, Rescaling, WhiteNoise};
pub use errors::{BoundaryFault, BuildError, FailedCollision, Remedy, RunError};
pub use events::{Counters, Event, RunEnd};
pub use inlet::Inlet;
pub use limits::Limits;
pub use warnings::Warning;

use crate::boundary::{Boundary, Container, Overlap, Probe};
use crate::collision::{CollisionRule, Frictional};
use crate::observable::{Mark, Observable, Partner, Snapshot};
use crate::quantity::accept;
use crate::scheduler::{BySize, EventScheduler};
use crate::{Disk, Gravity, ParameterError};
use builder::fit;
use cells::Cells;
use engine::{Engine, Held, Parts};
use state::Clock;
use traffic::check_inlets;

/// A system of disks that advances from event to event.
///
/// Times given and returned are absolute times, in the units of the caller. Internally, times are offsets
/// from an epoch that moves on, so that late times keep their digits. [`Simulation::builder`] makes a
/// simulation; [the module](crate::simulation) lists its promises.
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
/// let rule = Frictional::from_inelasticity(0.0, 0.0, 0.05)?;
/// let mut simulation = Simulation::builder(rule, boundary).disks(disks).gravity(0.0156).build()?;
/// let mut series = Series::new(OrderParameters, SampleTimes::every(1.0)?);
/// simulation.run_until(10.0, &mut series)?;
/// assert_eq!(series.values().len(), 10);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct Simulation<R = Frictional, B = Container, S = BySize> {
    parts: Parts<R, B, S>,
    engine: Held,
}

/// A rule that is chosen when the program runs.
pub type BoxedRule = Box<dyn CollisionRule + Send + Sync>;

/// A boundary that is chosen when the program runs.
pub type BoxedBoundary = Box<dyn Boundary + Send + Sync>;

/// A scheduler that is chosen when the program runs.
pub type BoxedScheduler = Box<dyn EventScheduler + Send + Sync>;

/// A simulation whose rule, boundary and scheduler are chosen when the program runs.
///
/// ```
/// use granular_edmd::boundary::Container;
/// use granular_edmd::collision::{Elastic, Smooth};
/// use granular_edmd::scheduler::BySize;
/// use granular_edmd::simulation::{BoxedBoundary, BoxedRule, BoxedScheduler, BoxedSimulation};
/// use granular_edmd::{Simulation, initial};
///
/// fn simulation(is_lossy: bool) -> Result<BoxedSimulation, Box<dyn std::error::Error>> {
///     let container = Container::closed(20.0, 20.0)?;
///     let disks = initial::lattice(&container, 50, 0.5)?;
///     let lossy = Smooth::from_restitution(0.9)?;
///     let rule: BoxedRule = if is_lossy { Box::new(lossy) } else { Box::new(Elastic) };
///     let boundary: BoxedBoundary = Box::new(container);
///     let scheduler: BoxedScheduler = Box::new(BySize::new());
///     Ok(Simulation::builder(rule, boundary).disks(disks).scheduler(scheduler).build()?)
/// }
/// assert_eq!(simulation(true)?.len(), 50);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub type BoxedSimulation = Simulation<BoxedRule, BoxedBoundary, BoxedScheduler>;

// A simulation can be sent to another thread, and be shared by several. Without this check, a new private
// field could break that unnoticed.
const _: () = {
    const fn is_sent_and_shared<T: Send + Sync>() {}
    is_sent_and_shared::<Simulation>();
    is_sent_and_shared::<BoxedSimulation>();
    is_sent_and_shared::<SimulationBuilder<Frictional, Container>>();
    is_sent_and_shared::<RunError>();
    is_sent_and_shared::<BuildError>();
};

impl<R: CollisionRule, B: Boundary, S: EventScheduler> Simulation<R, B, S> {
    /// Returns the present absolute time.
    pub fn time(&self) -> f64 {
        self.engine.clock.time()
    }

    /// Returns the number of disks.
    pub fn len(&self) -> usize {
        self.engine.bodies.len()
    }

    /// Returns whether there are no disks.
    pub fn is_empty(&self) -> bool {
        self.engine.bodies.len() == 0
    }

    /// Returns a disk as it is now, or `None` if there is no such disk.
    pub fn disk(&self, disk: usize) -> Option<Disk> {
        (disk < self.len()).then(|| self.engine.bodies.disk(disk, self.engine.clock.now))
    }

    /// Returns the index of the disk with this [id](Disk::id), or `None` if it is not in the run.
    ///
    /// The call examines all disks.
    pub fn index_of(&self, id: u64) -> Option<usize> {
        (0..self.len()).find(|&disk| self.engine.bodies.id(disk) == id)
    }

    /// Returns all disks as they are now.
    pub fn disks(&self) -> Vec<Disk> {
        self.engine.bodies.disks(self.engine.clock.now)
    }

    /// Returns the disk or wall that another disk would overlap most deeply now, and the depth, or `None` if
    /// there is room for the other disk.
    ///
    /// The call examines all disks.
    ///
    /// ```
    /// # use granular_edmd::{Disk, Simulation, boundary::Container, collision::Elastic};
    /// # use granular_edmd::{glam::DVec2, observable::Partner};
    /// let disk = |x: f64| Disk::new(DVec2::new(x, 1.0), 0.5);
    /// let run = Simulation::builder(Elastic, Container::closed(9.0, 2.0)?).disks([disk(2.0)?]).build()?;
    /// let with = |disk: Disk| run.overlap(&disk).map(|overlap| (overlap.with, overlap.depth));
    /// assert_eq!(with(disk(2.75)?), Some((Partner::Disk(0), 0.25)));
    /// assert_eq!(with(disk(0.25)?), Some((Partner::Wall(1), 0.25)));
    /// assert_eq!(with(disk(4.0)?), None);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn overlap(&self, disk: &Disk) -> Option<Overlap<Partner>> {
        let (position, domain) = (disk.position(), self.parts.boundary.domain());
        let with_disk = |other: usize| {
            let apart = domain
                .separation(position, self.engine.bodies.position(other, self.engine.clock.now))
                .length();
            Overlap::new(Partner::Disk(other), disk.radius() + self.engine.bodies.radius(other) - apart)
        };
        let wall = self.parts.boundary.overlap(&Probe::of(disk, self.engine.clock.now));
        let wall = wall.map(|overlap| Overlap::new(Partner::Wall(overlap.with), overlap.depth));
        Overlap::deepest((0..self.len()).map(with_disk).chain(wall))
    }

    /// Returns the present value of an observable.
    pub fn measure<Q: Observable + ?Sized>(&self, observable: &Q) -> Q::Value {
        observable.measure(&self.snapshot())
    }

    /// Returns the present state, for custom observables and observers.
    pub fn snapshot(&self) -> Snapshot<'_> {
        self.snapshot_as_of(self.time())
    }

    /// Returns the present state with the requested time. [`Self::time`] may differ from that time by
    /// rounding.
    fn snapshot_as_of(&self, time: f64) -> Snapshot<'_> {
        let engine: &Engine = &self.engine;
        let Engine { bodies, clock, marks, .. } = engine;
        Snapshot::of_run(time, clock.now, bodies, &self.parts.boundary, bodies.gravity, *marks)
    }

    /// Returns the numbers of events since the simulation was built.
    pub const fn counters(&self) -> &Counters {
        &self.engine.counters
    }

    /// Returns the rule between the disks.
    pub const fn rule(&self) -> &R {
        &self.parts.rule
    }

    /// Returns the boundary.
    pub const fn boundary(&self) -> &B {
        &self.parts.boundary
    }

    /// Returns gravity.
    pub const fn gravity(&self) -> Gravity {
        self.engine.bodies.gravity
    }

    /// Replaces the rule from now on.
    ///
    /// The predictions stay valid, since a rule decides the outcome of a collision and not its time.
    pub fn set_rule(&mut self, rule: R) {
        self.parts.rule = rule;
    }

    /// Sets gravity from now on.
    ///
    /// The time origin of the walls becomes the present time, so that [`Boundary::state`] gives their present
    /// state.
    ///
    /// # Errors
    /// If gravity is not finite, if a component is above 1e60 in magnitude, or if disks would fall so fast
    /// that times as late as the present are too coarse. The simulation then stays unchanged.
    pub fn set_gravity(&mut self, gravity: impl Into<Gravity>) -> Result<(), ParameterError> {
        let gravity = gravity.into().checked()?;
        let epoch_length = self.engine.bodies.epoch_length_under(gravity);
        let is_coarse =
            Clock { epoch_length, ..self.engine.clock }.coarseness(self.engine.clock.now).is_some();
        let requirement = "so small that the run can still tell times apart";
        accept(self.is_empty() || !is_coarse, "gravity", requirement, gravity.larger())?;
        self.shift_epoch(self.engine.clock.exact_offset());
        self.engine.bodies.set_gravity(gravity, self.engine.clock.now);
        self.engine.balance_anew(&self.parts.boundary.domain());
        self.engine.clock.epoch_length = self.engine.bodies.epoch_length();
        self.predict_all();
        Ok(())
    }

    /// Replaces the walls from now on.
    ///
    /// Moving walls take the positions of their motions at the present time. A new
    /// [`Piston`](crate::wall::Piston) begins now, in its initial state; in a clone of the present boundary,
    /// it continues.
    ///
    /// # Errors
    /// If the disks or the inlets do not fit into the new walls, or there are too many walls. The simulation
    /// then stays unchanged.
    pub fn set_boundary(&mut self, mut boundary: B) -> Result<(), BuildError> {
        (self.engine.wall_count, self.engine.cells) = self.admit(&mut boundary)?;
        self.parts.boundary = boundary;
        self.predict_all();
        Ok(())
    }

    /// Returns the same simulation with another rule, which may be of another type.
    ///
    /// The run continues as after [`set_rule`](Self::set_rule).
    ///
    /// ```
    /// # use granular_edmd::{Simulation, boundary::Container, initial};
    /// use granular_edmd::collision::{Elastic, Smooth};
    /// # let container = Container::closed(20.0, 20.0)?;
    /// # let disks = initial::with_maxwellian_velocities(initial::lattice(&container, 50, 0.5)?, 1.0, 1)?;
    /// let mut gas = Simulation::builder(Elastic, container).disks(disks).build()?;
    /// gas.run_until(10.0, &mut ())?;
    /// let mut cooling = gas.with_rule(Smooth::from_restitution(0.9)?);
    /// cooling.run_until(20.0, &mut ())?;
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn with_rule<T: CollisionRule>(self, rule: T) -> Simulation<T, B, S> {
        let Parts { boundary, scheduler, .. } = self.parts;
        Simulation { parts: Parts { rule, boundary, scheduler }, engine: self.engine }
    }

    /// Returns the same simulation with another scheduler, which may be of another type.
    ///
    /// The trajectory is the same, bit for bit.
    pub fn with_scheduler<T: EventScheduler>(self, scheduler: T) -> Simulation<R, B, T> {
        let Parts { rule, boundary, .. } = self.parts;
        let mut simulation = Simulation { parts: Parts { rule, boundary, scheduler }, engine: self.engine };
        simulation.reset_scheduler();
        simulation
    }

    /// Returns the same simulation with other walls, which may be of another type.
    ///
    /// The run continues as after [`set_boundary`](Self::set_boundary).
    ///
    /// # Errors
    /// If the disks or the inlets do not fit into the new walls, or there are too many walls.
    pub fn with_boundary<T: Boundary>(mut self, mut boundary: T) -> Result<Simulation<R, T, S>, BuildError> {
        (self.engine.wall_count, self.engine.cells) = self.admit(&mut boundary)?;
        let Parts { rule, scheduler, .. } = self.parts;
        let mut simulation = Simulation { parts: Parts { rule, boundary, scheduler }, engine: self.engine };
        simulation.predict_all();
        Ok(simulation)
    }

    /// Prepares the run for other walls, and these walls for the run. Returns the number of walls, and cells
    /// for them. The motion of walls that react is given from the time origin on, so the origin moves to the
    /// present.
    fn admit(&mut self, boundary: &mut impl Boundary) -> Result<(usize, Cells), BuildError> {
        let by = if boundary.state().is_empty() { 0.0 } else { self.engine.clock.exact_offset() };
        boundary.set_time_origin(self.engine.clock.origin + by);
        check_inlets(boundary, &self.engine.inlets)?;
        let fitted = fit(boundary, &self.disks(), self.engine.clock.now - by)?;
        if by > 0.0 {
            self.shift_epoch(by);
        }
        self.engine.balance_anew(&boundary.domain());
        self.engine.marks[1] = Mark::new();
        Ok(fitted)
    }
}
