//! The meanings of the columns of tables, for `columns.csv` and the command `explain`.

use super::experiment::columns::{Column, error_names};
use super::{Experiment, Plan};

/// The columns that the tables of every study have.
pub(super) const OF_TABLES: [(&str, &str); 15] = [
    ("ramp", "Index of the ramp, counted from 0. The repeats of a point are ramps that follow one another."),
    ("value", "Index of the value in its ramp, counted from 0."),
    ("leg", "Direction from which the ramp comes to the value: up or down. Empty without a ramp."),
    ("repeat", "Index of the repeat of the point, counted from 0."),
    ("point", "Index of the point: all repeats of the same parameters together."),
    ("repeats", "Number of finished repeats of the point, failed ones among them."),
    ("failed", "Number of repeats that stalled, failed or reached a limit."),
    ("seed", "Seed of the ramp, in hexadecimal digits behind a letter."),
    (
        "made_by",
        "Program that made the value: its version, the number of its results, and the revision of the experiment.",
    ),
    ("outcome", "`completed`, or `stopped`, `stalled`, `limited` or `failed`."),
    ("samples", "Number of samples of the value."),
    ("time", "Time of the sample since the start of the ramp."),
    ("from_state", "State on the side from which the ramp came to the transition."),
    ("to_state", "State on the far side of the transition; empty if none is known."),
    (
        "not_converged",
        "Names of the columns whose error is only a lower bound, since they have too few independent samples.",
    ),
];

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
