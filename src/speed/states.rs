//! The standard states: settled runs, with the same bits in every program.

use std::f64::consts::{PI, TAU};

use glam::DVec2;
use thiserror::Error;

use crate::boundary::{Boundary, Container, Part, Vessel, VesselError, Wall, WallError};
use crate::collision::{ContactDuration, Elastic, Frictional};
use crate::initial::{
    PlacementError, disks_from_radii, even_lattice, lattice, scattered_mix, with_maxwellian_velocities,
};
use crate::quantity::accept;
use crate::simulation::{BuildError, Limits, RunError};
use crate::wall::BiParabolic;
use crate::{Disk, ParameterError, Simulation};

/// The error of a standard state that cannot be created. Only [`gas`] has a parameter that can be wrong.
#[derive(Debug, Error)]
#[error(transparent)]
pub struct StateError(Box<dyn std::error::Error + Send + Sync>);

crate::error::from_causes! {
    StateError from ParameterError, PlacementError, VesselError, WallError, BuildError, RunError
}

/// The paper's box in a standard state.
pub type PaperBox = Simulation<ContactDuration<Frictional>>;

/// Number of disks in each standard state.
const DISKS: usize = 1000;
/// Number of oscillations after which the paper's box has forgotten its lattice.
const OSCILLATIONS: f64 = 500.0;
/// Number of collisions of each disk after which a gas has forgotten its lattice.
const COLLISIONS: u64 = 100;

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

/// Returns an elastic gas of equal disks at this area fraction, periodic on all sides. The standard fractions
/// are 0.1, 0.3 and 0.65.
///
/// # Errors
/// If the area fraction is not in `1e-4..=0.766`. A square lattice has room for no more disks, and fewer
/// would take hours to settle.
#[inline]
pub fn gas(area_fraction: f64) -> Result<Simulation<Elastic>, StateError> {
    accept((1e-4..=0.766).contains(&area_fraction), "area fraction", "in 1e-4..=0.766", area_fraction)?;
    let side = side(DISKS as f64, area_fraction);
    let container = Container::periodic(side, side)?;
    let disks = even_lattice(&container, DISKS, 0.5)?;
    settled_gas(container, disks)
}

/// Returns an elastic gas of disks of two sizes, in the ratio 1 to 10, each with about half of the disks'
/// area, at the area fraction 0.4, periodic on all sides.
///
/// # Errors
/// The errors of the builder, which do not occur for these fixed numbers.
#[inline]
pub fn mixture() -> Result<Simulation<Elastic>, StateError> {
    let large = DISKS / 101;
    let small = DISKS - large;
    let side = side(small as f64 + 100.0 * large as f64, 0.4);
    let container = Container::periodic(side, side)?;
    let radii = std::iter::repeat_n(5.0, large).chain(std::iter::repeat_n(0.5, small));
    let disks = scattered_mix(&container, disks_from_radii(radii, 1.0)?, side, 7)?;
    settled_gas(container, disks)
}

/// Returns an elastic gas in a square vessel with 36 round pegs, at the area fraction 0.4.
///
/// # Errors
/// The errors of the builder, which do not occur for these fixed numbers.
#[inline]
pub fn vessel() -> Result<Simulation<Elastic, Vessel>, StateError> {
    let side = side(DISKS as f64, 0.4);
    let mut vessel = Vessel::new(Container::closed(side, side)?);
    for peg in 0..36 {
        let place = DVec2::new(f64::from(peg % 6) + 0.5, f64::from(peg / 6) + 0.5);
        vessel.put(format!("peg {peg}"), Part::peg(side / 6.0 * place, 0.25)?)?;
    }
    let disks = even_lattice(&vessel, DISKS, 0.5)?;
    settled_gas(vessel, disks)
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

/// Returns the side of a square in which `disks` disks of diameter 1 have this area fraction.
fn side(disks: f64, area_fraction: f64) -> f64 {
    (0.25 * PI * disks / area_fraction).sqrt()
}

fn settled_gas<B: Boundary>(boundary: B, disks: Vec<Disk>) -> Result<Simulation<Elastic, B>, StateError> {
    let disks = with_maxwellian_velocities(disks, 1.0, 1)?;
    let collisions = COLLISIONS * disks.len() as u64 / 2;
    let mut run = Simulation::builder(Elastic, boundary).disks(disks).build()?;
    run.run(&Limits::collisions(collisions), &mut ())?;
    Ok(run)
}
