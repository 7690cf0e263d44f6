//! Walls with a mass that move freely along their normal, and that the disks push.

mod stroke;

pub(crate) use stroke::Stroke;

use crate::quantity::{accept, finite, non_negative, positive};
use crate::{Fingerprint, ParameterError};

/// A wall with a mass, which moves along its normal between two stops, under a constant force and a spring.
///
/// With the displacement $`z`$ along the wall's normal, which points to the disks, the mass $`M`$, the force
/// $`F`$, and a spring of the stiffness $`k`$ about $`z_0`$,
///
/// ```math
/// M\ddot z = F - k(z - z_0)
/// ```
///
/// between two impacts: a parabola or a sine, without a time step. Each disk that hits the wall changes the
/// wall's velocity by $`\Delta_n/M`$, as the collision rule says for partners of the masses $`m`$ and $`M`$.
/// The wall is guided, so an impulse along its surface does not move it. A stop takes all of the wall's
/// velocity: the wall rests there as long as the force presses it against the stop. A wall that has almost
/// stopped when it arrives at a stop (less than 1e-7 of its previous speed is left) turns around there
/// without touching the stop. The normal of a lid points down, so $`z > 0`$ is below its place at rest.
///
/// # At a stop, no rule is elastic
/// A disk that hits a wall at rest on a stop gives it the speed $`2mv/(M+m)`$ under
/// [`Elastic`](crate::collision::Elastic), and the stop absorbs it: the disk leaves with
///
/// ```math
/// v' = \frac{M-m}{M+m}\,v .
/// ```
///
/// If both masses are equal, the disk stops dead; a lighter wall is hit again and again. The simulation then
/// [warns](crate::simulation::Warning::WallOnStop). A force, or a spring, that keeps the wall off its stops
/// prevents it, as does a wall without a mass in its place.
///
/// [`Container::with_piston`](crate::boundary::Container::with_piston) makes a wall from a piston. A
/// checkpoint keeps the present state of the wall; a file of the container keeps only its state at the start.
/// Walls of a run that are used in another run begin there with their initial state, if that run starts
/// before their last impact; at a later time, they continue.
///
/// ```
/// use granular_edmd::boundary::{Container, Wall};
/// use granular_edmd::collision::Elastic;
/// use granular_edmd::prelude::*;
/// use granular_edmd::wall::Piston;
///
/// // A lid of mass 20, at first at height 30, that sinks to height 5 at most, under its weight.
/// let lid = Piston::new(20.0, [0.0, 25.0])?.with_force(20.0 * 0.1)?;
/// let container = Container::closed(10.0, 30.0)?.with_piston(Wall::Lid, lid)?;
/// let disks = initial::scattered(&container, 30, 0.5, 30.0, 1)?;
/// let disks = initial::with_maxwellian_velocities(disks, 1.0, 2)?;
/// let mut run = Simulation::builder(Elastic, container).disks(disks).gravity(0.1).build()?;
/// run.run_until(200.0, &mut ())?;
/// let height = run.snapshot().wall_point(3).ok_or("there is a lid")?.y;
/// assert!(height > 5.0 && height < 30.0);
/// // A displacement above 0, along the normal of the lid, is downward.
/// let (_, displacement, _) = run.snapshot().moving_walls()[0];
/// assert!(displacement.y < 0.0 && (displacement.y - (height - 30.0)).abs() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Piston {
    mass: f64,
    lowest: f64,
    highest: f64,
    force: f64,
    stiffness: f64,
    center: f64,
    displacement: f64,
    velocity: f64,
}

