//! In builds with debug assertions, one event loop for all parts.
//!
//! The event loop is generic, so that a release build compiles it for the rule, the boundary, the scheduler
//! and the observer of each run. Tests have hundreds of such combinations, and compiling the loop for each
//! takes far longer than the tests. In builds with debug assertions, a simulation therefore runs as another
//! one, whose parts are trait objects, and whose loop is compiled once, in this crate:
//!
//! ```text
//! Simulation<R, B, S>::run            generic, compiled where it is called
//!   lend                              refers to the parts as trait objects, and moves the engine over
//!     run_erased                      not generic, compiled here
//!       Simulation<&dyn ..>::run_here the event loop
//!   the loan ends                     moves the engine back
//! ```
//!
//! The arithmetic is the same, so the bits are, too. A simulation owns its engine, so that release builds
//! reach it without a pointer. It cannot be borrowed for a run, therefore, and moves, while a spare one takes
//! its place; in these builds it is in a box (`engine::Held`), so that only a pointer moves.

use std::cell::Cell;
use std::mem::replace;

use super::engine::{Engine, Held, Parts};
use super::errors::RunError;
use super::limits::Limits;
use super::{Event, RunEnd, Simulation};
use crate::boundary::Boundary;
use crate::collision::CollisionRule;
use crate::observable::Observer;
use crate::scheduler::EventScheduler;

/// A simulation whose parts are trait objects of another simulation.
pub(super) type Erased<'a> =
    Simulation<&'a dyn CollisionRule, &'a mut dyn Boundary, &'a mut dyn EventScheduler>;

thread_local! {
    /// An engine without disks, which stands in for the next one that is lent. It is kept, so that no run
    /// allocates one.
    static SPARE: Cell<Option<Held>> = const { Cell::new(None) };
}

/// A run that has the engine of another simulation, and returns it at the end, even if a part panics.
struct Loan<'a> {
    run: Option<Erased<'a>>,
    /// The owner's place for the engine, which holds the spare one until the engine returns.
    owner: &'a mut Held,
}

impl Drop for Loan<'_> {
    fn drop(&mut self) {
        if let Some(run) = self.run.take() {
            SPARE.set(Some(replace(self.owner, run.engine)));
        }
    }
}

impl<R: CollisionRule, B: Boundary, S: EventScheduler> Simulation<R, B, S> {
    /// Performs some work on this simulation, with its parts as trait objects.
    pub(super) fn lend<T>(&mut self, work: impl FnOnce(&mut Erased<'_>) -> T) -> T {
        let Parts { rule, boundary, scheduler } = &mut self.parts;
        let parts = Parts { rule: &*rule as _, boundary: boundary as _, scheduler: scheduler as _ };
        let spare = SPARE.take().unwrap_or_else(|| Engine::empty().into());
        let engine = replace(&mut self.engine, spare);
        let mut loan = Loan { run: None, owner: &mut self.engine };
        work(loan.run.insert(Simulation { parts, engine }))
    }
}

// The functions below are not generic and never inlined, so each is compiled only here.

#[inline(never)]
pub(super) fn run_erased(
    run: &mut Erased<'_>,
    limits: &Limits<'_>,
    observer: &mut dyn Observer,
) -> Result<RunEnd, RunError> {
    run.run_here(limits, observer)
}

#[inline(never)]
pub(super) fn step_erased(
    run: &mut Erased<'_>,
    end: f64,
    observer: &mut dyn Observer,
) -> Result<Option<Event>, RunError> {
    run.step_here(end, observer)
}

#[inline(never)]
pub(super) fn predict_all_erased(run: &mut Erased<'_>) {
    run.predict_all_here();
}
