//! Gases by random numbers: the mean energy change of any rule by sampling collisions, and direct
//! simulation of the homogeneous Boltzmann–Enskog equation.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::DVec2;
use rand_xoshiro::Xoshiro256PlusPlus;

use super::Maxwellian;
use crate::collision::{CollisionRule, collide_after};
use crate::disk::LARGEST;
use crate::quantity::{accept, finite, positive};
use crate::random::{Stream, generator, normal, uniform};
use crate::statistics::{Estimate, RunningMean};
use crate::{Disk, ParameterError};

/// Number of strata of the angle between closing and slip speed.
const STRATA: u32 = 64;
/// Number of samples per stratum in one chunk.
const SAMPLES: u32 = 64;
/// Number of collisions in one chunk, the unit of parallel work.
const CHUNK: u64 = STRATA as u64 * SAMPLES as u64;
/// Number of chunks before the error is checked for the first time, enough for a reliable error.
const FIRST_ROUND: u64 = 16;

/// A Monte Carlo average of the energy change per collision, for any rule.
///
/// In units of $`\sqrt S`$ and $`\sqrt V`$ (see [`Maxwellian`]), the closing and the slip speed are the
/// radius and the height of an isotropic vector of length $`R`$ and polar angle $`\theta`$. Samples are
/// concentrated where they matter:
///
/// - The angle is drawn uniformly, in 64 strata, so that grazing collisions get more samples than they would
///   by chance.
/// - The density of $`R^2`$ is the true density times $`R^2`$, because the energy of the relative motion, the
///   most that a collision can lose, is proportional to $`R^2`$.
///
/// A weight compensates for both choices, so the estimate is unbiased for every rule. Under a rule without a
/// speed scale, like the paper's, the only remaining scatter comes from the angle within a stratum.
///
/// Collisions come in chunks of 4096. Each chunk has its own stream of random numbers, and chunks are added
/// in order. The result therefore has the same bits on any number of threads, with and without the feature
/// `rayon`.
///
/// ```
/// use granular_edmd::collision::{Contact, Impulse, from_fn};
/// use granular_edmd::kinetic::{Maxwellian, MonteCarlo};
///
/// // Restitution that falls with the speed of the impact: no closed form.
/// let viscoelastic = from_fn(|contact: &Contact| {
///     let restitution = 1.0 / (1.0 + 0.1 * contact.closing_speed().sqrt());
///     Impulse::new((1.0 + restitution) * contact.normal_mass() * contact.closing_speed(), 0.0)
/// });
/// let estimate = MonteCarlo::new(1)
///     .with_standard_error(1e-3)?
///     .mean_energy_change(&viscoelastic, &Maxwellian::new(1.0)?);
/// assert!(estimate.standard_error() <= 1e-3);
/// assert!((estimate.mean() + 0.25).abs() < 0.02);
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MonteCarlo {
    seed: u64,
    samples: u64,
    standard_error: Option<f64>,
}

impl MonteCarlo {
    /// Creates an average over 2²⁰ collisions.
    pub const fn new(seed: u64) -> Self {
        Self { seed, samples: 1 << 20, standard_error: None }
    }

    /// Returns the same average over this number of collisions, rounded up to a multiple of 4096 and at
    /// least 4096.
    pub const fn with_samples(self, samples: u64) -> Self {
        Self { samples, ..self }
    }

    /// Returns the same average, which stops early when the standard error is this small.
    ///
    /// The error is checked after 2¹⁶ collisions and at each doubling. If the collisions run out first,
    /// [`Estimate::standard_error`] is the error that was reached.
    ///
    /// # Errors
    /// If the error is not finite and positive.
    pub fn with_standard_error(self, standard_error: f64) -> Result<Self, ParameterError> {
        Ok(Self { standard_error: Some(positive("standard error", standard_error)?), ..self })
    }

