//! Seeds that follow from another seed.

/// Returns the seed that follows from a seed and this index.
pub(super) fn derived_seed(seed: u64, index: u64) -> u64 {
    let bytes = [seed.to_le_bytes(), index.to_le_bytes()].concat();
    let hash = blake3::hash(&bytes);
    let mut first = [0; 8];
    first.copy_from_slice(&hash.as_bytes()[..8]);
    u64::from_le_bytes(first)
}
