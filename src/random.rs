//! The few samplers that enter a result, kept here so that no dependency can change their bits.

use rand::Rng;

/// Uniform in the interval (0, 1].
pub(crate) fn uniform<G: Rng + ?Sized>(generator: &mut G) -> f64 {
    const SCALE: f64 = 1.0 / (1u64 << 53) as f64;
    ((generator.next_u64() >> 11) as f64 + 0.5) * SCALE
}

/// Normal with mean 0 and variance 1 (Box & Muller 1958, one of the pair).
pub(crate) fn normal<G: Rng + ?Sized>(generator: &mut G) -> f64 {
    let radius = (-2.0 * libm::log(uniform(generator))).sqrt();
    radius * libm::cos(std::f64::consts::TAU * uniform(generator))
}
