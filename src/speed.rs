//! The speed of runs, and the cost of their parts.
//!
//! A [`Meter`] is started before a run and makes a [`RunReport`] after it. [`dilute`], [`dense`], [`gas`],
//! [`mixture`] and [`vessel`] are standard states, in which a part of your own is measured beside the
//! built-in one: [`Simulation::with_rule`](crate::Simulation::with_rule),
//! [`with_boundary`](crate::Simulation::with_boundary) and
//! [`with_scheduler`](crate::Simulation::with_scheduler) put it in, and a [`Comparison`] tells a difference
//! from noise. [`stretch`] does the same inside criterion.
//!
//! Times are those on the processor ([`Stopwatch`]). Measure builds with `--release` only.
//!
//! ```no_run
//! use granular_edmd::collision::{CollisionRule, Contact, Impulse};
//! use granular_edmd::speed::{self, Comparison};
//!
//! #[derive(Clone)]
//! struct Own;
//!
//! impl CollisionRule for Own {
//!     fn impulse(&self, contact: &Contact) -> Impulse {
//!         Impulse::new(contact.normal_impulse(0.9), 0.0)
//!     }
//! }
//!
//! let built_in = speed::dense()?;
//! let own = built_in.clone().with_rule(Own);
//! println!("{}", Comparison::between(
//!     || speed::stretch(&built_in, 10_000, &mut ()),
//!     || speed::stretch(&own, 10_000, &mut ()),
//! )?);
//! # Ok::<(), Box<dyn std::error::Error + Send + Sync>>(())
//! ```

mod circumstances;
mod comparison;
mod quartiles;
mod report;
mod states;
mod stopwatch;

pub use circumstances::Circumstances;
pub use comparison::{Comparison, Finding, stretch};
pub use quartiles::Quartiles;
pub use report::{Meter, RunReport};
pub use states::{PaperBox, StateError, dense, dilute, gas, mixture, vessel};
pub use stopwatch::Stopwatch;
