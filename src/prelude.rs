//! The names that a run of the paper's system needs, and most traits for custom parts, in one line: `use
//! granular_edmd::prelude::*;`.
//!
//! All other names are imported from their modules.

pub use crate::boundary::{Boundary, Container, Part, Region, Wall};
pub use crate::collision::{
    CollisionRule, Contact, ContactDuration, Elastic, Friction, Frictional, Impulse, LeastRebound, Smooth,
};
pub use crate::glam::DVec2;
pub use crate::initial;
pub use crate::observable::{
    CenterOfMass, Collision, Energies, Fields, Observable, Observer, ObserverError, OrderParameters,
    SampleTimes, Sampled, Series, Snapshot, Table, on_sample,
};
pub use crate::simulation::{Limits, Simulation};
pub use crate::statistics::Estimate;
pub use crate::wall::{BiParabolic, Sinusoidal, WallMotion};
pub use crate::{Disk, Gravity, Kind, ParameterError};
