//! Mean energy loss per collision, the quantity that governs the states of the driven system.
//!
//! A gas of disks with Maxwellian velocities and spins ([`Maxwellian`]) collides under a rule. The mean
//! change of kinetic energy per collision is $`\langle dE\rangle`$, negative when energy is lost. It is
//! computed in two ways, which test each other: [`mean_energy_change`] in closed form for the paper's rule,
//! and [`MonteCarlo`] for any [`CollisionRule`](crate::collision::CollisionRule). Neither needs a simulation.
//!
//! | question | answer | source |
//! |---|---|---|
//! | $`\langle dE\rangle`$ of the paper's rule | [`mean_energy_change`] | paper, Fig. 1 |
//! | cooling, temperatures and cumulants of a gas without correlations | [`DirectSimulation`] | Bird 1994 |
//! | the share of collisions that stick, under the paper's rule | [`sticking_fraction`] | paper, section II |
//! | $`\langle dE\rangle`$ of any rule | [`MonteCarlo`] | paper, section II |
//! | friction with the largest loss | [`friction_of_largest_loss`] | paper, $`\kappa\approx0.3`$ |
//! | one coefficient for inelasticity and friction | [`effective_inelasticity`] | paper, Eq. (9) |
//! | its inverse: loss without friction | [`frictionless_energy_change`] | paper, Eq. (8) |
//! | lines of equal loss in the plane of $`\kappa`$ and $`q`$ | [`IsoLine`] | paper, Fig. 1 |
//!
//! ```
//! use granular_edmd::collision::Frictional;
//! use granular_edmd::kinetic::{Maxwellian, MonteCarlo, effective_inelasticity, mean_energy_change};
//!
//! let (rule, gas) = (Frictional::from_inelasticity(0.1, 0.1, 0.3)?, Maxwellian::new(1.0)?);
//! let exact = mean_energy_change(&rule, &gas);
//! assert!((exact + 0.71851).abs() < 1e-5);
//!
//! let estimate = MonteCarlo::new(7).with_samples(100_000).mean_energy_change(&rule, &gas);
//! assert!((estimate.mean() - exact).abs() < 5.0 * estimate.standard_error());
//!
//! // The same loss, if it came from the normal restitution alone:
//! assert!((effective_inelasticity(exact, 1.0)? - 0.23472).abs() < 1e-5);
//! # Ok::<(), granular_edmd::ParameterError>(())
//! ```

mod iso_line;
mod maxwellian;
mod sampling;

pub use iso_line::{IsoLine, Piece, friction_of_largest_loss};
pub use maxwellian::Maxwellian;
pub use maxwellian::{effective_inelasticity, frictionless_energy_change};
pub use maxwellian::{mean_energy_change, sticking_fraction};
pub use sampling::{DirectSimulation, MonteCarlo};
