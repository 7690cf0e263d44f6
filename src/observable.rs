//! Observables and observers: what is measured, and when.
//!
//! An [`Observable`] is a pure function of a [`Snapshot`]. An [`Observer`] is told of every [`Collision`] and is shown
//! a snapshot at the times that it asks for. Both are lent to a run and read afterwards; several compose as a tuple, a
//! `Vec`, an `Option` or a `Box`. Watching never changes a trajectory.
//!
//! | observable | value |
//! |---|---|
//! | [`OrderParameters`] | Ψ1 and Ψ2 of the convection rolls (paper, Eqs. (10), (11)) |
//! | [`CenterOfMass`] | position of the centre of mass |
//! | [`Energies`] | translational, rotational and potential energy per disk |
//! | [`Temperatures`] | horizontal, vertical and rotational temperature |
//!
//! | observer | keeps |
//! |---|---|
//! | [`Series`] | the values of an observable at set times |
//! | [`EnergyChange`] | mean energy change per collision, by partner |
//! | [`EnergyChangeProfile`] | the same between disks, by height, with the temperatures there |
//! | [`CollisionCounts`] | counts by partner and regime, and rates |
//! | [`HeightProfile`] | packing fraction by height |
//! | [`Fields`] | density, flow and temperatures on a grid |
//! | [`on_collision`], [`on_sample`] | whatever your closure keeps |

mod center_of_mass;
mod collision_counts;
mod collision_event;
mod compose;
mod energies;
mod energy_change;
mod energy_change_profile;
mod fields;
mod from_fn;
mod height_bins;
mod height_profile;
mod order_parameters;
mod series;
mod snapshot;
mod statistics;
mod temperatures;

pub use center_of_mass::CenterOfMass;
pub use collision_counts::CollisionCounts;
pub use collision_event::{Collision, Partner};
pub use energies::{Energies, EnergyPerDisk};
pub use energy_change::EnergyChange;
pub use energy_change_profile::{EnergyChangeLayer, EnergyChangeProfile};
pub use fields::{FieldCell, Fields};
pub use from_fn::{OnCollision, OnSample, on_collision, on_sample};
pub use height_profile::{DenseLayer, HeightProfile};
pub use order_parameters::{ConvectionOrder, OrderParameters};
pub use series::{SampleTimes, Series};
pub use snapshot::Snapshot;
pub use statistics::RunningMean;
pub use temperatures::{Temperature, Temperatures};

/// A quantity that a snapshot determines.
pub trait Observable {
    /// What is measured.
    type Value;

    /// Its value now.
    fn measure(&self, snapshot: &Snapshot<'_>) -> Self::Value;
}

/// Someone who watches a run.
///
/// # Contract
/// A sample at time `$t$` has seen all events up to and at `$t$`. After a sample, `next_sample` must name a later
/// time; the run ends with an error otherwise.
pub trait Observer {
    fn on_start(&mut self, _: &Moment) {}
    fn on_end(&mut self, _: &Moment) {}
    fn verdict(&mut self) -> Result<std::ops::ControlFlow<()>, ObserverError> {
        Ok(std::ops::ControlFlow::Continue(()))
    }
    /// A collision has just happened.
    fn on_collision(&mut self, collision: &Collision) {
        let _ = collision;
    }

    /// When the next sample is wanted; infinite for never.
    fn next_sample(&self) -> f64 {
        f64::INFINITY
    }

    /// The sample that was asked for.
    fn on_sample(&mut self, snapshot: &Snapshot<'_>) {
        let _ = snapshot;
    }
}

pub type ObserverError = Box<dyn std::error::Error + Send + Sync>;
pub struct Moment {
    time: f64,
}
impl Moment {
    pub fn new(time: f64, _: usize, _: usize, _: crate::boundary::Domain, _: f64) -> Self {
        Self { time }
    }
    pub fn time(&self) -> f64 {
        self.time
    }
}
