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
    let cases = if more_are_asked() { asked.cases } else { cases };
    ProptestConfig { cases, rng_seed, failure_persistence: None, max_shrink_iters: 2000, ..asked }
}

fn more_are_asked() -> bool {
    std::env::var_os("PROPTEST_CASES").is_some()
}

/// Returns every `stride`-th of these cases, or all of them if the environment asks for more
/// (`PROPTEST_CASES`).
///
/// In the product of two lists, a stride without a common factor with the length of the inner list goes
/// through all values of both.
pub fn few<T>(cases: impl IntoIterator<Item = T>, stride: usize) -> impl Iterator<Item = T> {
    cases.into_iter().step_by(if more_are_asked() { 1 } else { stride })
}

/// Numbers spread evenly over the decades `10^low..10^high`.
pub fn decades(low: f64, high: f64) -> impl Strategy<Value = f64> {
    (low..=high).prop_map(|exponent| 10f64.powf(exponent))
}
