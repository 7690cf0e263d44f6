//! Random numbers: the streams of all parts that draw them, and the samplers on which trajectories depend.
//!
//! A part that takes a seed draws from its own [`Stream`], so the same seed in every part of a run gives
//! independent numbers. The map from a seed, a stream and an index to a generator never changes, nor do the
//! samplers: they are part of this crate, so that no dependency can change their bits. Numbers that are drawn
//! during a run also follow from *when* they are drawn (the time of a kick, the count of a disk's
//! collisions), and not from what was drawn before.
//!
//! A custom part draws from a stream with a number of its choice:
//!
//! ```
//! use granular_edmd::random::{Stream, generator, normal, uniform};
//!
//! let mut wind = generator(42, Stream::Custom(1), 0);
//! let mut gusts = generator(42, Stream::Custom(1), 1);
//! assert_ne!(uniform(&mut wind), uniform(&mut gusts));
//! assert!(normal(&mut wind).is_finite());
//! ```

use rand::{Rng, SeedableRng};
pub use rand_xoshiro::Xoshiro256PlusPlus;

/// Defines the streams, the list of them and their numbers, so that no stream can be missing from the list.
macro_rules! streams {
    ($($(#[$doc:meta])* $name:ident = $number:literal),+) => {
        /// The streams of random numbers, one for each kind of part that takes a seed.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        #[non_exhaustive]
        pub enum Stream {
            $($(#[$doc])* $name,)+
            /// A custom part with this number.
            Custom(u32),
        }

        impl Stream {
            /// All streams of the library.
            pub const ALL: &[Self] = &[$(Self::$name),+];

            const fn number(self) -> u64 {
                match self {
                    $(Self::$name => $number,)+
                    Self::Custom(number) => 1 << 32 | number as u64,
                }
            }
        }
    };
}

// The numbers never change.
streams! {
    /// Positions: [`scattered`](crate::initial::scattered()) and
    /// [`scattered_mix`](crate::initial::scattered_mix).
    Places = 1,
    /// Packings: [`packed_mix`](crate::initial::packed_mix).
    Packing = 2,
    /// Velocities: [`with_maxwellian_velocities`](crate::initial::with_maxwellian_velocities).
    Velocities = 3,
    /// Radii: [`Radii::draw`](crate::initial::Radii::draw).
    Radii = 4,
    /// Stochastic walls: [`SimulationBuilder::seed`](crate::simulation::SimulationBuilder::seed).
    Walls = 5,
    /// Random kicks: [`WhiteNoise`](crate::simulation::WhiteNoise).
    Noise = 6,
    /// Inlets: [`Inlet`](crate::simulation::Inlet).
    Inlets = 7,
    /// Direct simulation: [`DirectSimulation`](crate::kinetic::DirectSimulation).
    DirectSimulation = 8,
    /// Averages over collisions: [`MonteCarlo`](crate::kinetic::MonteCarlo).
    MonteCarlo = 9,
    /// Drivings and clusterings of the package `granular-edmd-study`.
    Studies = 10
}

/// Increment of SplitMix64: 2⁶⁴ over the golden ratio.
const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;

/// Returns the seed that follows from a seed for this part of a stream.
///
/// It gives a part of several members, such as a study with many runs, a seed for each. With
/// $`m`$ for the finalizer of SplitMix64 and $`\gamma`$ for its increment, the derived seed is
/// $`m(\gamma + (i \oplus m(\gamma + (n \oplus m(\gamma + s)))))`$ for the seed $`s`$, the number $`n`$ of
/// the stream and the index $`i`$. For one seed and stream, different indices give different seeds.
///
/// Source: G. L. Steele, D. Lea and C. H. Flood, Fast splittable pseudorandom number generators, OOPSLA 2014.
///
/// ```
/// use granular_edmd::random::{Stream, derived_seed};
/// assert_ne!(derived_seed(1, Stream::Noise, 0), derived_seed(1, Stream::Walls, 0));
/// ```
pub const fn derived_seed(seed: u64, stream: Stream, index: u64) -> u64 {
    let seed = mixed(seed);
    let part = mixed(seed ^ stream.number());
    mixed(part ^ index)
}

/// Returns the generator of a seed for this part of a stream.
///
/// Its state is the first four numbers of SplitMix64 after [`derived_seed`].
///
/// Source: D. Blackman and S. Vigna, ACM Trans. Math. Softw. **47**, 36 (2021).
pub fn generator(seed: u64, stream: Stream, index: u64) -> Xoshiro256PlusPlus {
    let seed = derived_seed(seed, stream, index);
    let mut state = [0; 32];
    for (word, bytes) in (0..).zip(state.as_chunks_mut().0) {
        *bytes = mixed(seed.wrapping_add(GOLDEN.wrapping_mul(word))).to_le_bytes();
    }
    Xoshiro256PlusPlus::from_seed(state)
}

/// Returns the generator for what a member of a stream draws at this time.
pub(crate) fn generator_at(seed: u64, stream: Stream, member: u64, time: f64) -> Xoshiro256PlusPlus {
    generator(derived_seed(seed, stream, member), stream, time.to_bits())
}

/// Returns the output of SplitMix64 in this state.
const fn mixed(state: u64) -> u64 {
    let state = state.wrapping_add(GOLDEN);
    let state = (state ^ (state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let state = (state ^ (state >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    state ^ (state >> 31)
}

/// Draws a number uniformly from the open interval (0, 1).
pub fn uniform<G: Rng + ?Sized>(generator: &mut G) -> f64 {
    // The samples are the middles of 2⁵² equal intervals. Neither 0 nor 1 is drawn, so a logarithm of the
    // result is finite.
    const SCALE: f64 = 1.0 / (1u64 << 52) as f64;
    ((generator.next_u64() >> 12) as f64 + 0.5) * SCALE
}

/// Draws a normal variable of mean 0 and variance 1 (Box & Muller 1958, one variable of the pair).
pub fn normal<G: Rng + ?Sized>(generator: &mut G) -> f64 {
    let radius = rayleigh(generator);
    radius * libm::cos(std::f64::consts::TAU * uniform(generator))
}

/// Draws a Rayleigh variable, with the density v·exp(−v²/2). It is the normal speed of a disk of mass 1 that
/// leaves a wall of temperature 1.
pub fn rayleigh<G: Rng + ?Sized>(generator: &mut G) -> f64 {
    (-2.0 * libm::log(uniform(generator))).sqrt()
}
