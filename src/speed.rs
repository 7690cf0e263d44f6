//! The speed of runs, and the cost of their parts.
//!
//! A [`Meter`] is started before a run and makes a [`RunReport`] after it. [`dilute`] and [`dense`] are
//! standard states in which to compare a custom part with the built-in one. Insert the part with
//! [`Simulation::with_rule`](crate::Simulation::with_rule),
//! [`with_boundary`](crate::Simulation::with_boundary) or
//! [`with_scheduler`](crate::Simulation::with_scheduler); a [`Comparison`] shows whether a difference exceeds
//! the noise. For benchmarks with criterion, [`measure`] measures one run alone instead of two runs
//! alternately.
//!
//! All times are processor times ([`RunReport::seconds`]). Measure builds with `--release` only.
//!
//! ```no_run
//! use granular_edmd::collision::{CollisionRule, Contact, ContactDuration, Friction, Impulse};
//! use granular_edmd::observable::EnergyChange;
//! use granular_edmd::scheduler::TournamentTree;
//! use granular_edmd::speed::{self, Comparison};
//!
//! #[derive(Clone)]
//! struct Own(Friction);
//!
//! impl CollisionRule for Own {
//!     fn impulse(&self, contact: &Contact) -> Impulse {
//!         let restitution = 1.0 / (1.0 + 0.1 * contact.closing_speed());
//!         self.0.impulse(contact, contact.normal_impulse(restitution))
//!     }
//! }
//!
//! let built_in = speed::dense()?;
//! let bare = || speed::measure(&built_in, 10_000, &mut ());
//! // The state has a contact duration, so the custom rule gets the same: only the rules differ.
//! let own = Own(Friction::from_inelasticity(0.05, 0.1)?);
//! let rule = ContactDuration::new(own, built_in.rule().duration())?;
//! let own = built_in.clone().with_rule(rule);
//! println!("{}", Comparison::between(bare, || speed::measure(&own, 10_000, &mut ()))?);
//!
//! let tree = built_in.clone().with_scheduler(TournamentTree::new());
//! println!("{}", Comparison::between(bare, || speed::measure(&tree, 10_000, &mut ()))?);
//!
//! let mut observer = EnergyChange::default();
//! println!("{}", Comparison::between(bare, || speed::measure(&built_in, 10_000, &mut observer))?);
//! # Ok::<(), Box<dyn std::error::Error + Send + Sync>>(())
//! ```

mod comparison;
mod report;
mod states;

pub use comparison::{Comparison, Finding, Quartiles, measure};
pub use report::{Meter, RunReport};
pub use states::{PaperBox, StateError, dense, dilute};
