//! The paper's box with soft disks in LAMMPS and with hard disks in this crate, from the same settled state
//! of this crate, over a sinusoidal base.
//!
//! LAMMPS first relaxes, since its contacts last. Height and energies have errors from blocks. Times are
//! wall-clock times per oscillation of the base. This crate runs longer, so that its own errors are smaller.

use std::path::PathBuf;
use std::time::Instant;

use granular_edmd::boundary::{Container, Wall};
use granular_edmd::collision::{ContactDuration, Frictional};
use granular_edmd::observable::{CenterOfMass, Energies, SampleTimes, Series};
use granular_edmd::wall::Sinusoidal;
use granular_edmd::{Simulation, initial};

use super::lammps::{CONTACTS, Lammps, Means};
use benches::state::{
    AMPLITUDE, ANGULAR_FREQUENCY, CONTACT_DURATION, DENSE, DILUTE, DISKS, HEIGHT, OSCILLATION,
};
use benches::state::{State, WIDTH};
use benches::{Outcome, ask};

const CAVEATS: &str = "\
One thread each, wall clock, a thousand disks. The ratio depends on the state and on how stiff the disks are:
hard disks take time per collision, soft disks per time step. The ratio therefore grows with stiffness, and falls
with the rate of collisions; where disks stay in contact, soft disks win. Soft disks have what hard disks lack:
lasting contacts, force chains, particles of any shape, runs on many processors.";

/// Number of oscillations of this crate for each oscillation of LAMMPS, so that the errors of this crate are
/// smaller.
const LONGER: u32 = 100;

/// Sampling interval in oscillations. The samples go through all phases of the base.
const INTERVAL: f64 = 0.26;

type Run = Simulation<ContactDuration<Frictional>, Container>;

/// Prints the table for this program, or this crate's rows alone.
pub(crate) fn compare(lammps: Option<&PathBuf>) -> Outcome<()> {
    let (settle, relax, oscillations) = if ask::is_test() { (10, 5, 10) } else { (2000, 50, 300) };
    let oscillations = ask::number("OSCILLATIONS", oscillations)?;
    println!(
        "{oscillations} oscillations of LAMMPS for each row, and {LONGER} times as many of this crate.\n"
    );
    println!("| state | program | s for 1000 oscillations | ratio | height | energy | of rotation |");
    println!("|---|---|---|---|---|---|---|");
    for (name, state) in [("dilute", DILUTE), ("dense", DENSE)] {
        let mut run = settled(&state, settle)?;
        let start = run.disks();
        let ours = measure(&mut run, LONGER * oscillations)?;
        print_row(name, "this crate", &ours, &ours);
        for contacts in CONTACTS {
            let Some(program) = lammps.cloned() else { continue };
            let folder = benches::working_folder("peers")?;
            let soft = Lammps { program, folder }.measure(&state, contacts, &start, (relax, oscillations))?;
            let label = format!("LAMMPS, {}: {}/{}", contacts.name, contacts.time, contacts.steps);
            print_row(name, &label, &soft, &ours);
        }
    }
    println!("\n{CAVEATS}");
    Ok(())
}

/// Returns the box after `oscillations` oscillations, at a time when the base is at its lowest position, from
/// which LAMMPS moves it.
fn settled(state: &State, oscillations: u32) -> Outcome<Run> {
    let base = Sinusoidal::new(AMPLITUDE, ANGULAR_FREQUENCY)?;
    let container = Container::closed(WIDTH, HEIGHT)?.with_motion(Wall::Floor, base)?;
    let disks = initial::with_maxwellian_velocities(initial::lattice(&container, DISKS, 0.5)?, 1.0, 1)?;
    let rule = Frictional::from_inelasticity(state.inelasticity, state.inelasticity, state.friction)?;
    let rule = ContactDuration::new(rule, CONTACT_DURATION)?;
    let mut run = Simulation::builder(rule, container).disks(disks).gravity(state.gravity).build()?;
    run.run_until((f64::from(oscillations) + 0.75) * OSCILLATION, &mut ())?;
    Ok(run)
}

/// Measures for `oscillations` oscillations.
fn measure(run: &mut Run, oscillations: u32) -> Outcome<Means> {
    let times = SampleTimes::every(INTERVAL * OSCILLATION)?;
    let mut series = Series::new((CenterOfMass, Energies), times);
    let (start, end) = (Instant::now(), run.time() + f64::from(oscillations) * OSCILLATION);
    run.run_until(end, &mut series)?;
    let seconds = start.elapsed().as_secs_f64() / f64::from(oscillations);
    let numbers =
        series.values().iter().map(|(center, energy)| [center.y, energy.translational, energy.rotational]);
    Means::of(seconds, &numbers.collect::<Vec<_>>())
}

fn print_row(state: &str, program: &str, means: &Means, ours: &Means) {
    let (seconds, ratio) = (1000.0 * means.seconds, means.seconds / ours.seconds);
    let [height, energy, rotation] = &means.values;
    println!("| {state} | {program} | {seconds:.3} | {ratio:.0} | {height} | {energy} | {rotation} |");
}
