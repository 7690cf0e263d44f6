//! Direct simulation of the homogeneous Boltzmann–Enskog equation, for any rule.

use std::f64::consts::{PI, TAU};

use glam::DVec2;
use rand_xoshiro::Xoshiro256PlusPlus;

use crate::collision::{CollisionRule, collide_after};
use crate::disk::LARGEST;
use crate::quantity::{accept, finite, positive};
use crate::random::{Stream, generator, uniform};
use crate::{Disk, ParameterError};

/// A homogeneous gas without correlations: direct simulation of the Boltzmann–Enskog equation (DSMC) under
/// any rule.
///
/// Disks have velocities and spins, but no positions. Any two of them collide, in any direction
/// $`\hat\sigma`$, at the rate
///
/// ```math
/// \frac{n\chi}{N}\,\sigma\,(\vec v_{12}\cdot\hat\sigma)\,d\hat\sigma ,
/// ```
///
/// so partners are drawn at random and have no common past: molecular chaos holds by construction. If an
/// event-driven simulation gives another result, its velocities are correlated, or its gas is not
/// homogeneous. With $`N\to\infty`$, the distribution of velocities is the solution of the equation, without
/// an expansion.
///
/// Waits between collisions have no memory, so each call of `run_until` draws the first wait anew. A gas that
/// is run in pieces therefore has other collisions than a gas that is run in one piece, with the same
/// statistics. A [`Simulation`](crate::Simulation) has the same bits in both cases.
///
/// The density with the contact value, $`n\chi`$, sets only the unit of time. Disks of different radii share
/// one $`\chi`$.
///
/// ```
/// use granular_edmd::collision::Smooth;
/// use granular_edmd::glam::DVec2;
/// use granular_edmd::kinetic::DirectSimulation;
/// use granular_edmd::{Disk, initial};
///
/// let disks = vec![Disk::new(DVec2::ZERO, 0.5)?; 2000];
/// let disks = initial::with_maxwellian_velocities(disks, 1.0, 1)?;
/// let mut gas = DirectSimulation::new(Smooth::from_restitution(0.9)?, disks, 0.1, 1)?;
/// gas.run_until(40.0)?;
/// let temperature = gas.disks().iter().map(Disk::translational_energy).sum::<f64>() / 2000.0;
/// // Haff's law, with the rate of collisions of a Maxwellian.
/// let rate = 2.0 * std::f64::consts::PI.sqrt() * 0.1;
/// let haff = (1.0 + 0.25 * (1.0 - 0.81) * rate * 40.0_f64).powi(-2);
/// assert!((temperature / haff - 1.0).abs() < 0.05);
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
///
/// Source: G. A. Bird, Molecular Gas Dynamics and the Direct Simulation of Gas Flows (1994); for granular
/// gases, J. J. Brey, M. J. Ruiz-Montero and D. Cubero, Phys. Rev. E 54, 3664 (1996).
#[derive(Debug, Clone)]
pub struct DirectSimulation<R> {
    rule: R,
    disks: Vec<Disk>,
    density: f64,
    generator: Xoshiro256PlusPlus,
    time: f64,
    collisions: u64,
    /// Time of the last collision of each disk.
    last: Vec<f64>,
    /// Largest diameter, and a speed that no disk exceeds.
    widest: f64,
    fastest: f64,
}

impl<R: CollisionRule> DirectSimulation<R> {
    /// Creates a gas of these disks, whose positions do not matter, with this product of the number density
    /// and the contact value, $`n\chi`$.
    ///
    /// # Errors
    /// If there are fewer than two disks, or the density is not finite and positive.
    pub fn new(rule: R, disks: Vec<Disk>, density: f64, seed: u64) -> Result<Self, ParameterError> {
        accept(disks.len() > 1, "number of disks", "at least 2", disks.len() as f64)?;
        let density = positive("density", density)?;
        let generator = generator(seed, Stream::DirectSimulation, 0);
        let (time, collisions, last) = (0.0, 0, vec![f64::NEG_INFINITY; disks.len()]);
        Ok(Self { rule, disks, density, generator, time, collisions, last, widest: 0.0, fastest: 0.0 })
    }

    /// Returns the disks.
    pub fn disks(&self) -> &[Disk] {
        &self.disks
    }

    /// Returns mutable access to the disks, for example for the driving of a simulation.
    pub fn disks_mut(&mut self) -> &mut [Disk] {
        &mut self.disks
    }

    /// Returns the time.
    pub const fn time(&self) -> f64 {
        self.time
    }

    /// Returns the number of collisions so far.
    pub const fn collisions(&self) -> u64 {
        self.collisions
    }

    /// Runs collisions until this time.
    ///
    /// # Errors
    /// If the time is not finite or has passed, or the rule gives a disk a speed above 1e60 or a velocity
    /// that is NaN.
    pub fn run_until(&mut self, end: f64) -> Result<(), ParameterError> {
        finite("time", end)?;
        accept(end >= self.time, "time", "at least the present one", end)?;
        while self.time < end {
            // The bounds are computed anew at intervals, because a cooling gas becomes slow and the driving
            // changes disks.
            let largest = |of: fn(&Disk) -> f64| self.disks.iter().map(of).fold(0.0, f64::max);
            (self.widest, self.fastest) =
                (2.0 * largest(Disk::radius), largest(|disk| disk.velocity().length()));
            for _ in 0..self.disks.len() {
                // Pairs are tried at the rate at which they would collide if all of them were as fast and
                // wide as the fastest and widest.
                let pairs = self.density * (self.disks.len() - 1) as f64 * PI;
                self.time -= libm::log(uniform(&mut self.generator)) / (pairs * self.largest_rate());
                if self.time >= end {
                    // Waiting times have no memory, so the next run draws a new waiting time.
                    self.time = end;
                    return Ok(());
                }
                self.attempt()?;
            }
        }
        Ok(())
    }

    /// Draws a pair and a direction. The pair collides with a probability equal to its rate over the largest
    /// rate.
    fn attempt(&mut self) -> Result<(), ParameterError> {
        let count = self.disks.len();
        let first = self.index(count);
        let second = (first + 1 + self.index(count - 1)) % count;
        let (sine, cosine) = libm::sincos(TAU * uniform(&mut self.generator));
        let normal = DVec2::new(cosine, sine);
        let [one, other] = [first, second].map(|disk| self.disks[disk]);
        let contact = one.radius() + other.radius();
        let closing = (other.velocity() - one.velocity()).dot(normal);
        // A pair that recedes has a negative rate, and is always refused.
        if uniform(&mut self.generator) * self.largest_rate() >= contact * closing {
            return Ok(());
        }
        let placed = |disk: Disk, place: DVec2| {
            disk.with_motion(place, disk.velocity(), disk.angle(), disk.angular_velocity())
        };
        let since = self.time - self.last[first].max(self.last[second]);
        let (one, other) = (placed(one, contact * normal), placed(other, DVec2::ZERO));
        let met = collide_after(since, &self.rule, &one, &other);
        for (disk, met) in [(first, met.first), (second, met.second)] {
            let speed = met.velocity().length();
            accept(speed <= LARGEST, "speed of a disk after a collision", "at most 1e60", speed)?;
            (self.disks[disk], self.last[disk]) = (met, self.time);
            self.fastest = self.fastest.max(speed);
        }
        self.collisions += 1;
        Ok(())
    }

    /// Returns the largest diameter times the largest closing speed of any pair.
    fn largest_rate(&self) -> f64 {
        self.widest * 2.0 * self.fastest
    }

    fn index(&mut self, count: usize) -> usize {
        (uniform(&mut self.generator) * count as f64) as usize
    }
}
