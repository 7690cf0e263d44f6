//! Gases between smooth elastic walls, periodic sideways.

use std::error::Error;
use std::f64::consts::PI;

use granular_edmd::boundary::{Boundary, Container, Wall};
use granular_edmd::collision::{CollisionRule, Elastic};
use granular_edmd::observable::Observer;
use granular_edmd::{Disk, ParameterError, Simulation, initial};

use crate::Outcome;

/// A gas of disks of diameter and mass 1 and temperature 1, at rest as a whole, without gravity.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Gas {
    pub(crate) count: usize,
    pub(crate) width: f64,
    pub(crate) height: f64,
    pub(crate) seed: u64,
}

impl Gas {
    /// Creates a gas of this packing fraction (of the height that centers can have), `aspect` times as wide
    /// as high.
    pub(crate) fn of(count: usize, packing_fraction: f64, aspect: f64, seed: u64) -> Self {
        let clear = (0.25 * PI * count as f64 / packing_fraction / aspect).sqrt();
        Self { count, width: aspect * clear, height: clear + 1.0, seed }
    }

    /// Returns the area that centers can have.
    pub(crate) fn area(&self) -> f64 {
        self.width * (self.height - 1.0)
    }

    /// Returns the number of disks per area that centers can have.
    pub(crate) fn density(&self) -> f64 {
        self.count as f64 / self.area()
    }

    pub(crate) fn container(&self) -> Result<Container, Box<dyn Error>> {
        let container = Container::closed(self.width, self.height)?.with_periodic_sides()?;
        Ok(container.with_rule(Wall::Floor, Elastic)?.with_rule(Wall::Lid, Elastic)?)
    }

    /// Returns a simulation of the gas under this rule, with spins at this temperature.
    pub(crate) fn simulation<R: CollisionRule>(
        &self,
        rule: R,
        rotational_temperature: f64,
    ) -> Result<Simulation<R>, Box<dyn Error>> {
        let container = self.container()?;
        // Dense gases start on a lattice that fills the box, dilute ones at random.
        let disks = if self.density() < 0.5 {
            initial::scattered(&container, self.count, 0.5, self.height, self.seed)?
        } else {
            initial::lattice(&container, self.count, 0.5)?
        };
        let disks = initial::with_maxwellian_velocities(disks, 1.0, self.seed)?;
        let disks = initial::without_drift(disks)?;
        let disks = with_spins(disks, rotational_temperature, self.seed)?;
        Ok(Simulation::builder(rule, container).disks(disks).build()?)
    }
}

/// Returns a gas of this many disks of diameter and mass 1 in a box that is periodic both ways, at this
/// packing fraction and at temperature 1, after twenty collisions per disk.
pub(crate) fn periodic_gas<R: CollisionRule>(
    count: usize,
    packing_fraction: f64,
    rule: R,
    seed: u64,
) -> Result<Simulation<R>, Box<dyn Error>> {
    let side = (0.25 * PI * count as f64 / packing_fraction).sqrt();
    let container = Container::periodic(side, side)?;
    let disks = initial::scattered(&container, count, 0.5, side, seed)?;
    let disks = initial::without_drift(initial::with_maxwellian_velocities(disks, 1.0, seed)?)?;
    let mut simulation = Simulation::builder(rule, container).disks(disks).build()?;
    run_for(&mut simulation, 20.0, &mut ())?;
    Ok(simulation)
}

/// Returns the pair correlation at contact of equal disks (Henderson, Mol. Phys. 30, 971 (1975)).
pub(crate) fn contact_value(packing_fraction: f64) -> f64 {
    (1.0 - 7.0 / 16.0 * packing_fraction) / (1.0 - packing_fraction).powi(2)
}

/// Returns the collisions per disk and time of equal disks at temperature 1 (Enskog).
pub(crate) fn collision_rate(packing_fraction: f64) -> f64 {
    2.0 * PI.sqrt() * (4.0 * packing_fraction / PI) * contact_value(packing_fraction)
}

/// Gives the disks the spins of a Maxwellian, from the velocities of another gas.
pub(crate) fn with_spins(disks: Vec<Disk>, temperature: f64, seed: u64) -> Result<Vec<Disk>, ParameterError> {
    let other = initial::with_maxwellian_velocities(disks.clone(), temperature, seed + 1000)?;
    let spin = |(disk, other): (Disk, Disk)| {
        disk.with_angular_velocity(other.velocity().x / disk.moment_of_inertia().sqrt())
    };
    disks.into_iter().zip(other).map(spin).collect()
}

/// Runs until each disk has had this many more collisions with others. No samples are taken.
pub(crate) fn run_for<R: CollisionRule, B: Boundary, O: Observer + ?Sized>(
    simulation: &mut Simulation<R, B>,
    collisions_per_disk: f64,
    observer: &mut O,
) -> Outcome {
    let wanted = (0.5 * collisions_per_disk * simulation.len() as f64) as u64;
    let last = simulation.counters().disk_collisions + wanted;
    while simulation.counters().disk_collisions < last {
        simulation.step_until(simulation.time() + 1.0, observer)?;
    }
    Ok(())
}
