//! The JSON that a study writes: flat objects, on one line in logs, and with a line for each field in files
//! for people.

use std::fmt::{Display, Write};

/// A JSON object to which fields are added one by one.
#[derive(Debug, Default)]
pub(super) struct Object(Vec<(&'static str, String)>);

impl Object {
    /// Adds a number, or any value that is JSON already.
    pub(super) fn with(mut self, name: &'static str, value: impl Display) -> Self {
        self.0.push((name, value.to_string()));
        self
    }

    /// Adds a text.
    pub(super) fn text(self, name: &'static str, value: &str) -> Self {
        self.with(name, quoted(value))
    }

    /// Returns the object on one line.
    pub(super) fn line(&self) -> String {
        let fields: Vec<String> = self.0.iter().map(|(name, value)| format!(r#""{name}":{value}"#)).collect();
        format!("{{{}}}", fields.join(","))
    }

    /// Returns the object with a field on each line.
    pub(super) fn page(&self) -> String {
        let fields: Vec<String> =
            self.0.iter().map(|(name, value)| format!(r#"  "{name}": {value}"#)).collect();
        format!("{{\n{}\n}}\n", fields.join(",\n"))
    }
}

/// Returns the value of a field in an object of [`Object::page`], without quotation marks.
///
/// Only such objects are read, so a parser of all of JSON is not needed: it would be one more dependency.
pub(super) fn field<'a>(page: &'a str, name: &str) -> Option<&'a str> {
    let start = format!(r#""{name}": "#);
    let value = page.lines().find_map(|line| line.trim().strip_prefix(&start))?;
    Some(value.trim_end_matches(',').trim_matches('"'))
}

fn quoted(text: &str) -> String {
    let mut quoted = String::from('"');
    for letter in text.chars() {
        match letter {
            '"' | '\\' => quoted.extend(['\\', letter]),
            '\0'..' ' => {
                // Writing to a string does not fail.
                let _ = write!(quoted, "\\u{:04x}", u32::from(letter));
            }
            _ => quoted.push(letter),
        }
    }
    quoted.push('"');
    quoted
}
