//! The engine: it takes disks from event to event.
//!
//! [`Simulation::builder`] checks disks, gravity and boundary and makes a [`Simulation`]; [`Simulation::run_until`] and
//! [`Simulation::step`] advance it; rule, boundary and gravity can be changed between runs.
//!
//! # Promises
//! 1. The same inputs give the same bits, under every scheduler, with any observer, and however a run is cut into
//!    pieces.
//! 2. Equal times are ordered by the smaller disk index, then the smaller partner index, disks before walls.
//! 3. A sample at time `$t$` has seen all events up to and at `$t$`.
//! 4. A run that cannot progress ends with [`RunError::Stalled`], within seconds.
//! 5. A checkpoint restores everything that the future depends on, except rule and boundary, which are given again.

mod bodies;
mod builder;
mod cells;
#[cfg(feature = "serde")]
mod checkpoint;
mod engine;
mod epoch;
mod errors;
mod event;
mod grid;
mod guard;
mod lookahead;
mod next_event;
mod prediction;
mod resolution;
mod view;

pub use builder::SimulationBuilder;
#[cfg(feature = "serde")]
pub use checkpoint::{Checkpoint, CheckpointError};
pub use engine::Simulation;
pub use errors::{BuildError, RunError};
pub use event::{Counters, Event};
