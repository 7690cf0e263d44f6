//! The code that may continue a study, listed in a readable file.

use granular_edmd::boundary::Boundary;
use granular_edmd::collision::CollisionRule;
use granular_edmd::{Fingerprint, RESULTS};

use super::experiment::origin::Maker;
use super::{Difference, Experiment, Plan};

/// Returns the maker of this program's records.
pub(super) fn maker<E: Experiment>() -> Maker {
    let version = env!("CARGO_PKG_VERSION").to_owned();
    Maker { version, results: RESULTS, revision: E::revision(), columns: columns::<E>() }
}

/// Returns a fingerprint of the names and units in all tables.
fn columns<E: Experiment>() -> Fingerprint {
    let heading = |hash: Fingerprint, name: &str, unit: &str| hash.text(name).text(unit);
    let columns = E::columns().iter().fold(Fingerprint::of("columns"), |hash, column| {
        let tables = f64::from(u8::from(column.in_samples) + 2 * u8::from(column.in_values));
        heading(hash, column.name(), column.unit()).number(tables)
    });
    E::tables().iter().fold(columns, |hash, table| {
        let hash = hash.text(table.name());
        table.columns().iter().fold(hash, |hash, column| heading(hash, column.name(), column.unit()))
    })
}

/// The file `provenance.json`: the code that may continue a study, and the program that began it.
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize)]
pub(super) struct Provenance {
    results: String,
    revision: String,
    columns: String,
    rule: String,
    boundary: String,
    version: String,
    program: String,
    target: String,
    /// Hash of the plan.
    plan: String,
    /// The earlier makers that were accepted, as keys separated by blanks.
    accepted: String,
}

impl Provenance {
    /// Describes this program as the maker of the study of a plan.
    pub(super) fn here<E: Experiment>(plan: &Plan<E>, hash: &blake3::Hash) -> Self {
        let Maker { version, results, revision, columns } = maker::<E>();
        let program = std::env::current_exe().ok();
        let program = program.as_deref().and_then(|path| path.file_stem()).unwrap_or_default();
        let rule = plan.experiment.rule().ok().and_then(|rule| rule.fingerprint());
        let boundary = plan.experiment.boundary().ok().and_then(|boundary| boundary.fingerprint());
        let [rule, boundary] =
            [rule, boundary].map(|part| part.map_or_else(|| "unknown".to_owned(), |part| part.to_string()));
        Self {
            results: results.to_string(),
            revision: revision.to_string(),
            columns: columns.to_string(),
            rule,
            boundary,
            version,
            program: program.to_string_lossy().into_owned(),
            target: format!("{}-{}", std::env::consts::ARCH, std::env::consts::OS),
            plan: hash.to_hex().to_string(),
            accepted: String::new(),
        }
    }

    /// Returns the text of the file.
    pub(super) fn text(&self) -> String {
        // Texts are always JSON.
        serde_json::to_string_pretty(self).unwrap_or_default() + "\n"
    }

    /// Returns the same provenance after an earlier one, all of whose makers were accepted.
    pub(super) fn after(self, before: Option<&Self>) -> Self {
        Self { accepted: before.map_or_else(String::new, Self::keys), ..self }
    }

    /// Returns whether the study was begun with the plan of this hash.
    pub(super) fn is_of(&self, hash: &blake3::Hash) -> bool {
        self.plan == hash.to_hex().as_str()
    }

    /// Returns the deciding fields in which this program differs from the one that made the study.
    pub(super) fn differences(&self, there: Option<&Self>) -> Vec<Difference> {
        let all = self.deciding().into_iter().enumerate().map(|(place, (name, ours))| Difference {
            field: name.to_owned(),
            old: there.map(|there| there.deciding()[place].1.clone()),
            new: Some(ours.clone()),
        });
        all.filter(|field| field.old != field.new).collect()
    }

    /// Returns the fields that decide whether a program may continue the study of a plan.
    const fn deciding(&self) -> [(&'static str, &String); 5] {
        [
            ("results", &self.results),
            ("revision", &self.revision),
            ("columns", &self.columns),
            ("rule", &self.rule),
            ("boundary", &self.boundary),
        ]
    }

    /// Returns the present maker and the earlier, accepted ones, as keys separated by blanks.
    fn keys(&self) -> String {
        let Self { results, revision, columns, accepted, .. } = self;
        format!("{accepted} {results}:{revision}:{columns}").trim_start().to_owned()
    }

    /// Returns whether the study accepts records of this maker.
    pub(super) fn takes(&self, maker: &Maker) -> bool {
        self.keys().split(' ').any(|key| key == maker.key())
    }
}
