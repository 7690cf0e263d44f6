//! The JSON schema of plans, by which editors complete and check them.

use serde_json::{Map, Value, json};

use super::keys::of_key;
use super::shape::{Kind, Shape};
use crate::plan::steps::Steps;
use crate::{Experiment, Plan};

/// Returns the schema of the plans of an experiment.
pub(super) fn schema<E: Experiment>() -> Value {
    let mut schema = of::<E>("", &Shape::of::<Plan<E>>());
    schema["$schema"] = "http://json-schema.org/draft-07/schema#".into();
    schema["title"] = "A plan of a study".into();
    schema
}

/// Returns the schema of the values of a key.
fn of<E: Experiment>(key: &str, shape: &Shape) -> Value {
    let mut schema = match shape.kind {
        Kind::Flag => json!({ "type": "boolean" }),
        Kind::Integer => json!({ "type": "integer" }),
        Kind::Number => json!({ "type": "number" }),
        Kind::Text => json!({ "type": "string" }),
        Kind::List => {
            let items: Vec<Value> = shape.parts.iter().map(|(_, item)| of::<E>(key, item)).collect();
            json!({ "type": "array", "items": items.first() })
        }
        Kind::Table | Kind::Choice => group::<E>(key, shape),
        Kind::Any if key.ends_with(".values") => {
            json!({ "anyOf": [{ "type": "array" }, of::<E>(key, &Shape::of::<Steps>())] })
        }
        Kind::Any | Kind::Word | Kind::Unknown => json!({}),
    };
    if let Some(meaning) = of_key::<E>(key) {
        schema["description"] = meaning.into();
    }
    schema
}

/// Returns the schema of a table or a choice.
fn group<E: Experiment>(key: &str, shape: &Shape) -> Value {
    let whole = |name: &str| format!("{key}.{name}").trim_start_matches('.').to_owned();
    let names = || shape.parts.iter().map(|(name, _)| *name);
    if shape.parts.iter().all(|(_, part)| part.kind == Kind::Word) {
        return json!({ "enum": names().collect::<Vec<_>>() });
    }
    let parts = shape.parts.iter();
    let properties: Map<String, Value> =
        parts.map(|(name, part)| ((*name).to_owned(), of::<E>(&whole(name), part))).collect();
    let mut schema = json!({ "type": "object", "properties": properties, "additionalProperties": false });
    if shape.kind == Kind::Choice {
        schema["minProperties"] = 1.into();
        schema["maxProperties"] = 1.into();
    } else {
        let is_required =
            |name: &&str| of_key::<E>(&whole(name)).is_some_and(|told| told.ends_with("Required."));
        schema["required"] = names().filter(is_required).collect();
    }
    schema
}
