//! The names that most programs need, in one line: `use granular_edmd::prelude::*;`.
//!
//! The prelude has everything that a run needs, and all types for a rule, a wall motion, a boundary, a
//! scheduler, an observable or a custom observer.

pub use crate::boundary::{
    Boundary, Brick, Container, Domain, FirstTouch, Obstacles, Part, Region, Response, Surface, Thermal,
    Touch, Vessel, Wall,
};
pub use crate::collision::{
    CollisionRule, Contact, ContactDuration, Elastic, ElasticBelow, Friction, Frictional, Impulse,
    LeastRebound, Regime, Rough, RulesByKind, Smooth, SpeedDependent,
};
pub use crate::glam::DVec2;
pub use crate::initial::{self, Radii};
pub use crate::observable::{
    Arrivals, BetweenKinds, CenterOfMass, Collision, CollisionCounts, Energies, EnergyChange, Fields, Grid,
    Observable, Observer, OfKind, OrderParameters, Partner, SampleTimes, Sampled, Series, Snapshot, Table,
    Tabular, Temperatures, Verdict, on_collision, on_sample, stop_when, stop_when_sampled,
};
pub use crate::scheduler::EventScheduler;
pub use crate::simulation::{
    BoxedBoundary, BoxedRule, BoxedScheduler, BoxedSimulation, Event, Inlet, Limits, RunEnd, RunError,
    Simulation,
};
pub use crate::statistics::Estimate;
pub use crate::trajectory::{ExtendedXyz, LammpsDump, Recorder};
pub use crate::wall::{
    AccelerationBounds, BiParabolic, Fixed, Sawtooth, Sinusoidal, Triangular, WallMotion, WallState,
};
pub use crate::{Disk, Fingerprint, Flight, Gravity, Kind, ParameterError};
