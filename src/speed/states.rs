//! Two standard states: settled runs, with the same bits in every program.

use std::f64::consts::TAU;

use thiserror::Error;

use crate::boundary::{Container, Wall, WallError};
use crate::collision::{ContactDuration, Frictional};
use crate::initial::{PlacementError, lattice, with_maxwellian_velocities};
use crate::simulation::{BuildError, RunError};
use crate::wall::BiParabolic;
use crate::{ParameterError, Simulation};

/// The error of a standard state that cannot be created, which does not occur.
#[derive(Debug, Error)]
#[error(transparent)]
pub struct StateError(Box<dyn std::error::Error + Send + Sync>);

crate::error::from_causes! {
    StateError from ParameterError, PlacementError, WallError, BuildError, RunError
}

/// The paper's box in a standard state.
pub type PaperBox = Simulation<ContactDuration<Frictional>>;

/// Number of disks.
const DISKS: usize = 1000;
/// Number of oscillations after which the paper's box has forgotten its lattice.
const OSCILLATIONS: f64 = 500.0;

/// Returns the paper's box as a gas that fills it: $`g = 1/64`$, $`q = 0`$, $`\kappa = 0.03`$.
///
/// Both inelasticities are q, both frictions κ, and the contact duration is 1e-5.
///
/// Most events are passages between cells.
///
/// # Errors
/// The errors of the builder, which do not occur for these fixed numbers.
#[inline]
pub fn dilute() -> Result<PaperBox, StateError> {
    paper_box(0.0, 0.03)
}

/// Returns the paper's box as a fluid a dozen diameters high: $`g = 1/64`$, $`q = 0.05`$,
/// $`\kappa = 0.1`$, the rest as in [`dilute`].
///
/// Most events are collisions.
///
/// # Errors
/// The errors of the builder, which do not occur for these fixed numbers.
#[inline]
pub fn dense() -> Result<PaperBox, StateError> {
    paper_box(0.05, 0.1)
}

#[inline]
fn paper_box(inelasticity: f64, friction: f64) -> Result<PaperBox, StateError> {
    let base = BiParabolic::new(0.1, 10.0)?;
    let container = Container::closed(60.0, 150.0)?.with_motion(Wall::Floor, base)?;
    let disks = with_maxwellian_velocities(lattice(&container, DISKS, 0.5)?, 1.0, 1)?;
    let rule = Frictional::from_inelasticity(inelasticity, inelasticity, friction)?;
    let rule = ContactDuration::new(rule, 1e-5)?;
    let mut run = Simulation::builder(rule, container).disks(disks).gravity(0.015_625).build()?;
    run.run_until(OSCILLATIONS * TAU / 10.0, &mut ())?;
    Ok(run)
}
