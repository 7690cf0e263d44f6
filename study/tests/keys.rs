//! The keys of plans: each one that the types accept has a meaning, and the plans of the documentation can be
//! run.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use granular_edmd_study::Plan;
use granular_edmd_study::vibrated_box::VibratedBox;

/// A plan in which each group of keys occurs, with `PLACE` as one more key of it.
const GROUPS: [(&str, &str); 8] = [
    ("", "PLACE\nseed = 1\n"),
    ("experiment", "[experiment]\nPLACE\n"),
    ("experiment.base", "[experiment]\ndisks = 2\nwidth = 9.0\nbase.PLACE\n"),
    ("experiment.base.thermal", "[experiment]\nbase.thermal.PLACE\n"),
    ("experiment.base.sinusoidal", "[experiment]\nbase.sinusoidal.PLACE\n"),
    ("protocol", "[protocol]\nPLACE\n"),
    ("ramp", "[ramp]\nPLACE\n"),
    ("ramp.values", "[ramp]\nvalues = { PLACE }\n"),
];

fn runs(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_granular-edmd")).args(arguments).output().unwrap()
}

/// Returns the plans of a page, between the marks of code.
fn plans(page: &str) -> Vec<String> {
    let blocks = page.split("```").skip(1).step_by(2).filter_map(|block| block.split_once('\n'));
    blocks.map(|(_, text)| text.to_owned()).filter(|text| text.contains("[experiment]")).collect()
}

/// Returns the names that a type expects, as the message of its error has them.
fn expected(message: &str) -> BTreeSet<&str> {
    if let Some((_, names)) = message.rsplit_once("available keys: ") {
        return names.trim().split(", ").collect();
    }
    let (_, names) = message.rsplit_once("expected ").unwrap_or_else(|| panic!("{message}"));
    names.split('`').skip(1).step_by(2).collect()
}

/// The names in the messages of the types are those that `explain` knows, group by group.
#[test]
fn each_key_that_a_plan_takes_is_explained() {
    for (group, plan) in GROUPS {
        let text = plan.replace("PLACE", "intruder = 1");
        let message = toml::from_str::<Plan<VibratedBox>>(&text).unwrap_err().to_string();
        for name in expected(&message) {
            let key = format!("{group}.{name}").trim_start_matches('.').to_owned();
            let output = runs(&["explain", &key]);
            let told = String::from_utf8(output.stdout).unwrap();
            assert!(output.status.success() && told.contains(name), "{key}: {told}");
        }
    }
}

#[test]
fn all_plans_of_the_documentation_can_be_run() {
    let package = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut all = plans(&fs::read_to_string(package.join("docs/guide/exercise_rolls.md")).unwrap());
    all.extend(fs::read_to_string(package.join("../docs/reproduction/refinement/plan.toml")));
    assert!(!all.is_empty());
    for text in all {
        Plan::<VibratedBox>::from_toml(&text).unwrap();
    }
}

/// A new plan also names the parameters that it leaves out, and no columns.
#[test]
fn a_new_plan_names_absent_parameters() {
    let text = String::from_utf8(runs(&["new"]).stdout).unwrap();
    Plan::<VibratedBox>::from_toml(&text).unwrap();
    assert!(text.contains("\n# dynamic_friction =\n") && text.contains("\nfriction = "), "{text}");
    assert!(!text.contains("# disks =") && !text.contains("# one_roll ="), "{text}");
}
