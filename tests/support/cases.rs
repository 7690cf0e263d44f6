//! The number of random cases, and their choice.

use proptest::prelude::*;
use proptest::test_runner::RngSeed;

/// Returns a configuration with the same cases on every run and machine, unless the environment asks for more
/// (`PROPTEST_CASES`) or others (`PROPTEST_RNG_SEED`).
pub fn config(cases: u32) -> ProptestConfig {
    let asked = ProptestConfig::default();
    let rng_seed = match asked.rng_seed {
        RngSeed::Random => RngSeed::Fixed(72_011_305),
        given @ RngSeed::Fixed(_) => given,
    };
    let cases = if std::env::var_os("PROPTEST_CASES").is_some() { asked.cases } else { cases };
    ProptestConfig { cases, rng_seed, failure_persistence: None, max_shrink_iters: 2000, ..asked }
}

/// Numbers spread evenly over the decades `10^low..10^high`.
pub fn decades(low: f64, high: f64) -> impl Strategy<Value = f64> {
    (low..=high).prop_map(|exponent| 10f64.powf(exponent))
}
