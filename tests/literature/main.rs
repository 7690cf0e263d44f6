//! Results of the literature that a right simulation reproduces; `docs/validation.md` has the table.
//!
//! ```text
//! cargo test --test literature
//! cargo test --release --test literature -- --ignored --nocapture
//! ```
//!
//! `.ci/validation` compares the table with the values that the tests write.

mod atmosphere;
mod billiards;
mod collapse;
mod collisions;
mod cooling;
mod driven;
mod equilibrium;
mod figure_2;
mod gas;
mod layer;
mod mixtures;
mod order_parameters;
mod piston;
mod plate;
mod reversal;
mod shock;
mod single_file;
mod stress;
mod structure;
mod superball;
mod thermal_walls;
mod transport;
mod velocities;
mod work;

use support::measured::measured;

/// The result of a test.
type Outcome = Result<(), Box<dyn std::error::Error>>;

/// Returns whether `value` is `expected` up to this relative deviation, and writes both, for the table.
fn agrees(quantity: &str, value: f64, expected: f64, tolerance: f64) -> bool {
    let deviation = value / expected - 1.0;
    measured(quantity, value);
    measured(&format!("expected {quantity}"), expected);
    println!("  deviation {deviation:.5} of {tolerance}");
    deviation.abs() < tolerance
}
