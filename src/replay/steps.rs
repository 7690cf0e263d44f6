//! A run that advances collision by collision, with the ids of its disks.

use crate::boundary::Boundary;
use crate::collision::CollisionRule;
use crate::observable::{Collision, Partner, on_collision};
use crate::scheduler::EventScheduler;
use crate::simulation::{RunError, Simulation};

/// A collision that was played back.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Replayed {
    /// Number of the collision, counted from 1.
    pub number: u64,
    /// Id of the disk whose event it was.
    pub id: u64,
    /// Id of the other disk; `None` if the partner is a wall.
    pub partner_id: Option<u64>,
    /// The collision. Its indices are the indices at that time.
    pub collision: Collision,
}

/// A run that advances by one collision at a time, and identifies the disks of each collision by their ids.
///
/// ```
/// use granular_edmd::prelude::*;
/// use granular_edmd::replay::Steps;
///
/// let container = Container::closed(12.0, 12.0)?;
/// let disks = initial::with_maxwellian_velocities(initial::lattice(&container, 40, 0.5)?, 1.0, 1)?;
/// let mut steps = Steps::new(Simulation::builder(Elastic, container).disks(disks).build()?);
/// let first = steps.next(5.0)?.ok_or("no collision until 5")?;
/// assert_eq!((first.number, first.collision.time), (1, steps.run().time()));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Steps<R, B, S> {
    run: Simulation<R, B, S>,
}

impl<R: CollisionRule, B: Boundary, S: EventScheduler> Steps<R, B, S> {
    /// Creates the steps of this run.
    pub const fn new(run: Simulation<R, B, S>) -> Self {
        Self { run }
    }

    /// Returns the run after the last step.
    pub const fn run(&self) -> &Simulation<R, B, S> {
        &self.run
    }

    /// Advances to the next collision, or to the absolute time `end` if no collision happens up to and
    /// including that time; the result is then `None`.
    ///
    /// # Errors
    /// The same as for [`Simulation::step_until`].
    pub fn next(&mut self, end: f64) -> Result<Option<Replayed>, RunError> {
        let mut last = None;
        self.run.step_until(end, &mut on_collision(|collision: &Collision| last = Some(*collision)))?;
        Ok(last.map(|collision| {
            let [id, partner] = collision.ids;
            let partner_id = matches!(collision.partner, Partner::Disk(_)).then_some(partner);
            Replayed { number: self.run.counters().collisions(), id, partner_id, collision }
        }))
    }
}
