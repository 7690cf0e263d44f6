//! The run of the page, natively: prints its hash after so many oscillations.
//!
//! ```text
//! cargo run --release --manifest-path web/Cargo.toml --bin native -- 200 0.03 0.0 1
//! ```
//!
//! The arguments are oscillations, friction, inelasticity and seed.

use rolls::{Failure, Rolls, Settings};

fn main() -> Result<(), Failure> {
    let arguments: Vec<f64> = std::env::args().skip(1).map(|text| text.parse()).collect::<Result<_, _>>()?;
    let &[oscillations, friction, inelasticity, seed] = arguments.as_slice() else {
        return Err("usage: native OSCILLATIONS FRICTION INELASTICITY SEED".into());
    };
    let settings =
        Settings { friction, inelasticity, gravity: 0.015_625, amplitude: 0.1, angular_frequency: 10.0 };
    let mut rolls = Rolls::new(settings, seed as u64)?;
    rolls.advance(oscillations, false)?;
    println!("{:016x} {}", rolls.hash(), rolls.collisions());
    Ok(())
}
