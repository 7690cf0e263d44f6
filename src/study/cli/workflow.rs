//! The workflow file of `row`, with the command for the folder of a ramp and the file that the command leaves
//! there.

use std::fs::File;
use std::io::{ErrorKind, Write};
use std::path::Path;

use crate::study::StudyError;

/// Writes `workflow.toml` into the folder of a study; an existing one stays as it is.
pub(super) fn write(folder: &Path) -> Result<(), StudyError> {
    let path = folder.join("workflow.toml");
    let program = std::env::current_exe().map_err(StudyError::io("find", Path::new("this program")))?;
    match File::create_new(&path).and_then(|mut file| file.write_all(text(&program).as_bytes())) {
        Err(error) if error.kind() != ErrorKind::AlreadyExists => Err(StudyError::io("write", &path)(error)),
        _ => Ok(()),
    }
}

/// Returns a workflow of one action, which does a ramp with this program.
fn text(program: &Path) -> String {
    let program = program.to_string_lossy().replace('\'', r"'\''");
    let command = format!("'{program}' run plan.toml --out . --threads 1 --ramp {{directory}}");
    format!(
        "\
# How `row` does this study, ramp by ramp: `row submit` in this folder. It is yours to edit.

[workspace]
path = \"ramps\"
value_file = \"value.json\"

[[action]]
name = \"ramp\"
command = {}
products = [\"done\"]

[action.group]
maximum_size = 1

[action.resources]
walltime.per_directory = \"01:00:00\"
",
        toml::Value::String(command)
    )
}
