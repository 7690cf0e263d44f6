//! A custom observer: the force on the base, oscillation by oscillation, in a table.
//!
//! ```text
//! cargo run --release -p granular-edmd --example own_observer > force.csv
//! ```
//!
//! It takes less than a second. You learn how an observer receives collisions and sampling times. It never
//! changes a run.

use anyhow::Context;
use granular_edmd::observable::Partner;
use granular_edmd::prelude::*;

/// Sums up the momentum that the base receives, from one sampling time to the next.
struct Force {
    clock: SampleTimes,
    base: Partner,
    momentum: f64,
    /// Each sampling time, and the mean force since the previous one.
    forces: Vec<(f64, f64)>,
    last: f64,
}

impl Observer for Force {
    fn on_start(&mut self, start: &Snapshot<'_>) -> Result<(), ObserverError> {
        self.clock.start_at(start.time());
        self.last = start.time();
        Ok(())
    }

    fn on_collision(&mut self, collision: &Collision) {
        if collision.partner == self.base {
            self.momentum += collision.impulse.normal();
        }
    }

    // The engine asks for the next sampling time, and samples at exactly that time.
    fn next_sample(&self) -> f64 {
        self.clock.upcoming()
    }

    fn on_sample(&mut self, snapshot: &Snapshot<'_>) {
        let force = std::mem::take(&mut self.momentum) / (snapshot.time() - self.last);
        self.forces.push((snapshot.time(), force));
        self.last = snapshot.time();
        self.clock.advance_past(snapshot.time());
    }
}

fn main() -> anyhow::Result<()> {
    let base = BiParabolic::new(0.1, 10.0)?;
    let oscillation = std::f64::consts::TAU / base.angular_frequency();
    let container = Container::closed(30.0, 60.0)?.with_motion(Wall::Floor, base)?;
    let disks = initial::lattice(&container, 300, 0.5)?;
    let disks = initial::with_maxwellian_velocities(disks, 0.5, 1)?;
    let rule = ContactDuration::new(Frictional::from_inelasticity(0.01, 0.01, 0.1)?, 1e-4)?;
    let mut simulation = Simulation::builder(rule, container).disks(disks).gravity(0.05).build()?;

    let clock = SampleTimes::every(10.0 * oscillation)?;
    // Collisions name walls by their index in the boundary.
    let base = Partner::Wall(simulation.boundary().index(Wall::Floor).context("a box without a floor")?);
    let mut force = Force { clock, base, momentum: 0.0, forces: Vec::new(), last: 0.0 };
    simulation.run_until(1000.0 * oscillation, &mut force)?;

    println!("time,force");
    force.forces.iter().for_each(|(time, force)| println!("{time},{force}"));
    // Over a long time the base carries the weight of all grains: 300 × 0.05 = 15.
    let mean = force.forces.iter().map(|(_, force)| force).sum::<f64>() / force.forces.len() as f64;
    eprintln!("mean force {mean:.2}, weight {:.2}", 300.0 * 0.05);
    Ok(())
}
