//! Fingerprints: the identity of a rule, a wall motion or a boundary, as a number that a checkpoint keeps.

use std::fmt;

/// Identity of a part of a simulation: equal for parts made alike, different for parts that act differently.
///
/// A checkpoint keeps the fingerprints of its rule and its boundary, and notices when a run is resumed with
/// others. A custom part makes its fingerprint from its name and from all numbers on which its results
/// depend. A part without a name and numbers, such as a closure, has no fingerprint, and two such parts
/// cannot be distinguished. Parts with different results must have different fingerprints, and parts made
/// alike must have equal ones; for rules, [`collision::laws::check_fingerprints`] compares the fingerprints
/// with the impulses. The hash is FNV-1a with 64 bits, over bytes in a fixed order, so it is the same on
/// every platform.
///
/// [`collision::laws::check_fingerprints`]: crate::collision::laws::check_fingerprints
///
/// ```
/// use granular_edmd::Fingerprint;
/// let mild = Fingerprint::of("Viscoelastic").number(0.1);
/// assert_eq!(mild, Fingerprint::of("Viscoelastic").number(0.1));
/// assert_ne!(mild, Fingerprint::of("Viscoelastic").number(0.2));
/// assert_ne!(Fingerprint::of("Twice").part(mild), mild);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(transparent))]
pub struct Fingerprint(u64);

const OFFSET: u64 = 0xcbf2_9ce4_8422_2325;
const PRIME: u64 = 0x0000_0100_0000_01b3;

impl Fingerprint {
    /// Creates the fingerprint of a part with this name and no parameters.
    pub const fn of(name: &str) -> Self {
        Self(OFFSET).text(name)
    }

    /// Adds a parameter that is a number.
    ///
    /// Numbers with different bits count as different, even `0.0` and `-0.0`.
    pub const fn number(self, value: f64) -> Self {
        self.bytes(&value.to_bits().to_le_bytes())
    }

    /// Adds a parameter that is a text.
    pub const fn text(self, text: &str) -> Self {
        // The length follows the text, so that ("ab", "c") and ("a", "bc") differ.
        self.bytes(text.as_bytes()).bytes(&(text.len() as u64).to_le_bytes())
    }

    /// Adds the fingerprint of a part that this part contains.
    pub const fn part(self, part: Self) -> Self {
        self.bytes(&part.0.to_le_bytes())
    }

    const fn bytes(self, bytes: &[u8]) -> Self {
        let mut hash = self.0;
        let mut rest = bytes;
        // A plain loop can run in a constant; an iterator cannot.
        while let [first, others @ ..] = rest {
            hash = (hash ^ *first as u64).wrapping_mul(PRIME);
            rest = others;
        }
        Self(hash)
    }
}

/// Writes the number as sixteen hexadecimal digits.
impl fmt::Display for Fingerprint {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{:016x}", self.0)
    }
}
