//! The schema of plans: it knows each key that the types accept, with its meaning, and all plans of the
//! documentation fit it.

#[path = "../src/cli/shape.rs"]
#[allow(dead_code, reason = "only the command asks for keys")]
mod shape;

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use granular_edmd_study::vibrated_box::VibratedBox;
use granular_edmd_study::{Experiment, Plan};
use serde::Deserialize;
use serde_json::Value;
use shape::{Kind, Shape};

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

fn schema() -> Value {
    serde_json::from_slice(&runs(&["explain", "--schema"]).stdout).unwrap()
}

/// Returns the schemas of the keys below this one, in lists and alternatives, too.
fn keys<'s>(schema: &'s Value, key: &str) -> Vec<(String, &'s Value)> {
    let below = schema["properties"].as_object().into_iter().flatten().flat_map(|(name, schema)| {
        let key = format!("{key}.{name}").trim_start_matches('.').to_owned();
        let below = keys(schema, &key);
        std::iter::once((key, schema)).chain(below)
    });
    let others = schema["anyOf"].as_array().into_iter().flatten().chain(schema.get("items"));
    below.chain(others.flat_map(|schema| keys(schema, key))).collect()
}

/// Returns the reason why a value does not fit a schema.
fn misfit(value: &Value, schema: &Value) -> Option<String> {
    if let Some(schemas) = schema["anyOf"].as_array() {
        let reasons: Option<Vec<String>> = schemas.iter().map(|schema| misfit(value, schema)).collect();
        return reasons.map(|reasons| reasons.join(" and "));
    }
    let fits = match schema["type"].as_str() {
        Some("integer") => value.is_u64(),
        Some("number") => value.is_number(),
        Some("boolean") => value.is_boolean(),
        Some("string") => value.is_string(),
        Some("array") => value.is_array(),
        Some("object") => value.is_object(),
        _ => schema["enum"].as_array().is_none_or(|choices| choices.contains(value)),
    };
    if !fits {
        return Some(format!("{value} is not {schema}"));
    }
    let mut parts = value.as_object().into_iter().flatten();
    let required = || schema["required"].as_array().into_iter().flatten().filter_map(Value::as_str);
    let absent = required().find(|name| value.get(name).is_none());
    let of_part = |(name, part): (&String, &Value)| match schema["properties"].get(name) {
        Some(schema) => misfit(part, schema),
        None => Some(format!("`{name}` is unknown")),
    };
    let mut items = value.as_array().into_iter().flatten().filter(|_| !schema["items"].is_null());
    let absent = absent.map(|name| format!("`{name}` is missing"));
    absent
        .or_else(|| parts.find_map(of_part))
        .or_else(|| items.find_map(|item| misfit(item, &schema["items"])))
}

/// Returns the plans of a page, between the marks of code.
fn plans(page: &str) -> Vec<String> {
    let blocks = page.split("```").skip(1).step_by(2).filter_map(|block| block.split_once('\n'));
    blocks.map(|(_, text)| text.to_owned()).filter(|text| text.contains("[experiment]")).collect()
}

/// Returns all plans of the package and, where it is there, of the repository.
fn all_plans() -> Vec<String> {
    let package = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut all = vec![String::from_utf8(runs(&["new"]).stdout).unwrap()];
    all.extend(plans(&fs::read_to_string(package.join("docs/guide/exercise_rolls.md")).unwrap()));
    all.extend(fs::read_to_string(package.join("../docs/reproduction/refinement/plan.toml")));
    let source = fs::read_to_string(package.join("src/plan.rs")).unwrap();
    let example = source.split("r#\"").nth(1).and_then(|text| text.split("\"#").next()).unwrap();
    all.push(example.replace("///", ""));
    all
}

/// Returns the names that a type expects, as the message of its error has them.
fn expected(message: &str) -> BTreeSet<&str> {
    if let Some((_, names)) = message.rsplit_once("available keys: ") {
        return names.trim().split(", ").collect();
    }
    let (_, names) = message.rsplit_once("expected ").unwrap_or_else(|| panic!("{message}"));
    names.split('`').skip(1).step_by(2).collect()
}

#[test]
fn each_key_of_the_schema_has_a_meaning_that_explain_tells() {
    let schema = schema();
    let all = keys(&schema, "");
    for key in ["experiment.base.thermal.slip", "ramp.refine.relative", "sweep.values.log", "repeats"] {
        assert!(all.iter().any(|(known, _)| known == key), "{key}");
    }
    for (key, schema) in all {
        let meaning = schema["description"].as_str().unwrap_or_else(|| panic!("{key} has no meaning"));
        let output = runs(&["explain", &key]);
        let told = String::from_utf8(output.stdout).unwrap();
        assert!(output.status.success() && told.contains(meaning), "{key}: {told}");
    }
}

