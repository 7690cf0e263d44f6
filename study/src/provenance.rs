//! The code that may continue a study, listed in a readable file.

use granular_edmd::boundary::Boundary;
use granular_edmd::collision::CollisionRule;
use granular_edmd::{Fingerprint, RESULTS};

use super::json::{self, Object};
use super::maker::Maker;
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
#[derive(Debug, Clone)]
pub(super) struct Provenance(String);

/// Name of the field with earlier makers that were accepted.
const ACCEPTED: &str = "accepted";

/// Name of the field with the hash of the plan.
const PLAN: &str = "plan";

impl Provenance {
    /// Describes this program as the maker of the study of a plan, after the earlier, accepted ones.
    pub(super) fn here<E: Experiment>(plan: &Plan<E>, hash: &blake3::Hash, accepted: &str) -> Self {
        let program = std::env::current_exe().ok();
        let program = program.as_deref().and_then(|path| path.file_stem()).unwrap_or_default();
        let deciding = deciding(plan).into_iter();
        let page = deciding.fold(Object::default(), |page, (name, value)| page.text(name, &value));
        let page = page.text("version", env!("CARGO_PKG_VERSION"));
        let page = page.text("program", &program.to_string_lossy());
        let page = page.text("target", &format!("{}-{}", std::env::consts::ARCH, std::env::consts::OS));
        Self(page.text(PLAN, hash.to_hex().as_str()).text(ACCEPTED, accepted).page())
    }

    /// Wraps the text of the file unchanged.
    pub(super) const fn of_text(text: String) -> Self {
        Self(text)
    }

    pub(super) fn text(&self) -> &str {
        &self.0
    }

    /// Returns whether the file exists.
    pub(super) fn is_there(&self) -> bool {
        !self.0.is_empty()
    }

    /// Returns whether the study was begun with the plan of this hash.
    pub(super) fn is_of(&self, hash: &blake3::Hash) -> bool {
        json::field(&self.0, PLAN) == Some(hash.to_hex().as_str())
    }

    /// Returns those deciding fields in which this program differs.
    pub(super) fn differences<E: Experiment>(&self, plan: &Plan<E>) -> Vec<Difference> {
        let ours = deciding(plan).into_iter();
        let both = ours.map(|(name, ours)| (name, json::field(&self.0, name).map(str::to_owned), ours));
        both.filter(|(_, old, new)| old.as_ref() != Some(new))
            .map(|(name, old, new)| Difference { field: name.to_owned(), old, new: Some(new) })
            .collect()
    }

    /// Returns the present maker and the earlier, accepted ones, as keys separated by blanks.
    pub(super) fn keys(&self) -> String {
        let of = |name| json::field(&self.0, name).unwrap_or_default();
        let present = format!("{}:{}:{}", of("results"), of("revision"), of("columns"));
        format!("{} {present}", of(ACCEPTED)).trim_start().to_owned()
    }

    /// Returns whether the study accepts records of this maker.
    pub(super) fn takes(&self, maker: &Maker) -> bool {
        self.keys().split(' ').any(|key| key == maker.key())
    }
}

/// Returns the fields that decide whether a program may continue the study of a plan: the fields of its
/// maker, and the fingerprints of rule and walls at the parameters of the plan.
fn deciding<E: Experiment>(plan: &Plan<E>) -> Vec<(&'static str, String)> {
    let rule = plan.experiment.rule().ok().and_then(|rule| rule.fingerprint());
    let boundary = plan.experiment.boundary().ok().and_then(|boundary| boundary.fingerprint());
    let told = |part: Option<Fingerprint>| part.map_or_else(|| "unknown".to_owned(), |part| part.to_string());
    let parts = [("rule", told(rule)), ("boundary", told(boundary))];
    maker::<E>().deciding().into_iter().chain(parts).collect()
}
