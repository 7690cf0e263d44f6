//! Elastic disks whose velocities are reversed go back the way they came.

use granular_edmd::boundary::Container;
use granular_edmd::collision::{CollisionRule, Elastic, Rough};
use granular_edmd::{Disk, ParameterError, Simulation, initial};

use crate::gas::run_for;
use crate::{Outcome, measured};

fn reversed(disk: &Disk) -> Result<Disk, ParameterError> {
    disk.with_velocity(-disk.velocity())?.with_angular_velocity(-disk.angular_velocity())
}

/// Returns the largest distance from the start after this many collisions per disk and as long a way back.
fn distance_after<R: CollisionRule + Copy>(
    rule: R,
    collisions_per_disk: f64,
) -> Result<f64, Box<dyn std::error::Error>> {
    let container = Container::closed(28.0, 28.0)?;
    let disks =
        initial::with_maxwellian_velocities(initial::scattered(&container, 100, 0.5, 28.0, 1)?, 1.0, 1)?;
    let mut forth = Simulation::builder(rule, container.clone()).disks(disks.clone()).build()?;
    run_for(&mut forth, collisions_per_disk, &mut ())?;
    let turned = forth.disks().iter().map(reversed).collect::<Result<Vec<_>, _>>()?;
    let mut back = Simulation::builder(rule, container).disks(turned).build()?;
    back.run_until(forth.time(), &mut ())?;
    let ways =
        back.disks().into_iter().zip(disks).map(|(end, start)| end.position().distance(start.position()));
    Ok(ways.fold(0.0, f64::max))
}

#[test]
fn time_can_be_reversed() -> Outcome {
    // Errors of 1e-16 grow by some e^4 for each collision of a disk. They are about 1e-13 after one and 1e-9
    // after four in the literature's gas; the bounds leave a factor of 1000. The way is lost after 12 to 16.
    for (collisions, bound) in [(1.0, 1e-10), (4.0, 1e-6)] {
        let smooth = distance_after(Elastic, collisions)?;
        let rough = distance_after(Rough::from_inelasticity(0.0, 0.0)?, collisions)?;
        measured("smooth", smooth);
        measured("rough", rough);
        assert!(smooth < bound && rough < bound);
    }
    assert!(distance_after(Elastic, 30.0)? > 0.1, "chaos");
    Ok(())
}
