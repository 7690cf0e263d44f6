//! Disks on walls that turn.

use granular_edmd::boundary::{Container, Part};
use granular_edmd::collision::{Elastic, RollingFriction};
use granular_edmd::glam::DVec2;
use granular_edmd::observable::{Collision, on_collision};
use granular_edmd::{Disk, Simulation};

const RADIUS: f64 = 6.0;

/// A disk that turns with a guided drum does not roll on it; nor on a belt that runs as fast.
#[test]
fn a_disk_that_turns_with_its_wall_does_not_roll() -> Result<(), Box<dyn std::error::Error>> {
    let spin = 0.5;
    let round = Part::drum(DVec2::ZERO, RADIUS)?;
    for part in [round.clone().with_rotation(DVec2::ZERO, spin)?, round.with_surface_speed(spin * RADIUS)?] {
        let vessel = Container::around([("drum", part)])?;
        let disk = Disk::new(DVec2::new(4.0, 0.0), 0.5)?.with_angular_velocity(spin)?;
        let disk = disk.with_velocity(DVec2::new(1.0, 0.0))?;
        let rule = RollingFriction::new(Elastic, 0.3)?;
        let mut run = Simulation::builder(rule, vessel).disks([disk]).build()?;
        let mut rolled = f64::NAN;
        let mut seen = on_collision(|collision: &Collision| rolled = collision.contact.relative_spin());
        run.run_until(2.0, &mut seen)?;
        assert!(rolled.abs() < 1e-12, "{rolled}");
        assert_eq!(run.disks()[0].angular_velocity(), spin);
    }
    Ok(())
}
