//! The origin of a record: its study, the code that made it, its place, and the direction of its ramp.

use std::fmt;

use granular_edmd::Fingerprint;

/// The study, ramp and value to which a file belongs.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Origin {
    /// Hash of the plan.
    pub(crate) study: [u8; 32],
    pub(crate) maker: Maker,
    pub(crate) ramp: usize,
    pub(crate) value: usize,
    pub(crate) seed: u64,
}

/// The code that made a record.
///
/// Two makers with the same results number, revision and columns give the same results, whatever their
/// versions are.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Maker {
    /// Version of this crate.
    pub(crate) version: String,
    /// The crate's [`RESULTS`](granular_edmd::RESULTS).
    pub(crate) results: u32,
    /// The revision of the experiment.
    pub(crate) revision: Fingerprint,
    /// Fingerprint of the names and units in all tables. An experiment need not declare a change of these.
    pub(crate) columns: Fingerprint,
}

impl Maker {
    /// Returns, in one word, the numbers that decide whether a study accepts the code.
    pub(crate) fn key(&self) -> String {
        format!("{}:{}:{}", self.results, self.revision, self.columns)
    }
}

/// Formats a record's maker for a cell of a table.
impl fmt::Display for Maker {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { version, results, revision, .. } = self;
        write!(formatter, "{version} results={results} revision={revision}")
    }
}

/// The direction from which a ramp comes to a value.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Leg {
    /// From below.
    Up,
    /// From above.
    Down,
}

impl fmt::Display for Leg {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.pad(match self {
            Self::Up => "up",
            Self::Down => "down",
        })
    }
}
