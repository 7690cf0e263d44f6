//! A rough elastic ball between vertical walls does not fall.

use granular_edmd::boundary::Container;
use granular_edmd::collision::{CollisionRule, Frictional, Rough};
use granular_edmd::glam::DVec2;
use granular_edmd::observable::{Collision, on_collision};
use granular_edmd::{Disk, Simulation};

use crate::{Outcome, measured};

/// Returns the lowest and highest height, relative to the start, at which a ball touches the sides in this
/// many touches.
fn range(rule: impl CollisionRule, touches: u64) -> Result<(f64, f64), Box<dyn std::error::Error>> {
    let height = 10_000.0;
    let disk = Disk::new(DVec2::new(30.0, height), 0.5)?.with_velocity(DVec2::new(1.4, 0.0))?;
    let mut simulation =
        Simulation::builder(rule, Container::open(60.0)?).disks([disk]).gravity(1.0 / 64.0).build()?;
    let (mut low, mut high) = (0.0_f64, f64::NEG_INFINITY);
    let mut watch = on_collision(|c: &Collision| {
        low = low.min(c.position.y - height);
        high = high.max(c.position.y - height);
    });
    while simulation.counters().wall_collisions < touches {
        simulation.step_until(simulation.time() + 1.0, &mut watch)?;
    }
    Ok((low, high))
}

#[test]
fn a_superball_between_no_slip_walls_stays_up() -> Outcome {
    // Two touches are a rotation of velocity and spin by 141 degrees, which is an orbit of bounded height
    // (Cox & Feres 2016, Chumley et al. 2018). Nothing here is random. The bounds are those of an independent
    // study, for another start.
    let (low, high) = range(Rough::from_inelasticity(0.0, 0.0)?, 20_000)?;
    measured("no slip, low", low);
    measured("no slip, high", high);
    assert!(low > -60.0 && high <= 0.0);
    let (low, high) = range(Frictional::from_inelasticity(0.0, 0.0, 0.3)?, 20_000)?;
    measured("friction 0.3, low", low);
    measured("friction 0.3, high", high);
    assert!(low > -90.0 && high <= 0.0);
    let (low, _) = range(Frictional::from_inelasticity(0.0, 0.0, 0.1)?, 200)?;
    assert!(low < -1000.0);
    Ok(())
}