/// The names in the messages of the types are those of the schema.
#[test]
fn the_keys_of_the_schema_are_those_that_a_plan_takes() {
    let schema = schema();
    for (group, plan) in GROUPS {
        let text = plan.replace("PLACE", "intruder = 1");
        let message = toml::from_str::<Plan<VibratedBox>>(&text).unwrap_err().to_string();
        let in_group = keys(&schema, "").into_iter().map(|(key, _)| key).filter_map(|key| {
            let name = if group.is_empty() { &key } else { key.strip_prefix(group)?.strip_prefix('.')? };
            (!name.contains('.')).then(|| name.to_owned())
        });
        let names: BTreeSet<String> = in_group.collect();
        assert_eq!(expected(&message), names.iter().map(String::as_str).collect(), "{group}: {message}");
    }
}

#[test]
fn all_plans_of_the_documentation_fit_the_schema() {
    let schema = schema();
    let plans = all_plans();
    assert!(plans.len() >= 3);
    for text in plans {
        Plan::<VibratedBox>::from_toml(&text).unwrap();
        let plan = serde_json::to_value(toml::from_str::<toml::Table>(&text).unwrap()).unwrap();
        assert_eq!(misfit(&plan, &schema), None, "{text}");
    }
    let wrong = [
        ("samples = 100", "samples = 1.5"),
        ("seed = 1", "sede = 1"),
        ("course = \"up\"", "course = 1"),
        ("disks = 200", ""),
        ("width = 30.0", "width = \"wide\""),
        ("[experiment.base.bi_parabolic]", "[experiment.base.parabolic]"),
    ];
    let text = String::from_utf8(runs(&["new"]).stdout).unwrap();
    for (right, wrong) in wrong {
        assert!(text.contains(right), "{text}");
        let plan = toml::from_str::<toml::Table>(&text.replacen(right, wrong, 1)).unwrap();
        assert!(misfit(&serde_json::to_value(plan).unwrap(), &schema).is_some(), "{wrong}");
    }
}

/// A key is required in the schema if a plan without it is refused for it.
#[test]
fn keys_are_required_as_plans_require_them() {
    let schema = schema();
    let text = String::from_utf8(runs(&["new"]).stdout).unwrap();
    let plan = toml::from_str::<toml::Table>(&text).unwrap();
    for group in ["", "experiment", "protocol", "ramp"] {
        let of = |plan: &toml::Table| match group {
            "" => plan.clone(),
            _ => plan[group].as_table().unwrap().clone(),
        };
        let required =
            if group.is_empty() { &schema["required"] } else { &schema["properties"][group]["required"] };
        let required: Vec<&str> = required.as_array().unwrap().iter().filter_map(Value::as_str).collect();
        for name in of(&plan).keys() {
            let mut rest = of(&plan);
            rest.remove(name);
            let mut changed = plan.clone();
            if group.is_empty() {
                changed = rest;
            } else {
                changed.insert(group.to_owned(), rest.into());
            }
            let made = Plan::<VibratedBox>::from_toml(&toml::to_string(&changed).unwrap());
            let is_missed =
                made.is_err_and(|error| error.to_string().contains(&format!("missing field `{name}`")));
            assert_eq!(required.contains(&name.as_str()), is_missed, "{group} {name}");
        }
    }
}

#[derive(Deserialize)]
#[expect(dead_code, reason = "its shape alone is of interest")]
struct Odd {
    below: Option<Box<Self>>,
    value: toml::Value,
    none: NoNumber,
    way: Way,
    last: bool,
}

#[derive(Deserialize)]
#[expect(dead_code, reason = "its shape alone is of interest")]
enum Way {
    Straight,
    To(f64),
    Round { turns: Vec<u32> },
    Both(u8, u8),
}

#[derive(Deserialize)]
#[serde(try_from = "u8")]
struct NoNumber;

impl TryFrom<u8> for NoNumber {
    type Error = &'static str;

    fn try_from(_: u8) -> Result<Self, &'static str> {
        Err("no number is right")
    }
}

/// A type may contain itself, look at the value before it decides, and refuse whatever it reads.
#[test]
fn odd_types_have_a_shape() {
    let kinds = |shape: &Shape| shape.parts.iter().map(|(_, part)| part.kind).collect::<Vec<_>>();
    let shape = Shape::of::<Odd>();
    assert_eq!(kinds(&shape), [Kind::Table, Kind::Any, Kind::Integer, Kind::Choice, Kind::Flag]);
    assert_eq!(kinds(&shape.parts[3].1), [Kind::Word, Kind::Number, Kind::Table, Kind::Any]);
}

/// Each name with a meaning belongs to a parameter or a column.
#[test]
fn all_meanings_of_the_box_are_explained() {
    let told = runs(&["explain"]).stdout;
    let told = std::str::from_utf8(&told).unwrap();
    let is_told = |name: &str| told.lines().any(|line| line.split([':', ' ']).next() == Some(name));
    let unknown: Vec<_> = VibratedBox::meanings().iter().filter(|(name, _)| !is_told(name)).collect();
    assert!(unknown.is_empty(), "{unknown:?}");
}
