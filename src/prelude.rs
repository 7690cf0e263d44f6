//! What most programs need, in one line: `use granular_edmd::prelude::*;`.

pub use crate::boundary::{Boundary, Container, Thermal, Wall};
pub use crate::collision::{
    CollisionRule, Contact, ContactDuration, Elastic, Frictional, Impulse, Rough, Smooth,
};
pub use crate::glam::DVec2;
pub use crate::initial;
pub use crate::observable::{
    CenterOfMass, Collision, CollisionCounts, Energies, EnergyChange, Observable, Observer, OrderParameters,
    Partner, SampleTimes, Series, Snapshot, Temperatures,
};
pub use crate::scheduler::EventScheduler;
pub use crate::simulation::{Event, RunError, Simulation};
pub use crate::wall::{BiParabolic, Fixed, Sawtooth, Sinusoidal, Triangular, WallMotion};
pub use crate::{Disk, ParameterError};
