//! Observables and observers: quantities of a state, and watchers of a run.
//!
//! An [`Observable`] is a pure function of a [`Snapshot`]. An [`Observer`] watches a run: the engine reports
//! the beginning and the end of the run and every [`Collision`] to it, and gives it a snapshot at the times
//! that it requests. An observer may stop the run. You lend an observer to a run and read its results
//! afterwards. Observers and observables compose as tuples and in a `Box`, observers also in a slice, a `Vec`
//! or an `Option`. Watching never changes a trajectory.
//!
//! An [`Accumulator`] adds up snapshots. It gets them from the [`Sampled`] that wraps it in a run, or from
//! your program. Observers such as [`Stress`], [`MeanSquaredDisplacement`] and [`Arrivals`] have their own
//! clocks, since the sampling interval is part of what they measure.
//!
//! | observable | value |
//! |---|---|
//! | [`OrderParameters`] | Ψ1 and Ψ2 of the convection rolls (paper, Eqs. (10), (11)) |
//! | [`CenterOfMass`] | position of the center of mass |
//! | [`Energies`] | translational, rotational and potential energy per disk |
//! | [`Temperatures`] | horizontal, vertical and rotational temperature |
//! | [`TemperaturesAboutFlow`] | the same about the mean velocity in each cell of a [`Grid`] |
//! | [`HexaticOrder`] | ψ6, local and global, and the coordination number |
//! | [`Velocities`] | velocities of all disks |
//! | [`OfKind`] | any of these, for the disks of one kind |
//! | [`measured_by`] | the result of a closure |
//!
//! | accumulator, observer when [`Sampled`] | keeps |
//! |---|---|
//! | [`HeightProfile`] | packing fraction by height |
//! | [`Fields`] | density, flow and temperatures on a grid |
//! | [`PairCorrelation`] | pair correlation function |
//! | [`VelocityDistribution`] | histograms and cumulants of velocities |
//! | [`EnergyChangeProfile`] | mean energy change per disk–disk collision and temperatures, by height |
//!
//! | observer | keeps |
//! |---|---|
//! | [`Series`] | the values of an observable at set times |
//! | [`EnergyChange`] | mean energy change per collision, by partner |
//! | [`CollisionCounts`] | counts by partner and regime, and rates |
//! | [`MeanSquaredDisplacement`] | mean squared displacement by time, coefficient of self-diffusion |
//! | [`TimeCorrelation`] | correlation function of an observable in time, of velocities for example |
//! | [`Stress`] | stress tensor of the disks, kinetic and collisional |
//! | [`Arrivals`] | disks that come to walls, by time: the flow into a sink |
//! | [`Crossings`] | crossings of a line by direction: the flux through it |
//! | [`WallStress`] | pressure and shear stress on walls |
//! | [`CollisionHistograms`] | histograms of obliqueness, closing speed and impulse |
//! | [`OfKind`], [`BetweenKinds`] | what another observer keeps, for one kind or for collisions of two |
//! | [`on_collision`], [`on_sample`] | whatever a closure keeps |
//! | [`stop_when`], [`stop_when_sampled`] | nothing: they stop the run when a closure says so |
//!
//! # Custom observers
//! An observer that only needs snapshots is an [`Accumulator`] in a [`Sampled`]. Other observers can use
//! [`SampleTimes`] as their clock. In a plain test, [`laws::check`] checks the contract of an observer.
//!
//! ```
//! use granular_edmd::observable::{Collision, Observer, ObserverError, SampleTimes, Snapshot, laws};
//!
//! /// Counts the collisions within each interval.
//! struct Beats {
//!     times: SampleTimes,
//!     present: u64,
//!     counts: Vec<u64>,
//! }
//!
//! impl Observer for Beats {
//!     fn on_start(&mut self, start: &Snapshot<'_>) -> Result<(), ObserverError> {
//!         self.times.start_at(start.time());
//!         Ok(())
//!     }
//!     fn on_collision(&mut self, _: &Collision) {
//!         self.present += 1;
//!     }
//!     fn next_sample(&self) -> f64 {
//!         self.times.upcoming()
//!     }
//!     fn on_sample(&mut self, snapshot: &Snapshot<'_>) {
//!         self.counts.push(std::mem::take(&mut self.present));
//!         self.times.advance_past(snapshot.time());
//!     }
//! }
//!
//! laws::check(&mut Beats { times: SampleTimes::every(0.5)?, present: 0, counts: Vec::new() })?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Tables
//! Every accumulator and every observer that measures something is a [`Table`]:
//! [`write_csv`](Table::write_csv) writes its results with names, units and errors. A [`Series`] is a table
//! if its observable is [`Tabular`]; a tuple has the columns of its parts. For a measure by kind, write the
//! table of the measure inside.
//!
//! # Errors
//! Errors do not assume that samples are independent. They come from blocks of consecutive samples or
//! collisions, by the method of [`block_average`](crate::statistics::block_average), and an
//! [`Estimate`](crate::statistics::Estimate) says how many independent samples there were. [`Fields`],
//! [`HeightProfile`] and [`CollisionCounts`] have no errors: repeat the run with other seeds, or keep a
//! [`Series`] of the number that you need.
//!
//! # Measurements in files
//! With the feature `serde`, you can write the observers of this module, except for closures, to a file
//! together with the checkpoint of the run: `Checkpoint::write_with` keeps every bit. If you read them back
//! and lend them to the resumed run, they end with the same bits as in a run without interruption. They
//! still refuse other walls at the same indices, but a file does not tell to which system it belongs. Text
//! formats may lose bits: JSON has no NaN, and its reader must round correctly (serde_json's
//! `float_roundtrip`).

