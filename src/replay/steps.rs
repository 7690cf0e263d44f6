//! A run taken collision by collision, with the ids of its disks.

use crate::boundary::Boundary;
use crate::collision::CollisionRule;
use crate::observable::{Collision, Partner, on_collision};
use crate::scheduler::EventScheduler;
use crate::simulation::{Inlet, RunError, Simulation};

/// A collision that was played back.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Replayed {
    /// Number of the collision, counted from 1 on.
    pub number: u64,
    /// Id of the disk whose event it was.
    pub id: u64,
    /// Id of the other disk; `None` if the partner is a wall.
    pub partner_id: Option<u64>,
    /// The collision. Its indices are those of that time.
    pub collision: Collision,
}

/// A run taken collision by collision, each with the ids of its disks.
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
    ids: Vec<u64>,
    /// Numbers of disks that have come and gone.
    population: [u64; 2],
}

impl<R: CollisionRule, B: Boundary, S: EventScheduler> Steps<R, B, S> {
    /// Begins with this run.
    pub fn new(run: Simulation<R, B, S>) -> Self {
        let mut steps = Self { run, ids: Vec::new(), population: [u64::MAX; 2] };
        steps.name();
        steps
    }

    /// Returns the run after the last step.
    pub const fn run(&self) -> &Simulation<R, B, S> {
        &self.run
    }

    /// Names the disks, if any have come or gone.
    fn name(&mut self) {
        let counters = self.run.counters();
        let population = [counters.insertions, counters.removals];
        if std::mem::replace(&mut self.population, population) != population {
            self.ids = self.run.disks().iter().map(crate::Disk::id).collect();
        }
    }

    /// Goes to the next collision; without one up to and at the absolute time `end`, the run goes there and
    /// the result is `None`.
    ///
    /// # Errors
    /// The same as for [`Simulation::step_until`].
    pub fn next(&mut self, end: f64) -> Result<Option<Replayed>, RunError> {
        let mut last = None;
        // A disk that comes in gets its name before it collides, so each opening of an inlet is a step.
        while last.is_none() {
            let opening = self.run.inlets().iter().map(Inlet::next_opening).fold(end, f64::min);
            self.run
                .step_until(opening, &mut on_collision(|collision: &Collision| last = Some(*collision)))?;
            if last.is_none() {
                self.name();
                if opening >= end {
                    return Ok(None);
                }
            }
        }
        let replayed = last.map(|collision| {
            let id = |disk: usize| self.ids.get(disk).copied().unwrap_or(0);
            let partner_id = match collision.partner {
                Partner::Disk(partner) => Some(id(partner)),
                Partner::Wall(_) => None,
            };
            let number = self.run.counters().collisions();
            Replayed { number, id: id(collision.disk), partner_id, collision }
        });
        self.name();
        Ok(replayed)
    }
}
