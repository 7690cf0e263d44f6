//! The samplers on which trajectories depend. They are part of this crate, so that no dependency can change
//! their bits.

use rand::Rng;

/// Draws a number uniformly from the open interval (0, 1).
pub(crate) fn uniform<G: Rng + ?Sized>(generator: &mut G) -> f64 {
    // The samples are the middles of 2⁵² equal intervals. Neither 0 nor 1 is drawn, so a logarithm of the
    // result is finite.
    const SCALE: f64 = 1.0 / (1u64 << 52) as f64;
    ((generator.next_u64() >> 12) as f64 + 0.5) * SCALE
}

/// Draws a normal variable of mean 0 and variance 1 (Box & Muller 1958, one variable of the pair).
pub(crate) fn normal<G: Rng + ?Sized>(generator: &mut G) -> f64 {
    let radius = rayleigh(generator);
    radius * libm::cos(std::f64::consts::TAU * uniform(generator))
}

/// Draws a Rayleigh variable, with the density v·exp(−v²/2). It is the normal speed of a disk of mass 1 that
/// leaves a wall of temperature 1.
pub(crate) fn rayleigh<G: Rng + ?Sized>(generator: &mut G) -> f64 {
    (-2.0 * libm::log(uniform(generator))).sqrt()
}
