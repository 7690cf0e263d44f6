//! The mean energy change of any rule, by sampling collisions.

use rand_xoshiro::Xoshiro256PlusPlus;

use super::Maxwellian;
use crate::ParameterError;
use crate::collision::CollisionRule;
use crate::quantity::positive;
use crate::random::{Stream, generator, normal, uniform};
use crate::statistics::{Estimate, RunningMean};

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
        use std::f64::consts::{FRAC_PI_2, PI};
        let angle = PI * (f64::from(stratum) + uniform(generator)) / f64::from(STRATA);
        let (sine, cosine) = libm::sincos(angle);
        let two_components = -2.0 * libm::log(uniform(generator) * uniform(generator));
        let third = normal(generator);
        let square = two_components + third * third;
        let length = square.sqrt();
        Self { closing: length * sine, slip: length * cosine, weight: FRAC_PI_2 * sine * 3.0 / square }
    }
}