mod adaptors;
mod at_walls;
mod by_wall;
mod closures;
mod collisions;
mod compose;
mod contract;
mod correlation;
mod crossings;
mod energy_change;
mod fields;
mod grid;
pub mod laws;
mod mechanics;
mod neighbors;
mod order;
mod sample_times;
mod sampled;
mod snapshot;
mod stress;
mod table;
mod velocity_distribution;

pub use adaptors::{BetweenKinds, ByCollisions, OfKind};
#[doc(alias("flow", "flux", "discharge"))]
pub use at_walls::Arrivals;
#[doc(alias("pressure", "wall force"))]
pub use at_walls::WallStress;
pub use closures::{MeasuredBy, OnCollision, OnSample, measured_by, on_collision, on_sample};
pub use closures::{StopWhen, StopWhenSampled, stop_when, stop_when_sampled};
#[doc(alias("collision rate", "collision frequency"))]
pub use collisions::CollisionCounts;
pub use collisions::CollisionHistograms;
#[doc(alias("compute", "measurement"))]
pub use contract::Observable;
#[doc(alias("callback", "hook", "fix"))]
pub use contract::Observer;
pub use contract::{Collision, ObserverError, Partner, Verdict};
#[doc(alias("MSD", "mean squared", "diffusion"))]
pub use correlation::MeanSquaredDisplacement;
pub use correlation::PerDisk;
#[doc(alias("autocorrelation", "VACF"))]
pub use correlation::{InnerProduct, TimeCorrelation, Velocities};
#[doc(alias("counter", "flux", "throughput"))]
pub use crossings::Crossings;
#[doc(alias("dissipation", "energy loss", "dE"))]
pub use energy_change::EnergyChange;
pub use energy_change::{EnergyChangeLayer, EnergyChangeProfile};
#[doc(alias("density profile", "volume fraction"))]
pub use fields::{DenseLayer, HeightProfile};
#[doc(alias("density", "velocity field", "coarse-graining"))]
pub use fields::{FieldCell, Fields};
pub use grid::Grid;
pub use mechanics::{CenterOfMass, Energies, EnergyPerDisk, TemperaturesAboutFlow};
#[doc(alias("piston"))]
pub use mechanics::{FreeWall, FreeWallMotion};
#[doc(alias("granular temperature"))]
pub use mechanics::{Temperature, Temperatures};
#[doc(alias("pair correlation", "radial distribution", "RDF", "structure"))]
pub use neighbors::PairCorrelation;
#[doc(alias("coordination number", "contacts"))]
pub use neighbors::{Neighbor, Neighbors};
#[doc(alias("convection", "psi", "Ψ1", "Ψ2"))]
pub use order::{ConvectionOrder, OrderParameters};
#[doc(alias("psi6", "bond order", "hexagonal order"))]
pub use order::{Hexatic, HexaticOrder};
pub use sample_times::SampleTimes;
pub use sampled::{Accumulator, Sampled, Series};
pub use snapshot::Snapshot;
pub(crate) use snapshot::{Mark, Moving};
#[doc(alias("pressure", "pressure tensor", "virial"))]
pub use stress::{Stress, StressTensor};
pub use table::{Heading, Named, Table, Tabular};
#[doc(alias("velocity distribution", "Sonine", "Maxwellian"))]
pub use velocity_distribution::VelocityDistribution;
