//! A free drum with a moment of inertia, which the disks turn: a custom boundary that reacts.

use granular_edmd::boundary::{
    Boundary, Brick, Domain, FirstTouch, Impact, Overlap, Probe, Reaction, Region, Surface, Touch, laws,
};
use granular_edmd::collision::Rough;
use granular_edmd::glam::DVec2;
use granular_edmd::{Disk, Flight, ParameterError, Simulation, initial};

const RADIUS: f64 = 6.0;
const INERTIA: f64 = 400.0;

/// A drum on an axle without friction.
#[derive(Debug, Clone)]
struct Rotor {
    rim: Brick,
    spin: f64,
}

impl Boundary for Rotor {
    fn domain(&self) -> Domain {
        Domain::new(-RADIUS, RADIUS, -RADIUS, RADIUS)
    }
    fn wall_count(&self) -> usize {
        1
    }
    fn set_time_origin(&mut self, _: f64) {}
    fn may_touch(&self, region: &Region, radius: f64) -> bool {
        self.rim.may_touch(region, radius)
    }
    fn first_touch(&self, flight: &Flight, until: f64) -> FirstTouch<Touch> {
        self.rim.first_touch(flight, until).map(|time| Touch::new(time, 0)).into()
    }
    fn surface(&self, _: usize, position: DVec2, _: f64) -> Surface<'_> {
        let normal = self.rim.normal(position);
        let surface = Surface::new(normal, -self.spin * RADIUS * normal.perp());
        surface.with_radius(-RADIUS).with_tangential_mass(INERTIA / (RADIUS * RADIUS))
    }
    fn overlap(&self, probe: &Probe) -> Option<Overlap> {
        let depth = probe.radius() - self.rim.signed_distance(probe.position());
        (depth > 0.0).then_some(Overlap::new(0, depth))
    }
    fn react(&mut self, impact: &Impact) -> Reaction {
        self.spin += (impact.point.perp_dot(impact.impulse) + impact.couple) / INERTIA;
        Reaction::Moved
    }
    fn state(&self) -> Vec<f64> {
        vec![self.spin]
    }
    fn set_state(&mut self, state: &[f64]) -> Result<(), ParameterError> {
        let &[spin] = state else {
            return Err(ParameterError::new("state of the drum", "one number", state.len() as f64));
        };
        self.spin = spin;
        Ok(())
    }
}

/// Returns the angular momentum about the axle, and the kinetic energy, of disks and drum together.
fn balance(run: &Simulation<Rough, Rotor>) -> [f64; 2] {
    let spin = run.boundary().spin;
    let turning = |disk: &Disk| {
        let orbit = disk.mass() * disk.position().perp_dot(disk.velocity());
        orbit + disk.moment_of_inertia() * disk.angular_velocity()
    };
    let energy = |disk: &Disk| disk.translational_energy() + disk.rotational_energy();
    let disks = run.disks();
    [
        disks.iter().map(turning).sum::<f64>() + INERTIA * spin,
        disks.iter().map(energy).sum::<f64>() + 0.5 * INERTIA * spin * spin,
    ]
}

/// Perfectly rough disks turn a drum that was at rest; angular momentum and energy of all are kept.
#[test]
fn disks_turn_a_free_drum() -> Result<(), Box<dyn std::error::Error>> {
    let mut drum = Rotor { rim: Brick::circle(DVec2::ZERO, RADIUS)?, spin: 0.0 };
    laws::check(&mut drum, 0.5, 1.0, 1)?;
    drum.spin = 0.0;
    let disks = initial::random(&drum, 20, 0.5, 2.0 * RADIUS, 1)?;
    let disks = initial::with_maxwellian_velocities(disks, 1.0, 2)?;
    let mut run = Simulation::builder(Rough::from_restitution(1.0, 1.0)?, drum).disks(disks).build()?;
    let before = balance(&run);
    let mut fastest = 0.0_f64;
    while run.counters().wall_collisions < 200_000 {
        run.run_until(run.time() + 100.0, &mut ())?;
        fastest = fastest.max(run.boundary().spin.abs());
    }
    let after = balance(&run);
    let errors = [0, 1].map(|of| after[of] / before[of] - 1.0);
    println!("spin up to {fastest}; errors of angular momentum and energy {errors:?}");
    assert!(fastest > 0.05, "{fastest}");
    assert!(errors.iter().all(|error| error.abs() < 1e-10), "{errors:?}");
    Ok(())
}
