//! The state of a run: the disks on their flights, the next event of each, and the time.

mod bodies;
mod clock;
mod forecast;
mod guard;
mod population;
mod properties;

#[cfg(feature = "serde")]
pub(super) use bodies::Spin;
pub(super) use bodies::{Bodies, Trajectory};
pub(super) use clock::{Clock, Ledger, Tally};
pub(super) use forecast::{Earliest, Exit, Forecast};
pub(super) use guard::{FARTHEST, Standstill, effort, least_progress};
pub(super) use properties::Identities;
