//! The few samplers that enter a trajectory. They are part of this crate, so that no dependency can change
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

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_xoshiro::Xoshiro256PlusPlus;

    /// A change of these bits changes trajectories. It must be announced under "Results" in the changelog.
    #[test]
    fn samplers_keep_their_bits() {
        let mut generator = Xoshiro256PlusPlus::seed_from_u64(1);
        let drawn = [uniform(&mut generator), normal(&mut generator), rayleigh(&mut generator)];
        assert_eq!(drawn.map(f64::to_bits), GOLDEN, "{drawn:?}");
    }

    const GOLDEN: [u64; 3] =
        [4_605_485_571_977_896_057, 4_603_735_790_719_543_685, 4_605_067_216_354_676_565];

    #[test]
    fn moments_are_those_of_the_distributions() {
        let mut generator = Xoshiro256PlusPlus::seed_from_u64(2);
        let count = 200_000;
        let mut sums = [0.0; 3];
        for _ in 0..count {
            let (gauss, speed) = (normal(&mut generator), rayleigh(&mut generator));
            sums[0] += gauss;
            sums[1] += gauss * gauss;
            sums[2] += speed * speed;
        }
        let [mean, variance, flux] = sums.map(|sum| sum / f64::from(count));
        // The standard errors are 0.0022, 0.0032 and 0.0045; each bound is five of them.
        assert!(mean.abs() < 0.011 && (variance - 1.0).abs() < 0.016 && (flux - 2.0).abs() < 0.023);
    }
}
