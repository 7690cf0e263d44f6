//! Kinds by the names that a file gives them.

use super::ReadError;
use super::lines::as_whole;
use super::table::Table;

/// Returns the numbers of the kinds with these names: the names themselves if all are numbers, or else their
/// positions in alphabetical order, which are the same for all frames with these names.
pub(super) fn of_names(table: &Table) -> Result<Vec<u16>, ReadError> {
    let names = table.names();
    let ordered = ordered(table);
    let kind = |name: &&str| match &ordered {
        Some(ordered) => ordered.binary_search(name).ok().and_then(|place| u16::try_from(place).ok()),
        None => as_whole(name),
    };
    let kinds: Option<Vec<u16>> = names.iter().map(kind).collect();
    let found = names.len().to_string();
    kinds.ok_or_else(|| {
        ReadError::unexpected(table.line, "the number of names of kinds", "at most 65536", found)
    })
}

/// Returns the kind names, sorted, or `None` if all of them are numbers.
pub(super) fn ordered(table: &Table) -> Option<Vec<&str>> {
    let mut names = table.names();
    names.sort_unstable();
    names.iter().any(|name| as_whole::<u16>(name).is_none()).then_some(names)
}
