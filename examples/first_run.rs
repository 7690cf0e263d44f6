//! The first run: grains in a shaken box, and the convection rolls that appear.
//!
//! ```text
//! cargo run --release -p granular-edmd --example first_run
//! ```
//!
//! It takes less than a second. You learn how a run is put together: walls, disks, a rule for their
//! collisions, and observers.

use granular_edmd::prelude::*;

// The crate `anyhow` shows an error as a sentence, with its causes. `Box<dyn Error>` would show its fields.
fn main() -> anyhow::Result<()> {
    // The base of the box goes up and down by 0.1 diameters of a grain. Speeds are measured in units of its
    // speed, 0.1 × 10 = 1, and lengths in diameters.
    let base = BiParabolic::new(0.1, 10.0)?;
    let oscillation = std::f64::consts::TAU / base.angular_frequency();

    // A box 60 wide and 150 high. The question mark ends the program with a message if a number makes no
    // sense.
    let container = Container::closed(60.0, 150.0)?.with_motion(Wall::Floor, base)?;

    // 1000 grains of radius 1/2 on a lattice, with random velocities. The last number is the seed: the same
    // seed gives the same run, bit for bit.
    let disks = initial::lattice(&container, 1000, 0.5)?;
    let disks = initial::with_maxwellian_velocities(disks, 0.5, 7)?;

    // Grains lose no energy by their inelasticity (0), but rub with the friction coefficient 0.03. Contacts
    // within a time of 1e-4 after the previous one lose nothing, so that grains at rest on each other do not
    // stall the run.
    let rule = ContactDuration::new(Frictional::from_inelasticity(0.0, 0.0, 0.03)?, 1e-4)?;
    let mut simulation = Simulation::builder(rule, container).disks(disks).gravity(0.015_625).build()?;

    // Watch the order parameters of one roll and of two, and the height of the center of mass. Samples a
    // whole number of oscillations apart would always see the base at the same phase; these samples see ten
    // phases.
    let mut series = Series::new((OrderParameters, CenterOfMass), SampleTimes::every(99.9 * oscillation)?);
    simulation.run_until(1000.0 * oscillation, &mut series)?;

    println!("oscillation  one roll  two rolls   height");
    for (time, (order, center)) in series.iter() {
        let count = time / oscillation;
        println!("{count:11.1} {:9.3} {:10.3} {:8.2}", order.one_roll, order.two_rolls, center.y);
    }
    println!("{} collisions", simulation.counters().disk_collisions);
    Ok(())
}
