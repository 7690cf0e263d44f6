//! The shaken box behind the page: a simulation whose parameters change while it runs.
//!
//! [`Rolls`] is plain Rust, and runs natively too: the same settings and seed have the same hash there. The
//! module `exports` is all that WebAssembly adds.

#[cfg(target_arch = "wasm32")]
mod exports;
mod flow;
mod rolls;
mod settings;

pub use flow::{COLUMNS, Flow, ROWS};
pub use rolls::{Failure, Rolls};
pub use settings::{CONTACT_DURATION, DISKS, HEIGHT, Settings, WIDTH};
