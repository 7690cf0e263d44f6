//! Convection rolls in a browser: the run behind the page, and what the page asks of it.
//!
//! [`Run`] is the paper's box, or one with a large disk, with settings that change while it runs. The
//! functions of [`exports`] are what the page calls; the binary of this package calls [`Run`] natively, to
//! compare.

mod diagram;
pub mod exports;
mod flow;
mod plan;
mod run;
mod scene;
mod watch;

pub use plan::{Mistake, Plan, Setting};
pub use run::{Advance, Run};
pub use scene::{Failure, Scene};
