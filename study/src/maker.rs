//! The identity of the code that made a record.

use std::fmt;

use granular_edmd::Fingerprint;

/// The code that made a record.
///
/// Two makers with the same results number, revision and columns give the same results, whatever their
/// versions are.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Maker {
    /// Version of this crate.
    pub(super) version: String,
    /// The crate's [`RESULTS`](granular_edmd::RESULTS).
    pub(super) results: u32,
    /// The revision of the experiment.
    pub(super) revision: Fingerprint,
    /// Fingerprint of the names and units in all tables. An experiment need not declare a change of these.
    pub(super) columns: Fingerprint,
}

impl Maker {
    /// Returns, in one word, the numbers that decide whether a study accepts the code.
    pub(super) fn key(&self) -> String {
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
