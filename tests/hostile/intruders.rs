//! Values with one field too many, which are refused by name.

use std::fmt::Debug;

use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::{Value, json};

/// Adds a superfluous field to each object of a value, in turn.
fn with_intruders(value: &Value) -> Vec<Value> {
    match value {
        Value::Object(fields) => {
            let mut all = vec![value.clone()];
            all[0]["intruder"] = json!(1);
            for (name, field) in fields {
                all.extend(with_intruders(field).into_iter().map(|changed| {
                    let mut whole = value.clone();
                    whole[name] = changed;
                    whole
                }));
            }
            all
        }
        Value::Array(items) => {
            let changed = |(at, item)| {
                with_intruders(item).into_iter().map(move |changed| {
                    let mut whole = value.clone();
                    whole[at] = changed;
                    whole
                })
            };
            items.iter().enumerate().take(2).flat_map(changed).collect()
        }
        _ => Vec::new(),
    }
}

pub(crate) fn refuses<T: Serialize + DeserializeOwned + PartialEq + Debug>(sound: &T) {
    let value = serde_json::to_value(sound).unwrap();
    assert_eq!(&serde_json::from_value::<T>(value.clone()).unwrap(), sound);
    refuses_intruders::<T>(&value);
}

pub(crate) fn refuses_intruders<T: DeserializeOwned>(value: &Value) {
    let intruders = with_intruders(value);
    assert!(!intruders.is_empty(), "{value}");
    for changed in intruders {
        let error = serde_json::from_value::<T>(changed.clone()).err().map(|error| error.to_string());
        let error = error.unwrap_or_else(|| panic!("{changed}"));
        // A field beside the name of a choice is a second choice. A field beside the numbers of walls is not
        // a number.
        let reasons = ["intruder", "single key", "key to be a number"];
        assert!(reasons.iter().any(|reason| error.contains(reason)), "{error}: {changed}");
    }
}
