//! Analysis: states, transitions and Table I from measured series.
//!
//! | question | answer | source |
//! |---|---|---|
//! | which convective states a run shows | [`StateCriteria::classify`] | paper, section III |
//! | where a ramp changes state, and its hysteresis | [`transitions`] | paper, Fig. 5 |
//!
//! Errors of means over correlated series come from [`statistics`](granular_edmd::statistics).
//!
//! Everything is deterministic: the same numbers and seeds give the same bits.
//!
//! ```
//! use granular_edmd_study::analysis::{ConvectiveState, StateCriteria, thermal_noise};
//! use granular_edmd::observable::ConvectionOrder;
//!
//! // A roll that turns clockwise for most of the time, and the other way for a while.
//! let order = |one_roll| ConvectionOrder::new(one_roll, 0.04);
//! let samples = [[0.12; 3].as_slice(), &[-0.12; 2], &[0.12; 3]].concat().into_iter().map(order);
//! let noise = thermal_noise(0.3, 1.0, 1000)?;
//! let found = StateCriteria::default().classify(&samples.collect::<Vec<_>>(), noise, None)?;
//! assert_eq!(found.state(), ConvectiveState::ClockwiseRoll);
//! assert_eq!(found.weight(ConvectiveState::CounterclockwiseRoll), 0.25);
//! # Ok::<(), granular_edmd::ParameterError>(())
//! ```

mod clusters;
mod states;

pub use clusters::{Cluster, Clusters};
pub use states::{
    Classification, ConvectiveRegime, ConvectiveState, StateCriteria, Transition, TransitionLine,
    thermal_noise, transitions,
};
