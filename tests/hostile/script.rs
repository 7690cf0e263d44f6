//! Random operations on a run, with all invariants checked after each event, and the trace that the run
//! leaves.

use granular_edmd::observable::Collision;
use granular_edmd::simulation::{BuildError, Event, RunEnd, RunError};
use granular_edmd::{Disk, Gravity};
use proptest::prelude::*;

use crate::invariants::{Change, check_state, farthest};
use crate::laws::{Law, law};
use crate::log::{KEPT, Log};
use crate::systems::{Run, System, gravity};
use crate::walls::{Walls, walls};
use support::schedulers::SCHEDULERS;

/// Number of collisions after which a run ends.
const ENOUGH: usize = 10_000;

/// Number of collisions of a case after which it ends in the middle of a run. A disk at rest bounces up to
/// 1e15 times in the time of one run. The number is twice what the guard lets pass without progress, so that
/// the guard ends what it should.
const BUDGET: usize = 400_000;

/// Longest time of a step.
const STEP: f64 = 0.5;

/// Depth by which one bounce may put a disk into a wall. It is the rounding of its height, which adds up for
/// a disk at rest.
const SINKING: f64 = 16.0 * f64::EPSILON;

#[derive(Debug, Clone)]
pub(crate) enum Operation {
    Steps(usize),
    /// A run of at most this time, with this many samples: after half of the time, after half of that, and so
    /// on.
    Run(f64, u32),
    Rule(Law),
    Gravity(Gravity),
    /// Other walls. The disks may not fit into them.
    Walls(Box<Walls>),
    /// The present walls, set again.
    SameWalls,
    /// A checkpoint, from which the run goes on if the interpreter says so.
    Checkpoint,
}

pub(crate) fn script() -> impl Strategy<Value = Vec<Operation>> {
    let operation = prop_oneof![
        8 => (1..40usize).prop_map(Operation::Steps),
        2 => (0.0..0.5f64, 30..40u32).prop_map(|(duration, samples)| Operation::Run(duration, samples)),
        1 => law().prop_map(Operation::Rule),
        1 => gravity().prop_map(Operation::Gravity),
        1 => walls().prop_map(|walls| Operation::Walls(Box::new(walls))),
        1 => Just(Operation::SameWalls),
        2 => Just(Operation::Checkpoint),
    ];
    prop::collection::vec(operation, 1..12)
}

/// A moment of a run, to the last bit.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Frame {
    time: u64,
    event: Option<Event>,
    collisions: usize,
    disks: Vec<[u64; 6]>,
}

fn bits(disk: &Disk) -> [u64; 6] {
    let (position, velocity) = (disk.position(), disk.velocity());
    [position.x, position.y, velocity.x, velocity.y, disk.angle(), disk.angular_velocity()].map(f64::to_bits)
}

/// The reason why a case ended before its script.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum End {
    /// Events piled up.
    Stalled(String),
    /// Absolute times became too coarse for a disk that a hot wall had made fast.
    TooLate(String),
    /// The case had as many collisions as it may.
    Spent,
    /// An end that may not happen.
    Other(String),
}

impl From<RunError> for End {
    fn from(error: RunError) -> Self {
        match error {
            RunError::Stalled { .. } => Self::Stalled(error.to_string()),
            RunError::TimeTooLate { .. } => Self::TooLate(error.to_string()),
            _ => Self::Other(error.to_string()),
        }
    }
}

/// A run under a script.
pub(crate) struct Actor {
    run: Run,
    walls: Walls,
    law: Law,
    /// True if a checkpoint is also resumed, each time under the next scheduler.
    resumes: bool,
    resumed: usize,
    /// Collisions that the case may still have.
    budget: usize,
    /// Largest distance of a disk from the origin so far.
    farthest: f64,
    pub(crate) trace: Vec<Frame>,
    pub(crate) end: Option<End>,
}

impl Actor {
    /// A run of `system` under the scheduler of this index.
    pub(crate) fn new(system: &System, scheduler: usize, resumes: bool) -> Self {
        let run = system.run(SCHEDULERS[scheduler]());
        let (walls, law) = (system.walls.clone(), system.law);
        Self {
            run,
            walls,
            law,
            resumes,
            resumed: scheduler,
            budget: BUDGET,
            farthest: 0.0,
            trace: Vec::new(),
            end: None,
        }
    }

    /// Does all operations, up to an error of the run or the end of its budget.
    pub(crate) fn perform(mut self, script: &[Operation]) -> Result<Self, TestCaseError> {
        self.check_state()?;
        for operation in script {
            if self.end.is_some() {
                break;
            }
            self.operate(operation)?;
            self.film(None, 0);
        }
        Ok(self)
    }

    fn operate(&mut self, operation: &Operation) -> Result<(), TestCaseError> {
        match operation {
            Operation::Steps(count) => self.steps(*count),
            Operation::Run(duration, samples) => self.run(*duration, *samples),
            Operation::Rule(law) => {
                self.law = *law;
                self.run.set_rule(law.rule());
                Ok(())
            }
            Operation::Gravity(gravity) => {
                self.run.set_gravity(*gravity).unwrap();
                Ok(())
            }
            Operation::Walls(walls) => self.rebuild(walls),
            Operation::SameWalls => self.keep_walls(),
            Operation::Checkpoint => self.save(),
        }
    }

    fn film(&mut self, event: Option<Event>, collisions: usize) {
        let disks = self.run.disks().iter().map(bits).collect();
        self.trace.push(Frame { time: self.run.time().to_bits(), event, collisions, disks });
    }

