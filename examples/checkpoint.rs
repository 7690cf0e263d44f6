//! A checkpoint: a run that is interrupted, written to a file, and resumed with the same bits.
//!
//! ```text
//! cargo run --release --features serde --example checkpoint
//! ```
//!
//! It takes less than a second. You learn what a checkpoint holds (the whole state), what it does not hold
//! (rule and walls, which the program creates again), and how to keep a measurement with it.

use granular_edmd::prelude::*;
use granular_edmd::simulation::Checkpoint;

fn container() -> anyhow::Result<Container> {
    Ok(Container::closed(20.0, 50.0)?.with_motion(Wall::Floor, BiParabolic::new(0.1, 10.0)?)?)
}

fn rule() -> Result<ContactDuration<Frictional>, ParameterError> {
    ContactDuration::new(Frictional::from_inelasticity(0.01, 0.01, 0.1)?, 1e-4)
}

fn main() -> anyhow::Result<()> {
    let container = container()?;
    let disks = initial::with_maxwellian_velocities(initial::lattice(&container, 100, 0.5)?, 0.5, 1)?;
    let mut whole = Simulation::builder(rule()?, container).disks(disks).gravity(0.015_625).build()?;
    let mut series = Series::new(CenterOfMass, SampleTimes::every(10.0)?);
    whole.run_until(500.0, &mut series)?;

    // Half of the run is done. The state and the samples go to one file, to the bit. A text format may round:
    // serde_json does, unless its feature `float_roundtrip` is on.
    let file = std::env::temp_dir().join(format!("checkpoint-{}", std::process::id()));
    whole.checkpoint().write_with(&series, &file)?;

    // A later program creates the rule and the walls again, and resumes the run. A checkpoint refuses another
    // rule or another wall; a custom part needs a `fingerprint` for that.
    let (checkpoint, mut resumed) = Checkpoint::read_with::<Series<CenterOfMass>>(&file)?;
    let mut second = Simulation::resume(&checkpoint, rule()?, self::container()?).build()?;
    second.run_until(1000.0, &mut resumed)?;
    std::fs::remove_file(&file)?;

    // The uninterrupted run reaches the same state, with the same samples.
    whole.run_until(1000.0, &mut series)?;
    assert_eq!(second.disks(), whole.disks());
    assert_eq!(resumed.values(), series.values());
    println!(
        "{} samples and {} disks are the same, to the last bit",
        series.values().len(),
        whole.disks().len()
    );
    Ok(())
}
