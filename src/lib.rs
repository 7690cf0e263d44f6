//! Event-driven molecular dynamics of shaken granular matter: exact collisions, no time step, no soft
//! springs.
//!
//! The disks are inelastic, rotate and have friction (normal and tangential restitution, static and dynamic
//! friction). They move under gravity in a box whose base vibrates or is a thermal wall. The engine computes
//! one collision after the other. The system was studied by D. Risso, R. Soto, S. Godoy and P. Cordero,
//! *Friction and convection in a vertically vibrated granular system*, Phys. Rev. E **72**, 011305 (2005),
//! called “the paper” throughout. Rules, walls, boundaries, schedulers and observables are traits, so a study
//! can go beyond the paper.
//!
//! ```
//! use granular_edmd::prelude::*;
//! use granular_edmd::observable::EnergyChange;
//!
//! // A box smaller than the paper's: width 20, height 50,
//! // over a base of amplitude 0.1 and angular frequency 10.
//! let base = BiParabolic::new(0.1, 10.0)?;
//! let oscillation = std::f64::consts::TAU / base.angular_frequency();
//! let container = Container::closed(20.0, 50.0)?.with_motion(Wall::Floor, base)?;
//!
//! // 100 disks of diameter 1 that start on a lattice,
//! // with inelasticity 0.01 and friction 0.1.
//! let disks = initial::lattice(&container, 100, 0.5)?;
//! let disks = initial::with_maxwellian_velocities(disks, 0.5, 42)?;
//! let rule = ContactDuration::new(Frictional::from_inelasticity(0.01, 0.01, 0.1)?, 1e-4)?;
//! let mut simulation = Simulation::builder(rule, container)
//!     .disks(disks)
//!     .gravity(0.015_625)
//!     .build()?;
//!
//! // Watch the convection rolls, the height and the energy loss for 100 oscillations.
//! // The sampling interval is not a whole number of oscillations, so that the samples cover all phases.
//! let times = SampleTimes::every(9.9 * oscillation)?;
//! let mut series = Series::new((OrderParameters, CenterOfMass), times);
//! let mut energy = EnergyChange::default();
//! simulation.run_until(100.0 * oscillation, &mut (&mut series, &mut energy))?;
//!
//! assert_eq!(series.values().len(), 10);
//! assert!(energy.disks().mean() < 0.0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The [`guide`] leads from a question to a figure, with a chapter for each step.
//!
//! A study is many runs over the values of parameters, on all cores and in many processes. The package
//! [`granular-edmd-study`](https://docs.rs/granular-edmd-study) plans, runs and tabulates them, and so does
//! its command `granular-edmd`. The package [`granular-edmd-files`](https://docs.rs/granular-edmd-files)
//! writes trajectories for other programs, and reads disks from their files.
//!
//! # Map
//! | module | contents |
//! |---|---|
//! | [`kinetic`] | ⟨dE⟩ by closed form and Monte Carlo, effective inelasticity; needs no simulation |
//! | [`speed`] | reports of runs, standard states, comparisons of parts |
//! | [`initial`] | initial states: lattices, random positions, dense packings, radii |
//! | [`replay`] | runs played back: any collision, and where two runs differ |
//! | [`simulation`] | the engine: builder, event loop, checkpoints |
//! | [`observable`] | measures, and the times at which they are taken |
//! | [`scheduler`] | the order of events |
//! | [`boundary`], [`wall`] | the walls around the disks, and their motion |
//! | [`collision`] | the outcome of a collision |
//! | [`Disk`] | one grain |
//! | [`file`](mod@file) | files that are complete or absent, and locks, also for other packages |
//! | [`random`] | the streams of random numbers that follow from a seed |
//! | [`statistics`] | means, and errors of correlated samples |
//!
//! # Features
//! | feature | additions |
//! |---|---|
//! | `serde` | parameters and checkpoints can be written and read; reading repeats all checks |
//! | `rayon` | Monte Carlo on all cores, with the same bits as on one |
//! | `proptest` | random contacts and disks for property tests of custom rules: `strategies` |

#![cfg_attr(docsrs, feature(doc_cfg))]

// The x87 floating-point unit of old x86 processors computes with more digits than a double has, so the same
// inputs would give other bits there.
#[cfg(all(target_arch = "x86", not(target_feature = "sse2")))]
compile_error!("granular-edmd needs SSE2 on x86: build for i686, or with `-C target-feature=+sse2`");

pub mod boundary;
pub mod collision;
mod disk;
mod error;
pub mod file;
mod fingerprint;
mod flight;
mod forward;
mod gate;
pub mod guide;
pub mod initial;
mod instructions;
pub mod kinetic;
pub mod observable;
pub mod prelude;
pub mod quantity;
pub mod random;
pub mod replay;
pub mod roots;
pub mod scheduler;
pub mod simulation;
pub mod speed;
pub mod statistics;
#[cfg(feature = "proptest")]
pub mod strategies;
pub mod wall;

/// Version number of the results.
///
/// Versions of the crate with the same number give the same bits for the same inputs. A version that changes
/// a trajectory, a seed or a measured value has a larger number, and a line under “Results” in its changelog.
/// Only versions with the same number can continue a study.
pub const RESULTS: u32 = 2;

pub use disk::Disk;
pub use disk::Kind;
pub use error::ParameterError;
pub use error::Violation;
pub use fingerprint::Fingerprint;
pub use flight::Flight;
pub use flight::Gravity;
pub use glam;
pub use simulation::Simulation;
