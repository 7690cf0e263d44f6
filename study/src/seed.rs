//! Seeds that follow from another seed, and numbers that have no influence on results.

use std::hash::{BuildHasher, Hasher, RandomState};

use super::Scalar;

/// Returns the seed that follows from a seed and this index.
pub(super) fn derived_seed(seed: u64, index: u64) -> u64 {
    derived(seed, &index.to_le_bytes())
}

/// Returns the seed that follows from a seed and the value of a parameter.
pub(super) fn seed_at(seed: u64, parameter: &str, value: &Scalar) -> u64 {
    let seed = derived(seed, parameter.as_bytes());
    match value {
        // Both zeros are one value.
        Scalar::Number(number) => derived(seed, &(number + 0.0).to_bits().to_le_bytes()),
        other => derived(seed, other.to_string().as_bytes()),
    }
}

/// Returns the first eight bytes of the hash of a seed and these bytes.
fn derived(seed: u64, bytes: &[u8]) -> u64 {
    let hash = blake3::Hasher::new().update(&seed.to_le_bytes()).update(bytes).finalize();
    u64::from_le_bytes(hash.as_bytes().as_chunks().0[0])
}

/// Returns a random index below this number, or 0. It has no influence on results.
pub(super) fn anywhere(count: usize) -> usize {
    // The standard library seeds its hash tables from the system: a random number that needs no dependency.
    let random = RandomState::new().build_hasher().finish();
    random.checked_rem(count as u64).unwrap_or(0) as usize
}