    /// Samples the mean energy change per collision ⟨dE⟩ of `rule` in `gas`, as the rule sees it: with the
    /// kinds, the radii and the relative spin of the partners.
    ///
    /// The partners have never collided before: a rule that asks for the time since their last collision gets
    /// infinity.
    pub fn mean_energy_change<R>(&self, rule: &R, gas: &Maxwellian) -> Estimate
    where
        R: CollisionRule + Sync + ?Sized,
    {
        let chunks = self.samples.div_ceil(CHUNK).max(1);
        let mut total = Sums::default();
        while total.chunks < chunks {
            let round = total.chunks.max(FIRST_ROUND).min(chunks - total.chunks);
            let round = (total.chunks..total.chunks + round).collect();
            for chunk in map(round, |chunk| Sums::of_chunk(rule, gas, self.seed, chunk)) {
                total.add(&chunk);
            }
            let error = total.average().standard_error();
            if self.standard_error.is_some_and(|wanted| error <= wanted) {
                break;
            }
        }
        total.average()
    }
}

/// Applies `work` to every item. The results are in the order of the items.
#[cfg(feature = "rayon")]
fn map<T: Send, U: Send>(items: Vec<T>, work: impl Fn(T) -> U + Send + Sync) -> Vec<U> {
    use rayon::prelude::*;
    items.into_par_iter().map(work).collect()
}

/// Applies `work` to every item. The results are in the order of the items.
#[cfg(not(feature = "rayon"))]
fn map<T, U>(items: Vec<T>, work: impl Fn(T) -> U) -> Vec<U> {
    items.into_iter().map(work).collect()
}

/// Sums of the means over chunks, and of the variances of their mean energy change.
#[derive(Default)]
struct Sums {
    chunks: u64,
    energy: f64,
    variance: f64,
}

impl Sums {
    fn of_chunk<R>(rule: &R, gas: &Maxwellian, seed: u64, chunk: u64) -> Self
    where
        R: CollisionRule + ?Sized,
    {
        let mut sums = Self { chunks: 1, ..Self::default() };
        // Few rules use the relative spin. Spins have their own stream, so that the speeds of a collision do
        // not depend on them.
        let [mut speeds, mut spins] =
            [2 * chunk, 2 * chunk + 1].map(|index| generator(seed, Stream::MonteCarlo, index));
        for stratum in 0..STRATA {
            let mut energy = RunningMean::default();
            for _ in 0..SAMPLES {
                let sample = Sample::draw(stratum, &mut speeds);
                let contact = gas.contact(sample.closing, sample.slip, normal(&mut spins));
                let impulse = rule.impulse(&contact);
                energy.push(sample.weight * impulse.energy_change(&contact));
            }
            let strata = f64::from(STRATA);
            sums.energy += energy.mean() / strata;
            sums.variance += energy.variance() / f64::from(SAMPLES) / (strata * strata);
        }
        sums
    }

    fn add(&mut self, other: &Self) {
        self.chunks += other.chunks;
        self.energy += other.energy;
        self.variance += other.variance;
    }

    fn average(&self) -> Estimate {
        let chunks = self.chunks as f64;
        let (mean, error) = (self.energy / chunks, self.variance.sqrt() / chunks);
        Estimate::independent(mean, error, self.chunks * CHUNK)
    }
}

/// A collision in scaled speeds, with its weight.
struct Sample {
    closing: f64,
    slip: f64,
    weight: f64,
}

impl Sample {
    /// Draws a collision in this stratum of the angle.
    ///
    /// The angle is uniform instead of having the density $`\tfrac12\sin\theta`$. The square of the length is
    /// chi-squared with 5 degrees of freedom instead of 3, which is the same density times $`R^2/3`$.
    fn draw(stratum: u32, generator: &mut Xoshiro256PlusPlus) -> Self {
        let angle = PI * (f64::from(stratum) + uniform(generator)) / f64::from(STRATA);
        let (sine, cosine) = libm::sincos(angle);
        let two_components = -2.0 * libm::log(uniform(generator) * uniform(generator));
        let third = normal(generator);
        let square = two_components + third * third;
        let length = square.sqrt();
        Self { closing: length * sine, slip: length * cosine, weight: FRAC_PI_2 * sine * 3.0 / square }
    }
}

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
