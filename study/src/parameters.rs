//! Parameters of any serializable type, by name.

use serde::Serialize;
use serde::de::DeserializeOwned;
use toml::{Table, Value};

use super::Scalar;
use super::errors::{Difference, PlanError, shortened};

/// Returns the parameters of an experiment as a tree of names.
pub(super) fn tree(experiment: &impl Serialize) -> Result<Table, PlanError> {
    Table::try_from(experiment).map_err(|error| PlanError::toml(&error))
}

/// Creates an experiment from a tree of names.
pub(super) fn experiment<E: DeserializeOwned>(tree: Table) -> Result<E, String> {
    E::deserialize(Value::Table(tree)).map_err(|error| shortened(&error.to_string()))
}

/// Returns the whole names of all parameters, with dots between the names of groups and fields.
pub(super) fn names(tree: &Table) -> Vec<String> {
    let mut names = Vec::new();
    for (name, value) in tree {
        match value {
            Value::Table(inner) => {
                names.extend(self::names(inner).iter().map(|inner| format!("{name}.{inner}")));
            }
            _ => names.push(name.clone()),
        }
    }
    names
}

/// Returns a parameter by its whole name.
pub(super) fn get<'a>(tree: &'a Table, name: &str) -> Option<&'a Value> {
    match name.split_once('.') {
        None => tree.get(name),
        Some((first, rest)) => get(tree.get(first)?.as_table()?, rest),
    }
}

/// Sets a parameter by its whole name; returns false if one of the names before the last does not name a
/// group.
#[must_use]
pub(super) fn set(tree: &mut Table, name: &str, to: &Scalar) -> bool {
    match name.split_once('.') {
        None => Value::try_from(to).map(|to| tree.insert(name.to_owned(), to)).is_ok(),
        Some((first, rest)) => {
            let group = tree.entry(first).or_insert_with(|| Value::Table(Table::new()));
            group.as_table_mut().is_some_and(|group| set(group, rest, to))
        }
    }
}

/// Returns the whole name of a parameter. The name after the last dot is enough if no other parameter has it.
///
/// An unknown name is returned unchanged, since the parameter may have no value yet.
pub(super) fn whole_name(tree: &Table, name: &str) -> Result<String, PlanError> {
    if get(tree, name).is_some() {
        return Ok(name.to_owned());
    }
    let ending = format!(".{name}");
    let mut found: Vec<String> = names(tree).into_iter().filter(|whole| whole.ends_with(&ending)).collect();
    match found.len() {
        0 => Ok(name.to_owned()),
        1 => Ok(found.remove(0)),
        _ => Err(PlanError::Refused(format!("`{name}` may be any of {}", found.join(", ")))),
    }
}

/// Sets a parameter of an experiment, and returns the value that the experiment then has. The error names the
/// reason: there is no such parameter, or the experiment refuses the value.
pub(super) fn probe<E: Serialize + DeserializeOwned>(
    base: &Table,
    parameter: &str,
    name: &str,
    to: &Scalar,
) -> Result<Scalar, PlanError> {
    let known = get(base, name);
    let to = known.and_then(Scalar::of_toml).map_or_else(|| to.clone(), |known| to.clone().like(&known));
    let mut changed = base.clone();
    let unknown = |reason: &str| {
        let known = names(base).join(", ");
        PlanError::Refused(format!("there is no parameter `{parameter}` ({reason}); there are {known}"))
    };
    if !set(&mut changed, name, &to) {
        return Err(unknown("a part of its name is that of a parameter without parts"));
    }
    let refused = |reason: String| match known {
        Some(_) => PlanError::Experiment { place: place(&[(parameter, to.clone())]), source: reason.into() },
        None => unknown(&reason),
    };
    let read = experiment::<E>(changed).map_err(refused)?;
    let found = get(&tree(&read)?, name).and_then(Scalar::of_toml);
    found.ok_or_else(|| unknown("the experiment ignores it"))
}

/// Returns the names and values of parameters as the text of an error.
pub(super) fn place(varied: &[(&str, Scalar)]) -> String {
    let varied: Vec<String> = varied.iter().map(|(name, value)| format!("{name} = {value}")).collect();
    if varied.is_empty() { String::new() } else { format!(" at {}", varied.join(", ")) }
}

/// Returns the fields in which two trees differ.
pub(super) fn differences(old: &Table, new: &Table) -> Vec<Difference> {
    let mut found = Vec::new();
    collect_differences("", old, new, &mut found);
    found
}

fn collect_differences(prefix: &str, old: &Table, new: &Table, found: &mut Vec<Difference>) {
    let added = new.keys().filter(|name| !old.contains_key(*name));
    for name in old.keys().chain(added) {
        let field = format!("{prefix}{name}");
        match (old.get(name), new.get(name)) {
            (Some(Value::Table(old)), Some(Value::Table(new))) => {
                collect_differences(&format!("{field}."), old, new, found);
            }
            (old, new) if old == new => {}
            (old, new) => {
                let [old, new] = [old, new].map(|value| value.map(ToString::to_string));
                found.push(Difference { field, old, new });
            }
        }
    }
}
