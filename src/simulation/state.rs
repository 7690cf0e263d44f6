//! The state of a run: the disks on their flights, the next event of each, and the time.

mod bodies;
mod clock;
mod forecast;
mod guard;
mod identities;
mod ledger;
mod pace;
mod population;
mod properties;

#[cfg(feature = "serde")]
pub(super) use bodies::Spin;
pub(super) use bodies::{Bodies, Trajectory};
pub(super) use clock::{Clock, Tally};
pub(super) use forecast::{Earliest, Exit, Forecast};
pub(super) use guard::{Standstill, effort, least_progress};
pub(super) use identities::Identities;
pub(super) use ledger::Ledger;
pub(super) use pace::FARTHEST;
