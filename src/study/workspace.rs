//! The folder of a study as a workspace, with a folder for each ramp before anything is done, and a file of
//! its parameters there.

use std::fmt::Write;
use std::fs;

use super::errors::StudyError;
use super::lock::Lock;
use super::{Experiment, Plan, Scalar, Study, file};

/// Name of the file with the parameters of a ramp, in its folder.
const VALUE: &str = "value.json";

impl<E: Experiment> Study<E> {
    /// Creates the folders of all ramps, each with its swept parameters in a file `value.json`, for workflow
    /// engines that go by folders.
    ///
    /// No run needs this. You may call it at any time, also beside runs, and repeat it.
    ///
    /// # Errors
    /// If the plan of the folder has changed, or files cannot be read or written.
    pub fn prepare(&self) -> Result<(), StudyError> {
        self.check_plan()?;
        let root = self.folder();
        let _lock = Lock::take(root)?;
        for ramp in 0..self.plan().ramp_count() {
            let folder = self.folder.ramp(ramp);
            fs::create_dir_all(&folder).map_err(StudyError::io("create", &folder))?;
            let (path, value) = (folder.join(VALUE), value(self.plan(), ramp));
            if fs::read(&path).is_ok_and(|found| found == value.as_bytes()) {
                continue;
            }
            // The file comes by way of the root, whose lock is held. The process that does the ramp removes
            // temporary files from the folder of the ramp.
            file::move_in(root, &path, value.as_bytes())?;
        }
        Ok(())
    }
}

/// Returns the parameters that distinguish a ramp from the others, as JSON.
fn value<E: Experiment>(plan: &Plan<E>, ramp: usize) -> String {
    let mut fields = vec![("ramp", Scalar::from(ramp as u64))];
    fields.extend((plan.repeats() > 1).then(|| ("repeat", Scalar::from((ramp % plan.repeats()) as u64))));
    fields.extend(plan.parameters_at(ramp, None));
    let fields: Vec<String> =
        fields.iter().map(|(name, value)| format!("{}: {}", quoted(name), json(value))).collect();
    format!("{{{}}}\n", fields.join(", "))
}

fn json(value: &Scalar) -> String {
    match value {
        Scalar::Text(text) => quoted(text),
        other => other.to_string(),
    }
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
