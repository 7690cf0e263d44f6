//! Disks on walls that turn.

use granular_edmd::boundary::{Container, Part};
use granular_edmd::collision::{Elastic, RollingFriction};
use granular_edmd::glam::DVec2;
use granular_edmd::observable::{Collision, on_collision};
use granular_edmd::{Disk, Simulation};

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
fn balance<R: CollisionRule>(run: &Simulation<R, Rotor>) -> [f64; 2] {
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
    let disks = initial::scattered(&drum, 20, 0.5, 2.0 * RADIUS, 1)?;
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

/// Rolling friction acts on the spin relative to the drum, whose inertia resists it, too. The total angular
/// momentum is conserved, and no collision gains energy.
#[test]
fn rolling_friction_slows_disks_and_drum() -> Result<(), Box<dyn std::error::Error>> {
    let drum = Rotor { rim: Brick::circle(DVec2::ZERO, RADIUS)?, spin: 0.4 };
    let disks = initial::scattered(&drum, 20, 0.5, 2.0 * RADIUS, 1)?;
    let disks = initial::with_maxwellian_velocities(disks, 1.0, 2)?;
    let rule = RollingFriction::new(Rough::from_restitution(1.0, 1.0)?, 0.05)?;
    let mut run = Simulation::builder(rule, drum).disks(disks).build()?;
    let [momentum, mut energy] = balance(&run);
    let mut spins = 0.0_f64;
    for _ in 0..5000 {
        let mut told = None;
        let mut seen = on_collision(|collision: &Collision| {
            let contact = collision.contact;
            if contact.kinds()[1] == Kind::WALL {
                let turning = collision.partner_position().perp_dot(collision.velocities[1]);
                let drum = turning / (RADIUS * RADIUS);
                assert!((contact.spin_inertia() - 1.0 / (1.0 / 0.125 + 1.0 / INERTIA)).abs() < 1e-12);
                assert!((contact.spin_response() - (4.0 + RADIUS / INERTIA)).abs() < 1e-12);
                spins = spins.max(drum.abs());
                told = Some(drum);
            }
        });
        run.run(&Limits::collisions(1), &mut seen)?;
        // The couple has turned the drum, too.
        let spin = run.boundary().spin;
        assert!(told.is_none_or(|drum| (drum - spin).abs() < 1e-13), "{told:?} {spin}");
        let [now, left] = balance(&run);
        assert!((now / momentum - 1.0).abs() < 1e-11, "{now} was {momentum}");
        assert!(left <= energy * (1.0 + 1e-14), "{left} was {energy}");
        energy = left;
    }
    assert!(spins > 0.3);
    Ok(())
}

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