    fn steps(&mut self, count: usize) -> Result<(), TestCaseError> {
        for _ in 0..count {
            let (time, before) = (self.run.time(), self.run.disks());
            let mut log = Log::new(f64::INFINITY, KEPT);
            let event = match self.run.step_until(time + STEP, &mut log) {
                Ok(event) => event,
                Err(error) => return self.fail(error.into()),
            };
            prop_assert!(self.run.time() >= time, "time goes back from {time} to {}", self.run.time());
            self.check(event, &before, self.run.time() - time, &log.collisions)?;
            self.film(event, log.collisions.len());
        }
        Ok(())
    }

    fn check(
        &mut self,
        event: Option<Event>,
        before: &[Disk],
        elapsed: f64,
        collisions: &[Collision],
    ) -> Result<(), TestCaseError> {
        let Self { run, walls, law, .. } = self;
        let change = Change { run, walls, law: *law, before, after: &run.disks(), elapsed };
        let (collides, involved) = match event {
            Some(Event::Collision { disk, partner }) => (true, [disk, partner]),
            Some(Event::WallCollision { disk, .. }) => (true, [disk, disk]),
            _ => (false, [usize::MAX; 2]),
        };
        prop_assert_eq!(collisions.len(), usize::from(collides), "{:?}", event);
        (0..before.len()).filter(|disk| !involved.contains(disk)).try_for_each(|d| change.check_flight(d))?;
        collisions.iter().try_for_each(|collision| change.check_collision(collision))?;
        self.check_state()
    }

    fn check_state(&mut self) -> Result<(), TestCaseError> {
        self.farthest = self.farthest.max(farthest(&self.run));
        check_state(&self.run, self.farthest)
    }

    /// Runs twice as long each time, as long as that is not too much: disks at rest bounce as often as
    /// rounding lets them.
    fn run(&mut self, duration: f64, samples: u32) -> Result<(), TestCaseError> {
        if !self.clock_ticks()? || self.end.is_some() {
            return Ok(());
        }
        let start = self.run.time();
        for halves in (0..samples).rev() {
            let time = start + duration * 0.5f64.powi(halves.cast_signed());
            let mut log = Log::new(time, self.budget);
            if let Err(end) = self.run_until(time, &mut log) {
                return self.fail(end);
            }
            self.budget -= log.count;
            prop_assert_eq!(&log.taken, &[time]);
            self.check_state()?;
            self.film(None, log.count);
            if log.count > ENOUGH {
                break;
            }
        }
        Ok(())
    }

    /// Runs until a time, or until the log stops the run.
    fn run_until(&mut self, time: f64, log: &mut Log) -> Result<(), End> {
        match self.run.run_until(time, log)? {
            RunEnd::Observer => Err(End::Spent),
            _ => Ok(()),
        }
    }

    /// Returns whether some steps go on to another time. A late clock is too coarse for a time at which to
    /// stop.
    fn clock_ticks(&mut self) -> Result<bool, TestCaseError> {
        let start = self.run.time();
        if start.abs() > 1e9 {
            self.steps(200)?;
        }
        Ok(self.run.time() != start || start.abs() <= 1e9)
    }

    /// Checks the end of a run. Events may pile up where a rule is lossy; nothing else may end a run.
    fn fail(&mut self, end: End) -> Result<(), TestCaseError> {
        prop_assert!(!matches!(end, End::Other(_)), "{end:?}");
        self.film(None, 0);
        self.end = Some(end);
        self.check_state()
    }

    fn rebuild(&mut self, walls: &Walls) -> Result<(), TestCaseError> {
        let before: Vec<_> = self.run.disks().iter().map(bits).collect();
        match self.run.set_boundary(walls.container()) {
            Ok(()) => self.walls = walls.clone(),
            Err(
                BuildError::Outside { .. } | BuildError::OverlapsWall { .. } | BuildError::Overlap { .. },
            ) => {
                prop_assert_eq!(before, self.run.disks().iter().map(bits).collect::<Vec<_>>());
            }
            Err(error) => prop_assert!(false, "{error}"),
        }
        self.check_state()
    }

    /// Checks that disks inside walls fit into them, except at times so late that the place of a wall is
    /// unknown.
    fn keep_walls(&mut self) -> Result<(), TestCaseError> {
        let bounces = self.run.counters().wall_collisions as f64;
        match self.run.set_boundary(self.walls.container()) {
            Ok(()) => Ok(()),
            Err(_) if self.run.time().abs() > 1e6 => Ok(()),
            Err(BuildError::OverlapsWall { depth, .. }) if depth <= SINKING * bounces => self.check_state(),
            Err(error) => {
                let (time, counters) = (self.run.time(), self.run.counters());
                Err(TestCaseError::fail(format!("{error}, at {time}, {counters:?}")))
            }
        }
    }

    #[cfg(feature = "serde")]
    fn save(&mut self) -> Result<(), TestCaseError> {
        use granular_edmd::Simulation;
        use granular_edmd::simulation::Checkpoint;
        let checkpoint = Checkpoint::from_bytes(&self.run.checkpoint().to_bytes().unwrap()).unwrap();
        prop_assert_eq!(&checkpoint, &self.run.checkpoint());
        if self.resumes {
            self.resumed = (self.resumed + 1) % SCHEDULERS.len();
            let (rule, walls) = (self.law.rule(), self.walls.container());
            let resumption =
                Simulation::resume(&checkpoint, rule, walls).scheduler(SCHEDULERS[self.resumed]());
            self.run = resumption.build().map_err(|error| TestCaseError::fail(error.to_string()))?;
        }
        Ok(())
    }

    #[cfg(not(feature = "serde"))]
    #[allow(clippy::unnecessary_wraps, reason = "as the other one")]
    fn save(&mut self) -> Result<(), TestCaseError> {
        let _ = (self.resumes, self.resumed);
        Ok(())
    }
}
