//! The meanings of the columns of tables, for `columns.csv` and the command `explain`.

use super::experiment::columns::{Column, OF_TABLES, error_names};
use super::{Experiment, Plan};

/// Returns the meaning of a column of a table of a plan; empty if the experiment gives none.
pub(super) fn of_column<E: Experiment>(plan: &Plan<E>, table: &str, column: &str) -> String {
    let whole_name = |name: &str| plan.varied().zip(&plan.varied).find(|(short, _)| *short == name);
    let parameter = |name: &str| whole_name(name).and_then(|(_, whole)| find(E::meanings(), whole));
    let side = |ending| column.strip_suffix(ending).filter(|_| table == "transitions");
    let sides = [("_near", "near side, from which the ramp came"), ("_far", "far side")];
    if let Some((name, side)) = sides.iter().find_map(|(ending, told)| Some((side(*ending)?, told))) {
        return format!("Value of {name} on the {side}.");
    }
    let own = find(&OF_TABLES, column).or_else(|| parameter(column)).or_else(|| find(E::meanings(), column));
    let own = own.map(|meaning| meaning.trim_end_matches(" Required.").to_owned());
    own.or_else(|| of_error::<E>(column)).unwrap_or_default()
}

/// Returns the meaning of one of the two columns that follow a mean.
pub(super) fn of_error<E: Experiment>(column: &str) -> Option<String> {
    E::columns().iter().filter(|mean| mean.has_error()).map(Column::name).find_map(|mean| {
        let told = ["Standard error of the mean", "Number of independent samples behind the mean"];
        let of = error_names(mean).into_iter().zip(told).find(|(name, _)| name == column);
        of.map(|(_, told)| format!("{told} of {mean}."))
    })
}

/// Returns the meaning of a name.
pub(super) fn find(meanings: &[(&str, &'static str)], name: &str) -> Option<&'static str> {
    meanings.iter().find(|(known, _)| *known == name).map(|(_, meaning)| *meaning)
}