impl Piston {
    /// Creates a wall of this mass between a lower and an upper stop, without forces. The stops are given as
    /// displacements along the normal. The wall is at rest at displacement 0, or at the stop nearest to 0.
    ///
    /// # Errors
    /// If the mass is not finite and positive, or the stops are not finite and in order.
    pub fn new(mass: f64, stops: [f64; 2]) -> Result<Self, ParameterError> {
        let [lowest, highest] = stops;
        let (lowest, highest) = (finite("lowest stop", lowest)?, finite("highest stop", highest)?);
        accept(highest > lowest, "highest stop", "above the lowest one", highest)?;
        let (mass, displacement) = (positive("mass of a piston", mass)?, 0_f64.clamp(lowest, highest));
        let (force, stiffness, center, velocity) = (0.0, 0.0, 0.0, 0.0);
        Ok(Self { mass, lowest, highest, force, stiffness, center, displacement, velocity })
    }

    /// Returns the same wall under a constant force along its normal, positive toward the disks.
    ///
    /// The weight of a lid is $`Mg`$.
    ///
    /// # Errors
    /// If the force is not finite.
    pub fn with_force(self, force: f64) -> Result<Self, ParameterError> {
        Ok(Self { force: finite("force on a piston", force)?, ..self })
    }

    /// Returns the same wall on a spring of this stiffness, which is slack at the displacement `center`.
    ///
    /// # Errors
    /// If the stiffness is negative, or one of the two numbers is not finite.
    pub fn with_spring(self, stiffness: f64, center: f64) -> Result<Self, ParameterError> {
        let stiffness = non_negative("stiffness of a spring", stiffness)?;
        Ok(Self { stiffness, center: finite("center of a spring", center)?, ..self })
    }

    /// Returns the same wall with this displacement and velocity at the start.
    ///
    /// # Errors
    /// If the displacement is not between the stops, or the velocity is not finite.
    pub fn with_start(self, displacement: f64, velocity: f64) -> Result<Self, ParameterError> {
        let is_between = self.lowest <= displacement && displacement <= self.highest;
        accept(is_between, "displacement of a piston", "between its stops", displacement)?;
        Ok(Self { displacement, velocity: finite("velocity of a piston", velocity)?, ..self })
    }

    /// Returns the mass.
    pub const fn mass(&self) -> f64 {
        self.mass
    }

    /// Returns the stops, as displacements along the normal.
    pub const fn stops(&self) -> [f64; 2] {
        [self.lowest, self.highest]
    }

    /// Returns the energy of the wall, kinetic and potential: $`\tfrac12 M\dot z^2 - Fz +
    /// \tfrac12k(z-z_0)^2`$.
    ///
    /// ```
    /// use granular_edmd::wall::Piston;
    /// let lid = Piston::new(4.0, [0.0, 10.0])?.with_force(0.5)?;
    /// assert_eq!(lid.energy(2.0, 3.0), 17.0);
    /// # Ok::<(), granular_edmd::ParameterError>(())
    /// ```
    pub fn energy(&self, displacement: f64, velocity: f64) -> f64 {
        let stretched = displacement - self.center;
        0.5 * self.mass * velocity * velocity - self.force * displacement
            + 0.5 * self.stiffness * stretched * stretched
    }

    /// Returns the square of the spring's angular frequency; 0 without a spring.
    fn square_of_frequency(&self) -> f64 {
        self.stiffness / self.mass
    }

    fn acceleration_at(&self, displacement: f64) -> f64 {
        self.force / self.mass - self.square_of_frequency() * (displacement - self.center)
    }

    pub(super) fn fingerprint(&self) -> Fingerprint {
        let Self { mass, lowest, highest, force, stiffness, center, displacement, velocity } = *self;
        let numbers = [mass, lowest, highest, force, stiffness, center, displacement, velocity];
        numbers.iter().fold(Fingerprint::of("Piston"), |piston, &number| piston.number(number))
    }
}

crate::gate::from_file! {
    Piston {
        mass: f64, lowest: f64, highest: f64, force: f64, stiffness: f64, center: f64, displacement: f64,
        velocity: f64
    } => Self::new(mass, [lowest, highest])?
        .with_force(force)?
        .with_spring(stiffness, center)?
        .with_start(displacement, velocity)
}
