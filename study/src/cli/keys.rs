//! The meanings of the keys of plans, for the command `explain`, its schema, and the comments of a new plan.

use std::sync::LazyLock;

use super::shape::Shape;
use crate::experiment::columns::{Meanings, OF_TABLES, meanings};
use crate::meanings::{find, of_error};
use crate::{Column, Experiment, Table};

/// The keys that every plan has, whatever its experiment, by section.
static OF_PLANS: Meanings = LazyLock::new(|| meanings(include_str!("keys.txt")));

/// Returns the meaning of a key of a plan by its whole name, such as `protocol.settle` or
/// `experiment.friction`.
pub(super) fn of_key<E: Experiment>(key: &str) -> Option<&'static str> {
    match key.strip_prefix("experiment.") {
        Some(parameter) => find(E::meanings(), parameter),
        // A rule of values means the same in a ramp and in a sweep.
        None => find(&OF_PLANS, key).or_else(|| find(&OF_PLANS, key.split_once('.')?.1)),
    }
}

/// Explains a key, or all of them: meaning, unit, range and default.
pub(super) fn explained<E: Experiment>(key: Option<&str>) -> Result<String, String> {
    let Some(key) = key else {
        let lines = all::<E>().map(|(name, meaning)| line::<E>(name, meaning));
        return Ok(lines.collect::<Vec<_>>().join("\n"));
    };
    // `experiment.friction` and `friction` are the same key of a plan, and the end of a name is enough.
    let name = key.strip_prefix("experiment.").unwrap_or(key);
    let is_meant = |known: &str| {
        let [part, group] = [known.strip_suffix(name), known.strip_prefix(name)];
        part.is_some_and(|group| group.is_empty() || group.ends_with('.'))
            || group.is_some_and(|part| part.starts_with('.'))
    };
    let meant = all::<E>().filter(|(known, _)| is_meant(known));
    let mut meant: Vec<String> = meant.map(|(name, meaning)| line::<E>(name, meaning)).collect();
    if meant.is_empty() {
        let other = of_key::<E>(key).filter(|_| name == key).map(str::to_owned);
        let other = other.or_else(|| of_error::<E>(key));
        meant.extend(other.map(|meaning| line::<E>(key, &meaning)));
    }
    if !meant.is_empty() {
        return Ok(meant.join("\n"));
    }
    let near = |name: &str| strsim::jaro_winkler(name.rsplit('.').next().unwrap_or(name), key);
    let nearest = all::<E>().max_by(|a, b| near(a.0).total_cmp(&near(b.0)));
    let nearest = nearest.map_or_else(String::new, |(name, _)| format!("; the nearest is `{name}`"));
    Err(format!("there is no key `{key}`{nearest}; `explain` without a key lists all"))
}

/// Returns all names with their meanings, except for names that are neither parameters nor columns.
fn all<E: Experiment>() -> impl Iterator<Item = (&'static str, &'static str)> {
    let (shape, columns, tables) = (Shape::of::<E>(), E::columns(), E::tables());
    let exists = move |name: &str| {
        shape.has(name)
            || columns.iter().any(|column| column.name() == name)
            || tables.iter().flat_map(Table::columns).any(|heading| heading.name() == name)
    };
    let own = E::meanings().iter().copied().filter(move |(name, _)| exists(name));
    OF_PLANS.iter().copied().chain(own).chain(OF_TABLES.iter().copied())
}

/// Returns the name with the unit of its column, and the meaning.
fn line<E: Experiment>(name: &str, meaning: &str) -> String {
    let columns = E::columns();
    match columns.iter().find(|column| column.name() == name).map(Column::unit) {
        Some(unit) if !unit.is_empty() => format!("{name} [{unit}]: {meaning}"),
        _ => format!("{name}: {meaning}"),
    }
}

#[cfg(test)]
mod tests {
    use granular_edmd::boundary::Container;
    use granular_edmd::collision::Elastic;
    use granular_edmd::observable::Snapshot;
    use granular_edmd::{Disk, Fingerprint};
    use serde::{Deserialize, Serialize};

    use super::*;
    use crate::ExperimentError;
    use crate::vibrated_box::VibratedBox;

    #[derive(Clone, Serialize, Deserialize)]
    struct Gas {
        width: f64,
        disks: Vec<Size>,
    }

    #[derive(Clone, Serialize, Deserialize)]
    struct Size {
        radius: f64,
    }

    impl Experiment for Gas {
        type Rule = Elastic;
        type Boundary = Container;
        type Observer = ();
        type Sample = f64;

        fn meanings() -> &'static [(&'static str, &'static str)] {
            &[
                ("width", "Width."),
                ("disks", "Disks."),
                ("disks.radius", "Radius."),
                ("speed", "Mean speed."),
                ("widht", "Misspelled."),
                ("disks.mass", "Removed."),
            ]
        }
        fn revision() -> Fingerprint {
            Fingerprint::of("Gas")
        }
        fn rule(&self) -> Result<Elastic, ExperimentError> {
            Ok(Elastic)
        }
        fn boundary(&self) -> Result<Container, ExperimentError> {
            Ok(Container::closed(self.width, 10.0)?)
        }
        fn disks(&self, _: u64) -> Result<Vec<Disk>, ExperimentError> {
            Ok(Vec::new())
        }
        fn observer(&self) -> Result<(), ExperimentError> {
            Ok(())
        }
        fn sample(&self, snapshot: &Snapshot<'_>, (): &mut ()) -> f64 {
            snapshot.mean(|disk| disk.velocity().length())
        }
        fn columns() -> Vec<Column<Self>> {
            vec![Column::sampled("speed", "length/time", |speed: &f64| *speed)]
        }
    }

    /// A misspelled name has a meaning, but a plan with it would be refused.
    #[test]
    fn only_parameters_and_columns_are_explained() {
        let told = explained::<Gas>(None).unwrap();
        for (name, is_known) in
            [("width", true), ("disks.radius", true), ("widht", false), ("disks.mass", false)]
        {
            assert_eq!(told.contains(&format!("\n{name}: ")), is_known, "{told}");
            assert_eq!(explained::<Gas>(Some(name)).is_ok(), is_known, "{name}");
            assert_eq!(explained::<Gas>(Some(&format!("experiment.{name}"))).is_ok(), is_known, "{name}");
        }
        assert_eq!(explained::<Gas>(Some("speed")).unwrap(), "speed [length/time]: Mean speed.");
        let nearest = explained::<Gas>(Some("widht")).unwrap_err();
        assert!(nearest.contains("there is no key `widht`; the nearest is `width`"), "{nearest}");
        assert!(unknown::<VibratedBox>().is_empty(), "{:?}", unknown::<VibratedBox>());
    }

    /// Returns the names with a meaning that are not explained.
    fn unknown<E: Experiment>() -> Vec<&'static str> {
        let told = explained::<E>(None).unwrap();
        let names = E::meanings().iter().map(|(name, _)| *name);
        let is_told = |name: &str| told.lines().any(|line| line.split([':', ' ']).next() == Some(name));
        names.filter(|name| !is_told(name)).collect()
    }
}
