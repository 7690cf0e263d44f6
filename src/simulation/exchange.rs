//! Exchange of the rule, boundary or scheduler for another one, which may have another type.

use super::builder::fit;
use super::cells::Cells;
use super::engine::Parts;
use super::traffic::check_inlets;
use super::{BuildError, Simulation};
use crate::boundary::Boundary;
use crate::collision::CollisionRule;
use crate::observable::Mark;
use crate::scheduler::EventScheduler;

impl<R: CollisionRule, B: Boundary, S: EventScheduler> Simulation<R, B, S> {
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
    pub(super) fn admit(&mut self, boundary: &mut impl Boundary) -> Result<(usize, Cells), BuildError> {
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
