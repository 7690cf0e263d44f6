//! Results of the literature that a right simulation reproduces; `docs/validation.md` has the table.
//!
//! ```text
//! cargo test --test literature
//! cargo test --release --test literature -- --ignored --nocapture
//! ```

mod atmosphere;
mod collapse;
mod collisions;
mod cooling;
mod equilibrium;
mod figure_2;
mod gas;
mod layer;
mod mixtures;
mod order_parameters;
mod plate;
mod reversal;
mod stress;
mod structure;
mod superball;
mod thermal_walls;
mod transport;
mod velocities;

/// The result of a test.
type Outcome = Result<(), Box<dyn std::error::Error>>;

/// Returns whether `measured` is `expected` up to this relative deviation, and prints both, for the table.
fn agrees(what: &str, measured: f64, expected: f64, tolerance: f64) -> bool {
    let deviation = measured / expected - 1.0;
    println!(
        "{what}: measured {measured:.5}, expected {expected:.5}, deviation {deviation:.5} of {tolerance}"
    );
    deviation.abs() < tolerance
}
